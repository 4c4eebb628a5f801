// light/daylight.cpp - a clear sky with its sun, as an environment map.
// SPDX-License-Identifier: Apache-2.0
#include "light/daylight.h"

#include "math/vec.h"
#include "math/warp.h"

#include <algorithm>
#include <array>
#include <cmath>

namespace obscura {

namespace {

constexpr double turbidity = 2.5;  ///< a clear day
constexpr double ground_albedo = 0.3;
constexpr double sun_radius_rad = 0.265 * pi_d / 180;
constexpr double sun_klx = 127.5;    ///< outside the air
constexpr double extinction = 0.21;  ///< of a clear sky, for each air mass

using Color = std::array<double, 3>;

/// Perez' five coefficients, as linear functions of the turbidity.
struct Perez {
    double a, b, c, d, e;
    double at(double cos_theta, double gamma) const {
        const double cos_gamma = std::cos(gamma);
        return (1 + a * std::exp(b / cos_theta)) *
               (1 + c * std::exp(d * gamma) + e * cos_gamma * cos_gamma);
    }
};

constexpr Perez luminance_law = {0.1787 * turbidity - 1.4630,
                                 -0.3554 * turbidity + 0.4275,
                                 -0.0227 * turbidity + 5.3251,
                                 0.1206 * turbidity - 2.5771,
                                 -0.0670 * turbidity + 0.3703};
constexpr Perez x_law = {-0.0193 * turbidity - 0.2592,
                         -0.0665 * turbidity + 0.0008,
                         -0.0004 * turbidity + 0.2125,
                         -0.0641 * turbidity - 0.8989,
                         -0.0033 * turbidity + 0.0452};
constexpr Perez y_law = {-0.0167 * turbidity - 0.2608,
                         -0.0950 * turbidity + 0.0092,
                         -0.0079 * turbidity + 0.2102,
                         -0.0441 * turbidity - 1.6537,
                         -0.0109 * turbidity + 0.0529};

/// Rows for turbidity^2, turbidity and 1; columns for the cube, square and so on of the sun's angle
/// from the zenith.
using ZenithTable = double[3][4];
constexpr ZenithTable zenith_x_table = {{0.00166, -0.00375, 0.00209, 0},
                                        {-0.02903, 0.06377, -0.03202, 0.00394},
                                        {0.11693, -0.21196, 0.06052, 0.25886}};
constexpr ZenithTable zenith_y_table = {{0.00275, -0.00610, 0.00317, 0},
                                        {-0.04214, 0.08970, -0.04153, 0.00516},
                                        {0.15346, -0.26756, 0.06670, 0.26688}};

double zenith_chromaticity(const ZenithTable& table, double sun_theta) {
    double out = 0;
    for (const auto& row : table) {
        const double value = ((row[0] * sun_theta + row[1]) * sun_theta + row[2]) * sun_theta;
        out = out * turbidity + value + row[3];
    }
    return out;
}

/// Linear Rec.709 of CIE xyY.
Color rgb_from_xyy(double x, double y, double luminance) {
    const double cie_x = x / y * luminance;
    const double cie_z = (1 - x - y) / y * luminance;
    const Color rgb = {3.2404542 * cie_x - 1.5371385 * luminance - 0.4985314 * cie_z,
                       -0.9692660 * cie_x + 1.8760108 * luminance + 0.0415560 * cie_z,
                       0.0556434 * cie_x - 0.2040259 * luminance + 1.0572252 * cie_z};
    return {std::max(rgb[0], 0.0), std::max(rgb[1], 0.0), std::max(rgb[2], 0.0)};
}

/// The sky of one place of the sun; kcd/m^2.
class Sky {
public:
    explicit Sky(double sun_theta) {
        const double chi = (4.0 / 9 - turbidity / 120) * (pi_d - 2 * sun_theta);
        const double zenith =
            (4.0453 * turbidity - 4.9710) * std::tan(chi) - 0.2155 * turbidity + 2.4192;
        luminance_ = zenith / luminance_law.at(1, sun_theta);
        x_ = zenith_chromaticity(zenith_x_table, sun_theta) / x_law.at(1, sun_theta);
        y_ = zenith_chromaticity(zenith_y_table, sun_theta) / y_law.at(1, sun_theta);
    }

