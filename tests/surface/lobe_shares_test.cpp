// tests/surface/lobe_shares_test.cpp - each lobe has its own part of the light.
// SPDX-License-Identifier: Apache-2.0
#include "surface/lobe_shares.h"

#include <gtest/gtest.h>

#include "support/lane_arrays.h"
#include "support/layered_materials.h"

namespace obscura {
namespace {

using namespace test;

constexpr size_t lobe_count = Lobes::count;
using LobeValues = std::array<Vec3d, lobe_count>;

/// What each lobe sends from wi to wo, by its own formula, below the layers that cover it.
LobeValues values_of(const LayeredParams<double>& p,
                     const LayeredWeights<double>& w,
                     const Vec3d& wo,
                     const Vec3d& wi) {
    LobeValues out{};
    const auto at = [&](int lobe) -> Vec3d& { return out[static_cast<size_t>(lobe)]; };
    if (wi.z < 0) {
        const Transmission<double> pair{p, w, wo, wi, -wi.z};
        const double below = w.below_coat * w.below_sheen;
        at(Lobes::index<DiffuseTransmission>()) =
            DiffuseTransmission::evaluate(pair).value_cos * below;
        at(Lobes::index<FacetTransmission>()) = FacetTransmission::evaluate(pair).value_cos * below;
        return out;
    }
    const Reflection<double> pair{p, w, wo, wi, normalize(wo + wi)};
    const LayerValue<double> sheen = Sheen::evaluate(pair);
    const LayerValue<double> coat = Coat::evaluate(pair);
    const double below = sheen.passes * coat.passes * wi.z;
    at(Lobes::index<Diffuse>()) = Diffuse::evaluate(pair).value_cos * below;
    at(Lobes::index<FacetReflection>()) = FacetReflection::evaluate(pair).value_cos * below;
    at(Lobes::index<Sheen>()) = sheen.value_cos * coat.passes;
    at(Lobes::index<Coat>()) = coat.value_cos;
    return out;
}

Vec3d share_of(const LobeShares<double>& shares, size_t lobe) {
    return shares.is_known[lobe] ? shares.share[lobe] : Vec3d{0, 0, 0};
}

void expect_channel(double share, double value, double sum, size_t lobe) {
    EXPECT_TRUE(share >= 0 && share <= 1) << "lobe " << lobe << ": " << share;
    if (sum > 0) {
        EXPECT_NEAR(share, value / sum, 1e-6) << "lobe " << lobe;
    }
}

void expect_shares(const LobeShares<double>& shares, const LobeValues& values) {
    Vec3d sum{0, 0, 0};
    Vec3d all{0, 0, 0};
    for (size_t k = 0; k < lobe_count; ++k) {
        sum = sum + values[k];
        all = all + share_of(shares, k);
    }
    for (size_t k = 0; k < lobe_count; ++k) {
        const Vec3d share = share_of(shares, k);
        expect_channel(share.x, values[k].x, sum.x, k);
        expect_channel(share.y, values[k].y, sum.y, k);
        expect_channel(share.z, values[k].z, sum.z, k);
    }
    if (max_component(sum) > 0) {
        EXPECT_NEAR(max_component(all), 1, 1e-6);
    }
}

TEST(LobeShares, AreTheLobesPartsOfLayeredMaterials) {
    Pcg32 random(31);
    int with_sheen = 0;
    for (int n = 0; n < 20000; ++n) {
        const auto p = convert<double>(random_layers(random, 0.01F));
        const Vec3d wo = normalize(convert<double>(direction_above(random, 0.05F)));
        Vec3d wi = normalize(convert<double>(direction_above(random, 0.05F)));
        if (n % 3 == 0) wi.z = -wi.z;
        const LayeredWeights<double> w = layered_weights(p, wo);
        LobeShares<double> shares{};
        share_layered(p, w, {wo, wi, evaluate_layered(p, w, wo, wi).value_cos}, shares);
        expect_shares(shares, values_of(p, w, wo, wi));
        with_sheen += wi.z > 0 && max_component(p.sheen_color) > 0 ? 1 : 0;
        if (HasFailure()) FAIL() << "material " << n;
    }
    EXPECT_GT(with_sheen, 1000);
}

TEST(LobeShares, OfTheCoreMaterialAreThoseOfTheLayeredOneWithoutLayers) {
    Pcg32 random(32);
    for (int n = 0; n < 5000; ++n) {
        LayeredParams<double> p = convert<double>(plain_layers(0.01F + random.next_float()));
        p.base_color = {0.3, 0.6, random.next_double()};
        p.metallic = n % 3 == 0 ? 1.0 : random.next_double();
        const BsdfParams<double> core{p.base_color, p.metallic, p.alpha.x};
        const Vec3d wo = normalize(convert<double>(direction_above(random, 0.05F)));
        const Vec3d wi = normalize(convert<double>(direction_above(random, 0.05F)));
        const LobeWeights<double> weights = lobe_weights(core, wo.z);
        LobeShares<double> shares{};
        share_bsdf(core, weights, {wo, wi, evaluate_bsdf(core, weights, wo, wi).value_cos}, shares);
        expect_shares(shares, values_of(p, layered_weights(p, wo), wo, wi));
        if (HasFailure()) FAIL() << "material " << n;
    }
}

/// Which sides and lobes the lanes of a group have; their own lobes are the first lane's alone.
struct GroupCase {
    float side;                   ///< of wi: 1 above, -1 below
    float sheen, transmission;    ///< of the first lane
    float base, diffuse_through;  ///< of all lanes
};

LayeredParams<Lanes> group_params(const GroupCase& group) {
    const LayeredParams<float> p = plain_layers(0.2F);
    const Mask first = lane_numbers() == LanesI(0);
    LayeredParams<Lanes> many{};
    many.base_color = {Lanes(group.base), Lanes(0.5F), Lanes(0.0F)};
    many.metallic = many.coat = Lanes(0.0F);
    many.alpha = {Lanes(p.alpha.x), Lanes(p.alpha.y)};
    many.f0 = splat3(Lanes(p.f0.x));
    many.f90 = Lanes(p.f90);
    many.eta = Lanes(p.eta);
    many.solid = Mask(false);
    many.transmission = select(first, Lanes(group.transmission), Lanes(0.0F));
    many.diffuse_transmission = Lanes(group.diffuse_through);
    many.diffuse_transmission_color = {Lanes(0.0F), Lanes(1.0F), Lanes(0.5F)};
    many.sheen_color = splat3(select(first, Lanes(group.sheen), Lanes(0.0F)));
    many.sheen_alpha = many.coat_alpha = Lanes(1.0F);
    many.coat_normal = {Lanes(0.0F), Lanes(0.0F), Lanes(1.0F)};
    many.thin_film = {Lanes(0.0F), Lanes(1.3F), Lanes(400.0F)};
    return many;
}

/// The shares of all lobes in one lane: 0 for those that are not known.
using LaneShares = std::array<Vec3f, lobe_count>;

[[gnu::noinline]] std::array<LaneShares, 2> shares_of(const GroupCase& group) {
    const LayeredParams<Lanes> p = group_params(group);
    const Vec3<Lanes> wo = normalize(Vec3<Lanes>{Lanes(0.3F), Lanes(-0.2F), Lanes(0.9F)});
    const Vec3<Lanes> wi =
        normalize(Vec3<Lanes>{Lanes(-0.4F), Lanes(0.15F), Lanes(0.7F * group.side)});
    const LayeredWeights<Lanes> w = layered_weights(p, wo);
    LobeShares<Lanes> shares;
    share_layered(p, w, {wo, wi, evaluate_layered(p, w, wo, wi).value_cos}, shares);
    std::array<LaneShares, 2> out{};
    for (size_t k = 0; k < lobe_count; ++k) {
        if (!shares.is_known[k]) continue;
        for (int i = 0; i < 2; ++i)
            out[static_cast<size_t>(i)][k] = lane(shares.share[k], i);
    }
    return out;
}

TEST(LobeShares, OfALaneDoNotDependOnItsNeighbours) {
    for (const float side : {1.0F, -1.0F}) {
        const GroupCase plain{side, 0, 0, 0.5F, 0.4F};
        const LaneShares alone = shares_of(plain)[1];
        GroupCase cloth = plain;
        cloth.sheen = 0.8F;
        GroupCase glass = plain;
        glass.transmission = 0.7F;
        for (const GroupCase& group : {cloth, glass}) {
            const auto [first, second] = shares_of(group);
            for (size_t k = 0; k < lobe_count; ++k) {
                EXPECT_EQ(second[k].x, alone[k].x) << "lobe " << k << ", side " << side;
                EXPECT_EQ(second[k].y, alone[k].y) << "lobe " << k << ", side " << side;
                EXPECT_EQ(second[k].z, alone[k].z) << "lobe " << k << ", side " << side;
            }
        }
    }
}

TEST(LobeShares, AddUpToOneInEveryLane) {
    for (const float side : {1.0F, -1.0F}) {
        for (const auto& lane : shares_of({side, 0.8F, 0.7F, 0.0F, 0.4F})) {
            Vec3f sum{0, 0, 0};
            for (const Vec3f& share : lane)
                sum = sum + share;
            EXPECT_NEAR(sum.x, 1, 2 * share_rounding) << side;
            EXPECT_NEAR(sum.y, 1, 2 * share_rounding) << side;
            EXPECT_NEAR(sum.z, 1, 2 * share_rounding) << side;
        }
    }
}

/// As surfaces are below which a smooth lobe was taken away.
TEST(LobeShares, FacetsWithoutLightHaveNone) {
    Pcg32 random(34);
    for (int n = 0; n < 2000; ++n) {
        const BsdfParams<float> p{{random.next_float(), 0.5F, 1.0F}, 0.0F, 0.3F};
        const Vec3f wo = normalize(direction_above(random, 0.05F));
        const Vec3f wi = normalize(direction_above(random, 0.05F));
        LobeWeights<float> weights = lobe_weights(p, wo.z);
        weights.specular_f0 = weights.specular_rise = {0, 0, 0};
        LobeShares<float> shares{};
        share_bsdf(p, weights, {wo, wi, evaluate_bsdf(p, weights, wo, wi).value_cos}, shares);
        ASSERT_EQ(max_component(shares.share[Lobes::index<FacetReflection>()]), 0.0F) << n;
    }
}

}  // namespace
}  // namespace obscura
