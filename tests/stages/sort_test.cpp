// tests/stages/sort_test.cpp - hits and misses are separated; each keeps its own path.
// SPDX-License-Identifier: Apache-2.0
#include "accel/accel_scenes.h"
#include "render/light_bounds.h"
#include "render/prepared_scene.h"
#include "stages/wavefront.h"

#include <gtest/gtest.h>

namespace obscura::test {
namespace {

constexpr float untouched = -5.0f;
constexpr float background[4] = {0.125f, 0.25f, 0.5f, 0.75f};

/// The squares that paths hit in turn. The last two are 1024 apart: sorting treats them as one.
constexpr int surfaces[] = {0, 5, 1029};

float blue_of(int surface) {
    return 2.0f + static_cast<float>(surface);
}

/// A sun, and as many points of light that the light tree chooses among.
void add_lights(Scene& scene) {
    PunctualLight light;
    std::fill_n(light.intensity, 3, 1.0f);
    scene.lights.assign(min_tree_lights, light);
    light.type = static_cast<int32_t>(PunctualType::directional);
    light.direction[2] = -1;
    scene.lights.push_back(light);
}

/// Unlit squares that show their colours, and nothing around them.
PreparedScene unlit_squares(Isa isa, bool with_lights) {
    SceneBuilder builder;
    for (int surface = 0; surface <= surfaces[2]; ++surface) {
        Material m;
        m.flags = material_unlit;
        m.base_color[0] = 0.5f;
        m.base_color[1] = 0.25f;
        m.base_color[2] = blue_of(surface);
        builder.quad({-1, -1, 0}, {2, 0, 0}, {0, 2, 0}, builder.material(m));
    }
    Log log(Verbosity::quiet);
    Scene scene = builder.take();
    if (with_lights) add_lights(scene);
    auto prepared = PreparedScene::create(std::move(scene), {}, isa, log);
    if (!prepared) throw std::runtime_error(prepared.error().message);
    return std::move(*prepared);
}

class Sort : public testing::TestWithParam<Isa> {
protected:
    /// Shades paths of which those with is_hit hit a square; path i belongs to slot_of(i, count)
    /// and has the throughput own_of(i).
    void shade(const std::vector<bool>& is_hit, int bounce) {
        const int count = static_cast<int>(is_hit.size());
        for (int i = 0; i < count + 16; ++i)
            write_path(i, count, i < count && is_hit[static_cast<size_t>(i)]);
        BatchSettings batch;
        std::copy_n(background, 4, batch.background);
        const ShadeCounts out = stage_table_for(GetParam())
                                    .shade(scene_.impl().view(),
                                           batch,
                                           bounce,
                                           count,
                                           {work_.paths[0],
                                            work_.hits,
                                            work_.misses,
                                            work_.paths[1],
                                            work_.shadows,
                                            work_.samples});
        EXPECT_EQ(out.next, 0) << "unlit surfaces and misses end paths";
        EXPECT_EQ(out.shadow, 0);
    }

    void expect_slots(const std::vector<bool>& is_hit, int bounce) const {
        const int count = static_cast<int>(is_hit.size());
        const SampleColumns& s = work_.samples;
        for (int i = 0; i < count; ++i) {
            const int slot = slot_of(i, count);
            const float own = own_of(i);
            const bool hit = is_hit[static_cast<size_t>(i)];
            const float back = bounce == 0 && own > 0 ? 1.0f : 0.0f;
            EXPECT_EQ(s.r[slot], hit ? own * 0.5f : back * background[0]) << count << " " << i;
            EXPECT_EQ(s.g[slot], hit ? own * 0.25f : back * background[1]) << count << " " << i;
            EXPECT_EQ(s.b[slot], hit ? own * blue_of(surface_of(i)) : back * background[2])
                << count << " " << i;
            const float alpha = hit ? 1.0f : back * background[3];
            EXPECT_EQ(s.a[slot], bounce == 0 ? alpha : 0.0f) << count << " " << i;
        }
        for (int slot = count; slot < count + 16; ++slot) {
            EXPECT_EQ(s.r[slot], untouched);
            EXPECT_EQ(s.a[slot], untouched);
        }
    }

    /// In      fewest, most: of the squares that are hit
    void expect_own_surfaces(int fewest, int most) {
        Pcg32 random(13);
        for (surface_count_ = fewest; surface_count_ <= most; ++surface_count_) {
            for (const size_t count :
                 {size_t{1}, size_t{15}, size_t{16}, size_t{100}, size_t{batch_size}}) {
                std::vector<bool> mixed(count);
                for (size_t i = 0; i < count; ++i)
                    mixed[i] = random.next_float() < 0.7f;
                for (const std::vector<bool>& is_hit : {mixed, std::vector<bool>(count, true)}) {
                    shade(is_hit, 1);
                    expect_slots(is_hit, 1);
                }
            }
        }
    }

