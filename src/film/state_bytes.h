// film/state_bytes.h - numbers, texts and arrays of a film's state as bytes of a file, and back.
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "base/atomic_file.h"
#include "base/checksum.h"
#include "base/file_bytes.h"

#include <algorithm>
#include <bit>
#include <cstddef>
#include <cstdint>
#include <limits>
#include <span>
#include <string>
#include <type_traits>
#include <utility>
#include <vector>

namespace obscura {

/// Names with texts, in the order of the command line; a name may come twice.
using NamedTexts = std::vector<std::pair<std::string, std::string>>;

static_assert(std::endian::native == std::endian::little);

/// What may be stored as the bytes that it has in memory.
template <typename T>
concept PlainBytes = std::is_trivially_copyable_v<T> && !std::is_pointer_v<T>;

/// Hands pieces to a file in large blocks, with their checksum behind them, or keeps them.
class StateWriter {
public:
    StateWriter() = default;
    explicit StateWriter(const ByteSink& sink) : sink_(&sink) { block_.reserve(block_size); }

    void put(const void* data, size_t size);
    void put_number(uint64_t number) { put(&number, sizeof(number)); }
    void put_texts(const NamedTexts& texts);
    /// The number of elements, then their bytes.
    template <PlainBytes T>
    void put_array(const std::vector<T>& array) {
        put_number(array.size());
        put(array.data(), array.size() * sizeof(T));
    }
    /// Whether an element is not zero, and if so the array.
    template <PlainBytes T>
    void put_unless_zero(const std::vector<T>& array) {
        const auto* const bytes = reinterpret_cast<const char*>(array.data());
        const size_t size = array.size() * sizeof(T);
        const bool has_any = std::any_of(bytes, bytes + size, [](char byte) { return byte != 0; });
        put_number(has_any ? 1 : 0);
        if (has_any) put(bytes, size);
    }
    /// Numbers without their number: as floats where that loses no bit, mostly sums of one block.
    void put_doubles(const std::vector<double>& numbers);
    /// Without a sink: all pieces.
    const Bytes& kept() const { return block_; }
    /// Writes the checksum of all pieces.
    ///
    /// Errors  those of the sink, at any piece
    Result<void> finish();

private:
    static constexpr size_t block_size = size_t{1} << 20;

    void flush();

    const ByteSink* sink_ = nullptr;
    Bytes block_;
    RunningChecksum sum_;
    Result<void> done_ = {};
};

/// Reads what StateWriter put; past the end there are zeros, and `good` is false.
class StateReader {
public:
    explicit StateReader(std::span<const std::byte> bytes) : rest_(bytes) {}

    bool good() const { return good_; }
    bool at_end() const { return rest_.empty(); }

    void take(void* out, uint64_t size);
    uint64_t number() {
        uint64_t out = 0;
        take(&out, sizeof(out));
        return out;
    }
    /// A number of an int's range, from 0; another one is not good.
    int integer() {
        const uint64_t out = number();
        good_ = good_ && out <= std::numeric_limits<int>::max();
        return good_ ? static_cast<int>(out) : 0;
    }
    std::string text();
    NamedTexts texts();
    /// An array of as many elements as `out` has; another one is not good.
    template <PlainBytes T>
    void take_array(std::vector<T>& out) {
        good_ = number() == out.size() && good_;
        take(out.data(), out.size() * sizeof(T));
    }
    /// What put_unless_zero put of as many elements.
    template <PlainBytes T>
    void take_unless_zero(std::vector<T>& out) {
        if (number() != 0) {
            take(out.data(), out.size() * sizeof(T));
        } else {
            std::fill(out.begin(), out.end(), T{});
        }
    }
    /// What put_doubles put of as many elements.
    void take_doubles(std::vector<double>& out);
    /// A reader of the bytes that were put as an array.
    StateReader piece() {
        const uint64_t size = number();
        good_ = good_ && size <= rest_.size();
        StateReader out(rest_.first(good_ ? size : 0));
        rest_ = rest_.subspan(good_ ? size : 0);
        return out;
    }
    /// An array of any number of elements.
    template <PlainBytes T>
    void take_new_array(std::vector<T>& out) {
        const uint64_t size = number();
        good_ = good_ && size <= rest_.size() / sizeof(T);
        out.resize(good_ ? size : 0);
        take(out.data(), out.size() * sizeof(T));
    }

private:
    std::span<const std::byte> rest_;
    bool good_ = true;
};

}  // namespace obscura
