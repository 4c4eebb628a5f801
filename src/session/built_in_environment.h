// session/built_in_environment.h - the environments that have a name in place of a file.
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "base/error.h"
#include "image/pixels.h"

#include <optional>
#include <string>

namespace obscura {

enum class BuiltInEnvironmentKind { studio, neutral, white, sky };

struct BuiltInEnvironment {
    BuiltInEnvironmentKind kind = BuiltInEnvironmentKind::studio;
    double elevation_deg = 0;  ///< of the sun; sky alone
    double azimuth_deg = 0;    ///< from +Z towards +X
};

/// "studio", "neutral", "white" or "sky:ELEVATION,AZIMUTH"; nothing where the text is a file's
/// name. A file that is called like one of them is ./sky.
///
/// Errors  64 E-USAGE-NUMBER, E-USAGE-RANGE the angles of a sky
Result<std::optional<BuiltInEnvironment>> parse_built_in_environment(const std::string& text);

/// Its map. studio: that of scenes without light; white: 1 in all directions; neutral: a little
/// brighter above than below, 1 in the mean; sky: see light/daylight.h.
ImageRgb32f make_built_in_environment(const BuiltInEnvironment& environment);

}  // namespace obscura
