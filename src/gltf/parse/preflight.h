// gltf/parse/preflight.h - what is checked and set right in the JSON before tinygltf sees it.
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "base/json/json_read.h"
#include "gltf/parse/document.h"

namespace obscura {

/// Checks the parts of an asset that tinygltf reads - the type and range of every member of glTF's
/// own and of KHR_lights_punctual, indices, what is required - in the order in which the readers
/// take them, and makes of the tree one that tinygltf reads without fault and without data:
///
/// - buffers lose their URI and length, images their URI and view: the document gets them;
/// - integers that are written as 3.0 become 3, and what does not fit into 32 bits the largest
///   integer that does;
/// - extensions that nobody reads are taken out, the others marked (mark_for_values);
/// - what tinygltf insists on and glTF does not is added.
///
/// Errors  in `fault`: 65 E-JSON-TYPE, E-DOC-MISSING, E-DOC-INDEX, E-DOC-IMAGE, E-BUF-LENGTH,
///         E-BUF-STRIDE, E-ACC-TYPE, E-MESH-TARGETS, E-CAM-TYPE, E-CAM-ASPECT, E-CAM-CLIP
void check_tree(nlohmann::json& tree, Document& document, Log& log, JsonFault& fault);

}  // namespace obscura
