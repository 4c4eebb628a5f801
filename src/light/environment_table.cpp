// light/environment_table.cpp - copies an environment map and builds the tables that sample it.
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

/// Half luminance, half the strongest channel: a deep blue light is sampled well too.
double importance_of(const float* rgb) {
    return 0.5 * (luminance_of(rgb) + std::max({rgb[0], rgb[1], rgb[2]}));
}

/// A measure of every pixel of row y.
template <typename Measure>
std::vector<double> measured_row(const std::vector<float>& pixels,
                                 size_t width,
                                 size_t y,
                                 const Measure& measure) {
    std::vector<double> result(width);
    for (size_t x = 0; x < width; ++x)
        result[x] = measure(pixels.data() + 4 * (y * width + x));
    return result;
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
    if (!(intensity >= 0) || !std::isfinite(intensity) || !std::isfinite(rotation_deg)) {
        return fail(ExitCode::usage,
                    "E-ENV-OPTION",
                    "environment map",
                    "intensity must be a finite number of at least 0 and rotation a finite number "
                    "of degrees; they are " +
                        std::to_string(intensity) + " and " + std::to_string(rotation_deg));
    }
    return {};
}

}  // namespace

Result<EnvironmentTable> EnvironmentTable::create(const EnvironmentImage& image,
                                                  double intensity,
                                                  double rotation_deg) {
    if (Result<void> checked = check(image, intensity, rotation_deg); !checked) {
        return fail(std::move(checked.error()));
    }
    EnvironmentTable table;
    table.width_ = image.width;
    table.height_ = image.height;
    const double rotation_rad = std::remainder(rotation_deg, 360.0) * pi_d / 180.0;
    table.cos_rotation_ = std::cos(rotation_rad);
    table.sin_rotation_ = std::sin(rotation_rad);
    table.copy_pixels(image.rgb, intensity);
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
    columns_.resize((width + 1) * height + cdf_padding<ShortCdfEntry>);
    std::vector<double> row_weight(height);
    std::vector<double> row_power(height);
    parallel_for(height, [&](size_t y) {
        const double steradians = pixel_steradians(width_, height_, static_cast<int>(y));
        const auto light = measured_row(pixels_, width, y, luminance_of);
        row_power[y] = sum_of(light) * steradians;
        const auto weights = measured_row(pixels_, width, y, importance_of);
        row_weight[y] = sum_of(weights) * steradians;
        const auto entries = build_cdf_table<ShortCdfEntry>(std::span<const double>(weights));
        std::copy(entries.begin(), entries.end(), columns_.data() + y * (width + 1));
        const auto shares = cdf_probabilities(entries);
        for (size_t x = 0; x < width; ++x) {
            pixels_[4 * (y * width + x) + 3] = static_cast<float>(shares[x]);
        }
    });
    power_ = sum_of(row_power);
    black_ = !(sum_of(row_weight) > 0);
    rows_ = build_cdf_table(std::span<const double>(row_weight));

    // A pixel's weight has the integral 1 / (width height) in (u, v); d omega = 2 pi^2 sin du dv.
    const auto row_shares = cdf_probabilities(rows_);
    const double spread = static_cast<double>(width * height) / (2 * pi_d * pi_d);
    parallel_for(height, [&](size_t y) {
        const double scale = black_ ? 0.0 : row_shares[y] * spread;
        for (size_t i = y * width; i < (y + 1) * width; ++i) {
            pixels_[4 * i + 3] = static_cast<float>(pixels_[4 * i + 3] * scale);
        }
    });
}

EnvironmentView EnvironmentTable::view() const {
    return {pixels_.data(),
            rows_.data(),
            columns_.data(),
            width_,
            height_,
            static_cast<float>(cos_rotation_),
            static_cast<float>(sin_rotation_)};
}

}  // namespace obscura
