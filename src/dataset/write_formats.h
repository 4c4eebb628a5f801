// dataset/write_formats.h - makes the files of BOP, COCO and NeRF of a data set's labels.
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "base/error.h"
#include "base/log.h"

#include "dataset/layout.h"

namespace obscura::dataset {

/// Reads the labels of all images that are there, and writes what the formats ask for, each file
/// whole or not at all:
///
/// - always objects.json: a number for each model, the same mesh stretched alike;
/// - BOP: scene_camera.json, scene_gt.json and scene_gt_info.json in each scene's folder;
/// - COCO: coco_annotations.json with the visible masks of all scenes' images;
/// - NeRF: transforms.json in each scene's folder.
///
/// Images that failed, or that other parts have not made yet, are left out; nothing is written
/// where there is no folder, since no image was begun.
///
/// Source  BOP: github.com/thodan/bop_toolkit, docs/bop_datasets_format.md; COCO:
///         cocodataset.org, "Data format"; NeRF: github.com/NVlabs/instant-ngp,
///         docs/nerf_dataset_tips.md
/// Errors  65 E-JSON-* a label file was damaged; 73 E-OUT-CREATE, 74 E-OUT-WRITE
Result<void> write_formats(const Dataset& dataset, Log& log);

}  // namespace obscura::dataset
