// benchmarks/particle_benchmarks.cpp - a million spheres beside Embree's native sphere points.
// SPDX-License-Identifier: Apache-2.0
#include "accel/accel.h"
#include "accel/embree.h"
#include "accel/safe_ray.h"
#include "gltf/geometry/particles.h"
#include "math/sampler.h"
#include "math/warp.h"

#include <benchmark/benchmark.h>

#include "benchmarks/benchmarks.h"
#include <algorithm>
#include <atomic>
#include <memory>

namespace obscura::benchmarks {

namespace {

constexpr size_t sphere_count = 1000000;
constexpr int ray_count = 1 << 16;

struct Particles {
    Scene scene;
    std::optional<Accel> accel;
    std::vector<float> points;  ///< x, y, z, radius, in the order of the blocks
    RTCDevice device = nullptr;
    RTCScene native = nullptr;
    std::atomic<int64_t> native_bytes = 0;
    std::vector<float> columns[6];  ///< rays
    std::vector<uint32_t> keys;

    ~Particles() {
        if (native != nullptr) rtcReleaseScene(native);
        if (device != nullptr) rtcReleaseDevice(device);
    }
    RayColumns rays() const {
        return {columns[0].data(),
                columns[1].data(),
                columns[2].data(),
                columns[3].data(),
                columns[4].data(),
                columns[5].data(),
                nullptr,
                keys.data(),
                ray_count};
    }
};

float unit(uint32_t i, uint32_t use) {
    return unit_float<float>(hash_word(i * 0x9E3779B9U + use));
}

/// Spheres at random in a cube of 2 m, of radii that leave rays about three times its edge to go.
void make_spheres(Particles& out) {
    std::vector<float> positions(3 * sphere_count);
    std::vector<float> radii(sphere_count);
    for (uint32_t i = 0; i < sphere_count; ++i) {
        for (uint32_t c = 0; c < 3; ++c)
            positions[3 * i + c] = 2.0f * unit(i, c) - 1.0f;
        radii[i] = 0.001f + 0.002f * unit(i, 3);
    }
    Primitive primitive;
    const gltf::ParticleRange range = gltf::append_spheres(positions, radii, out.scene);
    primitive.first_triangle = range.first;
    primitive.triangle_count = range.count;
    primitive.geometry = static_cast<int32_t>(GeometryKind::spheres);
    out.scene.positions.assign(4, 0.0f);
    out.scene.materials.resize(1);
    out.scene.primitives.push_back(primitive);
    out.scene.world_primitive_count = 1;
    out.points.resize(4 * sphere_count);
    for (size_t i = 0; i < sphere_count; ++i) {
        for (size_t c = 0; c < 4; ++c)
            out.points[4 * i + c] = out.scene.spheres[sphere_word(i) + c * sphere_block];
    }
}

bool count_bytes(void* user, ssize_t bytes, bool) {
    static_cast<std::atomic<int64_t>*>(user)->fetch_add(bytes, std::memory_order_relaxed);
    return true;
}

void build_native(Particles& out) {
    out.device = rtcNewDevice("");
    rtcSetDeviceMemoryMonitorFunction(out.device, count_bytes, &out.native_bytes);
    out.native = rtcNewScene(out.device);
    rtcSetSceneFlags(out.native, RTC_SCENE_FLAG_ROBUST);
    rtcSetSceneBuildQuality(out.native, RTC_BUILD_QUALITY_HIGH);
    RTCGeometry geometry = rtcNewGeometry(out.device, RTC_GEOMETRY_TYPE_SPHERE_POINT);
    rtcSetSharedGeometryBuffer(geometry,
                               RTC_BUFFER_TYPE_VERTEX,
                               0,
                               RTC_FORMAT_FLOAT4,
                               out.points.data(),
                               0,
                               16,
                               sphere_count);
    rtcSetGeometryMask(geometry, 0xFFFFFFFFU);
    rtcCommitGeometry(geometry);
    rtcAttachGeometry(out.native, geometry);
    rtcReleaseGeometry(geometry);
    rtcCommitScene(out.native);
}

/// Camera: from one point, pixel by pixel; else from anywhere in the cube to anywhere.
void make_rays(Particles& out, bool camera) {
    for (auto& column : out.columns)
        column.assign(ray_count + 16, 0.0f);
    out.keys.assign(ray_count + 16, 0U);
    for (uint32_t i = 0; i < ray_count; ++i) {
        const float x = static_cast<float>(i % 256) / 128.0f - 1.0f;
        const float y = static_cast<float>(i / 256) / 128.0f - 1.0f;
        const Vec3f origin =
            camera ? Vec3f{0, 0, 3}
                   : Vec3f{2 * unit(i, 4) - 1, 2 * unit(i, 5) - 1, 2 * unit(i, 6) - 1};
        const Vec3f direction = camera ? normalize(Vec3f{0.4f * x, 0.4f * y, -1})
                                       : uniform_sphere(Vec2f{unit(i, 7), unit(i, 8)});
        const float numbers[6] = {
            origin.x, origin.y, origin.z, direction.x, direction.y, direction.z};
        for (size_t c = 0; c < 6; ++c)
            out.columns[c][i] = numbers[c];
    }
}

Particles& particles() {
    static const auto made = [] {
        auto out = std::make_unique<Particles>();
        make_spheres(*out);
        auto accel = Accel::build(out->scene, "");
        if (accel) out->accel = std::move(*accel);
        build_native(*out);
        return out;
    }();
    return *made;
}

void note(benchmark::State& state, int64_t hits, double bytes) {
    state.SetItemsProcessed(state.iterations() * ray_count);
    state.counters["hits"] = static_cast<double>(hits);
    state.counters["bytes/sphere"] = bytes / static_cast<double>(sphere_count);
}

void ours(benchmark::State& state, bool camera) {
    Particles& p = particles();
    make_rays(p, camera);
    std::vector<float> numbers[3];
    std::vector<int32_t> indices[3];
    for (int i = 0; i < 3; ++i) {
        numbers[i].resize(ray_count + 16);
        indices[i].resize(ray_count + 16);
    }
    const HitColumns hits{numbers[0].data(),
                          numbers[1].data(),
                          numbers[2].data(),
                          indices[0].data(),
                          indices[1].data(),
                          indices[2].data()};
    for (auto _ : state) {
        p.accel->intersect(
            p.rays(), hits, camera ? Coherence::coherent : Coherence::incoherent, {});
        benchmark::ClobberMemory();
    }
    const auto found = std::count_if(indices[1].begin(),
                                     indices[1].begin() + ray_count,
                                     [](int32_t index) { return index >= 0; });
    note(state, found, static_cast<double>(p.accel->memory_bytes() + p.scene.spheres.size() * 4));
}

void native(benchmark::State& state, bool camera) {
    Particles& p = particles();
    make_rays(p, camera);
    int64_t found = 0;
    for (auto _ : state) {
        found = 0;
        QueryContext context;
        Query query(context, camera);
        const RayColumns rays = p.rays();
        alignas(64) int valid[16];
        std::fill_n(valid, 16, -1);
        for (int first = 0; first < ray_count; first += 16) {
            RTCRayHit16 block;
            const float* columns[6] = {rays.ox, rays.oy, rays.oz, rays.dx, rays.dy, rays.dz};
            float* fields[6] = {block.ray.org_x,
                                block.ray.org_y,
                                block.ray.org_z,
                                block.ray.dir_x,
                                block.ray.dir_y,
                                block.ray.dir_z};
            for (int c = 0; c < 6; ++c)
                std::copy_n(columns[c] + first, 16, fields[c]);
            std::fill_n(block.ray.tnear, 16, 0.0f);
            std::fill_n(block.ray.tfar, 16, unlimited);
            std::fill_n(block.ray.time, 16, 0.0f);
            std::fill_n(block.ray.mask, 16, 0xFFFFFFFFU);
            std::fill_n(block.ray.flags, 16, 0U);
            std::fill_n(block.hit.geomID, 16, RTC_INVALID_GEOMETRY_ID);
            std::fill_n(block.hit.instID[0], 16, RTC_INVALID_GEOMETRY_ID);
            query.intersect16(valid, p.native, &block);
            found += std::count(block.hit.geomID, block.hit.geomID + 16, 0U);
        }
    }
    note(state, found, static_cast<double>(p.native_bytes.load() + 16 * int64_t{sphere_count}));
}

}  // namespace

void register_particles() {
    for (const bool camera : {true, false}) {
        const std::string rays = camera ? "camera" : "random";
        benchmark::RegisterBenchmark(("particles/" + rays + "/blocks").c_str(), ours, camera);
        benchmark::RegisterBenchmark(("particles/" + rays + "/native").c_str(), native, camera);
    }
}

}  // namespace obscura::benchmarks
