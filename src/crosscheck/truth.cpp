// crosscheck/truth.cpp - finds nearest hits in double precision.
// SPDX-License-Identifier: Apache-2.0
#include "crosscheck/truth.h"

#include "crosscheck/segment_rounding.h"
#include "crosscheck/shape_side.h"
#include "crosscheck/truth_records.h"

#include <algorithm>
#include <cmath>

namespace obscura::crosscheck {

namespace {

TrueRay into(const Affined& object_from_world, const TrueRay& ray) {
    return {transform_point(object_from_world, ray.origin),
            transform_vector(object_from_world, ray.direction),
            ray.end};
}

Item placed(const Item& item, int32_t instance) {
    return {instance, item.primitive, item.element};
}

/// Passes on crossings that lie on the ray.
template <typename Take>
void take_ahead(const Crossings& found, const TrueRay& ray, const Item& item, const Take& take) {
    for (int k = 0; k < found.count; ++k) {
        if (found.t[k] > 0 && found.t[k] <= ray.end) take(found.t[k], item);
    }
}

}  // namespace

Affined absolute(const Affined& a) {
    Affined out;
    for (int r = 0; r < 3; ++r) {
        for (int c = 0; c < 4; ++c)
            out.m[r][c] = std::abs(a.m[r][c]);
    }
    return out;
}

TrueScene::TrueScene(const Scene& scene, double slack_m) : scene_(scene), slack_m_(slack_m) {
    groups_.push_back(make_group(0, scene.world_primitive_count));
    for (const Mesh& mesh : scene.meshes)
        groups_.push_back(make_group(mesh.first_primitive, mesh.primitive_count));
    add_object(0, -1);
    for (size_t i = 0; i < scene.instances.size(); ++i) {
        add_object(1 + static_cast<size_t>(scene.instances[i].mesh), static_cast<int32_t>(i));
    }
    std::vector<TrueBox> boxes;
    for (size_t i = 0; i < objects_.size(); ++i) {
        const Group& group = groups_[objects_[i].group];
        if (!group.infinite.empty()) infinite_objects_.push_back(i);
        if (group.items.size() == group.infinite.size()) continue;
        const TrueBox own = group.tree->bounds();
        TrueBox box;
        for (int k = 0; k < 8; ++k) {
            box.add(transform_point(objects_[i].world_from_object,
                                    {(k & 1) != 0 ? own.high.x : own.low.x,
                                     (k & 2) != 0 ? own.high.y : own.low.y,
                                     (k & 4) != 0 ? own.high.z : own.low.z}));
        }
        boxes.push_back(box.with_room());
        boxed_objects_.push_back(i);
    }
    objects_tree_.emplace(boxes);
}

TrueScene::Group TrueScene::make_group(int32_t first_primitive, int32_t count) const {
    Group group;
    std::vector<TrueBox> boxes;
    for (int32_t p = first_primitive; p < first_primitive + count; ++p) {
        const Primitive& primitive = scene_.primitives[static_cast<size_t>(p)];
        for (int32_t element = 0; element < primitive.triangle_count; ++element) {
            const Item item{-1, p, element};
            group.items.push_back(item);
            if (is_infinite(item)) group.infinite.push_back(item);
        }
    }
    std::stable_partition(group.items.begin(), group.items.end(), [&](const Item& item) {
        return !is_infinite(item);
    });
    for (size_t i = 0; i + group.infinite.size() < group.items.size(); ++i)
        boxes.push_back(box_of(group.items[i]));
    for (const Item& item : group.items)
        group.corners.push_back(is_triangle(item) ? corners_of(scene_, item) : Triangle<float>{});
    group.tree.emplace(boxes);
    return group;
}

void TrueScene::add_object(size_t group, int32_t instance) {
    Object object{group, instance, {}, {}};
    if (instance >= 0) {
        // The inverse in double of the single precision matrix that Embree gets.
        const Instance& record = scene_.instances[static_cast<size_t>(instance)];
        object.world_from_object = affine_cast<double>(record.world_from_object);
        object.object_from_world = inverse(object.world_from_object);
    }
    objects_.push_back(object);
    item_ends_.push_back(item_count() + groups_[group].items.size());
}

bool TrueScene::is_triangle(const Item& item) const {
    return is_mesh(scene_.primitives[static_cast<size_t>(item.primitive)]);
}

bool TrueScene::is_infinite(const Item& item) const {
    const Primitive& primitive = scene_.primitives[static_cast<size_t>(item.primitive)];
    if (primitive.geometry != static_cast<int32_t>(GeometryKind::shapes)) return false;
    const int32_t index = primitive.first_triangle + item.element;
    return is_unbounded(scene_.shapes[static_cast<size_t>(index)]);
}

ShapeRecord TrueScene::shape(const Item& item) const {
    const Primitive& primitive = scene_.primitives[static_cast<size_t>(item.primitive)];
    const int32_t number = primitive.first_triangle + item.element;
    const auto index = static_cast<size_t>(number);
    if (primitive.geometry == static_cast<int32_t>(GeometryKind::shapes)) {
        return scene_.shapes[index];
    }
    if (is_segment(item)) {
        const Capsule<double> own = curve_frame(item).capsule;
        ShapeRecord capsule;
        capsule.kind = static_cast<int32_t>(ShapeKind::capsule);
        capsule.size[0] = static_cast<float>(own.half_height);
        capsule.size[1] = static_cast<float>(own.bottom);
        capsule.size[2] = static_cast<float>(own.top);
        return capsule;
    }
    ShapeRecord sphere;
    const float* at = &scene_.spheres[sphere_word(index)];
    for (int c = 0; c < 3; ++c)
        sphere.centre[c] = at[c * sphere_block];
    sphere.size[0] = at[3 * sphere_block];
    return sphere;
}

Triangle<double> TrueScene::own_triangle(const Item& item) const {
    return in_double(corners_of(scene_, item));
}

TrueBox TrueScene::box_of(const Item& item) const {
    TrueBox box;
    if (is_triangle(item)) {
        const Triangle<double> t = own_triangle(item);
        for (const Vec3d& p : {t.a, t.b, t.c})
            box.add(p);
        return box;
    }
    if (is_segment(item)) {
        const SegmentFrame<double> frame = curve_frame(item);
        for (const double end : {-1.0, 1.0}) {
            const Vec3d middle =
                frame.centre + frame.axes.normal * (end * frame.capsule.half_height);
            const double radius = end < 0 ? frame.capsule.bottom : frame.capsule.top;
            box.add(middle + splat3(radius));
            box.add(middle - splat3(radius));
        }
        return box.with_room();
    }
    const ShapeBox around = shape_bounds(shape(item));
    box.add(Vec3d{around.low.x, around.low.y, around.low.z});
    box.add(Vec3d{around.high.x, around.high.y, around.high.z});
    return box;
}

Crossings TrueScene::crossings(const Item& item, const TrueRay& ray) const {
    if (is_triangle(item)) return cross_triangle(own_triangle(item), ray);
    if (is_segment(item)) return cross_segment(item, ray);
    return cross_shape(shape(item), ray);
}

Crossings TrueScene::crossings(const Group& group, size_t k, const TrueRay& ray) const {
    const Item& item = group.items[k];
    return is_triangle(item) ? cross_triangle(in_double(group.corners[k]), ray)
                             : crossings(item, ray);
}

template <typename Take>
void TrueScene::visit_hits(const TrueRay& ray, const double& limit, const Take& take) const {
    objects_tree_->visit(ray, limit, [&](int32_t i) {
        const Object& object = objects_[boxed_objects_[static_cast<size_t>(i)]];
        const Group& group = groups_[object.group];
        const TrueRay own = into(object.object_from_world, ray);
        group.tree->visit(own, limit, [&](int32_t number) {
            const auto k = static_cast<size_t>(number);
            take_ahead(
                crossings(group, k, own), ray, placed(group.items[k], object.instance), take);
        });
    });
    for (const size_t i : infinite_objects_) {
        const Object& object = objects_[i];
        const TrueRay own = into(object.object_from_world, ray);
        for (const Item& item : groups_[object.group].infinite)
            take_ahead(crossings(item, own), ray, placed(item, object.instance), take);
    }
}

TrueHit TrueScene::nearest(const TrueRay& ray) const {
    TrueHit best;
    double limit = ray.end;
    visit_hits(ray, limit, [&](double t, const Item& item) {
        if (!(t < best.t)) return;
        best = {t, item};
        limit = t;
    });
    return best;
}

TrueHit TrueScene::nearest_of_all(const TrueRay& ray) const {
    TrueHit best;
    for (const Object& object : objects_) {
        const TrueRay own = into(object.object_from_world, ray);
        const Group& group = groups_[object.group];
        for (size_t k = 0; k < group.items.size(); ++k) {
            const Item item = placed(group.items[k], object.instance);
            take_ahead(crossings(group, k, own), ray, item, [&](double t, const Item&) {
                if (t < best.t) best = {t, item};
            });
        }
    }
    return best;
}

void TrueScene::all_hits(const TrueRay& ray, const std::function<void(double, Item)>& take) const {
    visit_hits(ray, ray.end, take);
}

void TrueScene::near_items(const TrueRay& ray,
                           double room_m,
                           const std::function<void(const Item&)>& take) const {
    const auto visit_object = [&](int32_t i) {
        const Object& object = objects_[boxed_objects_[static_cast<size_t>(i)]];
        const Group& group = groups_[object.group];
        const TrueRay own = into(object.object_from_world, ray);
        const double room =
            max_component(transform_vector(absolute(object.object_from_world), splat3(room_m)));
        const auto visit_item = [&](int32_t k) {
            const Item& item = group.items[static_cast<size_t>(k)];
            take(placed(item, object.instance));
        };
        group.tree->visit(own, ray.end, visit_item, room);
    };
    objects_tree_->visit(ray, ray.end, visit_object, room_m);
}

std::vector<double> TrueScene::meetings(const TrueRay& ray, const Item& item) const {
    std::vector<double> found;
    const Object& object = object_of(item);
    const TrueRay own = into(object.object_from_world, ray);
    take_ahead(crossings(item, own), ray, item, [&](double t, const Item&) { found.push_back(t); });
    return found;
}

const TrueScene::Object& TrueScene::object_of(const Item& item) const {
    const int32_t number = item.instance + 1;
    return objects_[static_cast<size_t>(number)];
}

Affined TrueScene::world_from_object(const Item& item) const {
    if (is_segment(item)) return world_from(curve_frame(item));
    return object_of(item).world_from_object;
}

Affined TrueScene::object_from_world(const Item& item) const {
    if (is_segment(item)) return inverse(world_from(curve_frame(item)));
    return object_of(item).object_from_world;
}

bool TrueScene::has(const Item& item) const {
    const auto number = static_cast<size_t>(int64_t{item.instance} + 1);
    if (item.instance < -1 || number >= objects_.size() || item.primitive < 0) return false;
    const Mesh world{0, scene_.world_primitive_count};
    const size_t group = objects_[number].group;
    const Mesh& mesh = group == 0 ? world : scene_.meshes[group - 1];
    const int64_t within = int64_t{item.primitive} - mesh.first_primitive;
    return within >= 0 && within < mesh.primitive_count && item.element >= 0 &&
           item.element < scene_.primitives[static_cast<size_t>(item.primitive)].triangle_count;
}

Item TrueScene::item(size_t number) const {
    const auto end = std::upper_bound(item_ends_.begin(), item_ends_.end(), number);
    const auto object = static_cast<size_t>(end - item_ends_.begin());
    const size_t before = object > 0 ? item_ends_[object - 1] : 0;
    Item item = groups_[objects_[object].group].items[number - before];
    item.instance = objects_[object].instance;
    return item;
}

Triangle<double> TrueScene::triangle(const Item& item) const {
    const Triangle<double> own = own_triangle(item);
    if (item.instance < 0) return own;
    const Affined& world = object_of(item).world_from_object;
    return {transform_point(world, own.a),
            transform_point(world, own.b),
            transform_point(world, own.c)};
}

double TrueScene::rounding_m(const TrueRay& ray, const Item& item, double t) const {
    Vec3d size = abs(ray.origin) + abs(ray.direction) * t;
    if (item.primitive >= 0 && !is_infinite(item)) {
        const TrueBox box = box_of(item);
        const Affined world = absolute(object_of(item).world_from_object);
        const Vec3d corners = transform_point(world, max3(abs(box.low), abs(box.high)));
        size = max3(size, abs(ray.origin) + corners);
    }
    if (item.instance >= 0) {
        const Affined world = absolute(object_of(item).world_from_object);
        const Affined object = absolute(object_of(item).object_from_world);
        const Vec3d moved{world.m[0][3], world.m[1][3], world.m[2][3]};
        // Embree rounds the origin minus the translation, then its product with the inverse.
        const Vec3d own = transform_vector(object, size + moved);
        size = max3(size, transform_vector(world, own) + moved);
    }
    double rounding = max_component(size) * ulp_of_one;
    if (item.primitive >= 0 && is_segment(item)) {
        // edge_ulps times the result covers Embree's error.
        rounding = std::max(rounding, SegmentRounding(segment(item), ray).surface_m(t) / edge_ulps);
    }
    // With slack, two answers are compared by way of this scene: each may be as far off.
    return slack_m_ > 0 ? std::max(slack_m_, 2 * rounding) : rounding;
}

Vec3d TrueScene::middle(const Item& item) const {
    Vec3d own;
    if (is_triangle(item)) {
        const TrueBox box = box_of(item);
        own = (box.low + box.high) * 0.5;
    } else if (is_segment(item)) {
        own = curve_frame(item).centre;
    } else {
        const ShapeRecord record = shape(item);
        own = {record.centre[0], record.centre[1], record.centre[2]};
    }
    return transform_point(object_of(item).world_from_object, own);
}

Vec3d TrueScene::normal(const Item& item, const Vec3d& place) const {
    const Affined object = object_from_world(item);
    if (is_triangle(item)) {
        const Triangle<double> own = own_triangle(item);
        return normalize(transform_normal(object, cross(own.b - own.a, own.c - own.a)));
    }
    return normalize(
        transform_normal(object, normal_of_shape(shape(item), transform_point(object, place))));
}

}  // namespace obscura::crosscheck
