// dataset/ray_labels.h - what every pixel's middle shows, and what lies hidden behind it.
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "render/render.h"
#include "scene/visibility.h"

#include <atomic>
#include <cstdint>
#include <vector>

namespace obscura::dataset {

/// Surfaces with any of these flags are no objects: the camera passes them, or they are not shown
/// themselves.
inline constexpr uint8_t visibility_no_object =
    visibility_holdout | visibility_catcher | visibility_no_camera;

/// The pixels where one node lies, seen or hidden: its silhouette.
struct Silhouette {
    int32_t node = 0;              ///< index in glTF
    std::vector<uint32_t> pixels;  ///< in the frame, row after row; ascending
};

/// Labels of one image, by one ray through the middle of each pixel and of the lens. The frame is
/// the image, and where something may lie outside it also as much again on every side.
struct RayLabels {
    int width = 0, height = 0;  ///< of the image
    PixelRect frame;            ///< from the image's upper left corner
    /// Of the image's pixels: the nearest surface's; -1: nothing there, a holdout or a catcher.
    std::vector<int32_t> node;
    std::vector<int32_t> material;  ///< the same surface's, in Scene::materials; -1 likewise
    /// Metres along the view axis, of a fisheye and an image of all directions from the eye;
    /// 0 where `node` is -1.
    std::vector<float> depth_m;
    std::vector<Silhouette> silhouettes;  ///< of the nodes that have any, ascending

    /// True for a pixel of the frame that belongs to the image.
    bool is_inside(uint32_t pixel) const;
    /// Index in `node` and `depth_m` of such a pixel.
    size_t image_index(uint32_t pixel) const;
};

/// What of each pixel is traced: the nearest surface of the image's pixels, or all of the frame's.
enum class Depth { nearest, all };

/// Traces the labels on all threads. Surfaces count as they do for the layers `id_node` and
/// `depth`: alpha is a threshold, back faces of single-sided surfaces and what is invisible to the
/// camera are not there. Equal for any number of threads.
///
/// In   stop: what is left when it becomes true is not traced; null: never
RayLabels trace_labels(const PreparedScene& prepared,
                       const Camera& camera,
                       const RenderOptions& options,
                       Depth depth = Depth::all,
                       const std::atomic<bool>* stop = nullptr);

}  // namespace obscura::dataset
