// denoise/give_back.h - the light that a filter has taken goes back to the neighbourhood.
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "denoise/planes.h"

#include <vector>

namespace obscura {

/// Where taken light goes: to the noisy pixels of the same cell, but never more than a small share
/// of the cell's light; what is over goes to the cell twice as large, and so on, up to the whole
/// image. Which share goes where is decided by the beauty, for all layers alike.
class GiveBack {
public:
    /// In      taken: of the beauty, by channel; may be negative
    ///         light: of the filtered beauty
    ///         receives: how much each pixel gets, relative to others
    GiveBack(const Rgb& taken, const Plane& light, Plane receives);

    /// What each pixel gets of the light that was taken.
    Rgb spread(const Rgb& taken) const;

private:
    /// One size of cells.
    struct Level {
        int size = 0;                         ///< pixels a side
        int width = 0, height = 0;            ///< cells
        std::vector<double> light, receives;  ///< by cell, summed
        std::vector<double> receivers;        ///< what all pixels receive of a cell's light
        std::vector<double> kept;             ///< share of the cell's light that is not handed on
    };
    using CellSums = std::vector<std::array<double, 3>>;

    CellSums gather(const Rgb& taken) const;
    static CellSums hand_on(const CellSums& sums, const Level& level);
    static std::vector<double> merged(const std::vector<double>& sums, const Level& level);
    std::vector<double> receivers(const Level& level) const;
    void add(const Level& level, const CellSums& sums, Rgb& out) const;

    Plane receives_;
    std::vector<Level> levels_;
};

}  // namespace obscura
