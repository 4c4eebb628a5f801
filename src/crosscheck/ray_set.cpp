// crosscheck/ray_set.cpp - the rays of a cross-check.
// SPDX-License-Identifier: Apache-2.0
#include "crosscheck/ray_set.h"

#include "crosscheck/special_lines.h"

#include <algorithm>
#include <cmath>

namespace obscura::crosscheck {

namespace {

constexpr std::array group_pattern = {RayGroup::camera,
                                      RayGroup::inside,
                                      RayGroup::outside,
                                      RayGroup::edge,
                                      RayGroup::camera,
                                      RayGroup::vertex,
                                      RayGroup::grazing,
                                      RayGroup::far_origin,
                                      RayGroup::special};

constexpr size_t batch_chunks = 4096;

/// Of the largest half edge of the scene's box.
constexpr double min_half = 1e-3;

/// Steps through all pixels of an image of any size up to its own: scattered, each once.
constexpr uint64_t pixel_step = 2654435761;  ///< prime

Vec3d tangent_to(const Vec3d& normal, RandomStream& random) {
    const Vec3d tangent = cross(normal, random.direction());
    return dot(tangent, tangent) > 0 ? normalize(tangent) : random.direction();
}

}  // namespace

void RayBlock::clear() {
    for (auto& column : ray_)
        column.clear();
    end_.clear();
    key_.clear();
}

void RayBlock::set_end(int i, double end) {
    end_.resize((key_.size() + 15) / 16 * 16, unlimited);
    end_[static_cast<size_t>(i)] = static_cast<float>(std::min(end, double{unlimited}));
}

void RayBlock::add(const Vec3d& origin, const Vec3d& direction) {
    const double numbers[6] = {origin.x, origin.y, origin.z, direction.x, direction.y, direction.z};
    for (size_t c = 0; c < 6; ++c)
        ray_[c].push_back(static_cast<float>(numbers[c]));
    key_.push_back(static_cast<uint32_t>(key_.size()));
}

TrueRay RayBlock::true_ray(int i) const {
    const Vec3f o = origin(i);
    const Vec3f d = direction(i);
    const float end = end_.empty() ? unlimited : end_[static_cast<size_t>(i)];
    const bool ends = end < unlimited;
    return {{o.x, o.y, o.z}, {d.x, d.y, d.z}, ends ? static_cast<double>(end) : INFINITY};
}

RayColumns RayBlock::columns() {
    const size_t padded = (key_.size() + 15) / 16 * 16;
    for (size_t c = 0; c < 6; ++c) {
        padded_[c] = ray_[c];
        padded_[c].resize(padded, ray_[c].empty() ? 0.0f : ray_[c].back());
    }
    const int filled = count();
    key_.resize(padded);
    key_.resize(static_cast<size_t>(filled));  // the memory behind it is kept
    return {padded_[0].data(),
            padded_[1].data(),
            padded_[2].data(),
            padded_[3].data(),
            padded_[4].data(),
            padded_[5].data(),
            end_.empty() ? nullptr : end_.data(),
            key_.data(),
            filled};
}

HitColumns HitBlock::columns(int count) {
    const auto padded = static_cast<size_t>(count + 15) / 16 * 16;
    for (auto& column : number_)
        column.resize(padded);
    for (auto& column : index_)
        column.resize(padded);
    return {number_[0].data(),
            number_[1].data(),
            number_[2].data(),
            index_[0].data(),
            index_[1].data(),
            index_[2].data()};
}

Item HitBlock::item(int i) const {
    const auto index = static_cast<size_t>(i);
    if (index_[1][index] < 0) return {};
    return {index_[0][index], index_[1][index], index_[2][index]};
}

RaySet::RaySet(const TrueScene& scene, const RaySetOptions& options)
    : scene_(scene), options_(options) {
    const TrueBox box = scene.bounds();
    const bool empty = !(box.low.x <= box.high.x);
    centre_ = empty ? Vec3d{0, 0, 0} : (box.low + box.high) * 0.5;
    half_ = empty ? Vec3d{1, 1, 1} : (box.high - box.low) * 0.5;
    // In a flat scene all rays inside would run along its surface.
    half_ = max3(half_, splat3(min_half * max_component(half_)));
    radius_ = std::max(length(half_), 1e-30);
}

size_t RaySet::chunks() const {
    return static_cast<size_t>((options_.rays + chunk_rays - 1) / chunk_rays);
}

std::vector<RayBatch> batches_of(const RaySet& rays) {
    std::vector<RayBatch> out;
    for (size_t first = 0; first < rays.chunks(); first += batch_chunks)
        out.push_back({rays, first, std::min(batch_chunks, rays.chunks() - first)});
    return out;
}

RayGroup RaySet::group(size_t chunk) {
    return group_pattern[chunk % group_pattern.size()];
}

ScreenPlace RaySet::place(size_t chunk, int index) const {
    const uint64_t before = chunk / group_pattern.size() * 2 + (chunk % group_pattern.size() > 0);
    const uint64_t number = before * chunk_rays + static_cast<uint64_t>(index);
    const auto width = static_cast<uint64_t>(options_.width);
    const uint64_t pixels = width * static_cast<uint64_t>(options_.height);
    const uint64_t pixel = number % pixels * (pixel_step % pixels) % pixels;
    return {static_cast<int>(pixel % width), static_cast<int>(pixel / width)};
}

void RaySet::fill(size_t chunk, RayBlock& out) const {
    out.clear();
    const uint64_t first = chunk * chunk_rays;
    const int filled = static_cast<int>(std::min(chunk_rays, options_.rays - first));
    for (int i = 0; i < filled; ++i) {
        if (group(chunk) == RayGroup::camera) {
            add_camera_ray(chunk, i, out);
        } else {
            RandomStream random((first + static_cast<uint64_t>(i)) ^ (options_.seed << 40));
            add_ray(group(chunk), random, out);
        }
    }
}

void RaySet::add_camera_ray(size_t chunk, int index, RayBlock& out) const {
    const ScreenPlace at = place(chunk, index);
    const uint64_t pixels =
        static_cast<uint64_t>(options_.width) * static_cast<uint64_t>(options_.height);
    RandomStream random(chunk * chunk_rays + static_cast<uint64_t>(index));
    const bool centre = chunk / group_pattern.size() * 2 * chunk_rays < pixels;
    const double dx = centre ? 0.5 : random.unit();
    const double dy = centre ? 0.5 : random.unit();
    const CameraRay<float> ray =
        generate_ray(options_.camera,
                     Vec2f{static_cast<float>((at.x + dx) / options_.width),
                           static_cast<float>((at.y + dy) / options_.height)});
    out.add({ray.origin.x, ray.origin.y, ray.origin.z},
            {ray.direction.x, ray.direction.y, ray.direction.z});
}

TrueRay RaySet::special_ray(const Item& item, RandomStream& random) const {
    const bool triangle = scene_.is_triangle(item);
    TrueRay line = triangle ? special_line(scene_.triangle(item), random)
                            : special_line(scene_.shape(item), random);
    if (triangle) {
        // Of rays in a triangle's own plane rounding decides everything: parallel to it is enough.
        const Triangle<double> t = scene_.triangle(item);
        const Vec3d normal = normalize(cross(t.b - t.a, t.c - t.a));
        if (std::abs(dot(normal, line.direction)) < 1e-3 * length(line.direction)) {
            line.origin = line.origin + normal * (length(t.b - t.a) * random.between(-0.5, 0.5));
        }
    } else {
        const Affined world = scene_.world_from_object(item);
        line = {transform_point(world, line.origin), transform_vector(world, line.direction)};
    }
    // Along its axis Embree misses whole segments (SegmentRounding): that would show nothing new.
    if (scene_.is_segment(item)) line.direction = random.direction();
    const double size = length(line.direction);
    line.direction = size > 0 ? line.direction * (1 / size) : random.direction();
    line.origin = line.origin - line.direction * (radius_ * random.between(0.1, 2));
    return line;
}

Vec3d RaySet::origin_around(RandomStream& random) const {
    if (random.unit() < 0.5) return centre_ + random.direction() * (2 * radius_);
    return centre_ +
           half_ * Vec3d{random.between(-1, 1), random.between(-1, 1), random.between(-1, 1)};
}

RaySet::SurfaceSample RaySet::sample_triangle(const Item& item,
                                              RayGroup group,
                                              RandomStream& random) const {
    const Triangle<double> t = scene_.triangle(item);
    const Vec3d corner[3] = {t.a, t.b, t.c};
    const Vec3d across = cross(t.b - t.a, t.c - t.a);
    const Vec3d normal = dot(across, across) > 0 ? normalize(across) : random.direction();
    const size_t first = random.below(3);
    const Vec3d& a = corner[first];
    const Vec3d& b = corner[(first + 1) % 3];
    const Vec3d& c = corner[(first + 2) % 3];
    if (group == RayGroup::vertex) return {a, normal, true};
    const double along = random.unit();
    if (group == RayGroup::edge) return {a + (b - a) * along, normal, true};
    const double root = std::sqrt(random.unit());
    return {a + (b - a) * (root * along) + (c - a) * (root * (1 - along)), normal, false};
}

RaySet::SurfaceSample RaySet::sample_shape(const Item& item, RandomStream& random) const {
    const ShapeRecord record = scene_.shape(item);
    const auto side = [&](float middle, float low, float high) {
        const auto m = static_cast<double>(middle);
        const bool infinite = !(std::abs(low) < 1e18f && std::abs(high) < 1e18f);
        return infinite ? m + random.between(-1, 1) * radius_
                        : random.between(static_cast<double>(low), static_cast<double>(high));
    };
    const ShapeBox box = shape_bounds(record);
    const Vec3d near{side(record.centre[0], box.low.x, box.high.x),
                     side(record.centre[1], box.low.y, box.high.y),
                     side(record.centre[2], box.low.z, box.high.z)};
    const SurfacePoint<double> point =
        surface_of_shape<double>(record.kind, UniformShape<double>(record), near);
    return {transform_point(scene_.world_from_object(item), point.position),
            normalize(transform_normal(scene_.object_from_world(item), point.normal)),
            false};
}

void RaySet::add_ray(RayGroup group, RandomStream& random, RayBlock& out) const {
    const Vec3d anywhere =
        centre_ +
        half_ * Vec3d{random.between(-1, 1), random.between(-1, 1), random.between(-1, 1)};
    if (group == RayGroup::inside || scene_.item_count() == 0) {
        out.add(anywhere, random.direction());
        return;
    }
    if (group == RayGroup::outside) {
        const Vec3d origin = centre_ + random.direction() * (2 * radius_);
        out.add(origin, normalize(anywhere - origin));
        return;
    }
    const Item item = scene_.item(random.below(scene_.item_count()));
    if (group == RayGroup::special) {
        const TrueRay line = special_ray(item, random);
        out.add(line.origin, line.direction);
        return;
    }
    const SurfaceSample at = scene_.is_triangle(item) ? sample_triangle(item, group, random)
                                                      : sample_shape(item, random);
    if (group == RayGroup::far_origin) {
        const double distance = radius_ * std::pow(10.0, random.between(1, 5));
        const Vec3d origin = at.position + random.direction() * distance;
        out.add(origin, normalize(at.position - origin));
        return;
    }
    if (at.is_corner) {
        const Vec3d origin = origin_around(random);
        out.add(origin, normalize(at.position - origin));
        return;
    }
    // Along the surface, or nearly: for shapes, silhouettes are the edges.
    const double lift = std::pow(10.0, random.between(-6, -1));
    const bool grazing = group == RayGroup::grazing;
    const Vec3d direction =
        normalize(tangent_to(at.normal, random) - at.normal * (grazing ? lift : 0.0));
    out.add(at.position - direction * (radius_ * random.between(0.1, 2)), direction);
}

}  // namespace obscura::crosscheck
