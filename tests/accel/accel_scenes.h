// tests/accel/accel_scenes.h - ray columns, their hits, and scenes to trace.
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "accel/accel.h"
#include "stages/dispatch.h"

#include "support/random.h"
#include "support/scene_builder.h"
#include <cmath>
#include <memory>
#include <stdexcept>
#include <string>
#include <utility>
#include <vector>

namespace obscura::test {

#ifdef OBSCURA_DEBUG
inline constexpr int thorough = 20;  ///< sample counts are divided by this
#else
inline constexpr int thorough = 1;
#endif

inline constexpr Coherence both_ways[] = {Coherence::coherent, Coherence::incoherent};

/// Rays with their hits; columns are padded to whole packets.
class RayList {
public:
    void add(const Vec3f& origin, const Vec3f& direction, float tfar = 3e38F) {
        const float numbers[7] = {
            origin.x, origin.y, origin.z, direction.x, direction.y, direction.z, tfar};
        for (size_t c = 0; c < 7; ++c)
            ray_[c].push_back(numbers[c]);
        key_.push_back(static_cast<uint32_t>(key_.size()) * 0x9E3779B9U);
    }

    int count() const { return static_cast<int>(key_.size()); }
    Vec3f origin(int i) const { return {at(0, i), at(1, i), at(2, i)}; }
    Vec3f direction(int i) const { return {at(3, i), at(4, i), at(5, i)}; }

    /// Returns the number of refused rays; hits are in the members below.
    int intersect(const Accel& accel, Coherence coherence, SeeThrough see_through = {}) {
        const RayColumns rays = pad();
        const size_t padded = ray_[0].size() + 16;
        for (std::vector<float>* column : {&t, &u, &v})
            column->assign(padded, -7.0F);
        for (std::vector<int32_t>* column : {&instance, &primitive, &triangle})
            column->assign(padded, -7);
        const HitColumns hits{
            t.data(), u.data(), v.data(), instance.data(), primitive.data(), triangle.data()};
        const int refused = accel.intersect(rays, hits, coherence, see_through);
        unpad();
        return refused;
    }

    /// passes_thin_walls: as Accel::occluded does where it is given `thin_walls`
    int occlude(const Accel& accel,
                Coherence coherence,
                uint32_t segment = 0,
                bool passes_thin_walls = false) {
        const RayColumns rays = pad();
        occluded.assign(ray_[0].size() + 16, 9);
        thin_walls.assign(ray_[0].size() + 16, 0);
        const int refused =
            accel.occluded(rays,
                           occluded.data(),
                           coherence,
                           {.segment = segment,
                            .thin_walls = passes_thin_walls ? thin_walls.data() : nullptr,
                            .passes = passes});
        unpad();
        return refused;
    }

    std::vector<MetSurface> list_surfaces(const Accel& accel,
                                          Coherence coherence,
                                          const SeeThrough& see_through = {}) {
        std::vector<MetSurface> out;
        accel.list_surfaces(pad(), coherence, see_through, out);
        unpad();
        return out;
    }

    /// The boundaries of media along one ray, by a query of its own.
    std::vector<Crossing> list_crossings(const Accel& accel,
                                         int index,
                                         const SeeThrough& see_through) {
        std::vector<Crossing> out;
        accel.list_crossings(pad(), index, see_through, out);
        unpad();
        return out;
    }

    bool hit(int i) const { return primitive[static_cast<size_t>(i)] >= 0; }

    std::vector<float> t, u, v;
    std::vector<int32_t> instance, primitive, triangle;
    std::vector<uint8_t> occluded;
    std::vector<uint8_t> thin_walls;
    uint8_t passes = 0;  ///< of occlude, see ShadowQuery

private:
    float at(size_t column, int i) const { return ray_[column][static_cast<size_t>(i)]; }

    RayColumns pad() {
        count_ = key_.size();
        for (auto& column : ray_)  // what lies past the last ray may be anything
            column.resize(count_ + 16, std::nanf(""));
        key_.resize(count_ + 16, 0U);
        return {ray_[0].data(),
                ray_[1].data(),
                ray_[2].data(),
                ray_[3].data(),
                ray_[4].data(),
                ray_[5].data(),
                ray_[6].data(),
                key_.data(),
                static_cast<int>(count_)};
    }
    void unpad() {
        const auto kept = static_cast<std::ptrdiff_t>(count_);
        for (auto& column : ray_)
            column.erase(column.begin() + kept, column.end());
        key_.erase(key_.begin() + kept, key_.end());
    }

    std::vector<float> ray_[7];
    std::vector<uint32_t> key_;
    size_t count_ = 0;
};

/// A scene that does not move, with its hierarchy.
struct BuiltScene {
    std::unique_ptr<Scene> scene;
    Accel accel;
};

inline BuiltScene build(Scene scene, const std::string& embree_isa = "") {
    auto kept = std::make_unique<Scene>(std::move(scene));
    auto accel = Accel::build(*kept, embree_isa);
    if (!accel) throw std::runtime_error(accel.error().message);
    return {std::move(kept), std::move(*accel)};
}

/// Every instruction set that this CPU has.
inline std::vector<Isa> all_isas() {
    std::vector<Isa> out;
    for (const Isa isa : {Isa::baseline, Isa::avx2, Isa::avx512}) {
        if (has_isa(isa)) out.push_back(isa);
    }
    return out;
}

/// Turns a scene's primitives into one mesh that is placed once for each map.
inline Scene instanced(Scene scene, const std::vector<Affined>& placings) {
    scene.world_primitive_count = 0;
    scene.meshes = {{0, static_cast<int32_t>(scene.primitives.size())}};
    for (const Affined& placing : placings) {
        Instance instance;
        instance.world_from_object = affine_cast<float>(placing);
        instance.object_from_world =
            affine_cast<float>(inverse(affine_cast<double>(instance.world_from_object)));
        instance.mirrored = determinant(placing) < 0 ? 1 : 0;
        scene.instances.push_back(instance);
    }
    return scene;
}

inline Affined scaling(double x, double y, double z, const Vec3d& translation = {0, 0, 0}) {
    Affined a;
    a.m[0][0] = x;
    a.m[1][1] = y;
    a.m[2][2] = z;
    a.m[0][3] = translation.x;
    a.m[1][3] = translation.y;
    a.m[2][3] = translation.z;
    return a;
}

/// Makes the sphere of SceneBuilder closed: its seam and poles share their vertices.
inline void weld_sphere(Scene& scene, int rings) {
    const auto columns = static_cast<uint32_t>(2 * rings);
    for (uint32_t& index : scene.indices) {
        const uint32_t row = index / (columns + 1);
        uint32_t column = index % (columns + 1);
        if (column == columns || row == 0 || row == static_cast<uint32_t>(rings)) column = 0;
        index = row * (columns + 1) + column;
    }
}

inline float between(Pcg32& random, float low, float high) {
    return low + (high - low) * random.next_float();
}

inline Vec3f random_unit(Pcg32& random) {
    const float x = random.next_float();
    return uniform_sphere(Vec2f{x, random.next_float()});
}

inline Vec3f random_in_cube(Pcg32& random, float half) {
    const float x = between(random, -half, half);
    const float y = between(random, -half, half);
    return {x, y, between(random, -half, half)};
}

}  // namespace obscura::test
