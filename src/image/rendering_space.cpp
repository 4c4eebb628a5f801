// image/rendering_space.cpp - the linear RGB space in which light is computed.
// SPDX-License-Identifier: Apache-2.0
#include "image/rendering_space.h"

#include "base/setting_names.h"
#include "image/ocio_load.h"

#include <algorithm>
#include <array>
#include <cmath>

namespace obscura {

namespace ocio = OCIO_NAMESPACE;

namespace {

struct KnownSpace {
    const char* name;
    const char* interop_id;
    const RgbPrimaries& primaries;
    const Chromaticity& white;
};

/// Source of the ids  Color Interop Forum, "Color Space Encodings for Texture Assets and CG
///                    Rendering", 2024
constexpr std::array known_spaces = {
    KnownSpace{"lin_rec709", "lin_rec709_scene", rec709_primaries, d65},
    KnownSpace{"acescg", "lin_ap1_scene", ap1_primaries, aces_white},
    KnownSpace{"aces2065-1", "lin_ap0_scene", ap0_primaries, aces_white},
    KnownSpace{"lin_rec2020", "lin_rec2020_scene", rec2020_primaries, d65}};

Matrix3 from_rec709(const KnownSpace& space) {
    const Matrix3 adaptation = bradford_adaptation(white_xyz(d65), white_xyz(space.white));
    const Matrix3 xyz_from_rec709 = product(adaptation, xyz_from_rgb(rec709_primaries));
    return product(inverse(xyz_from_rgb(space.primaries, space.white)), xyz_from_rec709);
}

RenderingSpace space_of(const KnownSpace& known) {
    RenderingSpace out{known.name, known.interop_id, known.primaries, known.white};
    if (&known != known_spaces.data()) out.from_rec709 = from_rec709(known);
    return out;
}

double largest_difference(const Matrix3& a, const Matrix3& b) {
    double out = 0;
    for (size_t row = 0; row < 3; ++row) {
        for (size_t column = 0; column < 3; ++column)
            out = std::max(out, std::abs(a[row][column] - b[row][column]));
    }
    return out;
}

/// The chromaticities that make Rec.709 of the space's primaries, under D65.
RgbPrimaries primaries_of(const Matrix3& from_rec709) {
    const Matrix3 xyz = product(xyz_from_rgb(rec709_primaries), inverse(from_rec709));
    RgbPrimaries out = {};
    for (size_t c = 0; c < 3; ++c) {
        const double sum = xyz[0][c] + xyz[1][c] + xyz[2][c];
        out[c] = {xyz[0][c] / sum, xyz[1][c] / sum};
    }
    return out;
}

Xyz applied(const ocio::ConstCPUProcessorRcPtr& processor, const Xyz& color) {
    float rgb[3] = {
        static_cast<float>(color[0]), static_cast<float>(color[1]), static_cast<float>(color[2])};
    processor->applyRGB(rgb);
    return {static_cast<double>(rgb[0]), static_cast<double>(rgb[1]), static_cast<double>(rgb[2])};
}

Matrix3 columns_of(const ocio::ConstCPUProcessorRcPtr& processor) {
    Matrix3 out = {};
    for (size_t c = 0; c < 3; ++c) {
        Xyz primary = {};
        primary[c] = 1;
        const Xyz column = applied(processor, primary);
        for (size_t row = 0; row < 3; ++row)
            out[row][c] = column[row];
    }
    return out;
}

bool is_linear(const ocio::ConstCPUProcessorRcPtr& processor, const Matrix3& matrix) {
    for (const Xyz& probe : {Xyz{0, 0, 0}, Xyz{0.02, 0.3, 0.1}, Xyz{4, 0.5, 30}}) {
        const Xyz expected = product(matrix, probe);
        const Xyz found = applied(processor, probe);
        for (size_t c = 0; c < 3; ++c) {
            const double allowed = 1e-4 * std::max(std::abs(expected[c]), 0.01);
            if (!(std::abs(found[c] - expected[c]) <= allowed)) return false;
        }
    }
    return true;
}

/// True when white stays white and no colour of Rec.709 gets a negative coordinate.
bool holds_rec709(const Matrix3& matrix) {
    constexpr double slack = 1e-3;
    return std::all_of(matrix.begin(), matrix.end(), [&](const Xyz& row) {
        return std::abs(row[0] + row[1] + row[2] -
                        1)<slack&& * std::min_element(row.begin(), row.end())> -
               slack;
    });
}

/// Rounding of single precision is taken out: white is exactly white, black stays black.
Matrix3 cleaned(Matrix3 matrix) {
    for (Xyz& row : matrix) {
        for (double& value : row)
            value = std::max(value, 0.0);
        const double sum = row[0] + row[1] + row[2];
        for (double& value : row)
            value /= sum;
    }
    return matrix;
}

std::vector<std::string> space_names(const ocio::ConstConfigRcPtr& config) {
    std::vector<std::string> names;
    for (int i = 0; i < config->getNumColorSpaces(); ++i)
        names.emplace_back(config->getColorSpaceNameByIndex(i));
    return names;
}

Result<RenderingSpace> space_of_config(const NamedConfig& from, const std::string& name, Log& log) {
    const auto refuse = [&](const std::string& why) {
        return bad_configuration("E-OCIO-SPACE", setting("color-space") + " " + name, why);
    };
    std::string known;
    for (const std::string& one : rendering_space_names())
        known += (known.empty() ? "" : ", ") + one;
    const ocio::ConstColorSpaceRcPtr space = from.config->getColorSpace(name.c_str());
    if (!space) {
        return refuse("there is none of this name; known are " + known + ", and " + from.name +
                      " has " + quoted_list(space_names(from.config)));
    }
    const std::string rec709 = input_space(from, log);
    const bool is_color = !space->isData() && !rec709.empty();
    if (!is_color) return refuse("it is no colour space; expected a scene-linear one");
    const auto processor =
        from.config->getProcessor(rec709.c_str(), name.c_str())->getDefaultCPUProcessor();
    const Matrix3 matrix = columns_of(processor);
    if (!is_linear(processor, matrix)) {
        return refuse("it is not linear; light is computed in a scene-linear space such as " +
                      known);
    }
    if (!holds_rec709(matrix)) {
        return refuse(
            "it has another white, or does not hold all colours of Rec.709, which glTF "
            "has; choose a wider one such as " +
            known);
    }
    for (const KnownSpace& one : known_spaces) {
        if (largest_difference(matrix, from_rec709(one)) < 1e-4) return space_of(one);
    }
    const Matrix3 clean = cleaned(matrix);
    return RenderingSpace{name, "", primaries_of(clean), d65, clean};
}

}  // namespace

std::vector<std::string> rendering_space_names() {
    std::vector<std::string> names;
    for (const KnownSpace& known : known_spaces)
        names.emplace_back(known.name);
    return names;
}

Result<RenderingSpace> find_rendering_space(const std::string& name,
                                            const std::string& ocio_file,
                                            Log& log) {
    for (const KnownSpace& known : known_spaces) {
        if (name == known.name) return space_of(known);
    }
    const Result<NamedConfig> config = load_config(ocio_file, log);
    if (!config) return fail(config.error());
    try {
        const OcioNotesToLog notes(log, config->name);
        return space_of_config(*config, name, log);
    } catch (const std::exception& error) {
        return bad_configuration("E-OCIO-FILE", config->name, error.what());
    }
}

void convert_colors(const Matrix3& matrix, std::span<float> rgb, size_t stride) {
    float m[3][3];
    for (size_t row = 0; row < 3; ++row) {
        for (size_t column = 0; column < 3; ++column)
            m[row][column] = static_cast<float>(matrix[row][column]);
    }
    for (size_t i = 0; i + 2 < rgb.size(); i += stride) {
        const float r = rgb[i], g = rgb[i + 1], b = rgb[i + 2];
        for (size_t c = 0; c < 3; ++c)
            rgb[i + c] = m[c][0] * r + m[c][1] * g + m[c][2] * b;
    }
}

}  // namespace obscura
