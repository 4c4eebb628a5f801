// app/dataset_request.h - the request of `obscura dataset`, checked and ready to use.
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "app/render_request.h"

#include "dataset/layout.h"
#include <optional>
#include <string>
#include <vector>

namespace obscura::app {

/// The texts of the options as they stood on the command line.
struct DatasetArguments {
    OptionText output, count, sample, write, fill, vary, depth_unit, part;
    bool dry_run = false;
    bool layers_exr = false;
    RenderArguments render;  ///< the scenes, and options that all images get
};

/// One scene: how its images are rendered, and where they go.
struct DatasetScene {
    RenderArguments arguments;
    RenderRequest request;
};

struct DatasetRequest {
    ViewSampling sampling = {.count = 100};
    dataset::Dataset dataset;
    std::optional<double> depth_unit_mm;
    std::vector<DatasetScene> scenes;
};

/// Errors  64 E-USAGE-CONFLICT, E-USAGE-CHOICE, E-USAGE-RANGE; those of make_render_request
Result<DatasetRequest> make_dataset_request(const DatasetArguments& arguments);

}  // namespace obscura::app
