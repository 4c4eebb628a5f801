// image/ies_file.h - reads IES LM-63 photometric files.
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "base/error.h"
#include "light/light_profile.h"

#include <cstddef>
#include <span>
#include <string>

namespace obscura {

/// Reads LM-63 of 1986, 1991, 1995, 2002 and 2019, with photometry of types A, B and C. Candela
/// are multiplied by the file's multiplier and ballast factor, before 1995 also by the ballast-lamp
/// photometric factor. The effect of lamp tilt (TILT) is ignored: it depends on how the lamp is
/// mounted, which a scene does not describe. Planes that symmetry omits are reconstructed.
///
/// Out     type C: the polar axis is the aim (straight down), the zero axis horizontal angle 0;
///         A and B: the zero axis is the aim, the polar axis is perpendicular to it; a file's
///         clockwise angles grow towards cross(zero axis, polar axis)
/// Errors  65 E-IES-FORMAT no line TILT=, E-IES-SHORT cut off, E-IES-NUMBER not a number or out of
///         its range, E-IES-TYPE, E-IES-ANGLES do not rise or are not those of the type;
///         `where` and the line are in the message
/// Source  ANSI/IESNA LM-63-02; LM-63-95, section 4, for horizontal angles from 90 to 270
Result<LightProfile> read_ies(std::span<const std::byte> bytes, const std::string& where);

}  // namespace obscura
