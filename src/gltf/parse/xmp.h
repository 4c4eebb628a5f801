// gltf/parse/xmp.h - KHR_xmp_json_ld and KHR_xmp: what an asset says about itself.
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "base/json/json_read.h"

#include <string>

namespace obscura::gltf {

/// Longer packets are no description any more; images do not get them.
inline constexpr size_t longest_xmp = 1U << 20;

/// The packet that the object `asset` names, as JSON text; empty when it names none.
///
/// Errors  faults of the reader: 65 E-DOC-INDEX
std::string read_xmp(const JsonReader& root, const nlohmann::json& tree);

}  // namespace obscura::gltf
