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

/// The sum of a whole block from an index on, as LayerSums::add_to_block and Sum::total make it.
float block_sum(const float* column, size_t index) {
    std::array<float, 4> parts;
    const float* const from = column + index;
    for (size_t k = 0; k < 4; ++k)
        parts[k] = ((from[k] + from[4 + k]) + from[8 + k]) + from[12 + k];
    static_assert(sum_block_samples == 16);
    return (parts[0] + parts[1]) + (parts[2] + parts[3]);
}

/// The nearest of some hits, if it is nearer than a distance: the first of those as near; `end` if
/// there is none. Distances that are no hit's are 0.
size_t nearest_hit(
    const float* hit, const float* distance_m, size_t begin, size_t end, float nearer_than_m) {
    // Most pixels' samples lie on one surface: a minimum in four parts needs no branches.
    constexpr float none_m = std::numeric_limits<float>::infinity();
    std::array<float, 4> parts_m = {none_m, none_m, none_m, none_m};
    const auto far_m = [&](size_t i) { return hit[i] == 0.0f ? none_m : distance_m[i]; };
    const auto lower = [](float a, float b) { return a < b ? a : b; };
    size_t i = begin;
    for (; i + 4 <= end; i += 4) {
        for (size_t k = 0; k < 4; ++k)
            parts_m[k] = lower(far_m(i + k), parts_m[k]);
    }
    for (; i < end; ++i)
        parts_m[0] = lower(far_m(i), parts_m[0]);
    const float nearest_m = lower(lower(parts_m[0], parts_m[1]), lower(parts_m[2], parts_m[3]));
    if (!(nearest_m < nearer_than_m)) return end;
    i = begin;
    while (far_m(i) != nearest_m)
        ++i;
    return i;
}

}  // namespace

LayerPlan::LayerPlan(std::span<const Layer> layers, CryptomatteHashes hashes, bool catches)
    : hashes_(std::move(hashes)), catches_(catches) {
    for (const Layer& layer : layers)
        add_layer(layer);
    if (has_nearest() || mattes_ > 0) opacity_ = written_aov(Aov::opacity);
    if (has_nearest()) distance_ = written_aov(Aov::distance);
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
            const auto own = static_cast<size_t>(channel_count(*aov));
            nearest_.push_back({source.aov, source.first_value, own, channels});
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
    if (is_cryptomatte(layer) || is_majority(layer)) return sizeof(CryptomattePixel);
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
    nearest_m_.assign(plan.has_nearest() ? pixels : 0, std::numeric_limits<float>::infinity());
    luminance_.assign(plan.has_variance_ ? pixels : 0, {});
    rays_.assign(plan.counts_rays_ ? pixels : 0, 0);
    mattes_.assign(pixels * plan.mattes_, {});
}

void LayerSums::add(const LayerPlan& plan, const BatchShape& batch, const Workspace& work) {
    if (plan.sums_ > 0) add_means(plan, batch, work);
    if (plan.lights_ > 0 || plan.has_shadow_) add_light(plan, batch, work);
    if (plan.parts_ > 0) add_parts(plan, batch, work);
    if (plan.has_nearest()) add_nearest(plan, batch, work);
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

/// Adds whole blocks of samples to sums that are between blocks.
template <size_t N>
void LayerSums::add_blocks(const BatchShape& batch,
                           const std::array<const float*, N>& columns,
                           Sum* begun) {
    for (size_t p = 0; p < batch.pixels.size(); ++p) {
        Sum* const sums = begun + batch.pixels[p] * N;
        const size_t end = (p + 1) * batch.samples;
        for (size_t index = p * batch.samples; index < end; index += sum_block_samples) {
            for (size_t c = 0; c < N; ++c)
                sums[c].blocks += static_cast<double>(block_sum(columns[c], index));
        }
    }
}

/// Adds channels of a batch's samples to sums of each pixel.
template <size_t N>
void LayerSums::add_columns(const BatchShape& batch,
                            const std::array<const float*, N>& columns,
                            size_t first_sum) {
    Sum* const begun = begun_sums(first_sum, N);
    if (batch.first_sample % sum_block_samples == 0 && batch.samples % sum_block_samples == 0)
        return add_blocks<N>(batch, columns, begun);
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
    size_t begin = 0;
    for (const uint32_t p : batch.pixels) {
        const size_t end = begin + batch.samples;
        const size_t best = nearest_hit(hit, distance_m, begin, end, nearest_m_[p]);
        begin = end;
        if (best == end) continue;
        nearest_m_[p] = distance_m[best];
        float* value = &nearest_values_[p * plan.values_];
        for (const LayerPlan::Nearest& layer : plan.nearest_) {
            const float* const* from = work.aov_outputs[layer.aov].columns;
            for (size_t c = 0; c < layer.own; ++c)
                value[layer.first_value + c] = from[c][best];
            std::fill_n(value + layer.first_value + layer.own, layer.channels - layer.own, 1.0f);
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

}  // namespace obscura
