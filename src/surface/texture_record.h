// surface/texture_record.h - the record of a texture: its texels in the arena and its sampler.
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>

namespace obscura {

enum class Wrap : uint32_t { repeat = 0, clamp = 1, mirror = 2 };
enum class MipMode : uint32_t { none = 0, nearest = 1, linear = 2 };

inline constexpr int max_mip_levels = 17;  ///< a side of 65536 has 17 levels

/// One texture = one image in one colour interpretation + one sampler. Read word by word by lanes.
///
/// Texels are 4 bytes, R in the lowest byte, alpha not premultiplied; rows from the top (v = 0);
/// level l has max(1, width >> l) * max(1, height >> l) texels, starting at level_offset[l]. In
/// 16-bit textures these are the high bytes; a second mip chain of the same form, the low plane,
/// holds the low bytes. So texel indices do not depend on the bit depth.
struct TextureRecord {
    int32_t width = 1;
    int32_t height = 1;
    int32_t levels = 1;
    uint32_t sampler = 0;                       ///< see pack_sampler
    int32_t low_plane = 0;                      ///< offset from a texel to its low bytes; 0: 8 bits
    int32_t level_offset[max_mip_levels] = {};  ///< in texels from the start of the arena
};

/// All textures of a scene, as raw pointers for gathers.
struct TextureView {
    const uint32_t* texels = nullptr;
    const TextureRecord* records = nullptr;
    bool wide = false;  ///< some have a low plane
};

inline constexpr uint32_t sampler_mag_nearest = 1U << 4;
inline constexpr uint32_t sampler_min_nearest = 1U << 5;
inline constexpr uint32_t sampler_mip_bits = 3U << 6;
inline constexpr uint32_t sampler_srgb = 1U << 8;

/// Bits 0-1 wrap of u, 2-3 wrap of v, 4 magnification nearest, 5 minification nearest within a
/// level, 6-7 MipMode, 8 texels are sRGB-encoded (alpha never is).
constexpr uint32_t pack_sampler(
    Wrap wrap_u, Wrap wrap_v, bool mag_nearest, bool min_nearest, MipMode mip, bool srgb) {
    return static_cast<uint32_t>(wrap_u) | static_cast<uint32_t>(wrap_v) << 2 |
           (mag_nearest ? sampler_mag_nearest : 0U) | (min_nearest ? sampler_min_nearest : 0U) |
           static_cast<uint32_t>(mip) << 6 | (srgb ? sampler_srgb : 0U);
}

}  // namespace obscura
