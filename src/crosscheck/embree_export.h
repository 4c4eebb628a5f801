// crosscheck/embree_export.h - a scene as Embree's tutorial programs read it, and their pictures.
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

namespace obscura {

/// All triangles in the world, each instance's on their own: one primitive for each material that
/// Embree shall tell apart, three vertices a triangle. Shapes are left out.
Scene flattened(const Scene& scene);

/// The vertices and triangles of a flattened scene; one geometry a primitive.
std::string wavefront_text(const Scene& flat);

/// The viewer's camera options, without --size; double the pixels put their corners on our centres.
/// Nothing where the viewer has no such camera: only pinholes without shift or distortion.
std::optional<std::vector<std::string>> viewer_camera(const Camera& camera);

/// The colour that the viewer gives a number.
std::array<int, 3> viewer_color(unsigned number);

/// What the viewer's pictures say against our own queries with the same flags.
struct ViewerReport {
    std::string state;  ///< "compared"; else why nothing was: "not installed"
    uint64_t pixels = 0;
    uint64_t occlusion = 0;  ///< pixels that differ
    uint64_t geometry = 0;
    uint64_t primitive = 0;
    uint64_t normal = 0;
    uint64_t ties = 0;  ///< pixels apart from these: within a few ulp of an edge, either is right

    uint64_t differences() const { return occlusion + geometry + primitive + normal; }
};

/// Writes mesh.obj and mesh.ecs into the folder and, where Embree's viewer is installed, its
/// pictures, which are then compared pixel by pixel.
///
/// Errors  73 E-OUT-CREATE; those of Accel::build
Result<ViewerReport> export_for_embree(const Scene& scene,
                                       const Camera& camera,
                                       std::array<int, 2> size_px,
                                       const std::filesystem::path& folder);

}  // namespace obscura
