// math/table_record.h - reads a record of a table per lane, cheaper where all lanes share it.
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "math/gather4.h"
#include "math/vec.h"
#include "math/word_of.h"

namespace obscura {
inline namespace OBSCURA_ISA {

/// One record of a table of 32-bit words for every lane, read by the names of its members:
/// record.number<&Material::roughness>(), record.integer<&Primitive::uv_base>(set). Neighbouring
/// hits mostly lie on the same surface: if all lanes read the same record, a scalar load replaces
/// the gather.
template <typename F, typename Record>
class TableRecord {
public:
    TableRecord() = default;

    /// In  index: of the records, valid in idle lanes too
    OBSCURA_INLINE TableRecord(const Record* table, const IntOf<F>& index)
        : words_(reinterpret_cast<const int32_t*>(table)),
          first_(index * IntOf<F>(words_per_record<Record>)) {
        const int32_t index_of_first = first_lane(index);
        shared_ = all(index == IntOf<F>(index_of_first));
        record_words_ = words_ + static_cast<int64_t>(index_of_first) * words_per_record<Record>;
    }

    /// True when all lanes have the same record; then one_integer reads a word of it.
    OBSCURA_INLINE bool shared() const { return shared_; }
    template <auto... member>
    OBSCURA_INLINE int32_t one_integer() const {
        return record_words_[integer_word<member...>()];
    }

    /// In  element: of a member that is an array; else 0
    template <auto... member>
    OBSCURA_INLINE IntOf<F> integer(int element = 0) const {
        const int word = integer_word<member...>() + element;
        if (shared_) return IntOf<F>(record_words_[word]);
        return gather<F>(words_ + word, first_);
    }

    /// Another element of an array for every lane.
    template <auto... member>
    OBSCURA_INLINE IntOf<F> varying_integer(const IntOf<F>& element) const {
        return gather<F>(
            words_, IntOf<F>(first_ + IntOf<F>(element + IntOf<F>(integer_word<member...>()))));
    }

    template <auto... member>
    OBSCURA_INLINE F number(int element = 0) const {
        const int word = number_word<member...>() + element;
        if (shared_) return F(bits_float(record_words_[word]));
        return gather<F>(reinterpret_cast<const float*>(words_) + word, first_);
    }

    /// Elements [first, first + 4) of the array; may run past its end, but not past the table's.
    template <auto... member>
    OBSCURA_INLINE Four<F> four_numbers(int first = 0) const {
        const int word = number_word<member...>() + first;
        if (shared_) {
            const auto one = [&](int k) { return F(bits_float(record_words_[word + k])); };
            return {one(0), one(1), one(2), one(3)};
        }
        return gather4<F>(reinterpret_cast<const float*>(words_) + word, first_);
    }

    /// Three numbers that are followed by at least one more word.
    template <auto... member>
    OBSCURA_INLINE Vec3<F> vector() const {
        static_assert(number_word<member...>() + 4 <= words_per_record<Record>);
        const Four<F> words = four_numbers<member...>();
        return {words.x, words.y, words.z};
    }

private:
    template <auto first, auto... rest>
    static constexpr bool is_own = std::is_same_v<RecordOf<first>, Record>;

    template <auto... member>
    static consteval int integer_word() {
        static_assert(is_own<member...>, "another table's member");
        static_assert(std::is_integral_v<ElementOf<member...>>, "no integer");
        return word_of<member...>;
    }
    template <auto... member>
    static consteval int number_word() {
        static_assert(is_own<member...>, "another table's member");
        static_assert(std::is_same_v<ElementOf<member...>, float>, "no number");
        return word_of<member...>;
    }

    const int32_t* words_ = nullptr;
    const int32_t* record_words_ = nullptr;  ///< the first lane's record
    IntOf<F> first_{};                       ///< first word of each lane's record
    bool shared_ = false;
};

}  // namespace OBSCURA_ISA
}  // namespace obscura
