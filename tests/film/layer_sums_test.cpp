// tests/film/layer_sums_test.cpp - samples of layers become pixels, however they are cut.
// SPDX-License-Identifier: Apache-2.0
#include "film/layer_sums.h"

#include <gtest/gtest.h>

#include <array>
#include <bit>
#include <cmath>
#include <numeric>

namespace obscura {
namespace {

constexpr std::array<uint32_t, 3> pixels = {2, 0, 1};  // in the order of a batch
constexpr size_t samples = 70;

bool is_hit(size_t pixel, size_t sample) {
    return pixel == 1 ? sample == 33 : pixel == 2 || sample % 5 != 0;
}

/// A different distance for every sample, and of two pixels the least more than once.
float distance_m(size_t pixel, size_t sample) {
    if (pixel != 0 && sample % 23 == 11) return 0.125f;
    return 1.0f + std::fmod(static_cast<float>(sample) * 0.618f, 1.0f);
}

float normal(size_t pixel, size_t sample, size_t channel) {
    const auto number = static_cast<float>(sample * 3 + channel + pixel * 211);
    return std::sin(number * 1.7f) * std::exp(0.1f * std::fmod(number, 37.0f));
}

float position(size_t sample, size_t channel) {
    return static_cast<float>(sample) + 0.25f * static_cast<float>(channel);
}

std::vector<Layer> tested_layers() {
    const std::vector<std::string> names = {"normal", "position"};
    return layers_of(names, 6).value();
}

/// Writes what stages would for a batch.
void fill_samples(const BatchShape& batch, Workspace& work) {
    for (AovOutput& out : work.aov_outputs) {
        for (size_t p = 0; p < batch.pixels.size(); ++p) {
            for (size_t i = 0; i < batch.samples; ++i) {
                const size_t pixel = batch.pixels[p];
                const size_t sample = batch.first_sample + i;
                const size_t slot = p * batch.samples + i;
                const bool hits = is_hit(pixel, sample);
                for (size_t c = 0; c < static_cast<size_t>(channel_count(out.aov)); ++c) {
                    const float value = out.aov == Aov::normal     ? normal(pixel, sample, c)
                                        : out.aov == Aov::position ? position(sample, c)
                                        : out.aov == Aov::distance ? distance_m(pixel, sample)
                                                                   : 1.0f;
                    out.columns[c][slot] = hits ? value : 0.0f;
                }
            }
        }
    }
}

/// The film of all samples, taken in batches of these numbers.
Film film_of(const std::vector<size_t>& batches) {
    const LayerPlan plan(tested_layers(), {});
    LayerSums sums;
    sums.begin(plan, pixels.size());
    Workspace work;
    work.allot_aovs(plan.aovs());
    size_t done = 0;
    for (const size_t count : batches) {
        const BatchShape batch{pixels, count, done};
        fill_samples(batch, work);
        sums.add(plan, batch, work);
        done += count;
    }
    EXPECT_EQ(done, samples);
    Film film{3, 1, {}, {}};
    for (const Layer& layer : tested_layers())
        film.layers.push_back({layer, zero_array<float>(3 * layer.channels.size())});
    std::vector<size_t> at(pixels.size());
    std::iota(at.begin(), at.end(), size_t{0});
    const std::vector<int> counts(pixels.size(), static_cast<int>(samples));
    sums.store(plan, {at, counts, {}}, film);
    return film;
}

TEST(LayerSums, HowSamplesAreCutIntoBatchesChangesNoBit) {
    const std::vector<std::vector<size_t>> cuts = {{70},
                                                   {16, 16, 16, 16, 6},
                                                   {32, 32, 6},
                                                   {16, 1, 15, 32, 6},
                                                   {3, 16, 32, 13, 6},
                                                   {5, 11, 30, 2, 16, 6}};
    const Film first = film_of(std::vector<size_t>(samples, 1));
    for (const std::vector<size_t>& cut : cuts) {
        const Film film = film_of(cut);
        for (size_t k = 0; k < film.layers.size(); ++k) {
            for (size_t i = 0; i < film.layers[k].pixels.size(); ++i) {
                EXPECT_EQ(std::bit_cast<uint32_t>(film.layers[k].pixels[i]),
                          std::bit_cast<uint32_t>(first.layers[k].pixels[i]))
                    << film.layers[k].layer.name << " value " << i << " batch " << cut[0];
            }
        }
    }
}

TEST(LayerSums, MeansAreThoseOfDoublesToAFewUnits) {
    const Film film = film_of({16, 16, 16, 16, 6});
    for (size_t p = 0; p < pixels.size(); ++p) {
        for (size_t c = 0; c < 3; ++c) {
            double sum = 0;
            double size = 0;
            for (size_t i = 0; i < samples; ++i) {
                const double value = is_hit(p, i) ? static_cast<double>(normal(p, i, c)) : 0.0;
                sum += value;
                size += std::fabs(value);
            }
            EXPECT_NEAR(film.layers[0].pixels[p * 3 + c], sum / samples, 1e-6 * size / samples);
        }
    }
}

TEST(LayerSums, TheFirstOfTheNearestHitsCounts) {
    const Film film = film_of({16, 16, 16, 16, 6});
    for (size_t p = 0; p < pixels.size(); ++p) {
        size_t best = samples;
        for (size_t i = 0; i < samples; ++i) {
            if (!is_hit(p, i)) continue;
            if (best == samples || distance_m(p, i) < distance_m(p, best)) best = i;
        }
        for (size_t c = 0; c < 3; ++c)
            EXPECT_EQ(film.layers[1].pixels[p * 3 + c], position(best, c)) << p;
    }
}

}  // namespace
}  // namespace obscura
