// light/pixel_choice.h - draws a pixel of a map in proportion to its weight, in constant time.
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "math/gather4.h"
#include "math/sampler.h"
#include "math/vec.h"

#include <cstdint>
#include <functional>
#include <vector>

namespace obscura {

/// Side of the square blocks of pixels. Blocks are chosen in the order of a space-filling curve, so
/// that stratified random numbers give stratified blocks. Within a block an alias table chooses the
/// pixel: it scatters neighbouring numbers, but only within the block.
inline constexpr int choice_block_side = 8;
inline constexpr int choice_block_pixels = choice_block_side * choice_block_side;

/// A view of a PixelChoice, which owns the arrays.
struct PixelChoiceView {
    /// [k]: block of the first random number in part k of 2^(32 - guide_shift) equal parts
    const uint32_t* guide = nullptr;
    /// [k]: the last random number that leads to a block before block k
    const uint32_t* bounds = nullptr;
    /// [k]: first pixel of block k, its column in the lower half and its row in the upper
    const uint32_t* corners = nullptr;
    /// One per pixel, choice_block_pixels per block: how many of 2^24 random numbers choose this
    /// pixel, and in the lower 8 bits the pixel of the block that the others choose
    const uint32_t* choices = nullptr;
    int32_t guide_shift = 31;
};

/// The tables that draw a pixel.
class PixelChoice {
public:
    using PixelWeight = std::function<double(int x, int y)>;
    using SetProbability = std::function<void(int x, int y, double probability)>;

    /// The same weights give the same tables. Both functions are called from many threads.
    ///
    /// In      width and height: 1 to 32768; weight: of the pixel in column x and row y, at least 0
    ///         and finite, as all their sums
    /// Out     set: called with the probability of every pixel; pixels with a weight above 0 have
    ///         at least 2^-62. If all weights are 0, the first pixels of blocks are drawn
    void build(int width, int height, const PixelWeight& weight, const SetProbability& set);

    /// Valid for as long as the tables live, wherever they are moved.
    PixelChoiceView view() const;

private:
    std::vector<uint32_t> guide_, bounds_, corners_, choices_;  ///< as in PixelChoiceView
    int32_t guide_shift_ = 31;
};

inline namespace OBSCURA_ISA {

/// State of a draw in two steps. Tables and map are too large for the caches: the first step
/// prefetches the memory of the second, and the caller can work in between.
template <typename F>
struct PixelDraw {
    Vec2<UintOf<F>> random;  ///< uniform 32-bit numbers
    IntOf<F> block;
    IntOf<F> column, row;  ///< after the second step
    Vec2<F> left;          ///< in [0, 1], uniform: the randomness that the choices left
};

/// Index of the entry of `choices` that the second step reads.
template <typename F>
OBSCURA_INLINE IntOf<F> choice_number(const PixelDraw<F>& draw) {
    return draw.block * IntOf<F>(choice_block_pixels) + as_int(draw.random.y >> 26);
}

/// First step: the block. The search is linear: on average it passes few entries of `bounds`.
template <typename F>
OBSCURA_INLINE PixelDraw<F> draw_block(const PixelChoiceView& view, const Vec2<UintOf<F>>& random) {
    using U = UintOf<F>;
    using I = IntOf<F>;
    PixelDraw<F> draw;
    draw.random = random;
    const U r = random.x;
    I low = as_int(gather<F>(view.guide, as_int(r >> view.guide_shift)));
    const auto* bounds = reinterpret_cast<const int32_t*>(view.bounds);
    auto window = gather4<F>(bounds, low);
    while (any(as_uint(window.w) < r)) {
        low = select(as_uint(window.w) < r, low + I(3), low);
        window = gather4<F>(bounds, low);
    }
    const auto second = as_uint(window.y) < r;
    const auto third = as_uint(window.z) < r;
    draw.block = select(third, low + I(2), select(second, low + I(1), low));
    const U before = as_uint(select(third, window.z, select(second, window.y, window.x)));
    const U last = as_uint(select(third, window.w, select(second, window.z, window.y)));
    // Relative to `before`; ahead of the first block that is all ones and wraps around.
    const F place = float_from_uint<F>(U(r - before - U(1U))) + F(0.5f);
    draw.left.x = place / (float_from_uint<F>(U(last - before - U(1U))) + F(1.0f));
    prefetch<F>(view.choices, choice_number(draw));
    return draw;
}

/// Second step: the pixel of the block.
///
/// Source  Walker, "An Efficient Method for Generating Discrete Random Variables with General
///         Distributions", ACM Transactions on Mathematical Software 3(3), 1977
template <typename F>
OBSCURA_INLINE void draw_pixel(const PixelChoiceView& view, PixelDraw<F>& draw) {
    using U = UintOf<F>;
    using I = IntOf<F>;
    constexpr int32_t all_numbers = 1 << 24;
    const U choice = gather<F>(view.choices, choice_number(draw));
    const I stays = as_int(choice >> 8);
    const I number = as_int((draw.random.y >> 2) & U(0xFFFFFFU));
    const auto own = number < stays;
    const I pixel = as_int(select(own, draw.random.y >> 26, choice & U(0xFFU)));
    const I place = select(own, number, number - stays);
    draw.left.y =
        (from_int<F>(place) + F(0.5f)) / from_int<F>(select(own, stays, I(all_numbers) - stays));
    const U corner = gather<F>(view.corners, draw.block);
    draw.column = as_int(corner & U(0xFFFFU)) + (pixel & I(choice_block_side - 1));
    draw.row = as_int(corner >> 16) + as_int(as_uint(pixel) >> 3);
}

}  // namespace OBSCURA_ISA
}  // namespace obscura
