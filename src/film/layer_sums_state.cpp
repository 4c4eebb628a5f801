// film/layer_sums_state.cpp - sums of layers as bytes, to go on from.
// SPDX-License-Identifier: Apache-2.0
#include "film/layer_sums.h"

namespace obscura {

void LayerSums::put(StateWriter& out) const {
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
        out.put_unless_zero(blocks);
        out.put_unless_zero(parts);
    }
    out.put_array(nearest_values_);
    out.put_array(nearest_m_);
    out.put_array(luminance_);
    out.put_array(rays_);
    for (const CryptomattePixel& matte : mattes_)
        matte.put(out);
}

void LayerSums::take(StateReader& in) {
    in.take_array(sums_are_new_);
    std::vector<double> blocks(pixels_);
    std::vector<std::array<float, 4>> parts(pixels_);
    for (size_t k = 0; k < sums_are_new_.size(); ++k) {
        if (sums_are_new_[k] != 0) continue;
        in.take_unless_zero(blocks);
        in.take_unless_zero(parts);
        for (size_t p = 0; p < pixels_; ++p)
            sums_[k * pixels_ + p] = {blocks[p], parts[p]};
    }
    in.take_array(nearest_values_);
    in.take_array(nearest_m_);
    in.take_array(luminance_);
    in.take_array(rays_);
    for (CryptomattePixel& matte : mattes_)
        matte.take(in);
}

}  // namespace obscura
