// gltf/geometry/splat_primitive.cpp - reads one primitive of Gaussian splats into plain arrays.
// SPDX-License-Identifier: Apache-2.0
#include "gltf/geometry/splat_primitive.h"

#include "gltf/geometry/primitive_reader.h"
#include "gltf/parse/document_splats.h"

#include <algorithm>
#include <cmath>

namespace obscura::gltf {

namespace {

constexpr AttributeRule rotation_rule = {"ROTATION", 4, 4, signed_types, signed_types, 0};
constexpr AttributeRule scale_rule = {
    "SCALE", 3, 3, signed_types, signed_types, 0, 0, signed_types};
constexpr AttributeRule opacity_rule = {"OPACITY", 1, 1, unsigned_types, unsigned_types, 0};
constexpr AttributeRule harmonic_rule = {"SH_DEGREE_l_COEF_n", 3, 3, 0, 0, 0};

constexpr float farthest = 1e18f;

/// The highest degree that has any function; in `missing` the functions that should be there.
int find_degree(const GltfSplatAttributes& splats, std::string& missing) {
    int degree = 0;
    for (int i = 0; i < max_harmonics; ++i) {
        if (splats.harmonics[static_cast<size_t>(i)] < 0) continue;
        while ((degree + 1) * (degree + 1) <= i)
            ++degree;
    }
    for (int l = 0; l <= degree; ++l) {
        for (int n = 0; n <= 2 * l; ++n) {
            const int at = l * l + n;
            if (splats.harmonics[static_cast<size_t>(at)] >= 0) continue;
            missing += " " + splat_harmonic_name(l, n);
        }
    }
    return degree;
}

/// The degree of the harmonics, where nothing is missing.
Result<int> check_attributes(const PrimitiveReader& reader) {
    const GltfPrimitive& primitive = reader.primitive();
    const GltfSplatAttributes& splats = primitive.splats;
    std::string missing;
    if (primitive.position < 0) missing += " POSITION";
    if (splats.rotation < 0) missing += " ROTATION";
    if (splats.scale < 0) missing += " SCALE";
    if (splats.opacity < 0) missing += " OPACITY";
    const int degree = find_degree(splats, missing);
    if (!missing.empty()) {
        return reader.bad("E-MESH-SPLATS",
                          "Gaussian splats must have these attributes, too:" + missing);
    }
    return degree;
}

Result<void> read_arrays(PrimitiveReader& reader, SplatPrimitive& out) {
    const GltfPrimitive& primitive = reader.primitive();
    const GltfSplatAttributes& splats = primitive.splats;
    const auto read = [&](int accessor, const AttributeRule& rule, std::vector<float>& to) {
        Result<std::vector<float>> values = read_attribute(reader, accessor, -1, rule);
        if (values) to = std::move(*values);
        return values ? Result<void>{} : Result<void>(fail(std::move(values.error())));
    };
    Result<void> done = read(primitive.position, position_rule, out.positions);
    if (done) done = read(splats.rotation, rotation_rule, out.rotations);
    if (done) done = read(splats.scale, scale_rule, out.scales);
    if (done) done = read(splats.opacity, opacity_rule, out.opacities);
    for (size_t i = 0; i < out.harmonics.size() && done; ++i)
        done = read(splats.harmonics[i], harmonic_rule, out.harmonics[i]);
    return done;
}

/// Turns logarithms into standard deviations.
void finish_scales(SplatPrimitive& primitive) {
    const auto is_negative = [](float scale) { return scale < 0; };
    if (std::none_of(primitive.scales.begin(), primitive.scales.end(), is_negative)) return;
    primitive.scales_were_logarithms = true;
    for (float& scale : primitive.scales)
        scale = std::exp(scale);
}

bool all_within(const float* first, size_t count, float low, float high) {
    return std::all_of(first, first + count, [&](float x) { return x >= low && x <= high; });
}

/// What is wrong with a splat; nullptr: nothing.
const char* find_problem(const SplatPrimitive& primitive, size_t splat) {
    if (!all_within(&primitive.positions[3 * splat], 3, -farthest, farthest)) {
        return "a position that is not within 1e18 of the origin";
    }
    const float* q = &primitive.rotations[4 * splat];
    const float squared = q[0] * q[0] + q[1] * q[1] + q[2] * q[2] + q[3] * q[3];
    if (!(squared > 1e-12f && squared < 1e12f)) return "a rotation that is no unit quaternion";
    if (!all_within(&primitive.scales[3 * splat], 3, 0, farthest)) {
        return "a scale that is not a number up to 1e18";
    }
    if (!all_within(&primitive.opacities[splat], 1, 0, 1))
        return "an opacity that is not in [0, 1]";
    for (const std::vector<float>& values : primitive.harmonics) {
        if (!values.empty() && !all_within(&values[3 * splat], 3, -1e6f, 1e6f)) {
            return "spherical harmonics that are not numbers up to 1e6";
        }
    }
    return nullptr;
}

void find_good(const PrimitiveReader& reader, SplatPrimitive& primitive) {
    const size_t count = primitive.opacities.size();
    primitive.good.reserve(count);
    for (size_t i = 0; i < count; ++i) {
        const char* problem = find_problem(primitive, i);
        if (problem == nullptr) {
            primitive.good.push_back(static_cast<uint32_t>(i));
            continue;
        }
        if (!primitive.fault) {
            primitive.fault = {
                reader.bad("E-MESH-SPLATS", "splat " + std::to_string(i) + " has " + problem)
                    .value()};
        }
        ++primitive.fault->dropped;
    }
}

}  // namespace

Result<SplatPrimitive> read_splat_primitive(const Document& document,
                                            const BufferStore& store,
                                            PrimitiveName name) {
    PrimitiveReader reader{document, store, name};
    const Result<int> degree = check_attributes(reader);
    if (!degree) return fail(degree.error());
    Result<void> done = prepare_primitive(reader);
    if (!done) return fail(std::move(done.error()));
    std::vector<uint32_t> order;
    if (reader.primitive().indices >= 0) {
        Result<std::vector<uint32_t>> indices =
            read_indices(document, store, reader.primitive().indices);
        if (!indices) return fail(std::move(indices.error()));
        order = std::move(*indices);
        const auto is_bad = [&](uint32_t vertex) { return vertex >= reader.vertex_count; };
        if (std::any_of(order.begin(), order.end(), is_bad)) {
            return reader.bad("E-MESH-INDEX", "every index must be below the number of vertices");
        }
        reader.choice = {false, order};
    }
    SplatPrimitive primitive;
    primitive.degree = *degree;
    done = read_arrays(reader, primitive);
    if (!done) return fail(std::move(done.error()));
    finish_scales(primitive);
    find_good(reader, primitive);
    return primitive;
}

}  // namespace obscura::gltf
