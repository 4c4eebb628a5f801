// image/rendering_space.h - the linear RGB space in which light is computed.
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "base/error.h"
#include "base/log.h"
#include "image/rgb_primaries.h"

#include <cstddef>
#include <optional>
#include <span>
#include <string>
#include <vector>

namespace obscura {

/// A scene-linear RGB space whose (1, 1, 1) is the white of Rec.709, adapted, and in which every
/// colour of Rec.709 has positive coordinates. glTF and environments bring Rec.709.
struct RenderingSpace {
    std::string name = "lin_rec709";              ///< as --color-space calls it
    std::string interop_id = "lin_rec709_scene";  ///< of the Color Interop Forum; "": it has none
    RgbPrimaries primaries = rec709_primaries;
    Chromaticity white = d65;
    std::optional<Matrix3> from_rec709 = {};  ///< none: it is Rec.709
};

/// "lin_rec709", "acescg", "aces2065-1" and "lin_rec2020".
std::vector<std::string> rendering_space_names();

/// A space by its name above, else by its name in the OpenColorIO config (a file, else $OCIO, else
/// the built-in one).
///
/// Errors  78 E-OCIO-FILE; E-OCIO-SPACE the config has none of this name, or it is not linear, or
///         it does not hold all colours of Rec.709
Result<RenderingSpace> find_rendering_space(const std::string& name,
                                            const std::string& ocio_file,
                                            Log& log);

/// Converts colours in place.
///
/// In      stride: floats from one colour's red to the next one's
void convert_colors(const Matrix3& matrix, std::span<float> rgb, size_t stride = 3);

}  // namespace obscura
