// tests/accel/replay_test.cpp - recorded rays have the same hits in bare Embree as in the queries.
// SPDX-License-Identifier: Apache-2.0
#include "accel/accel_scenes.h"
#include "accel/ray_recording.h"

#include <gtest/gtest.h>

#include "support/shape_scenes.h"
#include <bit>

namespace obscura::test {
namespace {

constexpr ReplayMode all_modes[] = {ReplayMode::single,
                                    ReplayMode::packets,
                                    ReplayMode::coherent_packets,
                                    ReplayMode::coherent_streams};
/// More than one thread takes at a time, and not whole packets.
constexpr size_t ray_count = 5003;

/// A ball of triangles, a sheet that a ray passes as its key decides, and an analytic sphere.
Scene things() {
    Material sheet;
    sheet.flags |= material_alpha_blend;
    sheet.base_color[3] = 0.5F;
    SceneBuilder builder;
    builder.sphere({0, 0, 0}, 1.0F, 12, builder.material({}));
    builder.quad({-2, -2, 1.5F}, {4, 0, 0}, {0, 4, 0}, builder.material(sheet));
    Scene scene = builder.take();
    ShapeRecord sphere = make_shape(ShapeKind::sphere, 0.5F);
    sphere.centre[1] = 1.5F;
    scene.primitives.push_back(shape_primitive(scene, sphere, 0));
    scene.world_primitive_count = static_cast<int32_t>(scene.primitives.size());
    pad_tables(scene);
    return scene;
}

/// Turned, moved and stretched, twice.
Scene placed_things() {
    return instanced(things(),
                     {scaling(1, 1, 1, {-1.25, 0, 0}), scaling(0.5, 1.5, -1, {1.25, 0.5, 0})});
}

/// Rays from around the origin to near it, every hundredth not finite, with the queries' answers.
class Rays {
public:
    explicit Rays(uint64_t seed) {
        Pcg32 random(seed);
        const auto within = [&](float half) {
            return Vec3f{half * (2 * random.next_float() - 1),
                         half * (2 * random.next_float() - 1),
                         half * (2 * random.next_float() - 1)};
        };
        for (size_t i = 0; i < ray_count; ++i) {
            const Vec3f origin = within(4);
            const Vec3f direction = normalize(within(2) - origin);
            const float x = is_refused(i) ? std::nanf("") : origin.x;
            const float numbers[] = {x, origin.y, origin.z, direction.x, direction.y, direction.z};
            for (size_t c = 0; c < 6; ++c)
                ray_[c][i] = numbers[c];
            end_[i] = 1 + 4 * random.next_float();
            key_[i] = random.next_uint();
        }
    }

    static bool is_refused(size_t i) { return i % 100 == 99; }
    bool is_hit(size_t i) const { return !is_refused(i) && index_[1][i] >= 0; }
    bool is_occluded(size_t i) const { return !is_refused(i) && occluded_[i] != 0; }
    float t(size_t i) const { return number_[0][i]; }

    /// Queries, and records the rays and the answers as a renderer does.
    void intersect(const Accel& accel,
                   Coherence coherence,
                   SeeThrough see_through,
                   RayRecorder& recorder) {
        const HitColumns hits{number_[0].data(),
                              number_[1].data(),
                              number_[2].data(),
                              index_[0].data(),
                              index_[1].data(),
                              index_[2].data()};
        accel.intersect(columns(false), hits, coherence, see_through);
        recorder.add_hits(columns(false), hits, see_through);
    }
    void occlude(const Accel& accel, uint32_t segment, RayRecorder& recorder) {
        accel.occluded(columns(true), occluded_.data(), Coherence::incoherent, {segment});
        recorder.add_shadows(columns(true), occluded_.data(), {segment});
    }

private:
    static constexpr size_t padded = ray_count + 16;  // whole packets are read and written

    RayColumns columns(bool with_end) const {
        return {ray_[0].data(),
                ray_[1].data(),
                ray_[2].data(),
                ray_[3].data(),
                ray_[4].data(),
                ray_[5].data(),
                with_end ? end_.data() : nullptr,
                key_.data(),
                static_cast<int>(ray_count)};
    }

    using Numbers = std::vector<float>;
    using Indices = std::vector<int32_t>;
    std::array<Numbers, 6> ray_ = {Numbers(padded),
                                   Numbers(padded),
                                   Numbers(padded),
                                   Numbers(padded),
                                   Numbers(padded),
                                   Numbers(padded)};
    Numbers end_ = Numbers(padded);
    std::vector<uint32_t> key_ = std::vector<uint32_t>(padded);
    std::array<Numbers, 3> number_ = {Numbers(padded), Numbers(padded), Numbers(padded)};
    std::array<Indices, 3> index_ = {Indices(padded), Indices(padded), Indices(padded)};
    std::vector<uint8_t> occluded_ = std::vector<uint8_t>(padded);
};

/// The expected result of a replay.
struct Expected {
    uint64_t hits = 0;
    uint64_t checksum = 0;

