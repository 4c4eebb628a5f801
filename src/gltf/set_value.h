// gltf/set_value.h - values that a caller gives to properties of a document.
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "gltf/parse/document.h"

#include <span>
#include <string>
#include <vector>

namespace obscura::gltf {

/// A property, and the value that it keeps whatever the time is.
struct SetValue {
    GltfChannel channel;
    std::vector<double> value;
};

/// Finds what a pointer names and checks the value. A node with a matrix gets its translation,
/// rotation and scale in its place.
///
/// In      pointer: as those of KHR_animation_pointer: "/nodes/3/translation"
/// Errors  64 E-SET-UNKNOWN nothing that can be set; E-SET-VALUE not so many numbers, not finite, a
///         rotation without length, a node's matrix that shears
Result<SetValue> check_set_value(const std::string& pointer,
                                 std::span<const double> value,
                                 Document& document);

}  // namespace obscura::gltf
