// math/word_of.h - the offset of a member in a record that lanes read as 32-bit words.
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <bit>
#include <cstddef>
#include <cstdint>
#include <type_traits>

namespace obscura {

template <typename Record>
inline constexpr int32_t words_per_record = static_cast<int32_t>(sizeof(Record) / 4);

/// The record and the member type of a pointer to member.
template <typename T>
struct MemberTraits;
template <typename R, typename M>
struct MemberTraits<M R::*> {
    using Record = R;
    using Member = M;
};
template <auto member>
using RecordOf = typename MemberTraits<decltype(member)>::Record;

template <auto member>
using MemberOf = typename MemberTraits<decltype(member)>::Member;

/// A pointer to member as an empty value, to pass it to functions.
template <auto member>
struct Member {};

template <auto a, auto b>
inline constexpr bool same_member = std::is_same_v<Member<a>, Member<b>>;

/// A record's 32-bit words.
template <typename Record>
struct RecordWords {
    static_assert(sizeof(Record) % 4 == 0 && std::is_trivially_copyable_v<Record>);
    uint32_t word[sizeof(Record) / 4];
};

/// A record in which every word holds its own index.
template <typename Record>
constexpr Record numbered_words() {
    RecordWords<Record> words = {};
    for (uint32_t i = 0; i < sizeof(Record) / 4; ++i)
        words.word[i] = i;
    return std::bit_cast<Record>(words);
}

template <typename T>
constexpr const auto& first_element(const T& member) {
    if constexpr (std::is_array_v<T>) {
        return first_element(member[0]);
    } else {
        return member;
    }
}

/// The first word of a member, of a member within that member, and so on. Read from the record
/// itself at compile time, so that it stays right when members are reordered.
template <auto member, auto... inner>
constexpr int find_word() {
    constexpr RecordOf<member> record = numbered_words<RecordOf<member>>();
    const auto& first = first_element(record.*member);
    using Words = RecordWords<std::remove_cvref_t<decltype(first)>>;
    const auto word = static_cast<int>(std::bit_cast<Words>(first).word[0]);
    if constexpr (sizeof...(inner) == 0) {
        return word;
    } else {
        return word + find_word<inner...>();
    }
}

/// In   members: &Record::member, then &Member::its_member and so on
template <auto... members>
inline constexpr int word_of = find_word<members...>();

/// The type of the last member of such a chain.
template <auto first, auto... rest>
struct LastMember {
    using Type = typename LastMember<rest...>::Type;
};
template <auto only>
struct LastMember<only> {
    using Type = MemberOf<only>;
};
template <auto... members>
using LastMemberOf = typename LastMember<members...>::Type;

/// That type, or its element type if it is an array.
template <auto... members>
using ElementOf = std::remove_all_extents_t<LastMemberOf<members...>>;

}  // namespace obscura
