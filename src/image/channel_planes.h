// image/channel_planes.h - how the channels of a layer lie in memory.
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <algorithm>
#include <cstddef>
#include <span>

namespace obscura {

// The channels of a layer lie in planes of four: those of all pixels side by side, pixel after
// pixel, then the next four. The later ranks of Cryptomatte, which few pixels have, so lie by
// themselves, and memory that nobody writes is never touched. A layer of up to four channels is
// interleaved as usual.

/// Channels that lie side by side.
struct ChannelPlane {
    size_t first_channel, channels;
    size_t first_value;  ///< where they begin in the layer's memory
};

inline constexpr size_t plane_channels = 4;

/// Calls use(plane) for each plane of a layer.
///
/// In      pixels: of the layer
template <typename Use>
void for_planes(size_t channels, size_t pixels, const Use& use) {
    for (size_t first = 0; first < channels; first += plane_channels)
        use(ChannelPlane{first, std::min(plane_channels, channels - first), first * pixels});
}

/// Copies a layer from planes to pixels with all their channels side by side, or back.
///
/// In      from: channels * pixels values
///         to: room for as many
inline void interleave_planes(std::span<const float> from, size_t channels, float* to) {
    const size_t pixels = from.size() / std::max<size_t>(channels, 1);
    for_planes(channels, pixels, [&](const ChannelPlane& plane) {
        const float* value = from.data() + plane.first_value;
        for (size_t i = 0; i < pixels; ++i, value += plane.channels)
            std::copy_n(value, plane.channels, to + i * channels + plane.first_channel);
    });
}

inline void separate_planes(std::span<const float> from, size_t channels, float* to) {
    const size_t pixels = from.size() / std::max<size_t>(channels, 1);
    for_planes(channels, pixels, [&](const ChannelPlane& plane) {
        float* value = to + plane.first_value;
        for (size_t i = 0; i < pixels; ++i, value += plane.channels)
            std::copy_n(from.data() + i * channels + plane.first_channel, plane.channels, value);
    });
}

}  // namespace obscura
