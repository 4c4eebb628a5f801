// render/passes.h - adaptive sampling: passes over the whole film, each of the pixels in need.
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "render/tile.h"

#include <memory>
#include <vector>

namespace obscura {

/// A film, and what fills it.
struct FilmWork {
    const TileWork& tile_work;
    const RenderOptions& options;
    const ProgressFunction& progress;
    std::vector<std::unique_ptr<ThreadState>>& states;
    Film& film;
};

/// The state of the calling thread, made when it is first asked for.
ThreadState& thread_state(const FilmWork& work);

/// Renders with options.adaptive. Passes go over the whole film: the first two take the least
/// number of samples of every pixel, each later one those of the pixels in need, by the noise of
/// the film that the passes before it left. Between two passes the film is whole.
///
/// Out     nothing of worth when `tile_work.stop` is set
SamplesTaken render_passes(const FilmWork& work);

}  // namespace obscura
