// session/tev_packets.h - the bytes of packets that make the viewer tev show an image.
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "base/file_bytes.h"
#include "render/render.h"

#include <cstdint>
#include <span>
#include <string>
#include <vector>

namespace obscura {

/// Where tev listens unless it is told otherwise.
inline constexpr uint16_t tev_port = 14158;

/// An image in the viewer: by its name, packets tell one from another.
struct TevImage {
    std::string name;  ///< without NUL
    int width = 0;
    int height = 0;
    std::vector<std::string> channels;  ///< "R", "G", "B", "A"; a dot ends the name of a layer
};

/// Opens a black image and shows it; one of the same name goes.
///
/// Source  Müller, tev, https://github.com/Tom94/tev, class IpcPacket, so all: little-endian; a
///         length that counts itself, a byte for the kind, the fields; texts end with a NUL
Bytes tev_create_image(const TevImage& image);

/// Replaces a rectangle of an image that is open, all channels at once.
///
/// In      area: within the image; pixels: of the area, rows from the top, channels interleaved
Bytes tev_update_image(const TevImage& image, const PixelRect& area, std::span<const float> pixels);

}  // namespace obscura
