// dataset/write_labels.h - writes the label files of one image: depth, ids, masks and their JSON.
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "session/camera_choice.h"
#include "session/render_request.h"

#include "dataset/layout.h"

namespace obscura::dataset {

struct LabelOptions {
    std::filesystem::path folder;           ///< of the scene
    bool writes_masks = false;              ///< a file for each object's masks
    std::optional<double> depth_unit_mm{};  ///< of a step of the depth files; none: depth_unit_mm()
};

/// An image of which the colours are finished.
struct LabelledImage {
    const RenderRequest& request;  ///< of this image; its first output is its colours
    const PreparedScene& prepared;
    const ChosenCamera& camera;
};

/// Writes labels/NAME.json, depth/NAME.png, segmentation/NAME.png and, if asked for, the masks,
/// each whole or not at all, the JSON last; and objects.json of the scene. docs/dataset.md lists
/// what is in them.
///
/// In      a scene with Scene::node_places
/// Errors  69 E-SEG-IDS; those of write_image_file
Result<void> write_labels(const LabelOptions& options, const LabelledImage& image, Log& log);

/// The power of ten of millimetres of which 65535 reach beyond all that a request's views show.
double depth_unit_mm(const RenderRequest& request, const Scene& scene);

}  // namespace obscura::dataset
