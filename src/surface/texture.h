// surface/texture.h - texture look-ups from the arena: wrap, filter, decode; one path or many.
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "math/gather4.h"
#include "math/table_record.h"
#include "math/vec.h"
#include "surface/srgb.h"
#include "surface/texture_record.h"

namespace obscura {

template <typename F>
struct Rgba {
    Vec3<F> rgb;
    F alpha;
};

inline namespace OBSCURA_ISA {

/// The fields of a texture's record that look-ups need, for every lane.
template <typename F>
struct TextureInfo {
    TableRecord<F, TextureRecord> record;
    IntOf<F> width, height, levels;
    IntOf<F> sampler;
};

template <typename F>
OBSCURA_INLINE TextureInfo<F> texture_info(const TextureView& view, const IntOf<F>& texture) {
    const TableRecord<F, TextureRecord> record(view.records, texture);
    return {.record = record,
            .width = record.template integer<&TextureRecord::width>(),
            .height = record.template integer<&TextureRecord::height>(),
            .levels = record.template integer<&TextureRecord::levels>(),
            .sampler = record.template integer<&TextureRecord::sampler>()};
}

/// log2 of the side, in texels of level 0, of a footprint given as an area in UV space.
template <typename F>
OBSCURA_INLINE F level_of_detail(const TextureInfo<F>& info, const F& footprint) {
    const F texels = footprint * from_int<F>(info.width) * from_int<F>(info.height);
    return F(0.5f) * log2(clamp(texels, F(1e-12f), F(1e12f)));
}

/// True where (bits & flag) is set.
template <typename F>
OBSCURA_INLINE MaskOf<F> has_bits(const IntOf<F>& bits, uint32_t flag) {
    return (bits & IntOf<F>(static_cast<int32_t>(flag))) != IntOf<F>(0);
}

/// Folds a texture coordinate to [0, 1) by the sampler's wrap mode: repeat, clamp or mirror.
template <typename F>
OBSCURA_INLINE F wrap_unit(const F& coordinate, const IntOf<F>& mode) {
    const F repeated = coordinate - floor(coordinate);
    // inf - inf for infinite UV
    const auto finite = [](const F& x) { return select(x == x, x, F(0.0f)); };
    if (all(mode == IntOf<F>(0))) return finite(repeated);
    const F half = coordinate * F(0.5f);
    const F two = (half - floor(half)) * F(2.0f);
    const F mirrored = select(two > F(1.0f), F(2.0f) - two, two);
    const F clamped = clamp(coordinate, F(0.0f), F(1.0f));
    F out = select(mode == IntOf<F>(1), clamped, repeated);
    out = select(mode == IntOf<F>(2), mirrored, out);
    return finite(out);
}

/// Brings a texel index that is at most one period outside back into [0, size).
template <typename F>
OBSCURA_INLINE IntOf<F> wrap_texel(const IntOf<F>& i, const IntOf<F>& size, const IntOf<F>& mode) {
    const IntOf<F> last = size - IntOf<F>(1);
    const MaskOf<F> repeats = mode == IntOf<F>(0);
    const IntOf<F> below = select(repeats & (i < IntOf<F>(0)), IntOf<F>(i + size), i);
    const IntOf<F> inside = select(repeats & (i > last), IntOf<F>(i - size), below);
    return max(min(inside, last), IntOf<F>(0));  // clamp and mirror: the edge texel repeats
}

/// Unpacks one RGBA8 texel; sRGB-encoded where the sampler says so.
template <typename F>
OBSCURA_INLINE Rgba<F> decode_texel(const UintOf<F>& texel, const MaskOf<F>& srgb) {
    using U = UintOf<F>;
    const IntOf<F> r = as_int(texel & U(255U));
    const IntOf<F> g = as_int((texel >> 8) & U(255U));
    const IntOf<F> b = as_int((texel >> 16) & U(255U));
    const F scale = F(1.0f / 255.0f);
    Vec3<F> rgb{from_int<F>(r) * scale, from_int<F>(g) * scale, from_int<F>(b) * scale};
    if (any(srgb)) {
        const Vec3<F> linear{gather<F>(srgb_to_linear_table, r),
                             gather<F>(srgb_to_linear_table, g),
                             gather<F>(srgb_to_linear_table, b)};
        rgb = select(srgb, linear, rgb);
    }
    return {rgb, from_int<F>(as_int(texel >> 24)) * scale};
}

/// Linear light of a 16-bit sRGB code, by a straight line between 8-bit codes: off by 6e-6 at most.
template <typename F>
OBSCURA_INLINE F linear_from_srgb16(const F& code) {
    const F place = code * F(1.0f / 257.0f);
    const IntOf<F> below = min(to_int(place), IntOf<F>(254));
    const F low = gather<F>(srgb_to_linear_table, below);
    const F high = gather<F>(srgb_to_linear_table, IntOf<F>(below + IntOf<F>(1)));
    return lerp(low, high, place - from_int<F>(below));
}

/// Unpacks one RGBA16 texel from its high and its low bytes. With an 8-bit texel in place of both
/// it is decode_texel, to rounding.
template <typename F>
OBSCURA_INLINE Rgba<F> decode_wide_texel(const UintOf<F>& high,
                                         const UintOf<F>& low,
                                         const MaskOf<F>& srgb) {
    using U = UintOf<F>;
    const auto code = [&](int shift) {
        const U bytes = U((high >> shift) & U(255U)) << 8 | U((low >> shift) & U(255U));
        return from_int<F>(as_int(bytes));
    };
    const F scale = F(1.0f / 65535.0f);
    const Vec3<F> codes{code(0), code(8), code(16)};
    Vec3<F> rgb = codes * scale;
    if (any(srgb)) {
        const Vec3<F> linear{
            linear_from_srgb16(codes.x), linear_from_srgb16(codes.y), linear_from_srgb16(codes.z)};
        rgb = select(srgb, linear, rgb);
    }
    return {rgb, code(24) * scale};
}

/// Offset from a texture's texels to their low bytes.
template <typename F>
OBSCURA_INLINE IntOf<F> low_plane_of(const TextureView& view,
                                     const TableRecord<F, TextureRecord>& record) {
    return view.wide ? record.template integer<&TextureRecord::low_plane>() : IntOf<F>(0);
}

/// Reads a texel by its index.
///
/// In      low_plane: of its texture
template <typename F>
OBSCURA_INLINE Rgba<F> read_texel(const TextureView& view,
                                  const IntOf<F>& number,
                                  const IntOf<F>& low_plane,
                                  const MaskOf<F>& srgb) {
    const UintOf<F> texel = gather<F>(view.texels, number);
    if (!view.wide) return decode_texel<F>(texel, srgb);
    return decode_wide_texel<F>(texel, gather<F>(view.texels, IntOf<F>(number + low_plane)), srgb);
}

/// A mip level with its size, chosen for each lane.
template <typename F>
struct MipLevel {
    IntOf<F> offset, width, height;
};

template <typename F>
OBSCURA_INLINE MipLevel<F> mip_level(const TextureInfo<F>& info, const IntOf<F>& level) {
    const IntOf<F> offset =
        info.record.template varying_integer<&TextureRecord::level_offset>(level);
    // Sides halve, rounding down: exact in float for sides up to 65536.
    const F scale = power_of_two<F>(IntOf<F>(IntOf<F>(127) - level));
    return {offset,
            max(to_int(from_int<F>(info.width) * scale), IntOf<F>(1)),
            max(to_int(from_int<F>(info.height) * scale), IntOf<F>(1))};
}

/// The mip level of a look-up, by the sampler's mip mode. `pick` in [0,1) chooses between two
/// levels in proportion; 0.5 takes the nearest.
template <typename F>
OBSCURA_INLINE IntOf<F> choose_level(const TextureInfo<F>& info, const F& lod, const F& pick) {
    const IntOf<F> mode = IntOf<F>(as_int(as_uint(info.sampler) >> 6)) & IntOf<F>(3);
    const F top = from_int<F>(info.levels - IntOf<F>(1));
    const F bounded = clamp(lod, F(0.0f), top);
    const F threshold = select(mode == IntOf<F>(2), pick, F(0.5f));
    const IntOf<F> level = to_int(min(bounded + threshold, top));
    return select(mode == IntOf<F>(0), IntOf<F>(0), level);
}

/// Texel position of a look-up before filtering, and whether this lane takes the nearest texel.
template <typename F>
struct TexelPosition {
    MipLevel<F> level;
    F x, y;  ///< in texels, texel centres at +0.5
    MaskOf<F> nearest;
    IntOf<F> wrap_u, wrap_v;
};

template <typename F>
OBSCURA_INLINE TexelPosition<F> texel_position(const TextureInfo<F>& info,
                                               const Vec2<F>& uv,
                                               const F& lod,
                                               const F& pick) {
    const IntOf<F> wrap_u = info.sampler & IntOf<F>(3);
    const IntOf<F> wrap_v = IntOf<F>(as_int(as_uint(info.sampler) >> 2)) & IntOf<F>(3);
    const MipLevel<F> level = mip_level<F>(info, choose_level<F>(info, lod, pick));
    const MaskOf<F> magnified = lod <= F(0.0f);
    const MaskOf<F> nearest = (magnified & has_bits<F>(info.sampler, sampler_mag_nearest)) |
                              ((!magnified) & has_bits<F>(info.sampler, sampler_min_nearest));
    return {level,
            wrap_unit<F>(uv.x, wrap_u) * from_int<F>(level.width),
            wrap_unit<F>(uv.y, wrap_v) * from_int<F>(level.height),
            nearest,
            wrap_u,
            wrap_v};
}

/// The index of a texel in the arena.
template <typename F>
OBSCURA_INLINE IntOf<F> texel_number(const TexelPosition<F>& at,
                                     const IntOf<F>& x,
                                     const IntOf<F>& y) {
    const IntOf<F> column = wrap_texel<F>(x, at.level.width, at.wrap_u);
    const IntOf<F> row = wrap_texel<F>(y, at.level.height, at.wrap_v);
    return at.level.offset + row * at.level.width + column;
}

/// The index of one texel, chosen at random with the weights of the bilinear (and mip) filter:
/// unbiased, with a quarter or an eighth of the memory traffic.
///
/// In      footprint: area in UV space that the look-up stands for; random: three numbers in [0,1)
/// Source  Pharr et al., "Filtering After Shading With Stochastic Texture Filtering", I3D 2024
template <typename F>
OBSCURA_INLINE IntOf<F> stochastic_texel(const TextureInfo<F>& info,
                                         const Vec2<F>& uv,
                                         const F& footprint,
                                         const Vec3<F>& random) {
    const F lod = level_of_detail<F>(info, footprint);
    const TexelPosition<F> at = texel_position<F>(info, uv, lod, random.z);
    const F jitter_x = select(at.nearest, F(0.0f), random.x - F(0.5f));
    const F jitter_y = select(at.nearest, F(0.0f), random.y - F(0.5f));
    return texel_number<F>(at, to_int(floor(at.x + jitter_x)), to_int(floor(at.y + jitter_y)));
}

/// The index of a texel of level 0, chosen in proportion to its part of the square footprint: for
/// values that must not be averaged before use, such as normals. Under magnification, and
/// without mip levels, the same as stochastic_texel.
///
/// In      as stochastic_texel
template <typename F>
OBSCURA_INLINE IntOf<F> stochastic_single_texel(const TextureInfo<F>& info,
                                                const Vec2<F>& uv,
                                                const F& footprint,
                                                const Vec3<F>& random) {
    const F width = from_int<F>(info.width);
    const F height = from_int<F>(info.height);
    const F texels = footprint * width * height;
    const MaskOf<F> has_levels =
        (info.sampler & IntOf<F>(static_cast<int32_t>(sampler_mip_bits))) != IntOf<F>(0);
    const MaskOf<F> minified = (texels > F(1.0f)) & has_levels;
    const IntOf<F> usual = stochastic_texel<F>(info, uv, footprint, random);
    if (none(minified)) return usual;
    const F side = sqrt(clamp(texels, F(1.0f), F(1e12f)));
    const Vec2<F> at{uv.x + (random.x - F(0.5f)) * side / width,
                     uv.y + (random.y - F(0.5f)) * side / height};
    const TexelPosition<F> finest = texel_position<F>(info, at, F(0.0f), F(0.0f));
    const IntOf<F> found =
        texel_number<F>(finest, to_int(floor(finest.x)), to_int(floor(finest.y)));
    return select(minified, found, usual);
}

/// Reads one random texel.
///
/// In      texture: index of every lane, all valid; the others as stochastic_texel
template <typename F>
OBSCURA_INLINE Rgba<F> sample_texture_stochastic(const TextureView& view,
                                                 const IntOf<F>& texture,
                                                 const Vec2<F>& uv,
                                                 const F& footprint,
                                                 const Vec3<F>& random) {
    const TextureInfo<F> info = texture_info<F>(view, texture);
    return read_texel<F>(view,
                         stochastic_texel<F>(info, uv, footprint, random),
                         low_plane_of<F>(view, info.record),
                         has_bits<F>(info.sampler, sampler_srgb));
}

template <typename F>
OBSCURA_INLINE void add_texel(const Rgba<F>& value, const F& weight, Rgba<F>& sum) {
    sum.rgb = sum.rgb + value.rgb * weight;
    sum.alpha = sum.alpha + value.alpha * weight;
}

/// The words of two texels of a row.
template <typename F>
OBSCURA_INLINE Two<UintOf<F>> gather_texels(const uint32_t* texels,
                                            const IntOf<F>& left,
                                            const IntOf<F>& right,
                                            bool side_by_side) {
    if (side_by_side) return gather2<F>(texels, left);
    return {gather<F>(texels, left), gather<F>(texels, right)};
}

/// The four texels of a bilinear look-up, and their weights.
template <typename F>
struct BilinearTexels {
    IntOf<F> upper, lower;  ///< numbers of the texels at the begin of two rows
    IntOf<F> left, right;   ///< to be added to those
    bool side_by_side;      ///< right is left + 1 in all lanes
    F fx, fy;               ///< how near the right and the lower ones are
};

/// Finds the texels of the nearest mip level: no randomness.
///
/// In      footprint: area in UV space that the look-up stands for
template <typename F>
OBSCURA_INLINE BilinearTexels<F> bilinear_texels(const TextureInfo<F>& info,
                                                 const Vec2<F>& uv,
                                                 const F& footprint) {
    const F lod = level_of_detail<F>(info, footprint);
    const TexelPosition<F> at = texel_position<F>(info, uv, lod, F(0.5f));
    const F x = select(at.nearest, floor(at.x), at.x - F(0.5f));
    const F y = select(at.nearest, floor(at.y), at.y - F(0.5f));
    const IntOf<F> x0 = to_int(floor(x));
    const IntOf<F> y0 = to_int(floor(y));
    const auto row_begin = [&](const IntOf<F>& line) {
        const IntOf<F> row = wrap_texel<F>(line, at.level.height, at.wrap_v);
        return at.level.offset + row * at.level.width;
    };
    BilinearTexels<F> out;
    out.upper = row_begin(y0);
    out.lower = row_begin(y0 + IntOf<F>(1));
    out.left = wrap_texel<F>(x0, at.level.width, at.wrap_u);
    out.right = wrap_texel<F>(x0 + IntOf<F>(1), at.level.width, at.wrap_u);
    out.side_by_side = all(out.right == out.left + IntOf<F>(1));
    out.fx = x - floor(x);
    out.fy = y - floor(y);
    return out;
}

/// Reads four texels and adds them up by their weights.
///
/// In      shift: from the texture for which they were found to the one that is read
///         low_plane: of its texture
template <typename F>
OBSCURA_INLINE Rgba<F> read_bilinear(const TextureView& view,
                                     const BilinearTexels<F>& at,
                                     const IntOf<F>& shift,
                                     const IntOf<F>& low_plane,
                                     const MaskOf<F>& srgb) {
    Rgba<F> sum{splat3(F(0.0f)), F(0.0f)};
    for (int line = 0; line < 2; ++line) {
        const IntOf<F> start = (line == 0 ? at.upper : at.lower) + shift;
        const Two<UintOf<F>> texels =
            gather_texels<F>(view.texels, start + at.left, start + at.right, at.side_by_side);
        const F weight = line == 0 ? F(1.0f) - at.fy : at.fy;
        Two<UintOf<F>> low = texels;
        if (view.wide) {
            const IntOf<F> low_start = start + low_plane;
            low = gather_texels<F>(
                view.texels, low_start + at.left, low_start + at.right, at.side_by_side);
        }
        const auto decode = [&](const UintOf<F>& texel, const UintOf<F>& low_bytes) {
            return view.wide ? decode_wide_texel<F>(texel, low_bytes, srgb)
                             : decode_texel<F>(texel, srgb);
        };
        add_texel<F>(decode(texels.x, low.x), (F(1.0f) - at.fx) * weight, sum);
        add_texel<F>(decode(texels.y, low.y), at.fx * weight, sum);
    }
    return sum;
}

/// Reads the bilinearly filtered value of the nearest mip level.
template <typename F>
OBSCURA_INLINE Rgba<F> sample_texture_bilinear(const TextureView& view,
                                               const IntOf<F>& texture,
                                               const Vec2<F>& uv,
                                               const F& footprint) {
    const TextureInfo<F> info = texture_info<F>(view, texture);
    return read_bilinear<F>(view,
                            bilinear_texels<F>(info, uv, footprint),
                            IntOf<F>(0),
                            low_plane_of<F>(view, info.record),
                            has_bits<F>(info.sampler, sampler_srgb));
}

}  // namespace OBSCURA_ISA
}  // namespace obscura
