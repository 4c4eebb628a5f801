// camera/matrices.cpp - the world-to-camera and world-to-NDC matrices for image metadata.
// SPDX-License-Identifier: Apache-2.0
#include "camera/matrices.h"

namespace obscura {

namespace {

/// Column-vector convention while computing; transposed when stored.
struct Matrix4 {
    double m[4][4] = {};
};

Matrix4 from_affine(const Affined& a) {
    Matrix4 out;
    for (int r = 0; r < 3; ++r) {
        for (int c = 0; c < 4; ++c)
            out.m[r][c] = a.m[r][c];
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

/// The projection of glTF 2.0, section 3.10.3: camera space to clip space, z to [-w, w].
Matrix4 ndc_from_camera(const Camera& camera, double znear_m, double zfar_m) {
    Matrix4 out;
    const double depth = znear_m - zfar_m;
    if (camera.model == CameraModel::orthographic) {
        out.m[0][0] = 1.0 / static_cast<double>(camera.orthographic.half_width_m);
        out.m[1][1] = 1.0 / static_cast<double>(camera.orthographic.half_height_m);
        out.m[2][2] = 2.0 / depth;
        out.m[2][3] = (zfar_m + znear_m) / depth;
        out.m[3][3] = 1;
        return out;
    }
    const double half_height = static_cast<double>(camera.pinhole.tan_half_yfov);
    out.m[0][0] = 1.0 / (half_height * static_cast<double>(camera.pinhole.aspect));
    out.m[0][2] = out.m[0][0] * static_cast<double>(camera.pinhole.shift_x);
    out.m[1][1] = 1.0 / half_height;
    out.m[1][2] = out.m[1][1] * static_cast<double>(camera.pinhole.shift_y);
    out.m[2][2] = (zfar_m + znear_m) / depth;
    out.m[2][3] = 2.0 * zfar_m * znear_m / depth;
    out.m[3][2] = -1;
    return out;
}

void store_for_row_vectors(const Matrix4& matrix, float* out) {
    for (int r = 0; r < 4; ++r) {
        for (int c = 0; c < 4; ++c)
            out[4 * r + c] = static_cast<float>(matrix.m[c][r]);
    }
}

}  // namespace

CameraMatrices camera_matrices(const Camera& camera, double znear_m, double zfar_m) {
    const Matrix4 camera_from_world =
        from_affine(inverse(affine_cast<double>(camera.world_from_camera)));
    CameraMatrices out = {};
    store_for_row_vectors(camera_from_world, out.world_to_camera);
    const bool flat = camera.model != CameraModel::fisheye &&
                      camera.model != CameraModel::environment && !is_distorted(camera);
    out.has_ndc = flat;
    if (!flat) return out;
    store_for_row_vectors(multiply(ndc_from_camera(camera, znear_m, zfar_m), camera_from_world),
                          out.world_to_ndc);
    return out;
}

}  // namespace obscura
