// image/icc_profile.cpp - the ICC profile of the sRGB colour space, made from its formulas.
// SPDX-License-Identifier: Apache-2.0
#include "image/icc_profile.h"

#include "image/rgb_primaries.h"

#include <array>
#include <cmath>
#include <cstdint>
#include <string_view>
#include <utility>

namespace obscura {

namespace {

using Bytes = std::vector<std::byte>;

/// The white of the profile connection space, as the format spells it.
constexpr Xyz d50 = {0.9642, 1.0, 0.8249};

void append(Bytes& out, uint32_t value) {
    for (int shift = 24; shift >= 0; shift -= 8)
        out.push_back(static_cast<std::byte>(value >> shift & 0xFF));
}

void append(Bytes& out, std::string_view text) {
    for (const char c : text)
        out.push_back(static_cast<std::byte>(c));
}

/// s15Fixed16Number, section 4.6.
void append_fixed(Bytes& out, double value) {
    append(out, static_cast<uint32_t>(static_cast<int32_t>(std::lround(value * 65536))));
}

/// XYZType, section 10.31.
Bytes xyz_element(const Xyz& color) {
    Bytes out;
    append(out, "XYZ ");
    append(out, 0U);
    for (const double value : color)
        append_fixed(out, value);
    return out;
}

/// parametricCurveType, section 10.18, function type 3: y = (a x + b)^g from d on, c x below.
Bytes srgb_curve_element() {
    Bytes out;
    append(out, "para");
    append(out, 0U);
    append(out, 3U << 16);
    for (const double parameter : {2.4, 1 / 1.055, 0.055 / 1.055, 1 / 12.92, 0.04045})
        append_fixed(out, parameter);
    return out;
}

/// multiLocalizedUnicodeType, section 10.15, with one text in English.
Bytes text_element(std::string_view text) {
    constexpr uint32_t header = 28;
    Bytes out;
    append(out, "mluc");
    append(out, 0U);
    append(out, 1U);   // texts
    append(out, 12U);  // bytes of each of their records
    append(out, "enUS");
    append(out, static_cast<uint32_t>(2 * text.size()));
    append(out, header);
    for (const char c : text) {  // UTF-16, high byte first
        out.push_back(std::byte{0});
        out.push_back(static_cast<std::byte>(c));
    }
    return out;
}

/// s15Fixed16ArrayType, section 10.22.
Bytes matrix_element(const Matrix3& matrix) {
    Bytes out;
    append(out, "sf32");
    append(out, 0U);
    for (const Xyz& row : matrix) {
        for (const double value : row)
            append_fixed(out, value);
    }
    return out;
}

/// The header, section 7.2. Its date is that of the format's edition: the same image must give the
/// same bytes at any time.
Bytes profile_header(uint32_t size) {
    Bytes out;
    append(out, size);
    append(out, 0U);           // no preferred engine
    append(out, 0x04200000U);  // version 4.2
    append(out, "mntrRGB XYZ ");
    append(out, 2010U << 16 | 12);  // year and month
    append(out, 1U << 16);          // day and hour
    append(out, 0U);
    append(out, "acsp");
    for (int i = 0; i < 7; ++i)  // platform, flags, maker, model, attributes, perceptual intent
        append(out, 0U);
    for (const double value : d50)
        append_fixed(out, value);
    out.resize(128);  // no creator, no profile ID
    return out;
}

}  // namespace

std::vector<std::byte> srgb_icc_profile() {
    const Matrix3 adaptation = bradford_adaptation(white_xyz(d65), d50);
    const Matrix3 d50_from_rgb = product(adaptation, xyz_from_rgb(rec709_primaries));
    const auto column = [&](size_t c) {
        return xyz_element({d50_from_rgb[0][c], d50_from_rgb[1][c], d50_from_rgb[2][c]});
    };
    const Bytes curve = srgb_curve_element();
    // Tags of equal elements share one.
    const std::array<std::pair<std::string_view, Bytes>, 8> elements = {
        {{"desc", text_element("sRGB")},
         {"cprt", text_element("No copyright, use freely")},
         {"wtpt", xyz_element(d50)},
         {"chad", matrix_element(adaptation)},
         {"rXYZ", column(0)},
         {"gXYZ", column(1)},
         {"bXYZ", column(2)},
         {"rTRC", curve}}};
    constexpr uint32_t tags = 10;
    uint32_t at = 128 + 4 + 12 * tags;
    Bytes table;
    Bytes data;
    append(table, tags);
    for (const auto& [tag, element] : elements) {
        const auto size = static_cast<uint32_t>(element.size());
        const bool is_curve = tag == "rTRC";
        for (const std::string_view name :
             {tag, std::string_view("gTRC"), std::string_view("bTRC")}) {
            if (name != tag && !is_curve) continue;
            append(table, name);
            append(table, at);
            append(table, size);
        }
        data.insert(data.end(), element.begin(), element.end());
        while (data.size() % 4 != 0)
            data.push_back(std::byte{0});
        at = static_cast<uint32_t>(128 + 4 + 12 * tags + data.size());
    }
    Bytes out = profile_header(at);
    out.insert(out.end(), table.begin(), table.end());
    out.insert(out.end(), data.begin(), data.end());
    return out;
}

}  // namespace obscura
