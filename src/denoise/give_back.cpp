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

/// The two columns of cells whose middles are around a pixel's, and the share of each; or rows.
struct Between {
    size_t cells[2];
    double shares[2];

    Between(int pixel, int cell_size, int count) {
        const double at = (pixel + 0.5) / cell_size - 0.5;
        const double before = std::floor(at);
        for (int i = 0; i < 2; ++i) {
            const double cell = before + i;
            shares[i] = 1 - std::abs(at - cell);
            cells[i] = static_cast<size_t>(std::clamp(static_cast<int>(cell), 0, count - 1));
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
        now.receivers = receivers(now);
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
                           {},
                           {}});
    }
}

std::vector<double> GiveBack::receivers(const Level& level) const {
    const auto width = static_cast<size_t>(level.width);
    const auto rows = static_cast<size_t>(receives_.height());
    std::vector<double> of_rows(rows * width);
    for_rows(receives_.height(), [&](int y) {
        double* const cells = &of_rows[static_cast<size_t>(y) * width];
        for (int x = 0; x < receives_.width(); ++x) {
            const Between columns(x, level.size, level.width);
            for (size_t i = 0; i < 2; ++i)
                cells[columns.cells[i]] += columns.shares[i] * receives_.row(y)[x];
        }
    });
    // In order: sums are the same for any number of threads.
    std::vector<double> out(cell_count(level.width, level.height));
    for (size_t y = 0; y < rows; ++y) {
        const Between between(static_cast<int>(y), level.size, level.height);
        for (size_t i = 0; i < 2; ++i) {
            for (size_t x = 0; x < width; ++x)
                out[between.cells[i] * width + x] += between.shares[i] * of_rows[y * width + x];
        }
    }
    return out;
}

void GiveBack::add(const Level& level, const CellSums& sums, Rgb& out) const {
    CellSums given = sums;
    for (size_t cell = 0; cell < sums.size(); ++cell) {
        const double all = level.receivers[cell];
        for (double& channel : given[cell])
            channel *= all > 0 ? level.kept[cell] / all : 0.0;
    }
    for_rows(receives_.height(), [&](int y) {
        const Between rows(y, level.size, level.height);
        for (int x = 0; x < receives_.width(); ++x) {
            const float receives = receives_.row(y)[x];
            if (!(receives > 0)) continue;
            const Between columns(x, level.size, level.width);
            std::array<double, 3> sum = {};
            for (size_t i = 0; i < 4; ++i) {
                const size_t row = rows.cells[i / 2] * static_cast<size_t>(level.width);
                const double share = rows.shares[i / 2] * columns.shares[i % 2];
                for (size_t c = 0; c < 3; ++c)
                    sum[c] += share * given[row + columns.cells[i % 2]][c];
            }
            for (size_t c = 0; c < 3; ++c)
                out[c].row(y)[x] += receives * static_cast<float>(sum[c]);
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
    return out;
}

}  // namespace obscura
