// gltf/parse/preflight.h - checks and repairs the JSON before tinygltf sees it.
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "base/json/json_read.h"
#include "gltf/parse/document.h"

namespace obscura::gltf {

/// Checks the parts of an asset that tinygltf reads - the type and range of every member of glTF's
/// own and of KHR_lights_punctual, indices, required members - in the order in which the readers
/// take them, and rewrites the tree so that tinygltf reads it without fault and without data:
///
/// - buffers lose their URI and length, images their URI and view: the document gets them;
/// - integers that are written as 3.0 become 3, and what does not fit into 32 bits the largest
///   integer that does;
/// - extensions that nobody reads are removed, the others marked (mark_for_values);
/// - members that tinygltf insists on and glTF does not are added.
///
/// Errors  in `fault`: 65 E-JSON-TYPE, E-DOC-MISSING, E-DOC-INDEX, E-DOC-IMAGE, E-BUF-LENGTH,
///         E-BUF-STRIDE, E-ACC-TYPE, E-MESH-TARGETS, E-CAM-TYPE, E-CAM-ASPECT, E-CAM-CLIP
void check_tree(nlohmann::json& tree, Document& document, Log& log, JsonFault& fault);

}  // namespace obscura::gltf
