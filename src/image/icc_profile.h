// image/icc_profile.h - the ICC profile of the sRGB colour space, made from its formulas.
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <vector>

namespace obscura {

/// A profile of a display, of the matrix and curve kind, in version 4 of the format: some 500
/// bytes, always the same.
///
/// Source  ICC.1:2010, sections 7.2, 8.3, 9.2 and 10; IEC 61966-2-1:1999
std::vector<std::byte> srgb_icc_profile();

}  // namespace obscura
