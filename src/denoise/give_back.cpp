// denoise/give_back.cpp - the light that a filter has taken goes back to the neighbourhood.
// SPDX-License-Identifier: Apache-2.0
#include "denoise/give_back.h"

#include <cmath>
#include <utility>

namespace obscura {

namespace {

int half_up(int count) {
    return (count + 1) / 2;
}

/// Number of a cell in rows of `width` cells.
size_t cell_number(int x, int y, int width) {
    return static_cast<size_t>(y) * static_cast<size_t>(width) + static_cast<size_t>(x);
}

size_t cell_count(int width, int height) {
    return static_cast<size_t>(width) * static_cast<size_t>(height);
}

/// The value between the middles of four cells.
struct Between {
    size_t cells[4];
    double shares[4];

    Between(double x, double y, int width, int height) {
        const double left = std::floor(x);
        const double top = std::floor(y);
        for (int i = 0; i < 4; ++i) {
            const double column = left + static_cast<double>(i & 1);
            const double row = top + static_cast<double>(i >> 1);
            shares[i] = (1 - std::abs(x - column)) * (1 - std::abs(y - row));
            const int in_x = std::clamp(static_cast<int>(column), 0, width - 1);
            const int in_y = std::clamp(static_cast<int>(row), 0, height - 1);
            cells[i] = cell_number(in_x, in_y, width);
        }
    }
};

}  // namespace

GiveBack::CellSums GiveBack::gather(const Rgb& taken) const {
    const Level& level = levels_.front();
    CellSums sums(cell_count(level.width, level.height));
    for_rows(level.height, [&](int row) {
        const int end = std::min((row + 1) * level.size, receives_.height());
        for (int y = row * level.size; y < end; ++y) {
            for (int x = 0; x < receives_.width(); ++x) {
                auto& cell = sums[cell_number(x / level.size, row, level.width)];
                for (size_t c = 0; c < 3; ++c)
                    cell[c] += static_cast<double>(taken[c].row(y)[x]);
            }
        }
    });
    return sums;
}

GiveBack::CellSums GiveBack::hand_on(const CellSums& sums, const Level& level) {
    const int width = half_up(level.width);
    CellSums out(cell_count(width, half_up(level.height)));
    for (int y = 0; y < level.height; ++y) {
        for (int x = 0; x < level.width; ++x) {
            const size_t cell = cell_number(x, y, level.width);
            for (size_t c = 0; c < 3; ++c) {
                out[cell_number(x / 2, y / 2, width)][c] += sums[cell][c] * (1 - level.kept[cell]);
            }
        }
    }
    return out;
}

/// Sums of the cells twice as large.
std::vector<double> GiveBack::merged(const std::vector<double>& sums, const Level& level) {
    const int width = half_up(level.width);
    std::vector<double> out(cell_count(width, half_up(level.height)));
    for (int y = 0; y < level.height; ++y) {
        for (int x = 0; x < level.width; ++x) {
            out[cell_number(x / 2, y / 2, width)] += sums[cell_number(x, y, level.width)];
        }
    }
    return out;
}

GiveBack::GiveBack(const Rgb& taken, const Plane& light, Plane receives)
    : receives_(std::move(receives)) {
    constexpr int smallest_cell = 16;
    constexpr double most = 0.03;
    Level level{smallest_cell,
                (receives_.width() + smallest_cell - 1) / smallest_cell,
                (receives_.height() + smallest_cell - 1) / smallest_cell,
                {},
                {},
                {}};
    level.light.resize(cell_count(level.width, level.height));
    level.receives = level.light;
    for (int y = 0; y < receives_.height(); ++y) {
        for (int x = 0; x < receives_.width(); ++x) {
            const size_t cell = cell_number(x / level.size, y / level.size, level.width);
            level.light[cell] += static_cast<double>(light.row(y)[x]);
            level.receives[cell] += static_cast<double>(receives_.row(y)[x]);
        }
    }
    levels_.push_back(level);
    CellSums sums = gather(taken);
    for (;;) {
        Level& now = levels_.back();
        const bool last = now.width == 1 && now.height == 1;
        for (size_t i = 0; i < sums.size(); ++i) {
            const double all = std::abs(sums[i][0] + sums[i][1] + sums[i][2]) / 3;
            const double room = now.receives[i] > 0 ? most * now.light[i] : 0.0;
            now.kept.push_back(last || all <= room ? 1.0 : room / all);
        }
        if (last) break;
        sums = hand_on(sums, now);
        levels_.push_back({2 * now.size,
                           half_up(now.width),
                           half_up(now.height),
                           merged(now.light, now),
                           merged(now.receives, now),
                           {}});
    }
}

void GiveBack::add(const Level& level, const CellSums& sums, Rgb& out) const {
    for_rows(receives_.height(), [&](int y) {
        for (int x = 0; x < receives_.width(); ++x) {
            const float receives = receives_.row(y)[x];
            if (!(receives > 0)) continue;
            const Between between((x + 0.5) / level.size - 0.5,
                                  (y + 0.5) / level.size - 0.5,
                                  level.width,
                                  level.height);
            std::array<double, 3> given = {};
            double receivers = 0;
            for (size_t i = 0; i < 4; ++i) {
                const size_t cell = between.cells[i];
                receivers += between.shares[i] * level.receives[cell];
                for (size_t c = 0; c < 3; ++c)
                    given[c] += between.shares[i] * level.kept[cell] * sums[cell][c];
            }
            for (size_t c = 0; c < 3; ++c) {
                out[c].row(y)[x] += receives * static_cast<float>(given[c] / receivers);
            }
        }
    });
}

Rgb GiveBack::spread(const Rgb& taken) const {
    Rgb out;
    out.fill(Plane(receives_.width(), receives_.height(), receives_.border()));
    CellSums sums = gather(taken);
    for (const Level& level : levels_) {
        add(level, sums, out);
        sums = hand_on(sums, level);
    }
    // Between the middles of cells that receive unequally not all has been given.
    Rgb rest;
    for (size_t c = 0; c < 3; ++c) {
        rest[c] = make_plane(receives_.width(), receives_.height(), 0, [&](int x, int y) {
            return taken[c].row(y)[x] - out[c].row(y)[x];
        });
    }
    sums = gather(rest);
    std::array<double, 3> all = {};
    double receivers = 0;
    for (size_t i = 0; i < sums.size(); ++i) {
        receivers += levels_.front().receives[i];
        for (size_t c = 0; c < 3; ++c)
            all[c] += sums[i][c];
    }
    if (!(receivers > 0)) return out;
    for_rows(receives_.height(), [&](int y) {
        for (int x = 0; x < receives_.width(); ++x) {
            for (size_t c = 0; c < 3; ++c)
                out[c].row(y)[x] += receives_.row(y)[x] * static_cast<float>(all[c] / receivers);
        }
    });
    return out;
}

}  // namespace obscura
