// gltf/geometry/tangents.cpp - MikkTSpace: weld, pair edges, group, average.
// SPDX-License-Identifier: Apache-2.0
#include "gltf/geometry/tangents.h"

#include "math/vec.h"

#include <algorithm>
#include <array>
#include <bit>
#include <cfloat>
#include <cmath>

namespace obscura::gltf {
namespace {

constexpr uint32_t nothing = UINT32_MAX;

/// One triangle. Edge i joins corner i and corner i + 1.
struct Face {
    uint32_t vertex[3];                                  ///< welded
    uint32_t neighbor[3] = {nothing, nothing, nothing};  ///< the face across each edge
    Vec3f along_u = {0, 0, 0};                           ///< unit, towards growing u
    Vec3f along_v = {0, 0, 0};                           ///< unit, towards growing v
    bool turned = false;      ///< the UVs run the other way round than the corners
    bool undirected = true;   ///< UVs without area: joins any group, adds nothing to it
    bool degenerate = false;  ///< two corners share a position: has no say in anything
    bool grouped[3] = {false, false, false};
};

Vec3d vector_at(std::span<const float> values, uint32_t vertex) {
    const float* v = values.data() + 3 * static_cast<size_t>(vertex);
    return {static_cast<double>(v[0]), static_cast<double>(v[1]), static_cast<double>(v[2])};
}

/// a / |a|, or zero where that has no meaning.
Vec3d unit_or_zero(const Vec3d& a) {
    const double size = std::sqrt(dot(a, a));
    return size > 0.0 && size <= DBL_MAX ? a * (1.0 / size) : Vec3d{0.0, 0.0, 0.0};
}

Vec3d unit_in_plane(const Vec3d& a, const Vec3d& normal) {
    return unit_or_zero(a - normal * dot(normal, a));
}

// ---- welding -------------------------------------------------------------------------------

using VertexBits = std::array<uint32_t, 8>;

/// The bits of position, normal and UV; adding zero turns -0 into +0, its equal.
VertexBits bits_of(const TangentMesh& mesh, size_t vertex) {
    VertexBits bits{};
    for (size_t c = 0; c < 3; ++c) {
        bits[c] = std::bit_cast<uint32_t>(mesh.positions[3 * vertex + c] + 0.0f);
        bits[3 + c] = std::bit_cast<uint32_t>(mesh.normals[3 * vertex + c] + 0.0f);
    }
    for (size_t c = 0; c < 2; ++c) {
        bits[6 + c] = std::bit_cast<uint32_t>(mesh.uvs[2 * vertex + c] + 0.0f);
    }
    return bits;
}

uint64_t hash_of(const VertexBits& bits) {
    uint64_t hash = 0x9E3779B97F4A7C15U;
    for (const uint32_t word : bits) {
        hash = (hash ^ word) * 0xFF51AFD7ED558CCDU;
        hash ^= hash >> 32;
    }
    return hash;
}

/// For each vertex the first one that equals it in position, normal and UV.
std::vector<uint32_t> weld(const TangentMesh& mesh) {
    const size_t count = mesh.positions.size() / 3;
    const size_t mask = std::bit_ceil(2 * count + 2) - 1;
    std::vector<uint32_t> slots(mask + 1, nothing);
    std::vector<uint32_t> welded(count);
    for (size_t vertex = 0; vertex < count; ++vertex) {
        const VertexBits bits = bits_of(mesh, vertex);
        size_t slot = hash_of(bits) & mask;
        while (slots[slot] != nothing && bits_of(mesh, slots[slot]) != bits) {
            slot = (slot + 1) & mask;
        }
        if (slots[slot] == nothing) slots[slot] = static_cast<uint32_t>(vertex);
        welded[vertex] = slots[slot];
    }
    return welded;
}

// ---- faces ---------------------------------------------------------------------------------

bool same_position(const Vec3d& a, const Vec3d& b) {
    return a.x == b.x && a.y == b.y && a.z == b.z;
}

/// Directions of u and v in the face, from position = origin + u * dP/du + v * dP/dv.
void find_directions(const TangentMesh& mesh, const std::array<Vec3d, 3>& corner, Face& face) {
    const float* uv[3];
    for (int i = 0; i < 3; ++i)
        uv[i] = mesh.uvs.data() + 2 * static_cast<size_t>(face.vertex[i]);
    // In float like every other implementation, so that the same faces count as without area.
    const float u1 = uv[1][0] - uv[0][0], v1 = uv[1][1] - uv[0][1];
    const float u2 = uv[2][0] - uv[0][0], v2 = uv[2][1] - uv[0][1];
    const float area = u1 * v2 - v1 * u2;
    const Vec3d edge1 = corner[1] - corner[0], edge2 = corner[2] - corner[0];
    const double sign = area > 0.0f ? 1.0 : -1.0;
    const Vec3d du = (edge1 * static_cast<double>(v2) - edge2 * static_cast<double>(v1)) * sign;
    const Vec3d dv = (edge2 * static_cast<double>(u1) - edge1 * static_cast<double>(u2)) * sign;
    const auto least = static_cast<double>(FLT_MIN);
    const double double_area = std::fabs(static_cast<double>(area));
    face.turned = !(area > 0.0f);
    face.undirected = !(double_area > least && length(du) > least * std::max(1.0, double_area) &&
                        length(dv) > least * std::max(1.0, double_area));
    if (face.undirected) return;
    const Vec3d u = unit_or_zero(du), v = unit_or_zero(dv);
    face.along_u = {static_cast<float>(u.x), static_cast<float>(u.y), static_cast<float>(u.z)};
    face.along_v = {static_cast<float>(v.x), static_cast<float>(v.y), static_cast<float>(v.z)};
}

std::vector<Face> make_faces(const TangentMesh& mesh) {
    const std::vector<uint32_t> welded = weld(mesh);
    std::vector<Face> faces(mesh.indices.size() / 3);
    for (size_t f = 0; f < faces.size(); ++f) {
        Face& face = faces[f];
        std::array<Vec3d, 3> corner{};
        for (size_t i = 0; i < 3; ++i) {
            face.vertex[i] = welded[mesh.indices[3 * f + i]];
            corner[i] = vector_at(mesh.positions, face.vertex[i]);
        }
        face.degenerate = same_position(corner[0], corner[1]) ||
                          same_position(corner[1], corner[2]) ||
                          same_position(corner[2], corner[0]);
        if (!face.degenerate) find_directions(mesh, corner, face);
    }
    return faces;
}

// ---- neighbours ----------------------------------------------------------------------------

struct Edge {
    uint64_t ends;    ///< the lower and the higher vertex
    uint32_t corner;  ///< 3 * face + edge

