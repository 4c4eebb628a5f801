// app/display_canvas.h - an image as a viewer is to see it, and which pixels it has not seen yet.
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "film/film.h"
#include "session/tev_packets.h"

#include <cstddef>
#include <deque>
#include <optional>
#include <string>
#include <vector>

namespace obscura::app {

/// Where pixels lie in an image: the film that they are of, a finished image, or a tile alone.
struct PixelSource {
    std::optional<ImagePart> part_of;  ///< as Film::part_of
    int width = 0;
    const float* pixels = nullptr;  ///< interleaved
};

/// A copy of a film. What changes again before a viewer has seen it is sent once, and neighbours
/// together, so that a slow viewer costs no more memory than the copy.
class DisplayCanvas {
public:
    /// A black canvas. The viewer's image is the whole one, with a crop too; with overscan all that
    /// is rendered, as viewers know no pixels left of 0.
    ///
    /// In      film: for its place, size and channels
    DisplayCanvas(const std::string& name, const Film& film);

    /// Puts new pixels in.
    ///
    /// In      area: from the image's top left corner, within the film and the source
    void put(const PixelRect& area, const PixelSource& source);

    /// The packet that brings the viewer closer to this image; none: it has seen everything.
    std::optional<Bytes> take_packet();
    bool has_changes() const { return !is_created_ || !changed_.empty(); }

    size_t bytes() const { return pixels_.size() * sizeof(float); }

private:
    /// A square of the canvas; empty: the viewer has seen it.
    struct Cell {
        int x_0 = 0, y_0 = 0, x_1 = 0, y_1 = 0;
    };

    void note_change(int y, int x_0, int x_1);

    TevImage image_;
    int width_ = 0;                    ///< of the film
    int x_ = 0, y_ = 0;                ///< of the film, from the image's corner
    int viewer_x_ = 0, viewer_y_ = 0;  ///< the same, in the viewer's image
    int cells_across_ = 0;
    std::vector<float> pixels_;
    std::vector<Cell> cells_;
    std::deque<size_t> changed_;  ///< cells that are not empty, the earliest first
    bool is_created_ = false;
};

}  // namespace obscura::app
