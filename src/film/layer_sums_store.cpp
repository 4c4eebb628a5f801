// film/layer_sums_store.cpp - the sums of layers become the film's pixels.
// SPDX-License-Identifier: Apache-2.0
#include "film/layer_sums.h"
#include "image/channel_planes.h"

#include <algorithm>
#include <bit>
#include <cmath>
#include <limits>
#include <vector>

namespace obscura {

namespace {

/// 1 where no light could arrive.
float ratio(double arrived, double unoccluded) {
    return unoccluded > 0 ? static_cast<float>(arrived / unoccluded) : 1.0f;
}

/// Writes the pixels of one layer, which are 0, but no zeros over them: an array of zeros takes no
/// memory where nothing is written. Nothing is read either: a page that is read before it is
/// written costs two page faults and, on all threads, a flush of address translations.
///
/// In      at: as of store
///         value: writes all channels of a pixel of the tile
template <typename Value>
void write_pixels(std::span<const size_t> at, FilmLayer& layer, const Value& value) {
    const size_t channels = layer.layer.channels.size();
    std::vector<float> values(at.size() * channels);
    for (size_t p = 0; p < at.size(); ++p)
        value(p, std::span(values).subspan(p * channels, channels));
    for_planes(channels, layer.pixels.size() / channels, [&](const ChannelPlane& plane) {
        const auto is_zero = [](float x) { return std::bit_cast<uint32_t>(x) == 0; };
        const auto pixel = [&](size_t p) {
            return std::span(values).subspan(p * channels + plane.first_channel, plane.channels);
        };
        for (size_t p = 0; p < at.size(); ++p) {
            if (std::ranges::all_of(pixel(p), is_zero)) continue;
            std::ranges::copy(pixel(p), &layer.pixels[plane.first_value + at[p] * plane.channels]);
        }
    });
}

}  // namespace

void LayerSums::store(const LayerPlan& plan, const SampledPixels& pixels, Film& film) const {
    const std::span<const size_t> at = pixels.at;
    const std::span<const int> samples = pixels.samples;
    const auto count = [&](size_t p) { return static_cast<uint32_t>(samples[p]); };
    for (size_t k = 0; k < plan.layers_.size(); ++k) {
        const Layer& layer = plan.layers_[k];
        const LayerPlan::Source& source = plan.sources_[k];
        const auto write = [&](const auto& value) { write_pixels(at, film.layers[k], value); };
        const auto matte = [&](size_t p) -> const CryptomattePixel& {
            return mattes_[p * plan.mattes_ + source.matte];
        };
        if (std::holds_alternative<LightLayer>(layer.source)) {
            store_light(source, pixels, film.layers[k]);
        } else if (is_reduced(layer, Reduction::mean)) {
            write([&, sums = sums_of(source.first_sum)](size_t p, std::span<float> out) {
                for (size_t c = 0; c < out.size(); ++c)
                    out[c] = static_cast<float>(sums[p * out.size() + c].total() / samples[p]);
            });
        } else if (const auto* mean = std::get_if<PartMean>(&layer.source)) {
            write([&, sums = sums_of(source.first_sum)](size_t p, std::span<float> out) {
                const size_t part = samples_in(*mean, static_cast<size_t>(samples[p]));
                const double inverse = part > 0 ? 1.0 / static_cast<double>(part) : 0.0;
                for (size_t c = 0; c < out.size(); ++c)
                    out[c] = static_cast<float>(sums[p * out.size() + c].total() * inverse);
            });
        } else if (std::holds_alternative<ShadowRatio>(layer.source)) {
            store_ratio(source, pixels, film.layers[k]);
        } else if (is_reduced(layer, Reduction::nearest)) {
            write([&](size_t p, std::span<float> out) {
                const float* from = &nearest_values_[p * plan.values_ + source.first_value];
                std::copy_n(from, out.size(), out.begin());
            });
        } else if (std::holds_alternative<MajorityNode>(layer.source)) {
            write([&](size_t p, std::span<float> out) {
                out[0] = static_cast<float>(matte(p).majority(count(p)));
            });
        } else if (source.hashes != nullptr) {
            write([&](size_t p, std::span<float> out) { matte(p).write_ranks(count(p), out); });
        } else {
            const auto wanted = std::get<SampleStatistic>(layer.source);
            write(
                [&](size_t p, std::span<float> out) { out[0] = statistic(wanted, p, samples[p]); });
        }
    }
}

/// Of what a shadow catcher hides, the part that shows.
void LayerSums::store_light(const LayerPlan::Source& source,
                            const SampledPixels& pixels,
                            FilmLayer& layer) const {
    const bool catches = !pixels.catchers.empty();
    const Sum* const front = sums_of(source.first_sum);
    const Sum* const behind = catches ? sums_of(source.first_behind) : nullptr;
    if (front == nullptr && behind == nullptr) return;
    write_pixels(pixels.at, layer, [&](size_t p, std::span<float> out) {
        const double passes =
            behind != nullptr ? 1 - shadow_alpha(pixels.catchers[p].total()) : 0.0;
        for (size_t c = 0; c < out.size(); ++c) {
            const size_t at = p * light_channels + c;
            double sum = front != nullptr ? front[at].total() : 0.0;
            if (behind != nullptr) sum += passes * behind[at].total();
            out[c] = static_cast<float>(sum / pixels.samples[p]);
        }
    });
}

void LayerSums::store_ratio(const LayerPlan::Source& source,
                            const SampledPixels& pixels,
                            FilmLayer& layer) const {
    const Sum* const shadowed = sums_of(source.first_sum);
    const Sum* const unshadowed = sums_of(source.first_sum + light_channels);
    const auto total = [](const Sum* sums, size_t at) {
        return sums != nullptr ? sums[at].total() : 0.0;
    };
    write_pixels(pixels.at, layer, [&](size_t p, std::span<float> out) {
        for (size_t c = 0; c < out.size(); ++c) {
            const size_t at = p * light_channels + c;
            out[c] = ratio(total(shadowed, at), total(unshadowed, at));
        }
    });
}

float LayerSums::statistic(SampleStatistic statistic, size_t pixel, double samples) const {
    switch (statistic) {
        case SampleStatistic::sample_count:
            return static_cast<float>(samples);
        case SampleStatistic::cost:
            return static_cast<float>(rays_[pixel]);
        case SampleStatistic::variance:
            break;
    }
    if (samples < 2) return 0;
    const Luminance y = luminance_[pixel].total();
    const double mean = y.sum / samples;
    const double spread = std::max(y.squares / samples - mean * mean, 0.0);
    constexpr double most = std::numeric_limits<float>::max();
    return static_cast<float>(std::min(spread / (samples - 1), most));
}

}  // namespace obscura
