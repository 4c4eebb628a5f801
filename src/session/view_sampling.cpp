// session/view_sampling.cpp - random views of an asset, for data sets.
// SPDX-License-Identifier: Apache-2.0
#include "session/view_sampling.h"

#include "session/image_list.h"

#include <cmath>
#include <fmt/format.h>
#include <random>

namespace obscura {

namespace {

constexpr double whole_turn_deg = 360;
/// Cameras in a room look about level: by the sine of their elevation.
constexpr double max_slope = 0.5;

/// Numbers of one view. The engine and its seeding are defined by the C++ standard, unlike the
/// distributions.
class Chance {
public:
    Chance(uint64_t seed, int number, int attempt = 0) {
        const auto low = static_cast<uint32_t>(seed);
        const auto high = static_cast<uint32_t>(seed >> 32U);
        std::seed_seq sequence{
            low, high, static_cast<uint32_t>(number), static_cast<uint32_t>(attempt)};
        engine_.seed(sequence);
    }

    /// In [0, 1).
    double unit() { return static_cast<double>(engine_() >> 11U) * 0x1p-53; }
    double between(double low, double high) { return low + (high - low) * unit(); }

private:
    std::mt19937_64 engine_;
};

/// Uniform in solid angle between two sines of the elevation.
void sample_direction(Chance& chance,
                      std::array<double, 2> sines,
                      double& azimuth_rad,
                      double& elevation_rad) {
    azimuth_rad = chance.between(0, 2 * pi_d);
    elevation_rad = std::asin(chance.between(sines[0], sines[1]));
}

void place_around(const ViewSampling& sampling, Chance& chance, FramingOptions& framing) {
    const double lowest = sampling.space == ViewSpace::sphere ? -1 : 0;
    sample_direction(chance, {lowest, 1}, framing.azimuth_rad, framing.elevation_rad);
    framing.fit = FrameFit::sphere;
    framing.margin = 0.5 * (1 - chance.between(sampling.fill[0], sampling.fill[1]));
}

}  // namespace

InsidePlace sample_inside(const InsideView& view) {
    Chance chance(view.seed, view.number, view.attempt);
    InsidePlace out;
    sample_direction(chance, {-max_slope, max_slope}, out.azimuth_rad, out.elevation_rad);
    out.place.x = chance.unit();
    out.place.y = chance.unit();
    out.place.z = chance.unit();
    return out;
}

std::vector<View> sample_views(const ViewSampling& sampling,
                               const CameraRequest& camera,
                               const std::vector<std::string>& variants) {
    std::vector<View> views;
    for (int i = 0; i < sampling.count; ++i) {
        Chance chance(sampling.seed, i);
        View view{fmt::format("{:06}", i), camera};
        view.camera.frames = true;
        if (sampling.space == ViewSpace::box) {
            view.camera.inside = InsideView{sampling.seed, i};
        } else {
            place_around(sampling, chance, view.camera.framing);
        }
        const double turn_deg = chance.between(0, whole_turn_deg);
        if (sampling.turns_environment) view.environment_rotation_deg = turn_deg;
        const auto choice =
            static_cast<size_t>(chance.unit() * static_cast<double>(variants.size()));
        if (sampling.chooses_variant && !variants.empty()) view.variant = variants[choice];
        const FramingOptions& framing = view.camera.framing;
        view.text = fmt::format(
            "{} of seed {} in space {}: azimuth {} elevation {} margin {} turn {} "
            "variant {}",
            i,
            sampling.seed,
            static_cast<int>(sampling.space),
            framing.azimuth_rad,
            framing.elevation_rad,
            framing.margin,
            view.environment_rotation_deg.value_or(0),
            view.variant.value_or(""));
        views.push_back(std::move(view));
    }
    return views;
}

}  // namespace obscura
