// crosscheck/ray_set.h - the rays of a cross-check: the same ones in every run.
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "accel/columns.h"
#include "camera/camera.h"
#include "crosscheck/random.h"
#include "crosscheck/truth.h"

#include <algorithm>
#include <array>
#include <cstdint>
#include <vector>

namespace obscura::crosscheck {

/// How a ray was chosen. To add one: append it, raise ray_groups, give it a name in ray_group_names
/// and a case in RaySet::make_ray; group_pattern sets its frequency.
enum class RayGroup : int { camera, inside, outside, edge, vertex, grazing, far_origin, special };
inline constexpr size_t ray_groups = 8;
inline constexpr std::array<const char*, ray_groups> ray_group_names{
    "camera", "inside", "outside", "edge", "vertex", "grazing", "far", "special"};

/// Groups of unaimed rays, whose fractions mean something.
inline constexpr bool is_unaimed(RayGroup group) {
    return group == RayGroup::camera || group == RayGroup::inside || group == RayGroup::outside;
}

/// Rays in single precision, as Embree gets them.
class RayBlock {
public:
    void clear();
    void add(const Vec3d& origin, const Vec3d& direction);
    /// Rays have no ends by default.
    void set_end(int i, double end);
    int count() const { return static_cast<int>(key_.size()); }
    Vec3f origin(int i) const { return {at(0, i), at(1, i), at(2, i)}; }
    Vec3f direction(int i) const { return {at(3, i), at(4, i), at(5, i)}; }
    TrueRay true_ray(int i) const;
    /// Valid until the next add(); padded to whole packets.
    RayColumns columns();

private:
    float at(size_t column, int i) const { return ray_[column][static_cast<size_t>(i)]; }
    std::array<std::vector<float>, 6> ray_;
    std::vector<float> end_;  ///< empty: no ray has one
    std::vector<uint32_t> key_;
    std::array<std::vector<float>, 6> padded_;
};

/// Hits with room for whole packets.
class HitBlock {
public:
    HitColumns columns(int count);
    float t(int i) const { return number_[0][static_cast<size_t>(i)]; }
    float u(int i) const { return number_[1][static_cast<size_t>(i)]; }
    float v(int i) const { return number_[2][static_cast<size_t>(i)]; }
    Item item(int i) const;

private:
    std::array<std::vector<float>, 3> number_;
    std::array<std::vector<int32_t>, 3> index_;
};

inline constexpr uint64_t chunk_rays = 1024;

struct RaySetOptions {
    Camera camera;
    int width = 640;  ///< image of the camera's rays
    int height = 360;
    uint64_t rays = 1000000;
    uint64_t seed = 0;
};

/// Position of a camera ray on the screen.
struct ScreenPlace {
    int x = 0, y = 0;
};

/// Rays in chunks of chunk_rays, all of one group; a chunk's rays depend on its number alone.
class RaySet {
public:
    /// In   scene: outlives this object
    RaySet(const TrueScene& scene, const RaySetOptions& options);

    uint64_t count() const { return options_.rays; }
    size_t chunks() const;
    static RayGroup group(size_t chunk);
    void fill(size_t chunk, RayBlock& out) const;
    /// For rays of the group `camera`. Once every pixel had its centre, other points in pixels
    /// follow.
    ScreenPlace place(size_t chunk, int index) const;

private:
    struct SurfaceSample {
        Vec3d position, normal;
        bool is_corner = false;
    };
    void add_camera_ray(size_t chunk, int index, RayBlock& out) const;
    void add_ray(RayGroup group, RandomStream& random, RayBlock& out) const;
    SurfaceSample sample_triangle(const Item& item, RayGroup group, RandomStream& random) const;
    SurfaceSample sample_shape(const Item& item, RandomStream& random) const;
    TrueRay special_ray(const Item& item, RandomStream& random) const;
    Vec3d origin_around(RandomStream& random) const;

    const TrueScene& scene_;
    RaySetOptions options_;
    Vec3d centre_, half_;
    double radius_;
};

/// Some of a set's rays: `chunks` whole ones from `first_chunk` on.
struct RayBatch {
    const RaySet& rays;
    size_t first_chunk = 0;
    size_t chunks = 0;

    uint64_t first_ray() const { return first_chunk * chunk_rays; }
    uint64_t count() const { return std::min(rays.count() - first_ray(), chunks * chunk_rays); }
};

/// The whole set in batches, so that memory for answers does not grow with the rays.
std::vector<RayBatch> batches_of(const RaySet& rays);

}  // namespace obscura::crosscheck
