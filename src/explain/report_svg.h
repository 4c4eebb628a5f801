// explain/report_svg.h - draws one pixel's report: the plane of the ray and the normal.
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "explain/pixel_report.h"

namespace obscura {

/// An SVG document with its own light ground, so that it can be read on any page: cross sections of
/// the objects, the ray with a numbered dot at each hit, the normal, the directions
/// of the lights as far as they lie in the plane, and a legend with the numbers.
std::string pixel_svg(const crosscheck::TrueScene& scene, const PixelReport& report);

}  // namespace obscura
