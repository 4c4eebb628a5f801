// image/basis_lz_slice.cpp - reads a BasisLZ slice: an endpoint and a selector for each block.
// SPDX-License-Identifier: Apache-2.0
#include "image/basis_lz.h"

#include <utility>

namespace obscura {

namespace {

/// The source of a block's endpoint.
enum Prediction : uint32_t { from_left, from_above, from_above_left, from_delta };

constexpr uint32_t repeat_prediction = 256;  ///< follows all combinations of four predictions
constexpr uint64_t min_prediction_run = 3;
constexpr uint64_t min_selector_run = 3;
constexpr int long_selector_run = 63;  ///< its length follows

/// Recently used selectors; when one is used again, its index is halved.
class SelectorHistory {
public:
    explicit SelectorHistory(size_t size) : values_(size), next_(size / 2) {}

    size_t size() const { return values_.size(); }

    void add(uint16_t selector) {
        if (values_.empty()) return;
        values_[next_++] = selector;
        if (next_ == values_.size()) next_ = values_.size() / 2;
    }

    uint16_t use(size_t index) {
        const uint16_t selector = values_[index];
        std::swap(values_[index / 2], values_[index]);
        return selector;
    }

private:
    std::vector<uint16_t> values_;
    size_t next_;
};

/// A number in chunks of `chunk` bits, the lowest first, each followed by a continuation bit;
/// nullopt: more than 32 bits.
std::optional<uint32_t> read_chunked(BitReader& bits, int chunk) {
    uint32_t value = 0;
    for (int at = 0; at < 32; at += chunk) {
        const uint32_t read = bits.read(chunk + 1);
        value |= (read & ((1U << chunk) - 1)) << at;
        if (read >> chunk == 0) return value;
    }
    return std::nullopt;
}

class SliceReader {
public:
    SliceReader(std::span<const std::byte> bytes,
                const BasisLzCodebooks& books,
                const BasisLzCodes& codes)
        : bits_(bytes), books_(books), codes_(codes), history_(codes.history_size) {}

    std::optional<std::vector<BasisLzBlock>> read(size_t columns, size_t rows);

private:
    // These return false for broken data.
    bool read_predictions(uint32_t& of_four_blocks);
    bool read_endpoint(size_t x, size_t y, uint32_t prediction);
    bool read_selector();

    BitReader bits_;
    const BasisLzCodebooks& books_;
    const BasisLzCodes& codes_;
    SelectorHistory history_;
    std::vector<BasisLzBlock> blocks_;
    size_t columns_ = 0;
    size_t at_ = 0;               ///< the block that is being read
    uint32_t last_endpoint_ = 0;  ///< of the block before
    uint32_t last_predictions_ = 0;
    uint64_t prediction_run_ = 0;  ///< how often last_predictions_ is still repeated
    uint64_t selector_run_ = 0;    ///< how often the latest selector in the history is
};

bool SliceReader::read_predictions(uint32_t& of_four_blocks) {
    if (prediction_run_ > 0) {
        --prediction_run_;
    } else {
        const int symbol = codes_.endpoint_prediction.decode(bits_);
        if (symbol < 0 || symbol > static_cast<int>(repeat_prediction)) return false;
        if (symbol == static_cast<int>(repeat_prediction)) {
            const std::optional<uint32_t> more = read_chunked(bits_, 4);
            if (!more) return false;
            prediction_run_ = *more + min_prediction_run - 1;
        } else {
            last_predictions_ = static_cast<uint32_t>(symbol);
        }
    }
    of_four_blocks = last_predictions_;
    return true;
}

bool SliceReader::read_endpoint(size_t x, size_t y, uint32_t prediction) {
    if (prediction == from_delta) {
        const int delta = codes_.endpoint_delta.decode(bits_);
        if (delta < 0) return false;
        const auto count = static_cast<uint32_t>(books_.endpoints.size());
        last_endpoint_ += static_cast<uint32_t>(delta);
        if (last_endpoint_ >= count) last_endpoint_ -= count;
        if (last_endpoint_ >= count) return false;
    } else {
        const bool needs_left = prediction != from_above;
        const bool needs_above = prediction != from_left;
        if ((needs_left && x == 0) || (needs_above && y == 0)) return false;
        last_endpoint_ =
            blocks_[at_ - (needs_left ? 1 : 0) - (needs_above ? columns_ : 0)].endpoint;
    }
    blocks_[at_].endpoint = static_cast<uint16_t>(last_endpoint_);
    return true;
}

bool SliceReader::read_selector() {
    const size_t count = books_.selectors.size();
    size_t symbol = count;  // the latest in the history
    if (selector_run_ > 0) {
        --selector_run_;
    } else {
        const int read = codes_.selector.decode(bits_);
        if (read < 0) return false;
        symbol = static_cast<size_t>(read);
        if (symbol == count + history_.size()) {
            const int length = codes_.selector_run.decode(bits_);
            if (length < 0 || length > long_selector_run) return false;
            uint64_t more = static_cast<uint64_t>(length);
            if (length == long_selector_run) {
                const std::optional<uint32_t> long_length = read_chunked(bits_, 7);
                if (!long_length) return false;
                more = *long_length;
            }
            selector_run_ = more + min_selector_run - 1;
            symbol = count;
        }
    }
    if (symbol < count) {
        blocks_[at_].selector = static_cast<uint16_t>(symbol);
        history_.add(blocks_[at_].selector);
        return true;
    }
    if (symbol - count >= history_.size()) return false;
    blocks_[at_].selector = history_.use(symbol - count);
    return true;
}

std::optional<std::vector<BasisLzBlock>> SliceReader::read(size_t columns, size_t rows) {
    columns_ = columns;
    blocks_.resize(columns * rows);
    std::vector<uint32_t> predictions((columns + 1) / 2);  // of two by two blocks, two bits each
    for (size_t y = 0; y < rows; ++y) {
        for (size_t x = 0; x < columns; ++x, ++at_) {
            uint32_t& four = predictions[x / 2];
            if (x % 2 == 0 && y % 2 == 0 && !read_predictions(four)) return std::nullopt;
            const uint32_t prediction = four >> (4 * (y % 2) + 2 * (x % 2)) & 3U;
            if (!read_endpoint(x, y, prediction) || !read_selector()) return std::nullopt;
        }
        if (bits_.overran()) return std::nullopt;
    }
    return std::move(blocks_);
}

}  // namespace

std::optional<std::vector<BasisLzBlock>> read_slice(std::span<const std::byte> bytes,
                                                    const BasisLzCodebooks& books,
                                                    const BasisLzCodes& codes,
                                                    size_t columns,
                                                    size_t rows) {
    if (books.endpoints.empty() || books.selectors.empty()) return std::nullopt;
    return SliceReader(bytes, books, codes).read(columns, rows);
}

}  // namespace obscura
