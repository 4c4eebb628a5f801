// session/framed_geometry.cpp - the points that a view is to show, found fast along any direction.
// SPDX-License-Identifier: Apache-2.0
#include "session/framed_geometry.h"

#include "base/parallel.h"
#include "shape/shape_record.h"
#include "shape/sphere_block.h"

#include <algorithm>
#include <cmath>

namespace obscura {

namespace {

using Box = std::array<Vec3f, 2>;

constexpr int32_t chunk_size = 256;

Vec3d wide(const Vec3f& v) {
    return {v.x, v.y, v.z};
}

void grow(Box& box, const Vec3f& low, const Vec3f& high) {
    box[0] = {std::min(box[0].x, low.x), std::min(box[0].y, low.y), std::min(box[0].z, low.z)};
    box[1] = max3(box[1], high);
}

constexpr Box no_box = {Vec3f{INFINITY, INFINITY, INFINITY},
                        Vec3f{-INFINITY, -INFINITY, -INFINITY}};

Affined double_of(const Affinef* transform) {
    Affined out;
    if (transform == nullptr) return out;
    for (int r = 0; r < 3; ++r) {
        for (int c = 0; c < 4; ++c)
            out.m[r][c] = static_cast<double>(transform->m[r][c]);
    }
    return out;
}

Vec3d corner_of(const Box& box, int index) {
    return wide({box[(index & 1) != 0 ? 1 : 0].x,
                 box[(index & 2) != 0 ? 1 : 0].y,
                 box[(index & 4) != 0 ? 1 : 0].z});
}

/// Searches the greatest dot(direction, point).
class AlongDirection {
public:
    explicit AlongDirection(const Vec3d& direction) : direction_(direction) {}

    void enter(const Affinef* world_from_object) {
        world_ = double_of(world_from_object);
        const auto& m = world_.m;
        const Vec3d& d = direction_;
        local_ = {m[0][0] * d.x + m[1][0] * d.y + m[2][0] * d.z,
                  m[0][1] * d.x + m[1][1] * d.y + m[2][1] * d.z,
                  m[0][2] * d.x + m[1][2] * d.y + m[2][2] * d.z};
        length_ = length(local_);
        offset_ = dot(d, Vec3d{m[0][3], m[1][3], m[2][3]});
    }
    double bound(const Box& box) const {
        const int corner = (local_.x > 0 ? 1 : 0) | (local_.y > 0 ? 2 : 0) | (local_.z > 0 ? 4 : 0);
        return dot(local_, corner_of(box, corner)) + offset_;
    }
    void take(const Vec3d& centre, double radius) {
        const double value = dot(local_, centre) + radius * length_ + offset_;
        if (!(value > best)) return;
        best = value;
        const Vec3d out = length_ > 0 ? local_ * (radius / length_) : Vec3d{0, 0, 0};
        point = transform_point(world_, centre + out);
    }

    double best = -INFINITY;
    Vec3d point = {0, 0, 0};

private:
    Vec3d direction_;
    Affined world_;
    Vec3d local_;  ///< the direction in the space of the item
    double length_ = 0;
    double offset_ = 0;
};

/// Searches the greatest distance from a point.
class FromCentre {
public:
    explicit FromCentre(const Vec3d& centre) : centre_(centre) {}

    void enter(const Affinef* world_from_object) {
        world_ = double_of(world_from_object);
        scale_ = 0;
        for (int c = 0; c < 3; ++c)
            scale_ =
                std::max(scale_, length(Vec3d{world_.m[0][c], world_.m[1][c], world_.m[2][c]}));
    }
    double bound(const Box& box) const {
        double out = 0;
        for (int i = 0; i < 8; ++i)
            out = std::max(out, length(transform_point(world_, corner_of(box, i)) - centre_));
        return out;
    }
    void take(const Vec3d& centre, double radius) {
        best = std::max(best, length(transform_point(world_, centre) - centre_) + radius * scale_);
    }

