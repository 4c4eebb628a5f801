// light/environment_table.h - owns an environment map and its sampling tables.
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "base/error.h"
#include "base/unset_array.h"
#include "light/environment.h"

#include <cstdint>
#include <vector>

namespace obscura {

/// A latitude-longitude map in someone else's memory: 3 floats a pixel, linear, rows from the top.
struct EnvironmentImage {
    int width = 0;
    int height = 0;
    const float* rgb = nullptr;
};

/// Maximum width and height of an environment map.
inline constexpr int max_environment_side = 16384;

/// Radiance of a pixel after scaling never exceeds this, so that sums of squares stay finite.
inline constexpr float max_environment_radiance = 1e12f;

/// What light samples of an environment are drawn by.
enum class EnvironmentSampling {
    compensated,  ///< what stands out of it: BSDF samples are taken too, and find the rest
    by_radiance,  ///< its radiance: light samples are all there is, as on shadow catchers
};

class EnvironmentTable {
public:
    /// Copies the map, scaled by `intensity`, and builds its tables.
    ///
    /// In      rotation_deg: about +Y, counter-clockwise seen from above
    /// Out     negative and non-finite values count as 0 (infinite ones as the limit); see
    ///         repaired_values()
    /// Errors  67 E-ENV-SIZE sides not in [1, 16384] or more than 2^28 pixels;
    ///         64 E-ENV-OPTION intensity negative or not finite, rotation not finite
    static Result<EnvironmentTable> create(
        const EnvironmentImage& image,
        double intensity,
        double rotation_deg,
        EnvironmentSampling sampling = EnvironmentSampling::compensated);

    /// Valid for as long as the table lives, wherever it is moved.
    EnvironmentView view() const;

    /// Integral of the luminance over the sphere; 0 when the map is black.
    double power() const { return power_; }

    /// The part of the power that counts in the choice of lights: half of it where BSDF sampling
    /// finds the environment as well. A quarter would be too little under bright skies behind a
    /// window or leaves; all of it takes too many samples from lamps.
    double power_to_sample() const;

    /// True when the map is black: leave it out of light selection.
    bool black() const { return black_; }

    /// Number of map values that were replaced; worth a warning when not 0.
    int64_t repaired_values() const { return repaired_values_; }

private:
    EnvironmentTable() = default;
    void copy_pixels(const float* rgb, double intensity);
    void build_tables();

    LargeArray<float> pixels_;  ///< see EnvironmentView
    PixelChoice choice_;
    int width_ = 0;
    int height_ = 0;
    double rotation_deg_ = 0;
    double power_ = 0;
    EnvironmentSampling sampling_ = EnvironmentSampling::compensated;
    bool black_ = true;
    int64_t repaired_values_ = 0;
};

/// Errors  64 E-ENV-OPTION the rotation is not finite
Result<void> check_rotation(double rotation_deg);

/// The same map turned as EnvironmentTable::create() does, whatever its rotation was.
///
/// In      rotation_deg: finite
EnvironmentView turned(EnvironmentView view, double rotation_deg);

}  // namespace obscura
