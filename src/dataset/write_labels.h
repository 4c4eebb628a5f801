// dataset/write_labels.h - writes the label files of one image: depth, ids, masks and their JSON.
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "session/camera_choice.h"
#include "session/render_request.h"

#include "dataset/layout.h"
#include "dataset/ray_labels.h"
#include <atomic>
#include <optional>
#include <string>
#include <vector>

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
    const std::atomic<bool>& stop;  ///< when it becomes true, nothing more is written
};

/// Writes the labels of one scene's images.
class LabelWriter {
public:
    explicit LabelWriter(LabelOptions options) : options_(std::move(options)) {}

    /// Writes labels/NAME.json, depth/NAME.png, segmentation/NAME.png and, if asked for, the masks,
    /// each whole or not at all, the JSON last; and objects.json of the scene. docs/dataset.md
    /// lists what is in them.
    ///
    /// In      a scene with Scene::node_places
    /// Errors  69 E-SEG-IDS; 73 E-OUT-CREATE a folder cannot be made; those of write_image_file; 75
    ///         E-STOPPED
    Result<void> write(const LabelledImage& image, Log& log);

    /// Whether the files of an image are there and whole, by the name of its colours.
    bool has_written(const std::filesystem::path& image) const;

private:
    Result<void> begin(const RenderRequest& request, const Scene& scene);
    void warn_of_far_pixels(const std::filesystem::path& file, size_t count, Log& log) const;

    LabelOptions options_;
    std::vector<std::string> paths_;  ///< of all nodes; empty: nothing has been written
    double unit_mm_ = 0;
};

/// The power of ten of millimetres of which 65535 reach beyond all that a request's views show.
double depth_unit_mm(const RenderRequest& request, const Scene& scene);

}  // namespace obscura::dataset
