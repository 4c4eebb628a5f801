// app/display_canvas.cpp - an image as a viewer is to see it, and which pixels are new to it.
// SPDX-License-Identifier: Apache-2.0
#include "app/display_canvas.h"

#include <algorithm>
#include <cstring>
#include <utility>

namespace obscura::app {

namespace {

/// A packet is a quarter of a MiB at most: while one is made, rendering threads wait.
constexpr int cell_side = 128;

int cells_in(int pixels) {
    return (pixels + cell_side - 1) / cell_side;
}

}  // namespace

DisplayCanvas::DisplayCanvas(const std::string& name, const Film& film) : width_(film.width) {
    const ImagePart part = film.part_of.value_or(ImagePart{film.width, film.height, 0, 0});
    x_ = part.x;
    y_ = part.y;
    viewer_x_ = std::max(part.x, 0);
    viewer_y_ = std::max(part.y, 0);
    const int right = std::max(part.width, part.x + film.width);
    const int bottom = std::max(part.height, part.y + film.height);
    image_ = {name, right - std::min(part.x, 0), bottom - std::min(part.y, 0), film.channels};
    cells_across_ = cells_in(film.width);
    pixels_.resize(static_cast<size_t>(film.width) * static_cast<size_t>(film.height) *
                   film.channels.size());
    cells_.resize(static_cast<size_t>(cells_across_) * static_cast<size_t>(cells_in(film.height)));
}

void DisplayCanvas::put(const PixelRect& area, const PixelSource& source) {
    const ImagePart origin = source.part_of.value_or(ImagePart{});
    const size_t channels = image_.channels.size();
    const auto count = static_cast<size_t>(area.width) * channels;
    const auto offset = [&](int x, int y, int width) {
        return (static_cast<size_t>(y) * static_cast<size_t>(width) + static_cast<size_t>(x)) *
               channels;
    };
    for (int row = 0; row < area.height; ++row) {
        const int y = area.y + row - y_;
        const int x = area.x - x_;
        const float* const from =
            source.pixels + offset(area.x - origin.x, area.y + row - origin.y, source.width);
        float* const to = pixels_.data() + offset(x, y, width_);
        if (std::memcmp(from, to, count * sizeof(float)) == 0) continue;
        std::copy_n(from, count, to);
        note_change(y, x, x + area.width);
    }
}

void DisplayCanvas::note_change(int y, int x_0, int x_1) {
    const int row = y / cell_side;
    for (int column = x_0 / cell_side; column * cell_side < x_1; ++column) {
        const size_t index = static_cast<size_t>(row) * static_cast<size_t>(cells_across_) +
                             static_cast<size_t>(column);
        Cell& cell = cells_[index];
        const int begin = std::max(x_0, column * cell_side);
        const int end = std::min(x_1, (column + 1) * cell_side);
        if (cell.x_0 == cell.x_1) {
            cell = {begin, y, end, y + 1};
            changed_.push_back(index);
        } else {
            cell = {std::min(cell.x_0, begin),
                    std::min(cell.y_0, y),
                    std::max(cell.x_1, end),
                    std::max(cell.y_1, y + 1)};
        }
    }
}

std::optional<Bytes> DisplayCanvas::take_packet() {
    if (!is_created_) {
        is_created_ = true;
        return tev_create_image(image_);
    }
    if (changed_.empty()) return {};
    const Cell cell = std::exchange(cells_[changed_.front()], Cell{});
    changed_.pop_front();
    const PixelRect area{
        cell.x_0 + viewer_x_, cell.y_0 + viewer_y_, cell.x_1 - cell.x_0, cell.y_1 - cell.y_0};
    const size_t channels = image_.channels.size();
    const size_t row_size = static_cast<size_t>(area.width) * channels;
    std::vector<float> values;
    values.reserve(static_cast<size_t>(area.height) * row_size);
    for (int y = cell.y_0; y < cell.y_1; ++y) {
        const size_t first =
            (static_cast<size_t>(y) * static_cast<size_t>(width_) + static_cast<size_t>(cell.x_0)) *
            channels;
        const float* const row = pixels_.data() + first;
        values.insert(values.end(), row, row + row_size);
    }
    return tev_update_image(image_, area, values);
}

}  // namespace obscura::app
