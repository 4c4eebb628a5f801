// light/pixel_choice.cpp - builds the tables that draw a pixel of a map.
// SPDX-License-Identifier: Apache-2.0
#include "light/pixel_choice.h"

#include "base/parallel.h"
#include "light/cdf_table.h"

#include <algorithm>
#include <array>
#include <bit>
#include <numeric>
#include <span>

namespace obscura {
namespace {

constexpr auto pixels_of_block = static_cast<size_t>(choice_block_pixels);
constexpr uint32_t cell_numbers = 1U << 24;  ///< random numbers of one pixel's cell
constexpr uint32_t pixel_bits = 8;           ///< low bits, which hold the cell's other pixel

using BlockWeights = std::array<double, pixels_of_block>;
using BlockNumbers = std::array<uint32_t, pixels_of_block>;

/// Position of (x, y) on the Hilbert curve through a square of `side` (a power of two).
uint64_t position_on_curve(uint32_t side, uint32_t x, uint32_t y) {
    uint64_t place = 0;
    for (uint32_t half = side / 2; half > 0; half /= 2) {
        const bool right = (x & half) != 0;
        const bool down = (y & half) != 0;
        const uint64_t quarter = right ? (down ? 2 : 3) : (down ? 1 : 0);
        place = place * 4 + quarter;
        if (down) continue;
        // The first and the last quarter are transposed, the last one also mirrored.
        if (right) {
            x = side - 1 - x;
            y = side - 1 - y;
        }
        std::swap(x, y);
    }
    return place;
}

/// Row-major numbers of a grid's blocks, in the order of the curve.
std::vector<uint32_t> curve_order(uint32_t columns, uint32_t rows) {
    const uint32_t side = std::bit_ceil(std::max(columns, rows));
    std::vector<uint64_t> place(size_t{columns} * rows);
    parallel_for(rows, [&](size_t row) {
        for (uint32_t column = 0; column < columns; ++column)
            place[row * columns + column] =
                position_on_curve(side, column, static_cast<uint32_t>(row));
    });
    std::vector<uint32_t> order(place.size());
    std::iota(order.begin(), order.end(), 0U);
    std::sort(
        order.begin(), order.end(), [&](uint32_t a, uint32_t b) { return place[a] < place[b]; });
    return order;
}

/// How many of the 2^30 random numbers of a block lead to each pixel.
BlockNumbers share_numbers(const BlockWeights& weights) {
    const std::vector<uint64_t> bounds = share_randoms(std::span<const double>(weights), 4);
    BlockNumbers numbers;
    for (size_t i = 0; i < pixels_of_block; ++i)
        numbers[i] = static_cast<uint32_t>((bounds[i + 1] - bounds[i]) / 4);
    return numbers;
}

/// Walker's alias tables: cells that a pixel does not fill are completed by one with an excess.
void write_choices(BlockNumbers numbers, std::span<uint32_t> out) {
    std::vector<uint32_t> small;
    std::vector<uint32_t> large;
    for (uint32_t i = 0; i < numbers.size(); ++i) {
        out[i] = (cell_numbers - 1) << pixel_bits | i;
        if (numbers[i] < cell_numbers) small.push_back(i);
        if (numbers[i] > cell_numbers) large.push_back(i);
    }
    while (!small.empty()) {
        const uint32_t cell = small.back();
        const uint32_t giver = large.back();
        small.pop_back();
        out[cell] = numbers[cell] << pixel_bits | giver;
        numbers[giver] -= cell_numbers - numbers[cell];
        if (numbers[giver] > cell_numbers) continue;
        large.pop_back();
        if (numbers[giver] < cell_numbers) small.push_back(giver);
    }
}

/// The guide of draw_block.
///
/// In  bounds: as from share_randoms
std::vector<uint32_t> make_guide(std::span<const uint64_t> bounds, int shift) {
    std::vector<uint32_t> guide(size_t{1} << (32 - shift));
    uint32_t block = 0;
    for (uint64_t part = 0; part < guide.size(); ++part) {
        while (bounds[block + 1] <= part << shift)
            ++block;
        guide[part] = block;
    }
    return guide;
}

/// How many of the 2^30 random numbers of a block lead to each pixel, counted from the tables.
BlockNumbers count_numbers(std::span<const uint32_t> choices) {
    BlockNumbers numbers{};
    for (size_t i = 0; i < pixels_of_block; ++i) {
        const uint32_t stay = choices[i] >> pixel_bits;
        numbers[i] += stay;
        numbers[choices[i] & 0xFFU] += cell_numbers - stay;
    }
    return numbers;
}

/// Calls visit(number in the block, x, y) for the pixels of a block that lie in the map.
template <typename Visit>
void for_pixels(uint32_t corner, int width, int height, const Visit& visit) {
    for (int i = 0; i < choice_block_pixels; ++i) {
        const int x = static_cast<int>(corner & 0xFFFFU) + i % choice_block_side;
        const int y = static_cast<int>(corner >> 16) + i / choice_block_side;
        if (x < width && y < height) visit(static_cast<size_t>(i), x, y);
    }
}

}  // namespace

void PixelChoice::build(int width,
                        int height,
                        const PixelWeight& weight,
                        const SetProbability& set) {
    constexpr auto side = static_cast<uint32_t>(choice_block_side);
    const uint32_t columns = (static_cast<uint32_t>(width) + side - 1) / side;
    corners_ = curve_order(columns, (static_cast<uint32_t>(height) + side - 1) / side);
    for (uint32_t& corner : corners_)
        corner = ((corner / columns * side) << 16) | (corner % columns * side);
    std::vector<double> sums(corners_.size());
    choices_.resize(corners_.size() * pixels_of_block);
    const auto choices_of = [&](size_t block) {
        return std::span(choices_).subspan(block * pixels_of_block, pixels_of_block);
    };
    parallel_for(corners_.size(), [&](size_t block) {
        BlockWeights weights{};
        for_pixels(corners_[block], width, height, [&](size_t i, int x, int y) {
            weights[i] = weight(x, y);
        });
        sums[block] = std::accumulate(weights.begin(), weights.end(), 0.0);
        if (!(sums[block] > 0)) weights[0] = 1;  // pixels outside the map are never drawn
        write_choices(share_numbers(weights), choices_of(block));
    });
    const std::vector<uint64_t> bounds = share_randoms(sums, 1);
    // Twice as many parts as blocks, so that the search after the guide is short.
    guide_shift_ = 31 - static_cast<int32_t>(std::bit_width(corners_.size() - 1));
    guide_ = make_guide(bounds, guide_shift_);
    bounds_.assign(bounds.size() + 3, 0xFFFFFFFFU);  // gather4 reads three after the last block
    for (size_t block = 0; block < bounds.size(); ++block)
        bounds_[block] = static_cast<uint32_t>(bounds[block] - 1);
    parallel_for(corners_.size(), [&](size_t block) {
        const double share = static_cast<double>(bounds[block + 1] - bounds[block]) * 0x1p-62;
        const BlockNumbers numbers = count_numbers(choices_of(block));
        for_pixels(corners_[block], width, height, [&](size_t i, int x, int y) {
            set(x, y, share * static_cast<double>(numbers[i]));
        });
    });
}

PixelChoiceView PixelChoice::view() const {
    return {guide_.data(), bounds_.data(), corners_.data(), choices_.data(), guide_shift_};
}

}  // namespace obscura
