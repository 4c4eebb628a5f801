// include/obscura/control.h - how a rendering runs, who watches it and who may stop it.
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "obscura/view.h"
#include <atomic>
#include <cstddef>
#include <functional>
#include <string>
#include <vector>

OBSCURA_BEGIN_API

/// Pixels of the beauty that are finished, valid during the callback.
struct Tile {
    Rect area;  ///< in the whole image
    const std::vector<std::string>& channels;
    const float* pixels;     ///< of the area's top left corner
    std::size_t row_floats;  ///< from one row of the area to the next
};

/// Nothing of it but `isa` changes a bit of the image. What callbacks throw ends the
/// call with the error E-INTERNAL, or E-MEM.
struct Control {
    int threads = 0;           ///< 0: every core that the process may use
    std::string isa = "auto";  ///< "baseline", "avx2", "avx512"; images agree to rounding only
    int tile_size = 16;        ///< pixels, from 1 to 256
    /// When it becomes true, rendering ends soon with the error E-STOPPED. Null: nobody stops it.
    const std::atomic<bool>* cancel = nullptr;
    /// Called with the finished share in [0, 1], which never falls, from any thread, by one at a
    /// time.
    std::function<void(double)> progress;
    /// Called with each tile when it is finished, in no particular order; likewise. With
    /// Sampling::noise_target each comes several times, in every pass with less noise.
    std::function<void(const Tile&)> tile;
};

/// What the library has to say besides.
struct Message {
    bool is_warning = false;
    std::string place;  ///< of a warning: a file, with a JSON pointer into it
    std::string text;
};

/// Called from any thread, by one at a time.
using MessageSink = std::function<void(const Message&)>;

OBSCURA_END_API