    bool operator<(const Edge& other) const {
        return ends != other.ends ? ends < other.ends : corner < other.corner;
    }
};

std::vector<Edge> sorted_edges(const std::vector<Face>& faces) {
    std::vector<Edge> edges;
    edges.reserve(3 * faces.size());
    for (size_t f = 0; f < faces.size(); ++f) {
        if (faces[f].degenerate) continue;
        for (size_t i = 0; i < 3; ++i) {
            const uint32_t a = faces[f].vertex[i], b = faces[f].vertex[(i + 1) % 3];
            edges.push_back({static_cast<uint64_t>(std::min(a, b)) << 32 | std::max(a, b),
                             static_cast<uint32_t>(3 * f + i)});
        }
    }
    std::sort(edges.begin(), edges.end());
    return edges;
}

/// Joins faces that run along an edge in opposite directions. Where more than two meet, the
/// earliest free face takes the next one that runs the other way.
void join_neighbors(std::vector<Face>& faces) {
    const std::vector<Edge> edges = sorted_edges(faces);
    const auto runs_upwards = [&](uint32_t corner) {
        const Face& face = faces[corner / 3];
        return face.vertex[corner % 3] < face.vertex[(corner % 3 + 1) % 3];
    };
    std::vector<uint32_t> waiting;  // free corners along the present edge, all of one direction
    size_t served = 0;              // those before this one have found their partner
    for (size_t e = 0; e < edges.size(); ++e) {
        if (e == 0 || edges[e].ends != edges[e - 1].ends) {
            waiting.clear();
            served = 0;
        }
        const uint32_t corner = edges[e].corner;
        if (served == waiting.size() || runs_upwards(waiting[served]) == runs_upwards(corner)) {
            waiting.push_back(corner);
            continue;
        }
        const uint32_t partner = waiting[served++];
        faces[corner / 3].neighbor[corner % 3] = partner / 3;
        faces[partner / 3].neighbor[partner % 3] = corner / 3;
    }
}

// ---- groups --------------------------------------------------------------------------------

/// Working space of one group: the corners that meet at a vertex and share its tangent.
struct Group {
    struct Corner {
        Vec3d along_u, along_v;  ///< unit, in the normal's plane
        double weight;           ///< angle of the face at the vertex; 0 without direction
        bool undirected;
    };
    std::vector<uint32_t> members;  ///< 3 * face + corner
    std::vector<uint32_t> to_visit;
    std::vector<Corner> corners;  ///< beside members
};

size_t corner_at(const Face& face, uint32_t vertex) {
    return face.vertex[0] == vertex ? 0 : face.vertex[1] == vertex ? 1 : 2;
}

/// Collects the corners that are reached from `first` through edges at its vertex, without
/// passing from UVs of one orientation to the other. A face without orientation that no group
/// has met yet takes this group's.
void gather_group(std::vector<Face>& faces, uint32_t first, Group& group) {
    const uint32_t vertex = faces[first / 3].vertex[first % 3];
    const bool turned = faces[first / 3].turned;
    group.members.clear();
    group.to_visit.assign(1, first / 3);
    while (!group.to_visit.empty()) {
        const uint32_t f = group.to_visit.back();
        group.to_visit.pop_back();
        Face& face = faces[f];
        const size_t i = corner_at(face, vertex);
        if (face.grouped[i]) continue;
        if (face.undirected && !face.grouped[0] && !face.grouped[1] && !face.grouped[2]) {
            face.turned = turned;
        }
        if (face.turned != turned) continue;
        face.grouped[i] = true;
        group.members.push_back(static_cast<uint32_t>(3 * f + i));
        for (const uint32_t next : {face.neighbor[(i + 2) % 3], face.neighbor[i]}) {
            if (next != nothing) group.to_visit.push_back(next);
        }
    }
}

Vec3d widened(const Vec3f& a) {
    return {static_cast<double>(a.x), static_cast<double>(a.y), static_cast<double>(a.z)};
}

void measure_corners(const TangentMesh& mesh,
                     const std::vector<Face>& faces,
                     const Vec3d& normal,
                     Group& group) {
    group.corners.clear();
    for (const uint32_t member : group.members) {
        const Face& face = faces[member / 3];
        const uint32_t i = member % 3;
        const Vec3d here = vector_at(mesh.positions, face.vertex[i]);
        const Vec3d next = vector_at(mesh.positions, face.vertex[(i + 1) % 3]);
        const Vec3d last = vector_at(mesh.positions, face.vertex[(i + 2) % 3]);
        const double cosine =
            dot(unit_in_plane(next - here, normal), unit_in_plane(last - here, normal));
        group.corners.push_back({unit_in_plane(widened(face.along_u), normal),
                                 unit_in_plane(widened(face.along_v), normal),
                                 face.undirected ? 0.0 : std::acos(std::clamp(cosine, -1.0, 1.0)),
                                 face.undirected});
    }
}

/// Corners whose UVs point in exactly opposite directions do not average (to nothing).
bool opposed(const Group::Corner& a, const Group::Corner& b) {
    constexpr double limit = -1.0 + 1e-7;  // the precision of float, in which the rule is written
    return !a.undirected && !b.undirected &&
           (dot(a.along_u, b.along_u) <= limit || dot(a.along_v, b.along_v) <= limit);
}

/// True when no two corners can be opposed, which is nearly always seen at once.
bool surely_agree(const Group& group) {
    const Group::Corner* guide = nullptr;
    for (const Group::Corner& corner : group.corners) {
        if (corner.undirected) continue;
        if (guide == nullptr) guide = &corner;
        if (dot(corner.along_u, guide->along_u) < 0.1) return false;
        if (dot(corner.along_v, guide->along_v) < 0.1) return false;
    }
    return true;
}

void write_tangent(const Vec3d& tangent, bool turned, float* out) {
    out[0] = static_cast<float>(tangent.x);
    out[1] = static_cast<float>(tangent.y);
    out[2] = static_cast<float>(tangent.z);
    out[3] = turned ? 1.0f : -1.0f;  // v grows downwards in glTF: turned faces are upright
}

/// A direction for corners that have none.
Vec3d any_tangent(const Vec3d& normal) {
    const bool along_x = std::fabs(normal.x) > 0.99;
    const Vec3d tangent = unit_in_plane(along_x ? Vec3d{0, 1, 0} : Vec3d{1, 0, 0}, normal);
    return dot(tangent, tangent) > 0.0 ? tangent : Vec3d{1, 0, 0};
}

/// Sums what the corners say, weighted by their angles, and writes it for each of them.
void write_group(const Group& group, const Vec3d& normal, bool turned, float* tangents) {
    // A pairwise comparison would take too long around the rare vertex of very many faces.
    constexpr size_t max_compared = 512;
    const bool compare = group.members.size() <= max_compared && !surely_agree(group);
    Vec3d tangent{0.0, 0.0, 0.0};
    for (size_t m = 0; m < group.members.size(); ++m) {
        if (m == 0 || compare) {
            Vec3d sum{0.0, 0.0, 0.0};
            for (const Group::Corner& corner : group.corners) {
                if (compare && opposed(corner, group.corners[m])) continue;
                sum = sum + corner.along_u * corner.weight;
            }
            tangent = unit_or_zero(sum);
            if (dot(tangent, tangent) == 0.0) tangent = any_tangent(normal);
        }
        write_tangent(tangent, turned, tangents + 4 * static_cast<size_t>(group.members[m]));
    }
}

Vec3d normal_at(const TangentMesh& mesh, uint32_t vertex) {
    return unit_or_zero(vector_at(mesh.normals, vertex));
}

/// Corners that no group holds: those of degenerate faces take what the first proper face says at
/// the same vertex, the others a direction of no meaning.
void fill_gaps(const TangentMesh& mesh, const std::vector<Face>& faces, float* tangents) {
    std::vector<uint32_t> first_corner(mesh.positions.size() / 3, nothing);
    for (size_t corner = 0; corner < 3 * faces.size(); ++corner) {
        const Face& face = faces[corner / 3];
        const uint32_t vertex = face.vertex[corner % 3];
        if (!face.grouped[corner % 3]) {
            write_tangent(any_tangent(normal_at(mesh, vertex)), false, tangents + 4 * corner);
        }
        if (!face.degenerate && first_corner[vertex] == nothing) {
            first_corner[vertex] = static_cast<uint32_t>(corner);
        }
    }
    for (size_t corner = 0; corner < 3 * faces.size(); ++corner) {
        const Face& face = faces[corner / 3];
        const uint32_t first = first_corner[face.vertex[corner % 3]];
        if (!face.degenerate || first == nothing) continue;
        std::copy_n(tangents + 4 * static_cast<size_t>(first), 4, tangents + 4 * corner);
    }
}

}  // namespace

std::vector<float> make_tangents(const TangentMesh& mesh) {
    std::vector<Face> faces = make_faces(mesh);
    join_neighbors(faces);
    std::vector<float> tangents(12 * faces.size());
    Group group;
    for (uint32_t corner = 0; corner < 3 * faces.size(); ++corner) {
        const Face& face = faces[corner / 3];
        if (face.degenerate || face.undirected || face.grouped[corner % 3]) continue;
        const Vec3d normal = normal_at(mesh, face.vertex[corner % 3]);
        gather_group(faces, corner, group);
        measure_corners(mesh, faces, normal, group);
        write_group(group, normal, face.turned, tangents.data());
    }
    fill_gaps(mesh, faces, tangents.data());
    return tangents;
}

}  // namespace obscura::gltf
