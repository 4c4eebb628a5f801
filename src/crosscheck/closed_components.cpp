// crosscheck/closed_components.cpp - finds closed meshes and solid shapes.
// SPDX-License-Identifier: Apache-2.0
#include "crosscheck/closed_components.h"

#include <algorithm>
#include <array>
#include <map>
#include <numeric>

namespace obscura::crosscheck {

namespace {

using Corners = std::array<uint32_t, 3>;  ///< welded vertex numbers
using Position = std::array<float, 3>;

/// The triangles of primitives that share a space; coincident vertices are one.
struct WeldedMesh {
    std::vector<Position> positions;
    std::vector<Corners> triangles;
};

WeldedMesh weld(const Scene& scene, int32_t first_primitive, int32_t count) {
    std::vector<Position> corners;
    for (int32_t p = first_primitive; p < first_primitive + count; ++p) {
        const Primitive& primitive = scene.primitives[static_cast<size_t>(p)];
        if (!is_mesh(primitive)) continue;
        const auto begin = static_cast<size_t>(primitive.first_triangle) * 3;
        for (size_t i = begin; i < begin + static_cast<size_t>(primitive.triangle_count) * 3; ++i) {
            const float* at = &scene.positions[3 * static_cast<size_t>(scene.indices[i])];
            corners.push_back({at[0] + 0.0f, at[1] + 0.0f, at[2] + 0.0f});  // -0 becomes 0
        }
    }
    WeldedMesh mesh;
    mesh.positions = corners;
    std::sort(mesh.positions.begin(), mesh.positions.end());
    mesh.positions.erase(std::unique(mesh.positions.begin(), mesh.positions.end()),
                         mesh.positions.end());
    for (size_t i = 0; i + 2 < corners.size(); i += 3) {
        Corners triangle{};
        for (size_t k = 0; k < 3; ++k) {
            const auto at =
                std::lower_bound(mesh.positions.begin(), mesh.positions.end(), corners[i + k]);
            triangle[k] = static_cast<uint32_t>(at - mesh.positions.begin());
        }
        const bool flat =
            triangle[0] == triangle[1] || triangle[1] == triangle[2] || triangle[2] == triangle[0];
        if (!flat) mesh.triangles.push_back(triangle);
    }
    return mesh;
}

/// Which vertices are connected.
class Clusters {
public:
    explicit Clusters(size_t count) : parent_(count) {
        std::iota(parent_.begin(), parent_.end(), 0U);
    }
    uint32_t find(uint32_t v) {
        while (parent_[v] != v) {
            parent_[v] = parent_[parent_[v]];
            v = parent_[v];
        }
        return v;
    }
    void join(uint32_t a, uint32_t b) { parent_[find(a)] = find(b); }

private:
    std::vector<uint32_t> parent_;
};

/// The triangles of every closed cluster.
std::vector<std::vector<Corners>> closed_clusters(const WeldedMesh& mesh) {
    Clusters clusters(mesh.positions.size());
    for (const Corners& t : mesh.triangles) {
        clusters.join(t[0], t[1]);
        clusters.join(t[1], t[2]);
    }
    // An edge from the smaller to the greater vertex counts 1, the other way -1; with the cluster.
    std::vector<std::pair<std::pair<uint32_t, uint32_t>, int>> edges;
    for (const Corners& t : mesh.triangles) {
        for (size_t k = 0; k < 3; ++k) {
            const uint32_t a = t[k];
            const uint32_t b = t[(k + 1) % 3];
            edges.push_back({std::minmax(a, b), a < b ? 1 : -1});
        }
    }
    std::sort(edges.begin(), edges.end());
    std::vector<uint8_t> open(mesh.positions.size(), 0);
    for (size_t i = 0; i < edges.size();) {
        int sum = 0;
        const auto edge = edges[i].first;
        for (; i < edges.size() && edges[i].first == edge; ++i)
            sum += edges[i].second;
        if (sum != 0) open[clusters.find(edge.first)] = 1;
    }
    std::map<uint32_t, std::vector<Corners>> by_cluster;
    for (const Corners& t : mesh.triangles) {
        const uint32_t cluster = clusters.find(t[0]);
        if (open[cluster] == 0) by_cluster[cluster].push_back(t);
    }
    std::vector<std::vector<Corners>> out;
    for (auto& [cluster, triangles] : by_cluster)
        out.push_back(std::move(triangles));
    return out;
}

/// A scene of one primitive, in the world or placed as `instance` is.
Scene scene_of(Primitive primitive, const Instance* instance) {
    Scene scene;
    primitive.first_triangle = 0;
    primitive.material = 0;
    scene.materials.emplace_back();
    scene.material_names.emplace_back();
    scene.material_numbers.push_back(-1);
    scene.primitives.push_back(primitive);
    scene.world_primitive_count = instance == nullptr ? 1 : 0;
    if (instance != nullptr) {
        scene.meshes.push_back({0, 1});
        scene.instances.push_back(*instance);
        scene.instances.back().mesh = 0;
    }
    return scene;
}

ClosedComponent component_of(const WeldedMesh& mesh,
                             const std::vector<Corners>& triangles,
                             const Instance* instance) {
    Primitive primitive;
    primitive.triangle_count = static_cast<int32_t>(triangles.size());
    ClosedComponent component{scene_of(primitive, instance), triangles.size()};
    std::map<uint32_t, uint32_t> renumbered;
    for (const Corners& t : triangles) {
        for (const uint32_t v : t) {
            const auto [at, is_new] =
                renumbered.try_emplace(v, static_cast<uint32_t>(renumbered.size()));
            component.scene.indices.push_back(at->second);
            if (!is_new) continue;
            const Position& p = mesh.positions[v];
            component.scene.positions.insert(component.scene.positions.end(), p.begin(), p.end());
        }
    }
    pad_tables(component.scene);
    return component;
}

bool is_solid(const ShapeRecord& record) {
    switch (static_cast<ShapeKind>(record.kind)) {
        case ShapeKind::sphere:
        case ShapeKind::box:
        case ShapeKind::frustum:
        case ShapeKind::capsule:
            return true;
        case ShapeKind::plane:
        case ShapeKind::disk:
        case ShapeKind::quadric:
        case ShapeKind::quadric_from_above:
            break;
    }
    return false;
}

/// Finds the components of primitives that share a space.
void add_components(const Scene& scene,
                    Mesh range,
                    const Instance* instance,
                    ClosedComponents& out) {
    const WeldedMesh mesh = weld(scene, range.first_primitive, range.primitive_count);
    for (const std::vector<Corners>& triangles : closed_clusters(mesh))
        out.components.push_back(component_of(mesh, triangles, instance));
    for (int32_t i = range.first_primitive; i < range.first_primitive + range.primitive_count;
         ++i) {
        const Primitive& primitive = scene.primitives[static_cast<size_t>(i)];
        if (primitive.geometry != static_cast<int32_t>(GeometryKind::shapes)) continue;
        const ShapeRecord& record = scene.shapes[static_cast<size_t>(primitive.first_triangle)];
        if (!is_solid(record)) continue;
        ClosedComponent component{scene_of(primitive, instance), 1};
        component.scene.shapes.push_back(record);
        pad_tables(component.scene);
        out.components.push_back(std::move(component));
    }
}

}  // namespace

ClosedComponents find_closed_components(const Scene& scene, size_t most) {
    ClosedComponents out;
    add_components(scene, {0, scene.world_primitive_count}, nullptr, out);
    for (size_t m = 0; m < scene.meshes.size(); ++m) {
        const auto placed = std::find_if(
            scene.instances.begin(), scene.instances.end(), [&](const Instance& instance) {
                return instance.mesh == static_cast<int32_t>(m);
            });
        if (placed != scene.instances.end()) add_components(scene, scene.meshes[m], &*placed, out);
    }
    out.found = out.components.size();
    std::stable_sort(out.components.begin(),
                     out.components.end(),
                     [](const auto& a, const auto& b) { return a.items > b.items; });
    if (out.components.size() > most) out.components.resize(most);
    return out;
}

}  // namespace obscura::crosscheck