    /// In      cos_theta: of the angle from the zenith, above 0; gamma: from the sun
    Color at(double cos_theta, double gamma) const {
        return rgb_from_xyy(x_ * x_law.at(cos_theta, gamma),
                            y_ * y_law.at(cos_theta, gamma),
                            luminance_ * luminance_law.at(cos_theta, gamma));
    }

private:
    double luminance_, x_, y_;
};

/// The sun's illuminance on a plane that faces it, in klx, reddened by the air.
Color sun_illuminance(double elevation_rad) {
    const double degrees = elevation_rad * 180 / pi_d;
    const double air_mass =
        1 / (std::sin(elevation_rad) + 0.50572 * std::pow(degrees + 6.07995, -1.6364));
    const double luminance = sun_klx * std::exp(-extinction * air_mass);
    constexpr std::array<double, 3> wavelengths_um = {0.61, 0.55, 0.465};
    constexpr std::array<double, 3> weights = {0.2126, 0.7152, 0.0722};
    Color out = {};
    double sum = 0;
    for (size_t c = 0; c < 3; ++c) {
        out[c] = std::exp(-0.008735 * std::pow(wavelengths_um[c], -4.08) * air_mass);
        sum += weights[c] * out[c];
    }
    for (double& value : out)
        value *= luminance / sum;
    return out;
}

Vec3d direction_of(double x, double y) {
    const double theta = pi_d * y / daylight_height;
    const double phi = 2 * pi_d * (x / daylight_width - 0.5);
    return {std::sin(theta) * std::cos(phi), std::cos(theta), std::sin(theta) * std::sin(phi)};
}

double solid_angle_of_row(int y) {
    const double top = std::cos(pi_d * y / daylight_height);
    const double bottom = std::cos(pi_d * (y + 1) / daylight_height);
    return 2 * pi_d / daylight_width * (top - bottom);
}

double angle_between(const Vec3d& a, const Vec3d& b) {
    return 2 * std::asin(std::min(0.5 * length(a - b), 1.0));
}

/// The fraction of a pixel that the sun covers.
double sun_coverage(int x, int y, const Vec3d& sun) {
    constexpr int steps = 8;
    int inside = 0;
    for (int i = 0; i < steps * steps; ++i) {
        const double px = x + (i % steps + 0.5) / steps;
        const int row = i / steps;
        const double py = y + (row + 0.5) / steps;
        if (angle_between(direction_of(px, py), sun) <= sun_radius_rad) ++inside;
    }
    return static_cast<double>(inside) / (steps * steps);
}

struct CoveredPixel {
    size_t pixel;
    double coverage;
    double solid_angle;
};

/// The pixels of the sun, of which there is at least a part.
std::vector<CoveredPixel> find_sun(const Vec3d& sun) {
    std::vector<CoveredPixel> out;
    for (int y = 0; y < daylight_height; ++y) {
        const double theta = pi_d * (y + 0.5) / daylight_height;
        if (std::abs(theta - std::acos(std::clamp(sun.y, -1.0, 1.0))) > 3 * sun_radius_rad)
            continue;
        for (int x = 0; x < daylight_width; ++x) {
            if (angle_between(direction_of(x + 0.5, y + 0.5), sun) > 3 * sun_radius_rad) continue;
            const double coverage = sun_coverage(x, y, sun);
            if (!(coverage > 0)) continue;
            const auto pixel = static_cast<size_t>(y) * daylight_width + static_cast<size_t>(x);
            out.push_back({pixel, coverage, solid_angle_of_row(y)});
        }
    }
    return out;
}

/// Fills the upper half; returns the luminance's illuminance on the ground.
double add_sky(const Vec3d& sun, std::vector<float>& pixels) {
    const Sky sky(std::acos(std::clamp(sun.y, 0.0, 1.0)));
    double ground = 0;
    for (int y = 0; y < daylight_height / 2; ++y) {
        for (int x = 0; x < daylight_width; ++x) {
            const Vec3d direction = direction_of(x + 0.5, y + 0.5);
            const Color color = sky.at(direction.y, angle_between(direction, sun));
            const size_t at =
                3 * (static_cast<size_t>(y) * daylight_width + static_cast<size_t>(x));
            for (size_t c = 0; c < 3; ++c)
                pixels[at + c] = static_cast<float>(color[c]);
            const Vec3d rgb{color[0], color[1], color[2]};
            ground += luminance(rgb) * direction.y * solid_angle_of_row(y);
        }
    }
    return ground;
}

}  // namespace

std::vector<float> make_daylight_pixels(double elevation_rad, double azimuth_rad) {
    const double level = std::cos(elevation_rad);
    const Vec3d sun = {
        level * std::sin(azimuth_rad), std::sin(elevation_rad), level * std::cos(azimuth_rad)};
    std::vector<float> pixels(size_t{3} * daylight_width * daylight_height);
    double ground = add_sky(sun, pixels);
    const Color illuminance = sun_illuminance(elevation_rad);
    const std::vector<CoveredPixel> disc = find_sun(sun);
    double disc_size = 0;
    for (const CoveredPixel& covered : disc)
        disc_size += covered.coverage * covered.solid_angle;
    for (const CoveredPixel& covered : disc) {
        for (size_t c = 0; c < 3; ++c)
            pixels[3 * covered.pixel + c] +=
                static_cast<float>(illuminance[c] * covered.coverage / disc_size);
    }
    ground += luminance(Vec3d{illuminance[0], illuminance[1], illuminance[2]}) * sun.y;
    const double scale = daylight_ground * pi_d / ground;
    for (float& value : pixels)
        value = static_cast<float>(value * scale);
    const size_t horizon = pixels.size() / 2;
    std::fill(pixels.begin() + static_cast<long>(horizon),
              pixels.end(),
              static_cast<float>(ground_albedo * daylight_ground));
    return pixels;
}

}  // namespace obscura
