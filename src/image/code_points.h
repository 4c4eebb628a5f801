// image/code_points.h - what the codes of an OpenColorIO display mean, as the numbers of H.273.
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "image/display.h"

#include <OpenColorIO/OpenColorIO.h>

#include <optional>
#include <string>

namespace obscura {

/// Finds out which of the colour encodings that we can name is that of a display and view, by what
/// the config itself makes of some codes: names would prove nothing. Only where the config cannot
/// say it, because a view is a scene-referred colour space, a display that is called sRGB is taken
/// to be that.
///
/// Out     none: data, or an encoding that we have no numbers for
std::optional<ColorCodePoints> find_code_points(const OCIO_NAMESPACE::Config& config,
                                                const std::string& display,
                                                const std::string& view);

}  // namespace obscura
