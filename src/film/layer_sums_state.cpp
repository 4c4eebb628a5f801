// film/layer_sums_state.cpp - sums of layers as bytes, and added to those of earlier samples.
// SPDX-License-Identifier: Apache-2.0
#include "film/layer_sums.h"

#include <algorithm>

namespace obscura {

void LayerSums::put_sums(StateWriter& out) const {
    out.put_array(sums_are_new_);
    std::vector<double> blocks(pixels_);
    std::vector<std::array<float, 4>> parts(pixels_);
    for (size_t k = 0; k < sums_are_new_.size(); ++k) {
        if (sums_are_new_[k] != 0) continue;
        for (size_t p = 0; p < pixels_; ++p) {
            const Sum& sum = sums_[k * pixels_ + p];
            blocks[p] = sum.blocks;
            parts[p] = sum.parts;
        }
        out.put_doubles(blocks);
        out.put_unless_zero(parts);
    }
    out.put_array(luminance_);
}

void LayerSums::take_sums(StateReader& in) {
    in.take_array(sums_are_new_);
    std::vector<double> blocks(pixels_);
    std::vector<std::array<float, 4>> parts(pixels_);
    for (size_t k = 0; k < sums_are_new_.size(); ++k) {
        if (sums_are_new_[k] != 0) continue;
        in.take_doubles(blocks);
        in.take_unless_zero(parts);
        for (size_t p = 0; p < pixels_; ++p)
            sums_[k * pixels_ + p] = {blocks[p], parts[p]};
    }
    in.take_array(luminance_);
}

void LayerSums::put(StateWriter& out) const {
    put_sums(out);
    out.put_array(nearest_values_);
    out.put_array(nearest_m_);
    out.put_array(rays_);
    for (const CryptomattePixel& matte : mattes_)
        matte.put(out);
}

void LayerSums::take(StateReader& in) {
    take_sums(in);
    in.take_array(nearest_values_);
    in.take_array(nearest_m_);
    in.take_array(rays_);
    for (CryptomattePixel& matte : mattes_)
        matte.take(in);
}

void LayerSums::end_block(StateWriter& out) {
    put_sums(out);
    std::fill(sums_are_new_.begin(), sums_are_new_.end(), uint8_t{1});
    std::fill(luminance_.begin(), luminance_.end(), BlockSum<Luminance>{});
}

void LayerSums::take_block(StateReader& in) {
    take_sums(in);
}

void LayerSums::append(const LayerSums& later) {
    for (size_t k = 0; k < sums_are_new_.size(); ++k) {
        if (later.sums_are_new_[k] != 0) continue;
        Sum* const sums = begun_sums(k, 1);
        for (size_t p = 0; p < pixels_; ++p) {
            const Sum& from = later.sums_[k * pixels_ + p];
            sums[p] = {sums[p].blocks + from.blocks, from.parts};
        }
    }
    const size_t values = nearest_values_.size() / std::max<size_t>(pixels_, 1);
    for (size_t p = 0; p < nearest_m_.size(); ++p) {
        if (!(later.nearest_m_[p] < nearest_m_[p])) continue;
        nearest_m_[p] = later.nearest_m_[p];
        std::copy_n(&later.nearest_values_[p * values], values, &nearest_values_[p * values]);
    }
    for (size_t p = 0; p < luminance_.size(); ++p)
        luminance_[p].append(later.luminance_[p]);
    for (size_t p = 0; p < rays_.size(); ++p)
        rays_[p] += later.rays_[p];
    for (size_t i = 0; i < mattes_.size(); ++i)
        mattes_[i].append(later.mattes_[i]);
}

}  // namespace obscura
