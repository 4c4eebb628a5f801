// camera/aperture_table.h - running sums of an aperture image, for sampling.
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "camera/aperture.h"

#include <vector>

namespace obscura {

/// Owns the arrays of an ApertureView.
struct ApertureTable {
    std::vector<float> rows;
    std::vector<float> columns;
    ApertureView view() const { return {rows.data(), columns.data()}; }
};

/// In      brightness: width * height values, rows from the top; negative ones count as 0
/// Out     an empty table when nothing is bright
ApertureTable make_aperture_table(const std::vector<float>& brightness, int width, int height);

}  // namespace obscura
