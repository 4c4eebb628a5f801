// camera/aperture_table.cpp - running sums of an aperture image, for sampling.
// SPDX-License-Identifier: Apache-2.0
#include "camera/aperture_table.h"

#include <algorithm>
#include <cmath>

namespace obscura {

namespace {

constexpr size_t side = aperture_size;

/// Mean brightness of the part of the image that one cell covers.
double cell_mean(const std::vector<float>& brightness, int width, int height, int x, int y) {
    const auto span = [](int i, int size) {
        const int first = i * size / aperture_size;
        return std::pair{first, std::max((i + 1) * size / aperture_size, first + 1)};
    };
    const auto [x0, x1] = span(x, width);
    const auto [y0, y1] = span(y, height);
    double sum = 0;
    for (int row = y0; row < y1; ++row) {
        for (int column = x0; column < x1; ++column) {
            const float value = brightness[static_cast<size_t>(row) * static_cast<size_t>(width) +
                                           static_cast<size_t>(column)];
            sum += value > 0 ? static_cast<double>(value) : 0.0;
        }
    }
    return sum / ((x1 - x0) * (y1 - y0));
}

/// Running sums of `values`, divided by their total; the last is exactly 1.
void write_sums(const double* values, float* sums) {
    double total = 0;
    for (size_t i = 0; i < side; ++i)
        total += values[i];
    double running = 0;
    for (size_t i = 0; i < side; ++i) {
        running += values[i];
        sums[i] = total > 0 ? static_cast<float>(running / total) : 1.0f;
    }
    // Exactly 1 from the last bright cell on, despite rounding.
    for (size_t i = side; i-- > 0;) {
        sums[i] = 1.0f;
        if (values[i] > 0) break;
    }
}

}  // namespace

ApertureTable make_aperture_table(const std::vector<float>& brightness, int width, int height) {
    std::vector<double> cells(side * side);
    std::vector<double> row_sums(side);
    for (size_t y = 0; y < side; ++y) {
        for (size_t x = 0; x < side; ++x) {
            const double mean =
                cell_mean(brightness, width, height, static_cast<int>(x), static_cast<int>(y));
            cells[y * side + x] = mean;
            row_sums[y] += mean;
        }
    }
    if (std::all_of(row_sums.begin(), row_sums.end(), [](double s) { return !(s > 0); })) return {};
    ApertureTable table;
    table.rows.resize(side);
    table.columns.resize(side * side);
    write_sums(row_sums.data(), table.rows.data());
    for (size_t y = 0; y < side; ++y)
        write_sums(&cells[y * side], &table.columns[y * side]);
    return table;
}

}  // namespace obscura