    void add(const Rays& rays) {
        for (size_t i = 0; i < ray_count; ++i) {
            if (!rays.is_hit(i)) continue;
            ++hits;
            checksum += std::bit_cast<uint32_t>(rays.t(i));
        }
    }
};

/// Rays of two threads, with the queries' answers.
struct Recorded {
    Recorded(const Accel& accel, Coherence coherence, SeeThrough see_through) {
        for (const uint64_t seed : {1U, 2U}) {
            Rays rays(seed);
            recording.threads.push_back(std::make_unique<RayRecorder>());
            rays.intersect(accel, coherence, see_through, *recording.threads.back());
            expected.add(rays);
        }
    }
    RayRecording recording;
    Expected expected;
};

/// The queries ask packets of 16, or streams of two.
void expect_same_hits(const Accel& accel, RayKind kind, SeeThrough see_through) {
    for (const ReplayMode mode : all_modes) {
        const bool coherent =
            mode == ReplayMode::coherent_packets || mode == ReplayMode::coherent_streams;
        const Recorded recorded(
            accel, coherent ? Coherence::coherent : Coherence::incoherent, see_through);
        const ReplayResult got = accel.replay(recorded.recording, kind, mode);
        const auto number = static_cast<int>(mode);
        EXPECT_EQ(recorded.recording.count(kind), 2 * (ray_count - ray_count / 100)) << number;
        EXPECT_EQ(recorded.recording.hits(kind), recorded.expected.hits) << number;
        EXPECT_GT(got.hits, ray_count / 2) << number;
        EXPECT_EQ(got.hits, recorded.expected.hits) << number;
        // A single ray may round the last digit of a depth differently here and there.
        const uint64_t most = mode == ReplayMode::single ? got.hits / 100 : 0;
        const auto off = static_cast<int64_t>(got.checksum - recorded.expected.checksum);
        EXPECT_LE(static_cast<uint64_t>(std::abs(off)), most) << number;
    }
}

TEST(Replay, CameraAndBouncedRaysHitAsInTheQueries) {
    for (const Isa isa : all_isas()) {
        const BuiltScene world = build(things(), embree_isa_for(isa));
        expect_same_hits(world.accel, RayKind::camera, {});
        expect_same_hits(world.accel, RayKind::bounce, {false, false, 3});
    }
}

TEST(Replay, InstancesAreHitAsInTheQueries) {
    for (const Isa isa : all_isas()) {
        const BuiltScene built = build(placed_things(), embree_isa_for(isa));
        expect_same_hits(built.accel, RayKind::camera, {});
        expect_same_hits(built.accel, RayKind::bounce, {false, false, 3});
    }
}

TEST(Replay, WhereAlphaIsACutItIsOneAgain) {
    const BuiltScene built = build(things());
    expect_same_hits(built.accel, RayKind::camera, {false, true, 0});
}

TEST(Replay, ShadowRaysAreOccludedAsInTheQueries) {
    for (const bool placed : {false, true}) {
        const BuiltScene built = build(placed ? placed_things() : things());
        RayRecording recording;
        uint64_t expected = 0;
        for (const uint64_t seed : {1U, 2U}) {
            Rays rays(seed);
            recording.threads.push_back(std::make_unique<RayRecorder>());
            rays.occlude(built.accel, 2, *recording.threads.back());
            for (size_t i = 0; i < ray_count; ++i)
                expected += rays.is_occluded(i) ? 1 : 0;
        }
        EXPECT_EQ(recording.hits(RayKind::shadow), expected);
        for (const ReplayMode mode : all_modes) {
            const ReplayResult got = built.accel.replay(recording, RayKind::shadow, mode);
            EXPECT_EQ(got.hits, expected) << static_cast<int>(mode);
            EXPECT_EQ(got.checksum, expected) << static_cast<int>(mode);
        }
        EXPECT_GT(expected, ray_count / 4);
        EXPECT_LT(expected, 2 * ray_count);
    }
}

TEST(Replay, OtherHitsGiveAnotherSum) {
    const BuiltScene built = build(things());
    const Recorded recorded(built.accel, Coherence::incoherent, {});
    Scene moved = things();
    for (float& x : moved.positions)
        x *= 1.0001F;
    const BuiltScene other = build(std::move(moved));
    const ReplayResult got =
        other.accel.replay(recorded.recording, RayKind::camera, ReplayMode::single);
    EXPECT_NE(got.checksum, recorded.expected.checksum);
}

TEST(Replay, WhatWasNotRecordedTakesNothing) {
    const BuiltScene built = build(things());
    const Recorded recorded(built.accel, Coherence::incoherent, {});
    for (const RayKind kind : {RayKind::bounce, RayKind::shadow}) {
        EXPECT_EQ(recorded.recording.count(kind), 0U);
        EXPECT_EQ(built.accel.replay(recorded.recording, kind, ReplayMode::packets).hits, 0U);
    }
}

}  // namespace
}  // namespace obscura::test
