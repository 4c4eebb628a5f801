// camera/matrices.cpp - the camera as an image's header describes it: matrices and screen window.
// SPDX-License-Identifier: Apache-2.0
#include "camera/matrices.h"

namespace obscura {

namespace {

/// Column-vector convention while computing; transposed when stored.
struct Matrix4 {
    double m[4][4] = {};
};

/// OpenEXR's camera space from the world: ours, which looks down -Z, with the third axis reversed.
Matrix4 camera_from_world(const Camera& camera) {
    const Affined ours = inverse(affine_cast<double>(camera.world_from_camera));
    Matrix4 out;
    for (int c = 0; c < 4; ++c) {
        out.m[0][c] = ours.m[0][c];
        out.m[1][c] = ours.m[1][c];
        out.m[2][c] = -ours.m[2][c];
    }
    out.m[3][3] = 1;
    return out;
}

Matrix4 multiply(const Matrix4& a, const Matrix4& b) {
    Matrix4 out;
    for (int r = 0; r < 4; ++r) {
        for (int c = 0; c < 4; ++c) {
            for (int k = 0; k < 4; ++k)
                out.m[r][c] += a.m[r][k] * b.m[k][c];
        }
    }
    return out;
}

/// A size does not depend on the distance: w stays 1.
Matrix4 parallel_ndc(const OrthographicCamera& camera, double znear_m, double zfar_m) {
    Matrix4 out;
    out.m[0][0] = 0.5 / static_cast<double>(camera.half_width_m);
    out.m[0][3] = 0.5;
    out.m[1][1] = -0.5 / static_cast<double>(camera.half_height_m);
    out.m[1][3] = 0.5;
    out.m[2][2] = 1 / (zfar_m - znear_m);
    out.m[2][3] = -znear_m / (zfar_m - znear_m);
    out.m[3][3] = 1;
    return out;
}

/// w is the depth z, by which all else is divided.
Matrix4 perspective_ndc(const PinholeCamera& camera, double znear_m, double zfar_m) {
    const double half_height = static_cast<double>(camera.tan_half_yfov);
    const double half_width = half_height * static_cast<double>(camera.aspect);
    Matrix4 out;
    out.m[0][0] = 0.5 / half_width;
    out.m[0][2] = 0.5 - 0.5 * static_cast<double>(camera.shift_x) / half_width;
    out.m[1][1] = -0.5 / half_height;
    out.m[1][2] = 0.5 + 0.5 * static_cast<double>(camera.shift_y) / half_height;
    out.m[2][2] = zfar_m / (zfar_m - znear_m);
    out.m[2][3] = -zfar_m * znear_m / (zfar_m - znear_m);
    out.m[3][2] = 1;
    return out;
}

RowMatrix4 for_row_vectors(const Matrix4& matrix) {
    RowMatrix4 out = {};
    for (size_t r = 0; r < 4; ++r) {
        for (size_t c = 0; c < 4; ++c)
            out[4 * r + c] = static_cast<float>(matrix.m[c][r]);
    }
    return out;
}

ScreenWindow window_of(const PinholeCamera& camera) {
    return {2 * camera.tan_half_yfov * camera.aspect, -camera.shift_x, camera.shift_y};
}

}  // namespace

CameraMatrices camera_matrices(const Camera& camera, double znear_m, double zfar_m) {
    const Matrix4 view = camera_from_world(camera);
    CameraMatrices out = {for_row_vectors(view), {}, {}};
    if (is_distorted(camera)) return out;
    switch (camera.model) {
        case CameraModel::pinhole:
        case CameraModel::thin_lens:
            out.world_to_ndc =
                for_row_vectors(multiply(perspective_ndc(camera.pinhole, znear_m, zfar_m), view));
            out.screen_window = window_of(camera.pinhole);
            break;
        case CameraModel::orthographic:
            out.world_to_ndc =
                for_row_vectors(multiply(parallel_ndc(camera.orthographic, znear_m, zfar_m), view));
            break;
        case CameraModel::fisheye:
        case CameraModel::environment:
            break;
    }
    return out;
}

}  // namespace obscura
