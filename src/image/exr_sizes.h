// image/exr_sizes.h - the sizes in OpenEXR headers, before the library allocates memory by them.
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <optional>
#include <span>

namespace obscura {

/// True when the bytes begin like an OpenEXR file.
bool is_exr(std::span<const std::byte> bytes);

struct ExrSizes {
    /// Width and height of the first part's data window; none: its header is cut off or has none.
    std::optional<std::array<int64_t, 2>> window;
    int64_t longest_side = 0;  ///< of all parts' data windows and tiles
};

/// Reads the headers without OpenEXR, which allocates tables in proportion to the sizes as it opens
/// a file. Its own limits are process-wide, which a library must not change.
ExrSizes read_exr_sizes(std::span<const std::byte> bytes);

}  // namespace obscura
