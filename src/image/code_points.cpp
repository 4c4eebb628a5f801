// image/code_points.cpp - tells the encoding of a display by what its codes become in CIE XYZ.
// SPDX-License-Identifier: Apache-2.0
#include "image/code_points.h"

#include "image/rgb_primaries.h"

#include <algorithm>
#include <cmath>

namespace obscura {

namespace ocio = OCIO_NAMESPACE;

namespace {

/// Light of a code, relative to white as OpenColorIO's displays count it: 1 is 100 nit.
using Eotf = double (*)(double code);

/// Source  IEC 61966-2-1:1999, section 5.2
double srgb_eotf(double code) {
    return code <= 0.04045 ? code / 12.92 : std::pow((code + 0.055) / 1.055, 2.4);
}

double gamma_22_eotf(double code) {
    return std::pow(code, 2.2);
}

/// Source  SMPTE ST 2084:2014, section 5.1
double pq_eotf(double code) {
    constexpr double m1 = 2610.0 / 16384, m2 = 2523.0 / 4096 * 128;
    constexpr double c1 = 3424.0 / 4096, c2 = 2413.0 / 4096 * 32, c3 = 2392.0 / 4096 * 32;
    const double power = std::pow(code, 1 / m2);
    return 100 * std::pow(std::max(power - c1, 0.0) / (c2 - c3 * power), 1 / m1);
}

struct KnownEncoding {
    ColorCodePoints code_points;
    const RgbPrimaries& primaries;
    Eotf eotf;
};

/// Left out are those whose numbers are read in several ways (BT.1886 as 1, HLG as 18).
constexpr KnownEncoding known_encodings[] = {{srgb_code_points, rec709_primaries, srgb_eotf},
                                             {{1, 4}, rec709_primaries, gamma_22_eotf},
                                             {{12, 13}, p3_primaries, srgb_eotf},
                                             {{9, 16}, rec2020_primaries, pq_eotf},
                                             {{12, 16}, p3_primaries, pq_eotf}};

/// Saturated and pale, dark and light.
constexpr float probes[][3] = {
    {0.25f, 0.5f, 0.75f}, {0.9f, 0.1f, 0.4f}, {0.02f, 0.9f, 0.6f}, {0.7f, 0.7f, 0.05f}, {1, 1, 1}};

bool agrees(const KnownEncoding& known, const ocio::ConstCPUProcessorRcPtr& xyz_from_codes) {
    constexpr double tolerance = 1e-3;  // a third of what tells sRGB from gamma 2.2
    const Matrix3 matrix = xyz_from_rgb(known.primaries);
    for (const auto& probe : probes) {
        const Xyz expected =
            product(matrix, Xyz{known.eotf(probe[0]), known.eotf(probe[1]), known.eotf(probe[2])});
        float found[3] = {probe[0], probe[1], probe[2]};
        xyz_from_codes->applyRGB(found);
        for (size_t c = 0; c < 3; ++c) {
            const double allowed = tolerance * std::max(1.0, expected[c]);
            if (!(std::abs(static_cast<double>(found[c]) - expected[c]) <= allowed)) return false;
        }
    }
    return true;
}

bool is_called_srgb(std::string name) {
    std::transform(name.begin(), name.end(), name.begin(), [](char c) {
        return c >= 'A' && c <= 'Z' ? static_cast<char>(c - 'A' + 'a') : c;
    });
    return name == "srgb" || name == "srgb display" || name == "srgb - display";
}

bool is_display_referred(const ocio::ConstColorSpaceRcPtr& space) {
    return space->getReferenceSpaceType() == ocio::REFERENCE_SPACE_DISPLAY;
}

}  // namespace

std::optional<ColorCodePoints> find_code_points(const ocio::Config& config,
                                                const std::string& display,
                                                const std::string& view) {
    std::string name = config.getDisplayViewColorSpaceName(display.c_str(), view.c_str());
    if (name == ocio::OCIO_VIEW_USE_DISPLAY_NAME) name = display;
    const ocio::ConstColorSpaceRcPtr space = config.getColorSpace(name.c_str());
    if (!space || space->isData()) return std::nullopt;
    const ocio::ConstColorSpaceRcPtr xyz = config.getColorSpace("cie_xyz_d65_interchange");
    if (!is_display_referred(space) || !xyz || !is_display_referred(xyz)) {
        if (is_called_srgb(display)) return srgb_code_points;
        return std::nullopt;
    }
    const ocio::ConstCPUProcessorRcPtr xyz_from_codes =
        config.getProcessor(space, xyz)->getDefaultCPUProcessor();
    for (const KnownEncoding& known : known_encodings) {
        if (agrees(known, xyz_from_codes)) return known.code_points;
    }
    return std::nullopt;
}

}  // namespace obscura
