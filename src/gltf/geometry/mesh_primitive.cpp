// gltf/geometry/mesh_primitive.cpp - a glTF primitive as a plain indexed triangle list.
// SPDX-License-Identifier: Apache-2.0
#include "gltf/geometry/mesh_primitive.h"

#include "gltf/geometry/deform.h"
#include "gltf/geometry/farthest_position.h"
#include "gltf/geometry/mesh_shading.h"
#include "gltf/geometry/primitive_modes.h"
#include "gltf/geometry/primitive_reader.h"
#include "gltf/materials/materials.h"

#include <algorithm>
#include <cmath>
#include <numeric>
#include <optional>
#include <utility>

namespace obscura::gltf {

namespace {

/// The vertex order of a primitive: its indices, or 0, 1, 2...
Result<std::vector<uint32_t>> read_vertex_order(PrimitiveReader& reader) {
    const GltfPrimitive& primitive = reader.primitive();
    if (primitive.draco_view >= 0) return std::move(reader.draco.indices);
    if (primitive.indices < 0) {
        std::vector<uint32_t> order(reader.vertex_count);
        std::iota(order.begin(), order.end(), 0U);
        return order;
    }
    return read_indices(reader.document, reader.store, primitive.indices);
}

/// The first index of a vertex that does not exist.
std::optional<Error> find_bad_index(const PrimitiveReader& reader,
                                    const std::vector<uint32_t>& order) {
    const uint64_t count = reader.vertex_count;
    const auto is_bad = [&](uint32_t vertex) { return vertex >= count; };
    const auto found = std::find_if(order.begin(), order.end(), is_bad);
    if (found == order.end()) return std::nullopt;
    return reader
        .bad("E-MESH-INDEX",
             "index " + std::to_string(found - order.begin()) + " is vertex " +
                 std::to_string(*found) + ", but there are only " + std::to_string(count) +
                 "; every index must be below that")
        .value();
}

/// Leaves out the elements with a vertex that is not good, and says so once.
template <typename IsGood>
void drop_elements(MeshPrimitive& primitive, const IsGood& is_good, const Error& error) {
    size_t kept = 0;
    for (size_t i = 0; i < primitive.indices.size(); i += primitive.corners) {
        const uint32_t* first = &primitive.indices[i];
        if (!std::all_of(first, first + primitive.corners, is_good)) continue;
        std::copy_n(first, primitive.corners, &primitive.indices[kept]);
        kept += primitive.corners;
    }
    primitive.faults.push_back({error, (primitive.indices.size() - kept) / primitive.corners});
    primitive.indices.resize(kept);
}

/// Keeps the vertices that triangles use, where they are few: many primitives may share one long
/// accessor. Returns the kept ones in order; empty: all are kept.
std::vector<uint32_t> compact_vertices(std::vector<uint32_t>& indices, uint64_t vertex_count) {
    if (indices.size() >= vertex_count / 2) return {};
    std::vector<uint32_t> kept = indices;
    std::sort(kept.begin(), kept.end());
    kept.erase(std::unique(kept.begin(), kept.end()), kept.end());
    for (uint32_t& index : indices) {
        const auto found = std::lower_bound(kept.begin(), kept.end(), index);
        index = static_cast<uint32_t>(found - kept.begin());
    }
    return kept;
}

/// Positions that triangles use must be finite and in range; others become 0.
void check_positions(const PrimitiveReader& reader, const char* what, MeshPrimitive& primitive) {
    const auto is_good = [&](size_t vertex) {
        const float* p = &primitive.positions[3 * vertex];
        return std::abs(p[0]) <= farthest_position && std::abs(p[1]) <= farthest_position &&
               std::abs(p[2]) <= farthest_position;
    };
    if (!std::all_of(primitive.indices.begin(), primitive.indices.end(), is_good)) {
        const std::string message =
            std::string(what) + " not finite or beyond 1e18; accepted are numbers within that";
        drop_elements(primitive, is_good, reader.bad("E-MESH-POSITION", message).value());
    }
    for (size_t vertex = 0; vertex < primitive.positions.size() / 3; ++vertex) {
        if (!is_good(vertex)) std::fill_n(&primitive.positions[3 * vertex], 3, 0.0f);
    }
}

/// Compares POSITION's min and max with the data; ours are used in any case.
void check_declared_bounds(const PrimitiveReader& reader, MeshPrimitive& primitive) {
    const GltfAccessor& accessor =
        reader.document.accessors[static_cast<size_t>(reader.primitive().position)];
    if (!accessor.has_bounds) primitive.issues |= issue_bit(MeshIssue::missing_bounds);
    if (!accessor.has_bounds || accessor.component != ComponentType::float32) return;
    for (size_t axis = 0; axis < 3; ++axis) {
        const double low = accessor.low[axis];
        const double high = accessor.high[axis];
        const double slack = 1e-4 * (std::abs(low) + std::abs(high)) + 1e-30;
        for (const uint32_t vertex : primitive.indices) {
            const double x = primitive.positions[3 * static_cast<size_t>(vertex) + axis];
            if (x >= low - slack && x <= high + slack) continue;
            primitive.issues |= issue_bit(MeshIssue::wrong_bounds);
            return;
        }
    }
}

/// Makes four floats of three, and brings each into [0, largest].
void finish_colors(MeshPrimitive& primitive, size_t rows) {
    if (primitive.colors.empty()) return;
    std::vector<float> out;
    out.reserve(primitive.colors.size() / rows * 4);
    bool bad = false;
    for (size_t i = 0; i < primitive.colors.size(); ++i) {
        float value = primitive.colors[i];
        if (!(value >= 0 && value <= 1e30f)) {
            bad = true;
            value = value < 0 ? 0.0f : 1.0f;
        }
        out.push_back(value);
        if (rows == 3 && i % 3 == 2) out.push_back(1);
    }
    if (bad) primitive.issues |= issue_bit(MeshIssue::bad_colors);
    primitive.colors = std::move(out);
}

void finish_uvs(MeshPrimitive& primitive) {
    for (std::vector<float>& set : primitive.uvs) {
        for (float& value : set) {
            if (std::isfinite(value)) continue;
            primitive.issues |= issue_bit(MeshIssue::bad_uvs);
            value = 0;
        }
    }
}

/// Unusable normals of points and lines become 0: shading takes the round surface's there.
void finish_points_lines_normals(MeshPrimitive& primitive) {
    for (size_t i = 0; i < primitive.normals.size(); i += 3) {
        float* n = &primitive.normals[i];
        if (!std::all_of(n, n + 3, [](float x) { return std::isfinite(x); }))
            std::fill_n(n, 3, 0.0f);
    }
}

/// Reads what the material needs beside positions.
Result<void> read_attributes(PrimitiveReader& reader,
                             MeshPrimitive& primitive,
                             const MaterialNeeds& needs) {
    const GltfPrimitive& source = reader.primitive();
    const GltfAttributes& ids = source.draco_ids;
    const auto read = [&](int accessor, int id, const AttributeRule& rule, auto& out) {
        Result<std::vector<float>> values = read_attribute(reader, accessor, id, rule);
        if (values) out = std::move(*values);
        return values ? Result<void>{} : Result<void>(fail(std::move(values.error())));
    };
    Result<void> done = read(source.normal, ids.normal, normal_rule, primitive.normals);
    if (done) done = read(source.color, ids.color, color_rule, primitive.colors);
    for (size_t set = 0; set < primitive.uvs.size() && done; ++set) {
        if ((needs.uv_sets >> set & 1U) != 0)
            done = read(source.uv[set], ids.uv[set], uv_rule, primitive.uvs[set]);
    }
    const bool tangents_count = needs.tangents && !primitive.normals.empty();
    if (done && tangents_count)
        done = read(source.tangent, ids.tangent, tangent_rule, primitive.tangents);
    if (!done) return done;
    if (source.tangent >= 0 && source.normal < 0) {
        primitive.issues |= issue_bit(MeshIssue::lone_tangents);
    }
    if (source.color >= 0) {
        const GltfAccessor& color = reader.document.accessors[static_cast<size_t>(source.color)];
        finish_colors(primitive, static_cast<size_t>(color.rows));
    }
    finish_uvs(primitive);
    return {};
}

/// Fills primitive.indices with numbers among the vertices that it returns; empty: all are kept.
Result<std::vector<uint32_t>> read_elements(PrimitiveReader& reader,
                                            int mode,
                                            MeshPrimitive& primitive) {
    Result<std::vector<uint32_t>> order = read_vertex_order(reader);
    if (!order) return order;
    const std::optional<Error> bad_index = find_bad_index(reader, *order);
    primitive.corners = element_corners(mode);
    ElementList elements = element_list(std::move(*order), mode);
    primitive.indices = std::move(elements.vertices);
    if (bad_index) {
        const auto exists = [&](uint32_t vertex) { return vertex < reader.vertex_count; };
        drop_elements(primitive, exists, *bad_index);
    }
    if (elements.leftover) primitive.issues |= issue_bit(MeshIssue::leftover_vertices);
    return compact_vertices(primitive.indices, reader.vertex_count);
}

}  // namespace

std::string_view mesh_issue_text(MeshIssue issue) {
    switch (issue) {
        case MeshIssue::no_position:
            return "primitives without POSITION are not drawn";
        case MeshIssue::leftover_vertices:
            return "the last vertices do not make a triangle or a line";
        case MeshIssue::bad_normals:
            return "normals without length or not finite are replaced by the triangles' own";
        case MeshIssue::bad_tangents:
            return "tangents that cannot be used are made anew";
        case MeshIssue::bad_uvs:
            return "texture coordinates that are not finite become 0";
        case MeshIssue::bad_colors:
            return "vertex colours below 0 or not finite are clamped";
        case MeshIssue::wrong_bounds:
            return "min and max of POSITION do not hold the vertices";
        case MeshIssue::missing_bounds:
            return "POSITION has no min and max";
        case MeshIssue::unsorted_sparse:
            return "sparse indices are not in increasing order";
        case MeshIssue::lone_tangents:
            return "TANGENT without NORMAL is ignored";
        case MeshIssue::bad_weights:
            return "skin weights that are below 0, not finite or do not sum to 1 are repaired";
        case MeshIssue::no_joints:
            return "without JOINTS_0 and WEIGHTS_0 a skin cannot move them: drawn where their node "
                   "is";
        case MeshIssue::count:
            break;
    }
    return {};
}

MaterialNeeds material_needs(const Document& document, int material) {
    MaterialNeeds needs;
    if (document.keeps_uv) needs.uv_sets = 1;
    if (material < 0) return needs;
    const GltfMaterial& from = document.materials[static_cast<size_t>(material)];
    const MaterialLayers layers = from.layers.value_or(MaterialLayers{});
    for (size_t i = 0; i < slot_count; ++i) {
        const TextureSlot& slot = *slot_of(i, from.values, layers);
        if (slot.texture >= 0) needs.uv_sets |= 1U << slot.uv_set;
    }
    for (const TextureSlot* slot : {&from.values.normal_texture,
                                    &layers.clearcoat_normal_texture,
                                    &layers.anisotropy_texture}) {
        if (slot->texture < 0 || needs.tangents) continue;
        needs.tangents = true;
        needs.normal_map = *slot;
    }
    if (layers.anisotropy > 0.0F) {  // without a texture the tangents follow TEXCOORD_0
        needs.tangents = true;
        needs.uv_sets |= 1U << needs.normal_map.uv_set;
    }
    return needs;
}

uint64_t primitive_triangles(const Document& document, const GltfPrimitive& primitive) {
    const int order = primitive.indices >= 0 ? primitive.indices : primitive.position;
    if (order < 0) return 0;
    return triangle_count(primitive.mode, document.accessors[static_cast<size_t>(order)].count);
}

Result<MeshPrimitive> read_mesh_primitive(const Document& document,
                                          const BufferStore& store,
                                          PrimitiveName name,
                                          const PrimitivePose& pose) {
    PrimitiveReader reader{document, store, name};
    const GltfPrimitive& source = reader.primitive();
    MeshPrimitive primitive;
    if (source.position < 0) {
        primitive.issues |= issue_bit(MeshIssue::no_position);
        return primitive;
    }
    Result<void> done = prepare_primitive(reader);
    if (!done) return fail(std::move(done.error()));

    // Draco keeps triangles, not the strip that they may have been.
    const int mode = source.draco_view >= 0 ? triangles_mode : source.mode;
    const Result<std::vector<uint32_t>> kept = read_elements(reader, mode, primitive);
    if (!kept) return fail(kept.error());
    reader.choice = {kept->empty(), *kept};
    if (primitive.indices.empty()) return primitive;

    Result<std::vector<float>> positions =
        read_attribute(reader, source.position, source.draco_ids.position, position_rule);
    if (!positions) return fail(std::move(positions.error()));
    primitive.positions = std::move(*positions);
    const bool has_surface = !is_point_or_line_mode(mode);
    MaterialNeeds needs = material_needs(document, source.material);
    needs.tangents = needs.tangents && has_surface;
    check_positions(reader, "a position is used that is", primitive);
    if (primitive.indices.empty()) return primitive;
    done = read_attributes(reader, primitive, needs);
    if (!done) return fail(std::move(done.error()));
    check_declared_bounds(reader, primitive);
    done = deform_primitive(reader, pose, primitive);
    if (!done) return fail(std::move(done.error()));
    if (primitive.is_deformed) {
        check_positions(
            reader, "morph targets or a skin move a vertex to a place that is", primitive);
        finish_uvs(primitive);
    }
    primitive.issues |= reader.issues;
    if (primitive.indices.empty()) return primitive;
    if (has_surface) {
        finish_shading(primitive, needs);
    } else {
        finish_points_lines_normals(primitive);
    }
    return primitive;
}

}  // namespace obscura::gltf
