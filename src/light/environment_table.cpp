// light/environment_table.cpp - copies an environment map and builds its sampling tables.
// SPDX-License-Identifier: Apache-2.0
#include "light/environment_table.h"

#include "base/parallel.h"

#include <algorithm>
#include <cmath>
#include <span>

namespace obscura {
namespace {

constexpr int64_t max_pixels = int64_t{1} << 28;

struct Repaired {
    float value;
    bool changed;
};

Repaired repaired(float value, double scale) {
    const double scaled = static_cast<double>(value) * scale;
    if (!(scaled >= 0)) return {0.0F, true};  // NaN too
    if (scaled > max_environment_radiance) return {max_environment_radiance, true};
    return {static_cast<float>(scaled), false};
}

double luminance_of(const float* rgb) {
    return luminance(Vec3d{rgb[0], rgb[1], rgb[2]});
}

/// Half luminance, half the largest channel, so that deep blue lights are sampled well too.
double importance_of(const float* rgb) {
    return 0.5 * (luminance_of(rgb) + std::max({rgb[0], rgb[1], rgb[2]}));
}

/// MIS compensation: how often light sampling draws directions of this importance. BSDF sampling
/// finds the evenly lit part of a map well by itself, so the light samples go to what stands out
/// from it. Half the mean is taken off, and no direction loses more than nine tenths: where
/// geometry hides the bright part, as a room with one window does, the rest is all there is to
/// find.
/// Source  Karlik et al., "MIS Compensation: Optimizing Sampling Techniques in Multiple Importance
///         Sampling", ACM TOG 38(6), 2019, section 5, with half its offset
double compensated_importance(double importance, double mean) {
    return std::max(importance - 0.5 * mean, 0.1 * importance);
}

/// Solid angle of one pixel of row y.
double pixel_steradians(int width, int height, int y) {
    const double top = std::cos(pi_d * y / height);
    const double bottom = std::cos(pi_d * (y + 1) / height);
    return 2 * pi_d / width * (top - bottom);
}

double sum_of(const std::vector<double>& values) {
    double sum = 0;
    for (const double value : values)
        sum += value;
    return sum;
}

Result<void> check(const EnvironmentImage& image, double intensity, double rotation_deg) {
    const bool fits = image.width >= 1 && image.width <= max_environment_side &&
                      image.height >= 1 && image.height <= max_environment_side &&
                      int64_t{image.width} * image.height <= max_pixels;
    if (!fits || image.rgb == nullptr) {
        return fail(ExitCode::bad_resource,
                    "E-ENV-SIZE",
                    "environment map",
                    "it has " + std::to_string(image.width) + " x " + std::to_string(image.height) +
                        " pixels; accepted are sides from 1 to " +
                        std::to_string(max_environment_side));
    }
    if (!(intensity >= 0) || !std::isfinite(intensity)) {
        return fail(
            ExitCode::usage,
            "E-ENV-OPTION",
            "environment map",
            "intensity must be a finite number of at least 0; it is " + std::to_string(intensity));
    }
    return check_rotation(rotation_deg);
}

}  // namespace

Result<void> check_rotation(double rotation_deg) {
    if (std::isfinite(rotation_deg)) return {};
    return fail(
        ExitCode::usage,
        "E-ENV-OPTION",
        "environment map",
        "rotation must be a finite number of degrees; it is " + std::to_string(rotation_deg));
}

Result<EnvironmentTable> EnvironmentTable::create(const EnvironmentImage& image,
                                                  double intensity,
                                                  double rotation_deg,
                                                  EnvironmentSampling sampling) {
    if (Result<void> checked = check(image, intensity, rotation_deg); !checked) {
        return fail(std::move(checked.error()));
    }
    EnvironmentTable table;
    table.width_ = image.width;
    table.height_ = image.height;
    table.rotation_deg_ = rotation_deg;
    table.copy_pixels(image.rgb, intensity);
    table.sampling_ = sampling;
    table.build_tables();
    return table;
}

void EnvironmentTable::copy_pixels(const float* rgb, double intensity) {
    const size_t count = static_cast<size_t>(width_) * static_cast<size_t>(height_);
    pixels_.resize(count * 4);
    for (size_t i = 0; i < count; ++i) {
        for (size_t channel = 0; channel < 3; ++channel) {
            const Repaired value = repaired(rgb[3 * i + channel], intensity);
            pixels_[4 * i + channel] = value.value;
            repaired_values_ += value.changed ? 1 : 0;
        }
    }
}

void EnvironmentTable::build_tables() {
    const auto width = static_cast<size_t>(width_);
    const auto height = static_cast<size_t>(height_);
    std::vector<double> steradians(height);  // of one pixel
    std::vector<double> power(height);
    std::vector<double> importance(height);
    parallel_for(height, [&](size_t y) {
        steradians[y] = pixel_steradians(width_, height_, static_cast<int>(y));
        for (size_t i = y * width; i < (y + 1) * width; ++i) {
            power[y] += luminance_of(&pixels_[4 * i]) * steradians[y];
            importance[y] += importance_of(&pixels_[4 * i]) * steradians[y];
        }
    });
    power_ = sum_of(power);
    black_ = !(sum_of(importance) > 0);

    // A pixel's weight has the integral 1 / (width height) in (u, v); d omega = 2 pi^2 sin du dv.
    const double spread = static_cast<double>(width * height) / (2 * pi_d * pi_d);
    const auto pixel_at = [&](int x, int y) {
        return &pixels_[4 * (static_cast<size_t>(y) * width + static_cast<size_t>(x))];
    };
    const double mean = sum_of(importance) / (4 * pi_d);
    const auto weight = [&](int x, int y) {
        const double own = importance_of(pixel_at(x, y));
        const bool compensated = sampling_ == EnvironmentSampling::compensated;
        return (compensated ? compensated_importance(own, mean) : own) *
               steradians[static_cast<size_t>(y)];
    };
    const auto set = [&](int x, int y, double probability) {
        pixel_at(x, y)[3] = static_cast<float>(black_ ? 0.0 : probability * spread);
    };
    choice_.build(width_, height_, weight, set);
}

double EnvironmentTable::power_to_sample() const {
    return sampling_ == EnvironmentSampling::compensated ? 0.5 * power_ : power_;
}

EnvironmentView EnvironmentTable::view() const {
    return turned({pixels_.data(), choice_.view(), width_, height_}, rotation_deg_);
}

EnvironmentView turned(EnvironmentView view, double rotation_deg) {
    const double rotation_rad = std::remainder(rotation_deg, 360.0) * pi_d / 180.0;
    view.cos_rotation = static_cast<float>(std::cos(rotation_rad));
    view.sin_rotation = static_cast<float>(std::sin(rotation_rad));
    return view;
}

}  // namespace obscura
