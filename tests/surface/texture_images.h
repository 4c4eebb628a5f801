// tests/surface/texture_images.h - small texture arenas made by hand, and look-ups in double.
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "surface/texture.h"

#include "support/lane_arrays.h"
#include "support/random.h"
#include <algorithm>
#include <cmath>
#include <vector>

namespace obscura::test {

struct Rgba8 {
    double channel[4];
};

inline double srgb_to_linear(double encoded) {
    return encoded <= 0.04045 ? encoded / 12.92 : std::pow((encoded + 0.055) / 1.055, 2.4);
}

/// An arena of textures whose every level holds other random texels.
class Images {
public:
    explicit Images(uint64_t seed) : random_(seed) {
        texels_.resize(5);  // nothing starts at offset 0
    }

    /// One with 16 bits a channel.
    int32_t add_wide(int width, int height, uint32_t sampler) {
        const int32_t texture = add(width, height, sampler);
        TextureRecord& record = records_.back();
        const size_t count = texels_.size() - static_cast<size_t>(record.level_offset[0]);
        record.low_plane = static_cast<int32_t>(count);
        for (size_t i = 0; i < count; ++i)
            texels_.push_back(random_.next_uint());
        has_wide_ = true;
        return texture;
    }

    /// Returns the texture's number.
    int32_t add(int width, int height, uint32_t sampler) {
        TextureRecord record;
        record.width = width;
        record.height = height;
        record.levels = 0;
        record.sampler = sampler;
        for (int side = 2 * std::max(width, height); side > 1; side >>= 1) {
            const int level = record.levels++;
            record.level_offset[level] = static_cast<int32_t>(texels_.size());
            const int count = std::max(width >> level, 1) * std::max(height >> level, 1);
            for (int i = 0; i < count; ++i)
                texels_.push_back(random_.next_uint());
        }
        records_.push_back(record);
        return static_cast<int32_t>(records_.size()) - 1;
    }

    TextureView view() const { return {texels_.data(), records_.data(), has_wide_}; }
    const TextureRecord& record(int32_t texture) const {
        return records_[static_cast<size_t>(texture)];
    }

    /// The decoded texel (x, y) of a level, by the wrap modes of OpenGL: any whole numbers.
    Rgba8 texel(int32_t texture, int level, int64_t x, int64_t y) const {
        const TextureRecord& r = record(texture);
        const int64_t width = std::max(r.width >> level, 1);
        const int64_t height = std::max(r.height >> level, 1);
        const int64_t at = r.level_offset[level] + wrapped(y, height, r.sampler >> 2 & 3U) * width +
                           wrapped(x, width, r.sampler & 3U);
        const uint32_t word = texels_[static_cast<size_t>(at)];
        const uint32_t low = texels_[static_cast<size_t>(at + r.low_plane)];
        Rgba8 out{};
        for (int c = 0; c < 4; ++c) {
            const uint32_t high_byte = word >> (8 * c) & 255U;
            const double code = r.low_plane == 0
                                    ? high_byte / 255.0
                                    : (high_byte * 256 + (low >> (8 * c) & 255U)) / 65535.0;
            const bool encoded = c < 3 && (r.sampler & sampler_srgb) != 0;
            out.channel[c] = encoded ? srgb_to_linear(code) : code;
        }
        return out;
    }

    /// The texel that holds a point.
    Rgba8 nearest(int32_t texture, int level, double u, double v) const {
        const TextureRecord& r = record(texture);
        return texel(texture,
                     level,
                     static_cast<int64_t>(std::floor(u * std::max(r.width >> level, 1))),
                     static_cast<int64_t>(std::floor(v * std::max(r.height >> level, 1))));
    }

    /// The closed form of bilinear filtering.
    Rgba8 bilinear(int32_t texture, int level, double u, double v) const {
        const TextureRecord& r = record(texture);
        const double x = u * std::max(r.width >> level, 1) - 0.5;
        const double y = v * std::max(r.height >> level, 1) - 0.5;
        const double fx = x - std::floor(x);
        const double fy = y - std::floor(y);
        Rgba8 out{};
        for (int corner = 0; corner < 4; ++corner) {
            const int dx = corner & 1;
            const int dy = corner >> 1;
            const double weight = (dx != 0 ? fx : 1 - fx) * (dy != 0 ? fy : 1 - fy);
            const Rgba8 t = texel(texture,
                                  level,
                                  static_cast<int64_t>(std::floor(x)) + dx,
                                  static_cast<int64_t>(std::floor(y)) + dy);
            for (int c = 0; c < 4; ++c)
                out.channel[c] += weight * t.channel[c];
        }
        return out;
    }

private:
    static int64_t wrapped(int64_t i, int64_t size, uint32_t mode) {
        if (mode == static_cast<uint32_t>(Wrap::clamp)) {
            return std::clamp<int64_t>(i, 0, size - 1);
        }
        const int64_t period = mode == static_cast<uint32_t>(Wrap::mirror) ? 2 * size : size;
        const int64_t folded = ((i % period) + period) % period;
        return folded < size ? folded : 2 * size - 1 - folded;
    }

    bool has_wide_ = false;
    Pcg32 random_;
    std::vector<uint32_t> texels_;
    std::vector<TextureRecord> records_;
};

template <typename F>
Rgba8 widen(const Rgba<F>& value) {
    return {static_cast<double>(value.rgb.x),
            static_cast<double>(value.rgb.y),
            static_cast<double>(value.rgb.z),
            static_cast<double>(value.alpha)};
}

inline double difference(const Rgba8& a, const Rgba8& b) {
    double worst = 0;
    for (int c = 0; c < 4; ++c) {
        const double d = std::abs(a.channel[c] - b.channel[c]);
        worst = d <= worst ? worst : d;  // NaN counts
    }
    return worst;
}

inline constexpr Wrap all_wraps[] = {Wrap::repeat, Wrap::clamp, Wrap::mirror};
inline constexpr int sizes[][2] = {{8, 8}, {5, 3}, {1, 1}, {1, 7}, {16, 1}, {13, 32}};

constexpr uint32_t linear_sampler(Wrap u, Wrap v, MipMode mip = MipMode::none) {
    return pack_sampler(u, v, false, false, mip, false);
}

inline Rgba8 lanes_bilinear(const Images& images, int32_t texture, Vec2f uv, float footprint) {
    const Rgba<Lanes> many = sample_texture_bilinear<Lanes>(
        images.view(), LanesI(texture), {Lanes(uv.x), Lanes(uv.y)}, Lanes(footprint));
    const int last = lane_count - 1;
    return widen(Rgba<float>{lane(many.rgb, last), lane(many.alpha, last)});
}

/// Calls check(width, height, wrap of u, wrap of v).
template <typename Check>
void for_all_shapes(const Check& check) {
    for (const auto& size : sizes) {
        for (const Wrap u : all_wraps) {
            for (const Wrap v : all_wraps)
                check(size[0], size[1], u, v);
        }
    }
}

/// Footprint whose side is 2^lod texels of level 0.
inline float footprint_of(const TextureRecord& record, double lod) {
    return static_cast<float>(std::exp2(2 * lod) / (record.width * record.height));
}

}  // namespace obscura::test
