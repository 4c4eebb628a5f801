// crosscheck/embree_viewer.h - Embree's own viewer, run without a window and compared with us.
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "crosscheck/embree_export.h"

namespace obscura {

struct ViewerTask {
    const Scene& flat;
    const Camera& camera;
    std::array<int, 2> size_px;
    std::filesystem::path mesh;  ///< absolute; pictures are written beside it
    std::vector<std::string> camera_options;
};

/// The viewer of Embree's tutorials on $PATH, known by another tutorial beside it: its name alone
/// could be anybody's.
std::optional<std::filesystem::path> find_embree_viewer();

/// Errors  those of Accel::build
Result<ViewerReport> compare_with_viewer(const ViewerTask& task);

}  // namespace obscura
