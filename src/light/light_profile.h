// light/light_profile.h - photometric profiles: a lamp's luminous intensity by direction.
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "light/record_words.h"
#include "math/vec.h"
#include "math/warp.h"

#include <cstdint>
#include <span>
#include <vector>

namespace obscura {

/// A table of luminous intensity by two angles, in degrees. The polar angle is measured from the
/// polar axis; the azimuth around it, from the zero axis towards cross(zero axis, polar axis).
/// Outside the table the lamp is dark.
struct LightProfile {
    std::vector<float> polar_deg;    ///< rising, in [0, 180], two or more
    std::vector<float> azimuth_deg;  ///< rising, over 360 at most; one: the same all around
    std::vector<float> candela;      ///< [azimuth][polar], finite, 0 or more
    /// The polar axis is the lamp's direction; if false, the zero axis is, and the polar axis is
    /// perpendicular to it.
    bool polar_is_aim = true;
};

/// Light that a profile sends out, lumens: its integral over all directions, interpolated as
/// profile_candela does.
double profile_lumens(const LightProfile& profile);

/// One profile in a LightProfileTable, 32-bit words only.
struct LightProfileRecord {
    int32_t polar = 0;  ///< first word of the polar angles in LightProfileView::words
    int32_t polar_count = 0;
    int32_t azimuth = 0;
    int32_t azimuth_count = 0;
    int32_t candela = 0;
};

static_assert(sizeof(LightProfileRecord) == 5 * 4, "read as 32-bit words: no padding");

/// A view of a LightProfileTable.
struct LightProfileView {
    const LightProfileRecord* records = nullptr;  ///< null: no light has a profile
    const float* words = nullptr;
};

/// Owns the arrays of LightProfileView.
struct LightProfileTable {
    std::vector<LightProfileRecord> records;
    std::vector<float> words;

    LightProfileView view() const;
};

LightProfileTable pack_light_profiles(std::span<const LightProfile> profiles);

inline namespace OBSCURA_ISA {

/// Tolerance for rounding at the table's first and last angle.
inline constexpr float profile_slack_deg = 1e-3f;

/// Two neighbours in a rising list, and the interpolation weight of a value between them.
template <typename F>
struct ProfileStep {
    IntOf<F> low, high;
    F fraction;        ///< weight of `high`
    MaskOf<F> inside;  ///< the value lies in the list's range
};

/// Finds `value` among `count` words from words[first] on; count in [1, 2^24].
template <typename F>
OBSCURA_INLINE ProfileStep<F> find_profile_step(const float* words,
                                                const IntOf<F>& first,
                                                const IntOf<F>& count,
                                                const F& value) {
    using I = IntOf<F>;
    const I last = count - I(1);
    I low(0);
    I high = last;
    while (any(I(low + I(1)) < high)) {
        const I middle = as_int(as_uint(I(low + high)) >> 1);
        const auto before = value < gather<F>(words, I(first + middle));
        high = select(before, middle, high);
        low = select(before, low, middle);
    }
    const F begin = gather<F>(words, I(first + low));
    const F end = gather<F>(words, I(first + high));
    const F fraction = clamp((value - begin) / max(end - begin, F(1e-6f)), F(0.0f), F(1.0f));
    const F slack(profile_slack_deg);
    const MaskOf<F> inside = (value >= begin - slack) & (value <= end + slack);
    return {low, high, fraction, inside};
}

/// The lamp's axes in the world, unit and at right angles.
template <typename F>
struct ProfileAxes {
    Vec3<F> polar, zero;
};

/// Luminous intensity into a direction (unit, away from the lamp), candela: bilinear between the
/// table's angles.
///
/// In      profile: index in the view, in range for idle lanes too
/// Source  ANSI/IESNA LM-63-02, section 3 and annex B: the angles of types A, B and C
template <typename F>
OBSCURA_INLINE F profile_candela(const LightProfileView& view,
                                 const IntOf<F>& profile,
                                 const ProfileAxes<F>& axes,
                                 const Vec3<F>& direction) {
    using I = IntOf<F>;
    const I word = profile * I(words_per_record<LightProfileRecord>);
    const auto read = [&](size_t offset) {
        return gather<F>(member_words<int32_t>(view.records, offset), word);
    };
    const F x = dot(direction, axes.zero);
    const F y = dot(direction, cross(axes.zero, axes.polar));
    const F across = sqrt(x * x + y * y);
    const F along = dot(direction, axes.polar);
    const auto placed = across > F(0.0f);  // else along the axis: any azimuth will do
    const F degrees = exact_constant<F>(180.0 / pi_d);
    const F polar = atan2(across, select(placed | (along < F(0.0f)), along, F(1.0f))) * degrees;
    F azimuth = atan2(y, select(placed, x, F(1.0f))) * degrees;

    const I azimuth_first = read(offsetof(LightProfileRecord, azimuth));
    const I azimuth_count = read(offsetof(LightProfileRecord, azimuth_count));
    const I polar_count = read(offsetof(LightProfileRecord, polar_count));
    const F begin_azimuth = gather<F>(view.words, azimuth_first) - F(profile_slack_deg);
    azimuth = select(azimuth < begin_azimuth, azimuth + F(360.0f), azimuth);
    const ProfileStep<F> p = find_profile_step<F>(
        view.words, read(offsetof(LightProfileRecord, polar)), polar_count, polar);
    const ProfileStep<F> a =
        find_profile_step<F>(view.words, azimuth_first, azimuth_count, azimuth);

    const I first = read(offsetof(LightProfileRecord, candela));
    const auto candela = [&](const I& plane, const I& step) {
        return gather<F>(view.words, I(first + plane * polar_count + step));
    };
    const auto in_plane = [&](const I& plane) {
        const F begin = candela(plane, p.low);
        return begin + (candela(plane, p.high) - begin) * p.fraction;
    };
    const F begin = in_plane(a.low);
    const F value = begin + (in_plane(a.high) - begin) * a.fraction;
    const MaskOf<F> round = azimuth_count == I(1);
    return select(p.inside & (a.inside | round), value, F(0.0f));
}

}  // namespace OBSCURA_ISA
}  // namespace obscura
