// tests/session/view_sampling_test.cpp - random views: uniform, reproducible, independent of count.
// SPDX-License-Identifier: Apache-2.0
#include "session/view_sampling.h"

#include "session/image_list.h"

#include <gtest/gtest.h>

#include "support/chi_square.h"
#include <cmath>
#include <set>

namespace obscura {
namespace {

std::vector<View> views(ViewSpace space, int count, uint64_t seed = 7) {
    ViewSampling sampling;
    sampling.count = count;
    sampling.space = space;
    sampling.seed = seed;
    return sample_views(sampling, {}, {"red", "blue", "green"});
}

/// Counts in equal parts of [low, high].
std::vector<double> histogram(const std::vector<double>& values, double low, double high) {
    std::vector<double> out(20);
    for (const double value : values) {
        EXPECT_GE(value, low);
        EXPECT_LE(value, high);
        out[std::min<size_t>(19, static_cast<size_t>(20 * (value - low) / (high - low)))] += 1;
    }
    return out;
}

double p_value_of_uniform(const std::vector<double>& values, double low, double high) {
    const std::vector<double> counts = histogram(values, low, high);
    const double expected = static_cast<double>(values.size()) / static_cast<double>(counts.size());
    double statistic = 0;
    for (const double count : counts)
        statistic += (count - expected) * (count - expected) / expected;
    return chi_square_p_value(statistic, static_cast<int>(counts.size()) - 1);
}

TEST(ViewSampling, DirectionsAreUniform) {
    for (const ViewSpace space : {ViewSpace::sphere, ViewSpace::hemisphere}) {
        std::vector<double> azimuths, sines, margins, turns;
        for (const View& view : views(space, 20000)) {
            azimuths.push_back(view.camera.framing.azimuth_rad);
            sines.push_back(std::sin(view.camera.framing.elevation_rad));
            margins.push_back(view.camera.framing.margin);
            turns.push_back(*view.environment_rotation_deg);
        }
        EXPECT_GT(p_value_of_uniform(azimuths, 0, 2 * pi_d), 1e-4);
        EXPECT_GT(p_value_of_uniform(sines, space == ViewSpace::sphere ? -1 : 0, 1), 1e-4);
        EXPECT_GT(p_value_of_uniform(margins, 0.05, 0.25), 1e-4);
        EXPECT_GT(p_value_of_uniform(turns, 0, 360), 1e-4);
    }
}

TEST(ViewSampling, PlacesInsideAreUniform) {
    std::vector<double> heights, sines;
    for (int i = 0; i < 20000; ++i) {
        const InsidePlace place = sample_inside({3, i, i % 5});
        heights.push_back(place.place.y);
        sines.push_back(std::sin(place.elevation_rad));
    }
    EXPECT_GT(p_value_of_uniform(heights, 0, 1), 1e-4);
    EXPECT_GT(p_value_of_uniform(sines, -0.5, 0.5), 1e-4);
}

TEST(ViewSampling, AViewDependsOnItsNumberAndTheSeedAlone) {
    const std::vector<View> few = views(ViewSpace::sphere, 3);
    const std::vector<View> many = views(ViewSpace::sphere, 50);
    const auto azimuth = [](const View& view) { return view.camera.framing.azimuth_rad; };
    for (size_t i = 0; i < few.size(); ++i)
        EXPECT_EQ(few[i].text, many[i].text);
    std::set<double> azimuths;
    for (const View& view : many)
        azimuths.insert(azimuth(view));
    EXPECT_EQ(azimuths.size(), many.size());
    // Every bit of the seed counts.
    for (const uint64_t other : {7ULL ^ 1ULL, 7ULL ^ 1ULL << 31U, 7ULL ^ 1ULL << 32U}) {
        for (const View& view : views(ViewSpace::sphere, 3, other))
            EXPECT_EQ(azimuths.count(azimuth(view)), 0U) << other;
    }
    EXPECT_EQ(many[17].name, "000017");
}

TEST(ViewSampling, VariantsAndTurnsMayBeLeftOut) {
    ViewSampling sampling;
    sampling.count = 60;
    std::set<std::string> seen;
    for (const View& view : sample_views(sampling, {}, {"red", "blue"}))
        seen.insert(view.variant.value_or("none"));
    EXPECT_EQ(seen, (std::set<std::string>{"red", "blue"}));
    sampling.chooses_variant = sampling.turns_environment = false;
    for (const View& view : sample_views(sampling, {}, {"red", "blue"})) {
        EXPECT_FALSE(view.variant);
        EXPECT_FALSE(view.environment_rotation_deg);
    }
}

}  // namespace
}  // namespace obscura
