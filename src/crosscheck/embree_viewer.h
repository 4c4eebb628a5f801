// crosscheck/embree_viewer.h - runs Embree's own viewer without a window and compares images.
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "crosscheck/embree_export.h"

namespace obscura::crosscheck {

struct ViewerTask {
    const Scene& flat;
    const Camera& camera;
    std::array<int, 2> size_px;
    std::filesystem::path mesh;  ///< absolute path; images are written beside it
    std::vector<std::string> camera_options;
};

/// The tutorials' viewer on $PATH, recognised by another tutorial beside it: other programs may
/// have its name.
std::optional<std::filesystem::path> find_embree_viewer();

/// Errors  those of Accel::build
Result<ViewerReport> compare_with_viewer(const ViewerTask& task);

}  // namespace obscura::crosscheck
