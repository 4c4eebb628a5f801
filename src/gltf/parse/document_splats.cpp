// gltf/parse/document_splats.cpp - reads KHR_gaussian_splatting of a primitive.
// SPDX-License-Identifier: Apache-2.0
#include "gltf/parse/document_splats.h"

#include "gltf/geometry/primitive_modes.h"

namespace obscura::gltf {

namespace {

constexpr std::string_view prefix = "KHR_gaussian_splatting:";

/// The number behind "SH_DEGREE_2_COEF_" for every name that there is: l^2 + n; -1: another name.
int harmonic_of(std::string_view name) {
    for (int degree = 0; degree * degree < max_harmonics; ++degree) {
        for (int n = 0; n <= 2 * degree; ++n) {
            if (name == splat_harmonic_name(degree, n)) return degree * degree + n;
        }
    }
    return -1;
}

bool is_compressed(const ValueReader& splats) {
    bool found = false;
    splats.child("extensions").each_key([&](const std::string& name) {
        found = found || name.find("compression") != std::string::npos;
    });
    return found;
}

}  // namespace

std::string splat_harmonic_name(int degree, int number) {
    return "SH_DEGREE_" + std::to_string(degree) + "_COEF_" + std::to_string(number);
}

int* splat_slot(GltfSplatAttributes& attributes, const std::string& name) {
    if (name.rfind(prefix, 0) != 0) return nullptr;
    const std::string_view own = std::string_view(name).substr(prefix.size());
    if (own == "ROTATION") return &attributes.rotation;
    if (own == "SCALE") return &attributes.scale;
    if (own == "OPACITY") return &attributes.opacity;
    const int harmonic = harmonic_of(own);
    return harmonic < 0 ? nullptr : &attributes.harmonics[static_cast<size_t>(harmonic)];
}

void read_splats(const ModelElement& primitive, GltfPrimitive& out) {
    constexpr const char* name = "KHR_gaussian_splatting";
    if (!primitive.has_extension(name)) return;
    const ValueReader splats = primitive.extension(name);
    if (is_compressed(splats)) return;
    if (out.mode != points_mode) {
        primitive.fault("mode", "E-MESH-SPLATS", "Gaussian splats are points: accepted is 0");
    }
    out.is_splats = true;
    out.splats_are_linear = splats.text("colorSpace") == "lin_rec709_display";
}

}  // namespace obscura::gltf