    PreparedScene scene_ = unlit_squares(GetParam(), false);
    int surface_count_ = 1;   ///< how many of `surfaces` are hit
    bool ascending_ = false;  ///< path i has sample index i, as from the camera; else reversed
    int dark_every_ = 0;      ///< every so many paths have no throughput; 0: none has

private:
    int slot_of(int i, int count) const { return ascending_ ? i : count - 1 - i; }

    float own_of(int i) const {
        return dark_every_ > 0 && i % dark_every_ == 0 ? 0.0f : static_cast<float>(i + 1);
    }

    /// Neighbouring paths hit different squares, in no order.
    int surface_of(int i) const { return surfaces[i * 5 / 3 % surface_count_]; }

    void write_path(int i, int count, bool hit) {
        const bool exists = i < count;
        const PathColumns& p = work_.paths[0];
        for (float* zero : {p.ox, p.oy, p.dx, p.dy, p.pdf, p.cone_width, p.cone_spread})
            zero[i] = 0;
        p.oz[i] = 3;
        p.dz[i] = -1;
        for (float* throughput : {p.tr, p.tg, p.tb})
            throughput[i] = own_of(i);
        p.slot[i] = exists ? static_cast<uint32_t>(slot_of(i, count)) : 0xFFFFFFFFU;
        p.key[i] = p.sample[i] = p.path_key[i] = p.medium_stack[i] =
            static_cast<uint32_t>(i) * 0x9E3779B9U;
        const HitColumns& h = work_.hits;
        h.t[i] = hit ? 3.0f : std::nanf("");
        h.u[i] = h.v[i] = hit ? 0.25f : std::nanf("");
        h.instance[i] = hit ? -1 : -7;
        // An entry past the last one claims a hit that is out of every table's range.
        h.primitive[i] = hit ? surface_of(i) : exists ? -1 : 0x7000000;
        h.triangle[i] = hit ? i % 2 : 0x7000000;
        const float clear = exists ? 0.0f : untouched;
        for (float* channel :
             {work_.samples.r, work_.samples.g, work_.samples.b, work_.samples.a}) {
            channel[i] = clear;
        }
    }

    Workspace work_;
};

INSTANTIATE_TEST_SUITE_P(EveryIsa, Sort, testing::ValuesIn(all_isas()), [](const auto& isa) {
    return stage_table_for(isa.param).isa;
});

TEST_P(Sort, HitsAreOpaqueAndMissesTakeTheBackground) {
    Pcg32 random(11);
    for (size_t count = 1; count <= 33; ++count) {
        std::vector<bool> mixed(count);
        std::vector<bool> alternating(count);
        for (size_t i = 0; i < count; ++i) {
            mixed[i] = random.next_float() < 0.5f;
            alternating[i] = i % 2 == 0;
        }
        for (const std::vector<bool>& is_hit :
             {mixed, alternating, std::vector<bool>(count, true), std::vector<bool>(count)}) {
            shade(is_hit, 0);
            expect_slots(is_hit, 0);
        }
    }
}

TEST_P(Sort, EachPathKeepsTheSurfaceThatItHits) {
    expect_own_surfaces(2, 3);
}

TEST_P(Sort, EachPathKeepsItAmongThoseThatTheLightTreeLights) {
    scene_ = unlit_squares(GetParam(), true);
    expect_own_surfaces(1, 3);
}

TEST_P(Sort, ShadowRaysInTheOrderOfTheirSlotsAreAddedTogether) {
    ascending_ = true;
    for (size_t count = 1; count <= 33; ++count) {
        for (const bool hits : {false, true}) {
            shade(std::vector<bool>(count, hits), 0);
            expect_slots(std::vector<bool>(count, hits), 0);
        }
    }
}

TEST_P(Sort, PathsThatStayAndPathsThatMoveUpKeepTheirOwn) {
    std::vector<bool> is_hit(107, true);  // on one surface: whole groups, then some misses
    std::fill_n(is_hit.begin() + 64, 3, false);
    for (const bool ascending : {false, true}) {
        for (const int bounce : {0, 1}) {
            ascending_ = ascending;
            shade(is_hit, bounce);
            expect_slots(is_hit, bounce);
        }
    }
}

TEST_P(Sort, WhereTheCameraShowsNothingThereIsNoBackground) {
    dark_every_ = 3;
    for (const bool ascending : {false, true}) {
        std::vector<bool> is_hit(64);
        for (size_t i = 0; i < is_hit.size(); ++i)
            is_hit[i] = i % 2 == 0 && i < 40;
        ascending_ = ascending;
        shade(is_hit, 0);
        expect_slots(is_hit, 0);
    }
}

TEST_P(Sort, LaterBouncesLeaveAlphaAndBackgroundAlone) {
    Pcg32 random(12);
    for (size_t count = 1; count <= 33; ++count) {
        std::vector<bool> is_hit(count);
        for (size_t i = 0; i < count; ++i)
            is_hit[i] = random.next_float() < 0.5f;
        shade(is_hit, 1);
        expect_slots(is_hit, 1);
    }
}

}  // namespace
}  // namespace obscura::test
