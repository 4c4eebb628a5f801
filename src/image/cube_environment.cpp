// image/cube_environment.cpp - converts a cube map to a latitude-longitude environment.
// SPDX-License-Identifier: Apache-2.0
#include "image/cube_environment.h"

#include "base/parallel.h"
#include "math/warp.h"
#include "surface/srgb.h"

#include <algorithm>
#include <cmath>
#include <vector>

namespace obscura {

namespace {

constexpr int largest_side = 4096;
constexpr int min_width = 256;
constexpr int columns_per_texel = 4;  // a texel at a face's centre is then as wide as a pixel
constexpr int samples_per_side = 4;   // of a pixel

/// A direction's position on the cube.
struct CubePoint {
    size_t face;
    double s, t;  ///< in [-1, 1], as in CubeFaceFrame
};

CubePoint cube_point(const Vec3d& d) {
    const double x = std::abs(d.x);
    const double y = std::abs(d.y);
    const double z = std::abs(d.z);
    size_t face = d.z > 0 ? 4 : 5;
    double size = z;
    if (x >= y && x >= z) {
        face = d.x > 0 ? 0 : 1;
        size = x;
    } else if (y >= z) {
        face = d.y > 0 ? 2 : 3;
        size = y;
    }
    const CubeFaceFrame frame = cube_face_frame(face);
    return {face, dot(d, frame.right) / size, dot(d, frame.down) / size};
}

/// A face with a border of one texel from its neighbours.
struct PaddedFace {
    size_t stride = 0;  ///< texels
    std::vector<float> pixels;
};

const float* nearest_texel(const CubeFaces& faces, const Vec3d& direction) {
    const CubePoint point = cube_point(direction);
    const ImageRgb32f& face = faces[point.face];
    const auto index = [&](double at) {
        const double texel = std::floor(0.5 * (at + 1.0) * face.width);
        return static_cast<size_t>(std::clamp(texel, 0.0, face.width - 1.0));
    };
    return &face.pixels[3 * (index(point.t) * static_cast<size_t>(face.width) + index(point.s))];
}

PaddedFace pad_face(const CubeFaces& faces, size_t number) {
    const auto side = static_cast<size_t>(faces[number].width);
    const CubeFaceFrame frame = cube_face_frame(number);
    PaddedFace out;
    out.stride = side + 2;
    out.pixels.resize(3 * out.stride * out.stride);
    const auto place = [&](size_t i) {  // of a texel's centre
        return (2.0 * static_cast<double>(i) - 1.0) / static_cast<double>(side) - 1.0;
    };
    for (size_t y = 0; y < out.stride; ++y) {
        for (size_t x = 0; x < out.stride; ++x) {
            const Vec3d d = frame.middle + frame.right * place(x) + frame.down * place(y);
            std::copy_n(nearest_texel(faces, d), 3, &out.pixels[3 * (y * out.stride + x)]);
        }
    }
    return out;
}

using PaddedCube = std::array<PaddedFace, 6>;

Vec3d radiance(const PaddedCube& cube, const Vec3d& direction) {
    const CubePoint point = cube_point(direction);
    const PaddedFace& face = cube[point.face];
    const double texels = static_cast<double>(face.stride - 2);
    const double x = 0.5 * (point.s + 1.0) * texels + 0.5;
    const double y = 0.5 * (point.t + 1.0) * texels + 0.5;
    const double last = texels;
    const double column = std::clamp(std::floor(x), 0.0, last);
    const double row = std::clamp(std::floor(y), 0.0, last);
    const auto first = 3 * (static_cast<size_t>(row) * face.stride + static_cast<size_t>(column));
    const auto texel = [&](size_t offset) {
        const float* at = &face.pixels[first + offset];
        return Vec3d{at[0], at[1], at[2]};
    };
    const double right = x - column;
    const double down = y - row;
    const size_t below = 3 * face.stride;
    return (texel(0) * (1.0 - right) + texel(3) * right) * (1.0 - down) +
           (texel(below) * (1.0 - right) + texel(below + 3) * right) * down;
}

/// Cosines and sines of the azimuths of all samples in a row.
std::vector<Vec2<double>> azimuths(int width) {
    const int count = width * samples_per_side;
    std::vector<Vec2<double>> out;
    out.reserve(static_cast<size_t>(count));
    for (int i = 0; i < count; ++i) {
        const double angle = 2.0 * pi_d * ((i + 0.5) / count - 0.5);  // the middle column is +X
        out.push_back({std::cos(angle), std::sin(angle)});
    }
    return out;
}

Result<void> check_faces(const CubeFaces& faces, const std::string& where) {
    const int side = faces[0].width;
    for (const ImageRgb32f& face : faces) {
        if (face.width == side && face.height == side && side > 0) continue;
        return fail(ExitCode::bad_data,
                    "E-ENV-FACES",
                    where,
                    "a face is " + std::to_string(face.width) + " x " +
                        std::to_string(face.height) + ", the first one is " + std::to_string(side) +
                        " wide; accepted are six squares of one size");
    }
    if (side <= largest_side) return {};
    return fail(ExitCode::refused,
                "E-ENV-LIMIT",
                where,
                "the faces have a side of " + std::to_string(side) + "; accepted are up to " +
                    std::to_string(largest_side));
}

}  // namespace

ImageRgb32f light_from_image(const ImageRgba8& image) {
    const bool packed = image.format == "png";
    ImageRgb32f out{image.width, image.height, {}};
    out.pixels.reserve(3 * image.texels.size());
    for (const uint32_t texel : image.texels) {
        // Avoids division by zero: an alpha of 0 counts as 1/255.
        const uint32_t alpha = std::max(texel >> 24, 1U);
        const float divisor = packed ? static_cast<float>(alpha) / 255.0f : 1.0f;
        for (const uint32_t shift : {0U, 8U, 16U})
            out.pixels.push_back(srgb_to_linear_table[texel >> shift & 0xFFU] / divisor);
    }
    return out;
}

CubeFaceFrame cube_face_frame(size_t face) {
    static constexpr std::array<CubeFaceFrame, 6> frames = {
        CubeFaceFrame{{1, 0, 0}, {0, 0, 1}, {0, -1, 0}},
        CubeFaceFrame{{-1, 0, 0}, {0, 0, -1}, {0, -1, 0}},
        CubeFaceFrame{{0, 1, 0}, {-1, 0, 0}, {0, 0, 1}},
        CubeFaceFrame{{0, -1, 0}, {-1, 0, 0}, {0, 0, -1}},
        CubeFaceFrame{{0, 0, 1}, {-1, 0, 0}, {0, -1, 0}},
        CubeFaceFrame{{0, 0, -1}, {1, 0, 0}, {0, -1, 0}}};
    return frames[face];
}

Result<ImageRgb32f> environment_from_cube(const CubeFaces& faces,
                                          const Affined& cube_from_world,
                                          const std::string& where) {
    const Result<void> alike = check_faces(faces, where);
    if (!alike) return fail(alike.error());
    PaddedCube cube;
    parallel_for(cube.size(), [&](size_t i) { cube[i] = pad_face(faces, i); });

    const int width = std::max(columns_per_texel * faces[0].width, min_width);
    const int height = width / 2;
    ImageRgb32f out{width, height, {}};
    out.pixels.resize(3 * static_cast<size_t>(width) * static_cast<size_t>(height));
    const std::vector<Vec2<double>> turns = azimuths(width);
    constexpr double share = 1.0 / (samples_per_side * samples_per_side);
    parallel_for(static_cast<size_t>(height), [&](size_t row) {
        const double top = std::cos(pi_d * static_cast<double>(row) / height);
        const double bottom = std::cos(pi_d * static_cast<double>(row + 1) / height);
        std::vector<Vec3d> sums(static_cast<size_t>(width), splat3(0.0));
        for (int k = 0; k < samples_per_side; ++k) {
            // Equal steps of the cosine are equal steps of solid angle.
            const double y = top + (bottom - top) * (k + 0.5) / samples_per_side;
            const double sine = std::sqrt(std::max(1.0 - y * y, 0.0));
            for (size_t i = 0; i < turns.size(); ++i) {
                const Vec3d world{sine * turns[i].x, y, sine * turns[i].y};
                Vec3d& sum = sums[i / samples_per_side];
                sum = sum + radiance(cube, transform_vector(cube_from_world, world)) * share;
            }
        }
        float* to = &out.pixels[3 * row * static_cast<size_t>(width)];
        for (const Vec3d& sum : sums) {
            for (const double value : {sum.x, sum.y, sum.z})
                *to++ = static_cast<float>(value);
        }
    });
    return out;
}

}  // namespace obscura
