// dataset/image_labels.h - the labels of one image: its camera, and each object in it.
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "dataset/ray_labels.h"
#include "dataset/rigid_pose.h"
#include <optional>
#include <string>
#include <vector>

namespace obscura::dataset {

/// Pixels from the image's upper left corner; of a silhouette it may reach beyond the image.
struct PixelBox {
    int left = 0, top = 0, width = 0, height = 0;
};

/// One object, a node with a mesh, in one image.
struct ObjectLabel {
    int32_t node = 0;
    const Silhouette* silhouette = nullptr;  ///< of the labels it was made of
    RigidPose pose;
    std::optional<PixelBox> box;          ///< of the silhouette, hidden or not
    std::optional<PixelBox> visible_box;  ///< of what is seen
    size_t pixels = 0;                    ///< of the silhouette, beyond the image too
    size_t pixels_inside = 0;             ///< of them, those in the image
    size_t visible_pixels = 0;

    /// The share of the silhouette that is seen.
    double visibility() const {
        return static_cast<double>(visible_pixels) / static_cast<double>(pixels);
    }
};

/// The objects of which a pixel lies in the image, seen or hidden.
std::vector<ObjectLabel> label_objects(const RayLabels& rays, const Scene& scene);

/// Indices of the image's pixels, row after row, ascending.
struct Masks {
    std::vector<uint32_t> all;      ///< where an object lies
    std::vector<uint32_t> visible;  ///< where it is seen
};
Masks masks_of(const RayLabels& rays, const ObjectLabel& object);

}  // namespace obscura::dataset
