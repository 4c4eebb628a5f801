// session/exposure_meter.cpp - how much light falls on an asset, for --exposure auto.
// SPDX-License-Identifier: Apache-2.0
#include "session/exposure_meter.h"

#include "film/layers.h"
#include "math/vec.h"
#include "render/integrators.h"
#include "session/smaller_image.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <numeric>
#include <string>

namespace obscura {

namespace {

constexpr int metering_px = 128;  ///< of the longer side, at most twice as many
constexpr int metering_samples = 16;
constexpr double min_albedo = 0.02;             ///< below it a surface tells little of the light
constexpr double darkest_metered = 1.0 / 1024;  ///< of the mean: darker counts as this

/// A logarithmic mean needs all values first: dark ones are raised.
class LogMean {
public:
    void add(double value, double weight) {
        values_.push_back({value, weight});
        sum_ += value * weight;
        weight_ += weight;
    }
    std::optional<double> log2() const {
        if (!(sum_ > 0)) return std::nullopt;
        const double least = darkest_metered * sum_ / weight_;
        double logs = 0;
        for (const auto& [value, weight] : values_)
            logs += weight * std::log2(std::max(value, least));
        return logs / weight_;
    }

private:
    std::vector<std::array<double, 2>> values_;
    double sum_ = 0, weight_ = 0;
};

}  // namespace

RenderRequest metering_image(const RenderRequest& request) {
    const int side = std::max(request.options.width, request.options.height);
    RenderRequest out = smaller_image(request, std::max(side / metering_px, 1), metering_samples);
    out.options.seed = 0;
    out.options.crop.reset();
    out.options.light_groups = {};
    out.options.background = BackgroundKind::transparent;
    out.overscan.reset();
    out.segmentation.reset();
    if (has_layers(out.options.integrator)) {
        const std::array<std::string, 1> names = {"albedo"};
        out.options.layers = layers_of(names, 0).value();
    }
    return out;
}

std::optional<double> metered_stops(const Film& film) {
    const size_t channels = film.channels.size();
    if (channels < 4) return std::nullopt;
    const float* const albedos = film.layers.empty() ? nullptr : film.layers.front().pixels.data();
    LogMean incident, reflected;
    for (size_t i = 0; i * channels < film.pixels.size(); ++i) {
        const float* const pixel = film.pixels.data() + i * channels;
        const auto covered = static_cast<double>(pixel[3]);
        if (!(covered > 0)) continue;
        const auto light = static_cast<double>(luminance(Vec3f{pixel[0], pixel[1], pixel[2]}));
        reflected.add(light / covered, covered);
        if (albedos == nullptr) continue;
        const float* const a = albedos + 3 * i;
        const auto albedo = static_cast<double>(luminance(Vec3f{a[0], a[1], a[2]}));
        if (albedo > min_albedo * covered) incident.add(light / albedo, covered);
    }
    if (const std::optional<double> stops = incident.log2()) return stops;
    const std::optional<double> stops = reflected.log2();
    if (!stops) return std::nullopt;
    return *stops - std::log2(middle_grey);
}

double exposure_for(std::vector<double> stops) {
    std::sort(stops.begin(), stops.end());  // sums of another order may differ
    const double sum = std::accumulate(stops.begin(), stops.end(), 0.0);
    const double rounded = std::round(-100 * sum / static_cast<double>(stops.size())) / 100;
    return std::clamp(rounded, -50.0, 50.0) + 0.0;  // no -0
}

}  // namespace obscura