    double best = -INFINITY;

private:
    Vec3d centre_;
    Affined world_;
    double scale_ = 1;  ///< of the radius; the greatest of three axes at right angles
};

}  // namespace

/// Calls visit(centre, radius) for the vertices, with the radius 0, and for round things.
template <typename Visit>
void FramedGeometry::each_point(const Chunk& chunk, const Visit& visit) const {
    const Scene& scene = *scene_;
    const Primitive& primitive = scene.primitives[chunk.primitive];
    const auto kind = static_cast<GeometryKind>(primitive.geometry);
    // The radius of points and lines may depend on the view, and must not decide about it.
    const float thickness = is_point_or_line(primitive) ? 0.0f : 1.0f;
    const auto first = static_cast<size_t>(chunk.first);
    const size_t end = first + static_cast<size_t>(chunk.count);
    for (size_t i = first; i < end; ++i) {
        if (kind == GeometryKind::triangles) {
            for (size_t corner = 3 * i; corner < 3 * i + 3; ++corner) {
                const float* at = &scene.positions[3 * size_t{scene.indices[corner]}];
                visit(Vec3f{at[0], at[1], at[2]}, 0.0f);
            }
        } else if (kind == GeometryKind::spheres) {
            const float* at = &scene.spheres[sphere_word(i)];
            visit(Vec3f{at[0], at[sphere_block], at[2 * sphere_block]},
                  thickness * at[3 * sphere_block]);
        } else if (kind == GeometryKind::curves) {
            for (size_t point = 0; point < 2; ++point) {
                const float* at = &scene.curve_points[4 * (scene.curve_segments[i] + point)];
                visit(Vec3f{at[0], at[1], at[2]}, thickness * at[3]);
            }
        } else {
            const ShapeRecord& record = scene.shapes[i];
            const Vec3f centre{record.centre[0], record.centre[1], record.centre[2]};
            if (record.kind == static_cast<int32_t>(ShapeKind::sphere)) {
                visit(centre, record.size[0]);
                continue;
            }
            const Vec3f half{0.5f, 0.5f, 0.5f};  // of an infinite plane, as in Scene::bounds
            const ShapeBox around = is_unbounded(record) ? ShapeBox{centre - half, centre + half}
                                                         : shape_bounds(record);
            for (int corner = 0; corner < 8; ++corner) {
                const Vec3d p = corner_of({around.low, around.high}, corner);
                visit(
                    Vec3f{
                        static_cast<float>(p.x), static_cast<float>(p.y), static_cast<float>(p.z)},
                    0.0f);
            }
        }
    }
}

template <typename Search>
void FramedGeometry::look_into(const Chunk& chunk, Search& search) const {
    each_point(chunk, [&](const Vec3f& centre, float radius) {
        search.take(wide(centre), static_cast<double>(radius));
    });
}

/// Looks first where the bound is greatest: it then spares nearly all else.
template <typename Search>
void FramedGeometry::run(Search& search) const {
    search.enter(nullptr);
    for (const Vec3d& corner : corners_)
        search.take(corner, 0);
    const auto each_chunk = [&](const auto& visit) {
        for (const Item& item : items_) {
            search.enter(item.world_from_object);
            if (!(search.bound(item.box) > search.best)) continue;
            for (size_t i = item.chunks.first; i < item.chunks.first + item.chunks.count; ++i) {
                const double bound = search.bound(chunks_[i].box);
                if (bound > search.best) visit(item, chunks_[i], bound);
            }
        }
    };
    const Item* likely_item = nullptr;
    const Chunk* likely = nullptr;
    double most = -INFINITY;
    each_chunk([&](const Item& item, const Chunk& chunk, double bound) {
        if (!(bound > most)) return;
        most = bound;
        likely_item = &item;
        likely = &chunk;
    });
    if (likely == nullptr) return;
    search.enter(likely_item->world_from_object);
    look_into(*likely, search);
    each_chunk([&](const Item&, const Chunk& chunk, double) { look_into(chunk, search); });
}

void FramedGeometry::add_chunks(size_t primitive) {
    Range& range = chunks_of_primitive_[primitive];
    if (range.count != 0) return;
    const Primitive& source = scene_->primitives[primitive];
    range.first = chunks_.size();
    for (int32_t done = 0; done < source.triangle_count; done += chunk_size) {
        const int32_t count = std::min(chunk_size, source.triangle_count - done);
        chunks_.push_back({primitive, source.first_triangle + done, count, no_box});
    }
    range.count = chunks_.size() - range.first;
}

void FramedGeometry::add_item(size_t primitive, const Affinef* world_from_object) {
    add_chunks(primitive);
    items_.push_back({chunks_of_primitive_[primitive], no_box, world_from_object});
}

void FramedGeometry::add_corners(const Vec3f& low, const Vec3f& high) {
    for (int i = 0; i < 8; ++i)
        corners_.push_back(corner_of({low, high}, i));
}

FramedGeometry::FramedGeometry(const Bounds& box) {
    if (!box.empty()) add_corners(box.low, box.high);
    box_ = box;
}

FramedGeometry::FramedGeometry(const Scene& scene, const std::vector<char>& nodes)
    : scene_(&scene) {
    const auto counts = [&](int32_t node, int32_t other) {
        const int32_t named = node >= 0 ? node : other;
        return nodes.empty() || (named >= 0 && nodes[static_cast<size_t>(named)] != 0);
    };
    chunks_of_primitive_.resize(scene.primitives.size());
    for (size_t i = 0; i < static_cast<size_t>(scene.world_primitive_count); ++i) {
        if (counts(scene.primitives[i].node, -1)) add_item(i, nullptr);
    }
    for (const Instance& instance : scene.instances) {
        const Mesh& mesh = scene.meshes[static_cast<size_t>(instance.mesh)];
        const auto first = static_cast<size_t>(mesh.first_primitive);
        const size_t end = first + static_cast<size_t>(mesh.primitive_count);
        for (size_t primitive = first; primitive < end; ++primitive) {
            if (counts(scene.primitives[primitive].node, instance.node))
                add_item(primitive, &instance.world_from_object);
        }
    }
    for (const SplatGroup& group : scene.splats.groups) {
        if (!counts(group.node, -1)) continue;
        Box around = no_box;
        for (size_t i = 0; i < scene.splats.boxes.size(); ++i) {
            const auto owner = static_cast<size_t>(scene.splats.group_of_block[i]);
            if (&scene.splats.groups[owner] != &group) continue;
            grow(around, scene.splats.boxes[i].low, scene.splats.boxes[i].high);
        }
        if (around[0].x <= around[1].x) add_corners(around[0], around[1]);
    }
    parallel_for(chunks_.size(), [&](size_t i) {
        each_point(chunks_[i], [&](const Vec3f& centre, float radius) {
            grow(chunks_[i].box, centre - splat3(radius), centre + splat3(radius));
        });
    });
    for (Item& item : items_) {
        for (size_t i = item.chunks.first; i < item.chunks.first + item.chunks.count; ++i)
            grow(item.box, chunks_[i].box[0], chunks_[i].box[1]);
    }
    std::erase_if(items_, [](const Item& item) { return !(item.box[0].x <= item.box[1].x); });
    box_ = find_box();
}

Vec3d FramedGeometry::farthest(const Vec3d& direction) const {
    AlongDirection search(direction);
    run(search);
    return search.point;
}

double FramedGeometry::farthest_from(const Vec3d& centre) const {
    FromCentre search(centre);
    run(search);
    return std::max(search.best, 0.0);
}

Bounds FramedGeometry::find_box() const {
    Bounds out;
    if (empty()) return out;
    out.low = {static_cast<float>(farthest({-1, 0, 0}).x),
               static_cast<float>(farthest({0, -1, 0}).y),
               static_cast<float>(farthest({0, 0, -1}).z)};
    out.high = {static_cast<float>(farthest({1, 0, 0}).x),
                static_cast<float>(farthest({0, 1, 0}).y),
                static_cast<float>(farthest({0, 0, 1}).z)};
    return out;
}

const FramedGeometry& KeptGeometry::of(const Scene& scene, const std::vector<char>& nodes) {
    if (geometry_ && nodes_ == nodes) {
        geometry_->follow(scene);
    } else {
        nodes_ = nodes;
        geometry_.emplace(scene, nodes);
    }
    return *geometry_;
}

}  // namespace obscura
