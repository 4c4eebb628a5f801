// gltf/parse/glb.h - the binary container: a header and chunks.
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "base/error.h"
#include "base/log.h"

#include <cstddef>
#include <optional>
#include <span>
#include <string>
#include <string_view>

namespace obscura::gltf {

/// The chunks of a .glb file, as views into its bytes.
struct GlbChunks {
    std::string_view json;
    std::optional<std::span<const std::byte>> binary;  ///< absent: there is no BIN chunk
};

bool is_glb(std::span<const std::byte> bytes);

/// Finds the chunks. Unknown chunks are skipped, bytes behind the declared length are ignored with
/// a warning.
///
/// Errors  65 E-GLB-* truncated, wrong lengths, wrong order of chunks; 69 E-VERSION
Result<GlbChunks> split_glb(std::span<const std::byte> bytes, const std::string& where, Log& log);

/// Says what a file that is neither GLB nor JSON looks like ("a ZIP archive"); empty: unknown.
std::string_view guess_foreign_format(std::span<const std::byte> bytes);

}  // namespace obscura::gltf
