// gltf/geometry/mesh_primitive.h - a glTF primitive as a plain indexed triangle list.
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "gltf/decode/accessors.h"

#include <array>
#include <cstdint>
#include <string_view>
#include <vector>

namespace obscura::gltf {

/// Oddities of primitives that do not stop loading; reported together.
///
/// To add one: append it before `count` and give it its words in mesh_issue_text.
enum class MeshIssue : uint32_t {
    no_position,
    leftover_vertices,
    bad_normals,
    bad_tangents,
    bad_uvs,
    bad_colors,
    wrong_bounds,
    missing_bounds,
    unsorted_sparse,
    lone_tangents,
    bad_weights,
    no_joints,
    count
};

std::string_view mesh_issue_text(MeshIssue issue);

constexpr uint32_t issue_bit(MeshIssue issue) {
    return 1U << static_cast<uint32_t>(issue);
}

/// Which optional attributes a material needs.
struct MaterialNeeds {
    uint32_t uv_sets = 0;    ///< bit n: TEXCOORD_n is looked up
    bool tangents = false;   ///< a normal map or an anisotropic highlight needs them
    TextureSlot normal_map;  ///< whose coordinates they follow
};

MaterialNeeds material_needs(const Document& document, int material);

/// Something about a primitive that is drawn only where loading is lenient.
struct PrimitiveFault {
    Error error;
    size_t dropped = 0;  ///< elements that are left out for it
};

/// Arrays of absent attributes are empty. Vertices outside of all triangles do not matter. Points
/// and lines have no tangents.
struct MeshPrimitive {
    size_t corners = 3;                               ///< of a triangle; 2: lines, 1: points
    std::vector<uint32_t> indices;                    ///< `corners` an element
    std::vector<float> positions;                     ///< 3 a vertex, finite
    std::vector<float> normals;                       ///< 3, unit
    std::vector<float> tangents;                      ///< 4, unit and handedness
    std::vector<float> colors;                        ///< 4
    std::array<std::vector<float>, max_uv_sets> uvs;  ///< 2
    uint32_t issues = 0;                              ///< issue_bit
    std::vector<PrimitiveFault> faults;
    bool in_world = false;     ///< true: a skin moved it there
    bool is_deformed = false;  ///< deformed: every pose has the same vertices in the same order
};

/// How a primitive is deformed before it is placed.
struct PrimitivePose {
    std::span<const double> weights = {};           ///< of the morph targets; empty: all are 0
    std::span<const Affined> world_from_bind = {};  ///< by joint; empty: it has no skin
};

/// Names one primitive of the document.
struct PrimitiveName {
    int mesh = 0;
    int primitive = 0;
};

/// As listed in the file, before degenerate ones are dropped.
uint64_t primitive_triangles(const Document& document, const GltfPrimitive& primitive);

/// Reads one primitive in its mesh's space; a skinned one in the world. Without POSITION the result
/// is empty. Elements whose vertices do not exist or have no finite position are left out, each
/// kind with a fault: E-MESH-INDEX, E-MESH-POSITION.
///
/// Errors  65 E-MESH-*, E-SKIN-JOINT, E-ACC-*, E-DRACO-DATA; 69 E-DRACO-VERSION;
///         77 E-LIMIT-COUNT
Result<MeshPrimitive> read_mesh_primitive(const Document& document,
                                          const BufferStore& store,
                                          PrimitiveName name,
                                          const PrimitivePose& pose = {});

}  // namespace obscura::gltf
