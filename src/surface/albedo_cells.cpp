// surface/albedo_cells.cpp - the albedo tables as look-ups read them.
// SPDX-License-Identifier: Apache-2.0
#include "surface/albedo_table.h"

#include <algorithm>

namespace obscura {

namespace {

/// In   entry(i): of the table; the last column and the last row begin no cell
template <typename Entry>
AlbedoCells cells_of(const Entry& entry) {
    constexpr int entries = albedo_cosines * albedo_roughnesses;
    AlbedoCells cells{};
    for (int i = 0; i < entries; ++i) {
        const int from[4] = {i, i + 1, i + albedo_cosines, i + albedo_cosines + 1};
        for (int k = 0; k < 4; ++k)
            cells.corners[4 * i + k] = entry(std::min(from[k], entries - 1));
    }
    return cells;
}

}  // namespace

const AlbedoCells specular_scale_cells = cells_of([](int i) { return specular_albedo_scale[i]; });
const AlbedoCells specular_bias_cells = cells_of([](int i) { return specular_albedo_bias[i]; });
const AlbedoCells sheen_cells = cells_of([](int i) { return sheen_albedo_table[i]; });
const AlbedoCells dielectric_cells = cells_of(
    [](int i) { return dielectric_f0 * specular_albedo_scale[i] + specular_albedo_bias[i]; });

}  // namespace obscura
