// tests/crosscheck/injected_faults_test.cpp - wrong answers of Embree, of every kind, are detected.
// SPDX-License-Identifier: Apache-2.0
#include "crosscheck/budget.h"
#include "crosscheck/check_scenes.h"

#include <bit>
#include <gmock/gmock.h>

namespace obscura::crosscheck {
namespace {

using namespace test;

/// Spoils the answer to one ray.
using Spoil = std::function<void(const TrueRay&, Answer&)>;

/// Hits a fraction of the rays, by their direction alone.
bool is_chosen(const TrueRay& ray, uint64_t every) {
    uint64_t hash = 0;
    for (const double c : {ray.direction.x, ray.direction.y, ray.direction.z})
        hash = RandomStream(hash ^ std::bit_cast<uint64_t>(c)).next();
    return hash % every == 0;
}

Kernel spoilt(const Kernel& kernel, uint64_t every, const Spoil& spoil) {
    Kernel out = kernel;
    out.ask = [=](RayBlock& rays, std::vector<Answer>& answers) {
        kernel.ask(rays, answers);
        for (int i = 0; i < rays.count(); ++i) {
            const TrueRay ray = rays.true_ray(i);
            if (is_chosen(ray, every)) spoil(ray, answers[static_cast<size_t>(i)]);
        }
    };
    return out;
}

/// A ball of triangles, a cube of coplanar ones, both again turned and scaled, and shapes.
Scene mixed_scene() {
    SceneBuilder builder;
    const int32_t material = builder.material({});
    builder.sphere({1.5F, 0.2F, 0}, 0.9F, 24, material, true, true);
    builder.quad({-2, -1, 0}, {1.5F, 0, 0}, {0, 1.5F, 0.2F}, material);
    builder.quad({-3, -1, 1}, {1.5F, 0, 0}, {0, 1.5F, 0.2F}, material);
    Scene scene = builder.take();
    add_shape(scene, make_shape(ShapeKind::sphere, 0.7F), material);
    Affined place;
    place.m[0][0] = 2;
    place.m[1][1] = -0.5;
    place.m[0][3] = 0.5;
    place.m[1][3] = 2;
    add_shape(scene, make_shape(ShapeKind::frustum, 1, 0.7F, 0.3F), material, place);
    return scene;
}

class InjectedFaults : public testing::Test {
protected:
    static constexpr uint64_t ray_count = 8 * 9216;

    void SetUp() override {
        auto built = ReferenceKernels::build(scene_, {});
        ASSERT_TRUE(built);
        kernels_ = std::make_shared<const ReferenceKernels>(std::move(*built));
        compare_kernel(truth_, batch_, truth_kernel(truth_), {}, {.answers = &truths_});
        truths_.is_truth = true;
    }

    /// Verdicts on Embree's spoilt answers.
    PairFigures figures(bool occlusion, uint64_t every, const Spoil& spoil) {
        const Kernel kernel = make_kernel(kernels_, {"robust 16", 16, occlusion});
        return compare_kernel(truth_, batch_, spoilt(kernel, every, spoil), {&truths_}, {})[0];
    }

    static std::vector<std::string> faults(const PairFigures& pair) {
        CheckedScene checked;
        checked.pairs = {pair};
        checked.faults = faults_of(checked);
        const Result<void> within = check_budget({checked});
        EXPECT_EQ(within ? "" : within.error().id, checked.faults.empty() ? "" : "E-CROSSCHECK");
        return checked.faults;
    }

