// gltf/assign_material.h - gives a node a material other than the file's.
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "gltf/parse/document.h"

#include <cstddef>

namespace obscura::gltf {

/// Gives all that a node draws a material, in every variant. A mesh that other nodes draw, too, is
/// copied for this one; the copy has the morph weights that the mesh has now.
///
/// In      node, material: their numbers in the file
/// Errors  64 E-SET-UNKNOWN there is no such node or material, or the node draws nothing
Result<void> assign_material(size_t node, size_t material, Document& document);

}  // namespace obscura::gltf
