// film/layer_sums.cpp - samples of layers become pixels, tile by tile.
// SPDX-License-Identifier: Apache-2.0
#include "film/layer_sums.h"

#include "math/vec.h"

#include <algorithm>
#include <bit>
#include <cmath>
#include <limits>
#include <utility>

namespace obscura {

namespace {

/// The layer's AOV, if that is what it is.
const Aov* aov_of(const Layer& layer) {
    return std::get_if<Aov>(&layer.source);
}

bool is_majority(const Layer& layer) {
    return std::holds_alternative<MajorityNode>(layer.source);
}

bool is_reduced(const Layer& layer, Reduction reduction) {
    const Aov* aov = aov_of(layer);
    return aov != nullptr && entry_of(*aov).reduction == reduction;
}

/// Light layers are red, green and blue.
constexpr size_t light_channels = 3;

/// What LayerSums::add_means knows.
constexpr bool has_one_or_three_channels(const AovEntry& entry) {
    return entry.reduction != Reduction::mean || entry.letters.size() == 1 ||
           entry.letters.size() == 3;
}
static_assert(std::all_of(aov_entries.begin(), aov_entries.end(), has_one_or_three_channels));

/// Whether a sample belongs to the part.
bool is_in(const PartMean& mean, size_t sample) {
    if (mean.part == SamplePart::all) return true;
    const bool second = (sample / mean.run) % 2 == 1;
    return second == (mean.part == SamplePart::second_half);
}

/// 1 where no light could arrive.
float ratio(double arrived, double unoccluded) {
    return unoccluded > 0 ? static_cast<float>(arrived / unoccluded) : 1.0f;
}

/// Writes the pixels of one layer.
///
/// In      at: as of store
///         value: writes the channels of a pixel of the tile
template <typename Value>
void write_pixels(std::span<const size_t> at, FilmLayer& layer, const Value& value) {
    const size_t channels = layer.layer.channels.size();
    for (size_t p = 0; p < at.size(); ++p)
        value(p, std::span(layer.pixels.data() + at[p] * channels, channels));
}

}  // namespace

LayerPlan::LayerPlan(std::span<const Layer> layers, CryptomatteHashes hashes, bool catches)
    : hashes_(std::move(hashes)), catches_(catches) {
    for (const Layer& layer : layers)
        add_layer(layer);
    if (has_nearest_ || mattes_ > 0) opacity_ = written_aov(Aov::opacity);
    if (has_nearest_) distance_ = written_aov(Aov::distance);
}

size_t LayerPlan::written_aov(Aov aov) {
    const auto found = std::find(aovs_.begin(), aovs_.end(), aov);
    const auto index = static_cast<size_t>(found - aovs_.begin());
    if (found == aovs_.end()) aovs_.push_back(aov);
    return index;
}

void LayerPlan::add_layer(const Layer& layer) {
    Source source;
    if (const Aov* aov = aov_of(layer)) {
        source.aov = written_aov(*aov);
        const size_t channels = layer.channels.size();
        if (entry_of(*aov).reduction == Reduction::mean) {
            source.first_sum = std::exchange(sums_, sums_ + channels);
        } else {
            source.first_value = std::exchange(values_, values_ + channels);
            has_nearest_ = true;
        }
    } else if (const auto* names = std::get_if<CryptomatteNames>(&layer.source)) {
        const bool materials = *names == CryptomatteNames::materials;
        const std::vector<uint32_t>& hashes = materials ? hashes_.materials
                                              : *names == CryptomatteNames::objects
                                                  ? hashes_.objects
                                                  : hashes_.assets;
        source.aov = written_aov(materials ? Aov::id_material : Aov::id_node);
        source.hashes = hashes.data();
        source.hash_count = hashes.size();
        source.matte = mattes_++;
    } else if (std::holds_alternative<LightLayer>(layer.source)) {
        source.light = lights_++;
        source.first_sum = std::exchange(sums_, sums_ + light_channels);
        if (catches_) source.first_behind = std::exchange(sums_, sums_ + light_channels);
    } else if (std::holds_alternative<ShadowRatio>(layer.source)) {
        source.first_sum = std::exchange(sums_, sums_ + 2 * light_channels);
        has_shadow_ = true;
    } else if (const auto* mean = std::get_if<PartMean>(&layer.source)) {
        if (mean->aov) source.aov = written_aov(*mean->aov);
        source.first_sum = std::exchange(sums_, sums_ + layer.channels.size());
        ++parts_;
    } else if (is_majority(layer)) {
        source.aov = written_aov(Aov::id_node);
        source.hashes = hashes_.nodes.data();
        source.hash_count = hashes_.nodes.size();
        source.matte = mattes_++;
    } else {
        const auto statistic = std::get<SampleStatistic>(layer.source);
        counts_rays_ |= statistic == SampleStatistic::cost;
        has_variance_ |= statistic == SampleStatistic::variance;
    }
    layers_.push_back(layer);
    sources_.push_back(source);
}

size_t sum_bytes(const Layer& layer, bool catches) {
    constexpr size_t sum = sizeof(double) + 4 * sizeof(float);
    const bool counts_ids =
        std::holds_alternative<CryptomatteNames>(layer.source) || is_majority(layer);
    if (counts_ids) return sizeof(CryptomattePixel);
    if (std::holds_alternative<SampleStatistic>(layer.source)) return 5 * sizeof(double);
    if (std::holds_alternative<ShadowRatio>(layer.source)) return 2 * light_channels * sum;
    if (std::holds_alternative<LightLayer>(layer.source))
        return (catches ? 2 : 1) * light_channels * sum;
    return layer.channels.size() * sum;
}

void LayerSums::begin(const LayerPlan& plan, size_t pixels) {
    pixels_ = pixels;
    sums_.resize(pixels * plan.sums_);
    sums_are_new_.assign(plan.sums_, 1);
    nearest_values_.assign(pixels * plan.values_, 0.0f);
    nearest_m_.assign(plan.has_nearest_ ? pixels : 0, std::numeric_limits<float>::infinity());
    luminance_.assign(plan.has_variance_ ? pixels : 0, {});
    rays_.assign(plan.counts_rays_ ? pixels : 0, 0);
    mattes_.assign(pixels * plan.mattes_, {});
}

void LayerSums::add(const LayerPlan& plan, const BatchShape& batch, const Workspace& work) {
    if (plan.sums_ > 0) add_means(plan, batch, work);
    if (plan.lights_ > 0 || plan.has_shadow_) add_light(plan, batch, work);
    if (plan.parts_ > 0) add_parts(plan, batch, work);
    if (plan.has_nearest_) add_nearest(plan, batch, work);
    if (plan.mattes_ > 0) add_mattes(plan, batch, work);
    if (plan.has_variance_ || plan.counts_rays_) add_statistics(plan, batch, work);
}

LayerSums::Sum* LayerSums::begun_sums(size_t first_sum, size_t channels) {
    Sum* const sums = sums_.data() + first_sum * pixels_;
    if (sums_are_new_[first_sum] != 0) {
        std::fill_n(&sums_are_new_[first_sum], channels, uint8_t{0});
        std::fill_n(sums, channels * pixels_, Sum{});
    }
    return sums;
}

const LayerSums::Sum* LayerSums::sums_of(size_t first_sum) const {
    return sums_are_new_[first_sum] != 0 ? nullptr : sums_.data() + first_sum * pixels_;
}

/// Adds `count` samples of one block from an index on, of which the first has this number in its
/// pixel: all channels side by side, as one alone would wait for each of its additions.
template <size_t N>
void LayerSums::add_to_block(const std::array<const float*, N>& columns,
                             size_t index,
                             size_t number,
                             size_t count,
                             std::array<Sum, N>& sums) {
    const size_t end = index + count;
    const auto add = [&](size_t part) {
        for (size_t c = 0; c < N; ++c)
            sums[c].parts[part] += columns[c][index];
    };
    for (; index < end && number % 4 != 0; ++index, ++number)
        add(number % 4);
    for (; index + 4 <= end; index += 4) {
        for (size_t c = 0; c < N; ++c) {
            for (size_t k = 0; k < 4; ++k)
                sums[c].parts[k] += columns[c][index + k];
        }
    }
    for (size_t part = 0; index < end; ++index, ++part)
        add(part);
}

/// Adds channels of a batch's samples to sums of each pixel.
template <size_t N>
void LayerSums::add_columns(const BatchShape& batch,
                            const std::array<const float*, N>& columns,
                            size_t first_sum) {
    Sum* const begun = begun_sums(first_sum, N);
    for (size_t p = 0; p < batch.pixels.size(); ++p) {
        Sum* const sums = begun + batch.pixels[p] * N;
        std::array<Sum, N> at;
        std::copy_n(sums, N, at.begin());
        for (size_t done = 0; done < batch.samples;) {
            const size_t number = batch.first_sample + done;
            const size_t left = sum_block_samples - number % sum_block_samples;
            const size_t count = std::min(left, batch.samples - done);
            add_to_block<N>(columns, p * batch.samples + done, number, count, at);
            done += count;
            if (count < left) continue;
            for (Sum& sum : at)
                sum.end_block();
        }
        std::copy_n(at.begin(), N, sums);
    }
}

/// What a batch without any light in a layer does to sums: their blocks end all the same.
void LayerSums::end_blocks(const BatchShape& batch, size_t first_sum, size_t channels) {
    const size_t end = batch.first_sample + batch.samples;
    if (batch.first_sample / sum_block_samples == end / sum_block_samples) return;
    if (sums_are_new_[first_sum] != 0) return;
    Sum* const begun = begun_sums(first_sum, channels);
    for (const uint32_t p : batch.pixels) {
        for (size_t c = 0; c < channels; ++c)
            begun[p * channels + c].end_block();
    }
}

void LayerSums::add_light(const LayerPlan& plan, const BatchShape& batch, const Workspace& work) {
    const auto add = [&](const ColorView& color, size_t sum) {
        if (color.r == nullptr) return end_blocks(batch, sum, light_channels);
        add_columns<3>(batch, {color.r, color.g, color.b}, sum);
    };
    for (size_t k = 0; k < plan.layers_.size(); ++k) {
        const LayerPlan::Source& source = plan.sources_[k];
        if (std::holds_alternative<LightLayer>(plan.layers_[k].source)) {
            add(work.light_paths.layer(source.light), source.first_sum);
            if (plan.catches_) add(work.light_paths.behind(source.light), source.first_behind);
        } else if (std::holds_alternative<ShadowRatio>(plan.layers_[k].source)) {
            add(work.light_paths.shadowed(), source.first_sum);
            add(work.light_paths.unshadowed(), source.first_sum + light_channels);
        }
    }
}

void LayerSums::add_means(const LayerPlan& plan, const BatchShape& batch, const Workspace& work) {
    for (size_t k = 0; k < plan.layers_.size(); ++k) {
        if (!is_reduced(plan.layers_[k], Reduction::mean)) continue;
        const LayerPlan::Source& source = plan.sources_[k];
        const AovOutput& output = work.aov_outputs[source.aov];
        const float* const* from = output.columns;
        if (channel_count(output.aov) == 3) {
            add_columns<3>(batch, {from[0], from[1], from[2]}, source.first_sum);
        } else {
            add_columns<1>(batch, {from[0]}, source.first_sum);
        }
    }
}

void LayerSums::add_parts(const LayerPlan& plan, const BatchShape& batch, const Workspace& work) {
    for (size_t k = 0; k < plan.layers_.size(); ++k) {
        const auto* mean = std::get_if<PartMean>(&plan.layers_[k].source);
        if (mean == nullptr) continue;
        const LayerPlan::Source& source = plan.sources_[k];
        const SampleColumns& beauty = work.samples;
        const float* const colors[] = {beauty.r, beauty.g, beauty.b};
        const float* const* from = mean->aov ? work.aov_outputs[source.aov].columns : colors;
        const size_t channels = plan.layers_[k].channels.size();
        Sum* const begun = begun_sums(source.first_sum, channels);
        for (size_t i = 0; i < batch.samples; ++i) {
            const size_t sample = batch.first_sample + i;
            const bool counts = is_in(*mean, sample);
            const bool ends_block = (sample + 1) % sum_block_samples == 0;
            if (!counts && !ends_block) continue;
            for (size_t p = 0; p < batch.pixels.size(); ++p) {
                Sum* const sums = begun + batch.pixels[p] * channels;
                for (size_t c = 0; c < channels; ++c) {
                    if (counts) sums[c].parts[sample % 4] += from[c][p * batch.samples + i];
                    if (ends_block) sums[c].end_block();
                }
            }
        }
    }
}

void LayerSums::add_nearest(const LayerPlan& plan, const BatchShape& batch, const Workspace& work) {
    const float* hit = work.aov_outputs[plan.opacity_].columns[0];
    const float* distance_m = work.aov_outputs[plan.distance_].columns[0];
    size_t slot = 0;
    for (const uint32_t p : batch.pixels) {
        const size_t end = slot + batch.samples;
        size_t best = end;
        for (; slot < end; ++slot) {
            if (hit[slot] == 0.0f || !(distance_m[slot] < nearest_m_[p])) continue;
            nearest_m_[p] = distance_m[slot];
            best = slot;
        }
        if (best == end) continue;
        for (size_t k = 0; k < plan.layers_.size(); ++k) {
            if (!is_reduced(plan.layers_[k], Reduction::nearest)) continue;
            const LayerPlan::Source& source = plan.sources_[k];
            const AovOutput& output = work.aov_outputs[source.aov];
            float* value = &nearest_values_[p * plan.values_ + source.first_value];
            const int own = channel_count(output.aov);
            for (int c = 0; c < own; ++c)
                value[c] = output.columns[c][best];
            std::fill(value + own, value + plan.layers_[k].channels.size(), 1.0f);
        }
    }
}

void LayerSums::add_mattes(const LayerPlan& plan, const BatchShape& batch, const Workspace& work) {
    const float* hit = work.aov_outputs[plan.opacity_].columns[0];
    for (const LayerPlan::Source& source : plan.sources_) {
        if (source.hashes == nullptr) continue;
        const float* id = work.aov_outputs[source.aov].columns[0];
        for (size_t p = 0; p < batch.pixels.size(); ++p) {
            CryptomattePixel& matte = mattes_[batch.pixels[p] * plan.mattes_ + source.matte];
            const size_t begin = p * batch.samples;
            const auto hash_of = [&](size_t slot) {
                const auto number = static_cast<size_t>(id[slot]);
                const bool named = hit[slot] != 0.0f && number < source.hash_count;
                return named ? source.hashes[number] : cryptomatte_no_object;
            };
            const auto bits = [](float value) { return std::bit_cast<uint32_t>(value); };
            uint32_t differences = 0;
            for (size_t slot = begin; slot < begin + batch.samples; ++slot) {
                differences |= bits(id[slot]) ^ bits(id[begin]);
                differences |= bits(hit[slot]) ^ bits(hit[begin]);
            }
            if (differences == 0) {  // most pixels show one object
                matte.add(hash_of(begin), static_cast<uint32_t>(batch.samples));
                continue;
            }
            for (size_t slot = begin; slot < begin + batch.samples; ++slot)
                matte.add(hash_of(slot), 1);
        }
    }
}

void LayerSums::add_statistics(const LayerPlan& plan,
                               const BatchShape& batch,
                               const Workspace& work) {
    size_t slot = 0;
    for (const uint32_t p : batch.pixels) {
        for (size_t i = 0; i < batch.samples; ++i, ++slot) {
            if (plan.has_variance_) {
                const SampleColumns& from = work.samples;
                const auto y =
                    static_cast<double>(luminance(Vec3f{from.r[slot], from.g[slot], from.b[slot]}));
                luminance_[p].block_of(batch.first_sample + i) += {y, y * y};
            }
            if (plan.counts_rays_) rays_[p] += work.rays_cast[slot];
        }
    }
}

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
        } else if (is_majority(layer)) {
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
    return static_cast<float>(spread / (samples - 1));
}

}  // namespace obscura
