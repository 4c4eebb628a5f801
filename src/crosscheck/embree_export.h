// crosscheck/embree_export.h - writes a scene for Embree's tutorials and compares their images.
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "base/error.h"
#include "camera/camera.h"
#include "scene/scene.h"

#include <array>
#include <filesystem>
#include <optional>
#include <string>
#include <vector>

namespace obscura::crosscheck {

/// All triangles in world space, instances flattened: one primitive for each material that Embree
/// tells apart, three vertices a triangle. Shapes are left out.
Scene flattened(const Scene& scene);

/// The vertices and triangles of a flattened scene; one geometry a primitive.
std::string wavefront_text(const Scene& flat);

/// The viewer's camera options, without --size; at twice the pixels, its corners are our centres.
/// Nothing for cameras that it lacks: it has only pinholes without shift or distortion.
std::optional<std::vector<std::string>> viewer_camera(const Camera& camera);

/// The colour by which the viewer shows an index.
std::array<int, 3> viewer_color(unsigned number);

/// The viewer's images compared with our own queries with the same flags.
struct ViewerReport {
    std::string state;  ///< "compared"; else the reason why not: "not installed"
    uint64_t pixels = 0;
    uint64_t occlusion = 0;  ///< pixels that differ
    uint64_t geometry = 0;
    uint64_t primitive = 0;
    uint64_t normal = 0;
    uint64_t ties = 0;  ///< differing pixels within a few ulp of an edge: either is right

    uint64_t differences() const { return occlusion + geometry + primitive + normal; }
};

/// Writes mesh.obj and mesh.ecs into the folder and, where Embree's viewer is installed, its
/// images, which are then compared pixel by pixel.
///
/// Errors  73 E-OUT-CREATE; those of Accel::build
Result<ViewerReport> export_for_embree(const Scene& scene,
                                       const Camera& camera,
                                       std::array<int, 2> size_px,
                                       const std::filesystem::path& folder);

}  // namespace obscura::crosscheck
