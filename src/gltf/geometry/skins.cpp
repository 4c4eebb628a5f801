// gltf/geometry/skins.cpp - the joint matrices of a skin: world space from bind pose.
// SPDX-License-Identifier: Apache-2.0
#include "gltf/geometry/skins.h"

#include <cmath>

namespace obscura::gltf {

namespace {

constexpr size_t matrix_floats = 16;

/// A column-major 4x4 matrix whose last row is 0 0 0 1; false: a number is not finite.
bool read_matrix(const float* columns, Affined& out) {
    bool finite = true;
    for (size_t r = 0; r < 3; ++r) {
        for (size_t c = 0; c < 4; ++c) {
            out.m[r][c] = double{columns[c * 4 + r]};
            finite = finite && std::isfinite(out.m[r][c]);
        }
    }
    return finite;
}

}  // namespace

Result<std::vector<Affined>> skin_matrices(const Document& document,
                                           const BufferStore& buffers,
                                           const std::vector<Affined>& world_from_node,
                                           int skin) {
    const GltfSkin& record = document.skins[static_cast<size_t>(skin)];
    std::vector<Affined> out;
    out.reserve(record.joints.size());
    for (const int joint : record.joints)
        out.push_back(world_from_node[static_cast<size_t>(joint)]);
    if (record.inverse_bind_matrices < 0) return out;
    const Result<std::vector<float>> matrices =
        read_floats(document, buffers, record.inverse_bind_matrices, {});
    if (!matrices) return fail(matrices.error());
    for (size_t i = 0; i < out.size(); ++i) {
        Affined joint_from_bind;
        if (!read_matrix(&(*matrices)[i * matrix_floats], joint_from_bind)) {
            return fail(ExitCode::bad_data,
                        "E-SKIN-MATRICES",
                        document.at("skins", static_cast<size_t>(skin)),
                        "inverse bind matrix " + std::to_string(i) + " is not finite");
        }
        out[i] = compose(out[i], joint_from_bind);
    }
    return out;
}

}  // namespace obscura::gltf
