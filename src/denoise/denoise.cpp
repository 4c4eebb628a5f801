// denoise/denoise.cpp - takes the noise out of an image, guided by its features and two halves.
// SPDX-License-Identifier: Apache-2.0
#include "denoise/denoise.h"

#include "denoise/features.h"
#include "denoise/frame.h"
#include "denoise/give_back.h"
#include "denoise/mix.h"
#include "denoise/reprojection.h"

#include <cmath>
#include <optional>
#include <utility>
#include <vector>

namespace obscura {

namespace {

float mean_of(const Rgb& from, int x, int y) {
    return (from[0].row(y)[x] + from[1].row(y)[x] + from[2].row(y)[x]) * (1.0f / 3.0f);
}

/// Where light goes that was taken from `beauty`: to noisy pixels.
///
/// In      filtered: the beauty without it
GiveBack plan_give_back(const Rgb& taken,
                        const Rgb& filtered,
                        const FilterGuides& guides,
                        const Mix& mix,
                        const Rgb& reflected) {
    const PlaneSize size{taken[0].width(), taken[0].height()};
    const Plane light =
        size.plane([&](int x, int y) { return std::max(mean_of(filtered, x, y), 0.0f); });
    const Plane variance = box_blur(halves_variance(guides.halves[0], guides.halves[1]), 1);
    Plane receives = size.plane([&](int x, int y) {
        const float noise = mean_of(reflected, x, y) * std::sqrt(variance.row(y)[x]);
        return (1 - mix.noisy.row(y)[x]) * std::min(noise, 0.5f * light.row(y)[x]);
    });
    return GiveBack(taken, light, std::move(receives));
}

/// What remains of light that is taken from the pixels that take part.
Rgb taken_light(const Rgb& before, const Rgb& after, const Plane& share) {
    const PlaneSize size{share.width(), share.height()};
    Rgb out;
    for (size_t c = 0; c < 3; ++c) {
        out[c] = size.plane([&](int x, int y) {
            return share.row(y)[x] > 0 ? before[c].row(y)[x] - after[c].row(y)[x] : 0.0f;
        });
    }
    return out;
}

/// By how much the filtered light of every layer is multiplied in a pixel, so that the beauty gets
/// what is returned to it.
Rgb gains(const Rgb& filtered, const Rgb& returned) {
    const PlaneSize size{filtered[0].width(), filtered[0].height()};
    Rgb out;
    for (size_t c = 0; c < 3; ++c) {
        out[c] = size.plane([&](int x, int y) {
            const float light = filtered[c].row(y)[x];
            return light > 0 ? std::max(1 + returned[c].row(y)[x] / light, 0.0f) : 1.0f;
        });
    }
    return out;
}

/// Writes a layer's colours where there is alpha.
void write(const Rgb& filtered,
           const Rgb& gain,
           const Rgb& returned,
           const Plane& share,
           const LightImage& to) {
    const PlaneSize size{share.width(), share.height()};
    for_rows(size.height, [&](int y) {
        for (int x = 0; x < size.width; ++x) {
            if (share.row(y)[x] == 0) continue;
            float* const pixel = &to.pixels[size.index(x, y) * to.channels];
            for (size_t c = 0; c < 3; ++c) {
                pixel[c] = filtered[c].row(y)[x] * gain[c].row(y)[x] + returned[c].row(y)[x];
            }
        }
    });
}

}  // namespace

DenoiseReport denoise(const DenoiseInput& input,
                      std::span<const LightImage> images,
                      std::span<const NeighborFrame> neighbors) {
    const PlaneSize size{input.width, input.height};
    std::vector<Frame> frames = {make_frame(input, images.subspan(1))};
    frames[0].guides.aliasing = aliasing_of(input, frames[0]);
    for (const NeighborFrame& neighbor : neighbors)
        frames.push_back(reproject(input, neighbor));
    const FilterGuides& guides = frames[0].guides;
    const Rgb& reflected = frames[0].reflected;
    const Candidates candidates = filter_halves(frames);
    const Mix mix = mix_candidates(guides, candidates);

    std::vector<Rgb> layers;
    if (images.size() > 1) layers = filter_layers(frames, candidates, mix);
    layers.insert(layers.begin(), mixed_halves(guides, candidates, mix, input.first_share));
    std::optional<GiveBack> give_back;
    Rgb gain;
    for (size_t i = 0; i < images.size(); ++i) {
        // A pixel without alpha reflects nothing here, and is not written.
        const Rgb filtered = product(layers[i], reflected);
        const Rgb before = size.rgb(images[i].pixels, images[i].channels);
        const Rgb lowered = product(before, frames[0].kept);
        if (!give_back) {
            const Rgb taken = taken_light(before, filtered, guides.share);
            give_back = plan_give_back(taken, filtered, guides, mix, reflected);
            gain = gains(filtered, give_back->spread(taken_light(lowered, filtered, guides.share)));
        }
        const Rgb of_outliers = give_back->spread(taken_light(before, lowered, guides.share));
        write(filtered, gain, of_outliers, guides.share, images[i]);
    }
    return {frames[0].outlier_share};
}

}  // namespace obscura