    Scene scene_ = mixed_scene();
    TrueScene truth_{scene_};
    RaySet rays_{truth_, few_rays(ray_count)};
    RayBatch batch_ = batches_of(rays_)[0];
    AnswerList truths_;
    std::shared_ptr<const ReferenceKernels> kernels_;
};

TEST_F(InjectedFaults, NothingSpoiltIsWithinTheBudget) {
    const auto nothing = [](const TrueRay&, Answer&) {};
    for (const bool occlusion : {false, true}) {
        const PairFigures pair = figures(occlusion, 1, nothing);
        EXPECT_THAT(faults(pair), testing::IsEmpty());
        EXPECT_GT(pair.total().hits, ray_count / 8);
        EXPECT_LT(pair.total().hits, ray_count);
    }
}

TEST_F(InjectedFaults, TheNameOfAnotherItemIsSeen) {
    const PairFigures neighbour =
        figures(false, 100, [](const TrueRay&, Answer& answer) { answer.item.element ^= 1; });
    EXPECT_GT(neighbour.total().of(Verdict::item), 100U);
    EXPECT_THAT(faults(neighbour), testing::Not(testing::IsEmpty()));
    const PairFigures first =
        figures(false, 100, [](const TrueRay&, Answer& answer) { answer.item.element = 0; });
    EXPECT_GT(first.total().of(Verdict::item), 100U);
    // A triangle, a primitive, an instance that do not exist.
    for (const Item& item : {Item{-1, 0, 100000}, Item{-1, 77, 0}, Item{9, 0, 0}, Item{0, 0, 0}}) {
        const PairFigures none = figures(false, 1000, [&](const TrueRay&, Answer& answer) {
            if (answer.found()) answer.item = item;
        });
        EXPECT_GT(none.total().of(Verdict::item), 10U);
    }
}

TEST_F(InjectedFaults, PlacesAndNormalsOfElsewhereAreSeen) {
    const auto spoil_uv = [](const TrueRay&, Answer& answer) {
        answer.place.u = 0.1;
        answer.place.v = 0.1;
    };
    const auto spoil_ng = [](const TrueRay&, Answer& answer) {
        answer.place.ng.x *= -1;
        answer.place.ng.y *= 2;
    };
    const auto swap_uv = [](const TrueRay&, Answer& answer) {
        std::swap(answer.place.u, answer.place.v);
    };
    for (const Spoil& spoil : {Spoil(spoil_uv), Spoil(spoil_ng), Spoil(swap_uv)}) {
        const PairFigures all = figures(false, 1, spoil);
        EXPECT_GT(all.total().of(Verdict::place), 1000U);
        EXPECT_THAT(faults(all), testing::Not(testing::IsEmpty()));
    }
    EXPECT_GT(figures(false, 1000, spoil_uv).total().of(Verdict::place), 5U);
}

TEST_F(InjectedFaults, WrongDepthsAndMissesAreSeen) {
    for (const double factor : {1 + 1e-5, 1 + 1e-3}) {
        const PairFigures pair =
            figures(false, 1000, [&](const TrueRay&, Answer& answer) { answer.t *= factor; });
        EXPECT_GT(pair.total().unexplained(), 5U) << factor;
        EXPECT_THAT(faults(pair), testing::Not(testing::IsEmpty()));
    }
    const PairFigures missed =
        figures(false, 1000, [](const TrueRay&, Answer& answer) { answer = {}; });
    EXPECT_GT(missed.total().of(Verdict::missed), 5U);
}

/// Errors as a shape's callback would make them: in depth, or in its bounds.
TEST_F(InjectedFaults, ShapesAtWrongDepthsAndInBoxesTooSmallAreSeen) {
    const auto is_shape = [&](const Answer& answer) {
        return answer.found() && !truth_.is_triangle(answer.item);
    };
    const PairFigures deep = figures(false, 100, [&](const TrueRay&, Answer& answer) {
        if (is_shape(answer)) answer.t *= 1 + 1e-5;
    });
    EXPECT_GT(deep.total().of(Verdict::depth), 10U);
    const PairFigures cut = figures(false, 1, [&](const TrueRay& ray, Answer& answer) {
        if (!is_shape(answer) || answer.item.instance >= 0) return;
        if (std::abs(ray.origin.x + ray.direction.x * answer.t) > 0.97 * 0.7) answer = {};
    });
    EXPECT_GT(cut.total().unexplained(), 3U);
    EXPECT_THAT(faults(cut), testing::Not(testing::IsEmpty()));
}

/// One in a thousand rays: some of them in each of the two answers.
TEST_F(InjectedFaults, FalseOcclusionAndFalseLightAreSeen) {
    const PairFigures dark =
        figures(true, 1000, [](const TrueRay&, Answer& answer) { answer.any = true; });
    EXPECT_GT(dark.total().of(Verdict::false_hit), 0U);
    EXPECT_THAT(faults(dark), testing::Not(testing::IsEmpty()));
    const PairFigures light =
        figures(true, 1000, [](const TrueRay&, Answer& answer) { answer.any = false; });
    EXPECT_GT(light.total().of(Verdict::missed), 0U);
    EXPECT_THAT(faults(light), testing::Not(testing::IsEmpty()));
}

/// In a closed room every unbounded ray is occluded; rays that end before the wall are not.
TEST(InjectedOcclusion, IsSeenInAClosedRoom) {
    const Scene scene = closed_cube();
    const TrueScene truth(scene);
    RaySetOptions options = few_rays(9216);
    options.camera = look_at({0.2F, 0.1F, 0.3F}, {0, 0, -1}, 0.8F, 64, 36);
    const RaySet rays(truth, options);
    const RayBatch batch = batches_of(rays)[0];
    AnswerList truths;
    compare_kernel(truth, batch, truth_kernel(truth), {}, {.answers = &truths});
    truths.is_truth = true;
    const Kernel dark{"dark",
                      [](RayBlock& block, std::vector<Answer>& answers) {
                          answers.assign(static_cast<size_t>(block.count()), {});
                          for (Answer& answer : answers)
                              answer.any = true;
                      },
                      true};
    const PairFigures pair = compare_kernel(truth, batch, dark, {&truths}, {})[0];
    const Tally& camera = pair.groups[static_cast<size_t>(RayGroup::camera)];
    EXPECT_GT(camera.of(Verdict::false_hit), camera.rays / 5);
    EXPECT_LT(camera.of(Verdict::false_hit), camera.rays / 3);
}

/// The whole check, with faults in every kernel: even the smallest exceeds the budget.
TEST(InjectedFault, OfEveryKindPutsTheWholeCheckOutsideOfTheBudget) {
    const Scene scene = mixed_scene();
    const auto faults_with = [&](uint64_t every, const Spoil& spoil) {
        Log log(Verbosity::quiet);
        CheckTask task{&scene, "test", "test.glb", few_rays(9216)};
        task.stand_in = [&](const Kernel& kernel) { return spoilt(kernel, every, spoil); };
        const auto checked = check_scene(task, log);
        EXPECT_TRUE(checked);
        return checked ? checked->faults.size() : 0;
    };
    EXPECT_EQ(faults_with(1, [](const TrueRay&, Answer&) {}), 0U);
    EXPECT_GT(faults_with(1000, [](const TrueRay&, Answer& answer) { answer.item.element ^= 1; }),
              0U);
    EXPECT_GT(faults_with(1, [](const TrueRay&, Answer& answer) { answer.place.u = 0.1; }), 0U);
}

}  // namespace
}  // namespace obscura::crosscheck
