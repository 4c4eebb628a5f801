// tests/surface/bsdf_test.cpp - the BRDF's energy, symmetry, safety, and agreement of precisions.
// SPDX-License-Identifier: Apache-2.0
#include "surface/bsdf.h"

#include <gtest/gtest.h>

#include "support/bsdf_albedo.h"
#include "support/lane_arrays.h"
#include "support/random.h"
#include <cmath>

namespace obscura {
namespace {

using test::lane;

#ifdef OBSCURA_DEBUG
constexpr int random_cases = 50000;
#else
constexpr int random_cases = 1000000;
#endif

const Vec3d white{1, 1, 1};
const Vec3d black{0, 0, 0};

Vec3d widen(const Vec3f& v) {
    return {v.x, v.y, v.z};
}

BsdfParams<double> widen(const BsdfParams<float>& p) {
    return {widen(p.base_color), p.metallic, p.alpha};
}

BsdfParams<Lanes> spread(const BsdfParams<float>& p) {
    return {{p.base_color.x, p.base_color.y, p.base_color.z}, p.metallic, p.alpha};
}

Vec3<Lanes> spread(const Vec3f& v) {
    return {v.x, v.y, v.z};
}

/// Materials from mirror to chalk, the extremes often.
BsdfParams<float> random_material(Pcg32& random, float darkest) {
    const auto color = [&] { return darkest + (1.0F - darkest) * random.next_float(); };
    const uint32_t kind = random.next_uint();
    const float roughness = kind % 5 == 0 ? 0.0F : kind % 5 == 1 ? 1.0F : random.next_float();
    const float metallic = kind % 7 < 2 ? 0.0F : kind % 7 < 4 ? 1.0F : random.next_float();
    const float red = color();
    const float green = color();
    return {{red, green, color()}, metallic, std::max(roughness * roughness, min_ggx_alpha)};
}

/// Directions above the horizon, a third of them grazing down to cosine 1e-7.
Vec3f random_direction(Pcg32& random) {
    const uint32_t kind = random.next_uint() % 6;
    float z = random.next_float();
    if (kind == 0) z = std::pow(10.0F, -7.0F * random.next_float());
    if (kind == 1) z = 1e-7F;
    z = std::clamp(z, 1e-7F, 1.0F);
    const float radius = std::sqrt(1.0F - z * z);
    const SinCos<float> turn = sin_cos_turn(random.next_float());
    return {radius * turn.cos, radius * turn.sin, z};
}

/// Numbers in [0, 1), the ends often.
float random_number(Pcg32& random) {
    const uint32_t kind = random.next_uint() % 8;
    if (kind == 0) return 0.0F;
    if (kind == 1) return std::nextafter(1.0F, 0.0F);
    return random.next_float();
}

TEST(Bsdf, WhiteSurfacesReflectAllAtEveryRoughnessAndAngle) {
    for (double roughness = 0.05; roughness <= 1.0; roughness += 0.095) {
        for (const double cosine : {1.0, 0.95, 0.7, 0.4, 0.2, 0.1, 0.05, 0.02}) {
            const Vec3d wo = test::view_direction(cosine);
            for (const double metallic : {0.0, 0.3, 1.0}) {
                const auto p = test::bsdf_of(white, metallic, roughness);
                const double albedo = test::quadrature_albedo(p, wo).albedo.y;
                // Interpolation in the albedo table; wider only in the last degree before grazing.
                EXPECT_NEAR(albedo, 1, cosine < 0.05 ? 0.006 : 0.003)
                    << "roughness " << roughness << ", cosine " << cosine << ", " << metallic;
            }
        }
    }
}

TEST(Bsdf, AlbedoTableIsTheSpecularLobesIntegral) {
    Pcg32 random(1);
    for (int n = 0; n < 150; ++n) {
        const double roughness = 0.05 + 0.95 * random.next_double();
        const double cosine = 0.05 + 0.95 * random.next_double();
        const auto p = test::bsdf_of(black, 0.0, roughness);  // no diffuse part: specular only
        const double truth = test::quadrature_albedo(p, test::view_direction(cosine)).albedo.y;
        const double table = dielectric_lobe(specular_albedo(cosine, p.alpha)).albedo;
        EXPECT_NEAR(table, truth, 0.002) << "roughness " << roughness << ", cosine " << cosine;
    }
}

/// Fractions of white light that white facets reflect after one bounce: published values, and one
/// by another integration of the height-correlated form.
TEST(Bsdf, MaskingIsHeightCorrelated) {
    const auto once = [](double cosine, double roughness) {
        return specular_albedo(cosine, roughness * roughness).mirror;
    };
    EXPECT_NEAR(once(1.0, 0.5), 0.916, 0.001);
    EXPECT_NEAR(once(1.0, 0.75), 0.627, 0.001);
    EXPECT_NEAR(once(1.0, 1.0), 0.307, 0.001);
    EXPECT_NEAR(once(0.2, 1.0), 0.6417, 0.001);  // separable masking: 0.513
}

/// Light caught by the facets meets them again: a coloured metal grows more colourful, by the
/// geometric series of its mean reflectance.
TEST(Bsdf, CaughtLightIsColouredAtEachBounce) {
    const Vec3d color{0.9, 0.5, 0.1};
    const auto p = test::bsdf_of(color, 1.0, 1.0);
    const Vec3d wo = test::view_direction(0.8);
    const Vec3d albedo = test::quadrature_albedo(p, wo).albedo;
    const double caught = 1 - test::quadrature_albedo(test::bsdf_of(white, 1.0, 1.0), wo).once;
    const auto series = [&](double reflectance) {
        const double mean = reflectance + (1 - reflectance) / 21;
        double sum = 0;
        double left = 1;
        for (int bounce = 0; bounce < 200; ++bounce) {
            sum += left;
            left *= mean * caught;
        }
        return sum;
    };
    const Vec3d once = test::quadrature_albedo(p, wo).single;
    EXPECT_NEAR(albedo.x, once.x * series(0.9), 0.003);
    EXPECT_NEAR(albedo.y, once.y * series(0.5), 0.003);
    EXPECT_NEAR(albedo.z, once.z * series(0.1), 0.003);
    EXPECT_GT(albedo.x, 1.5 * once.x);
}

TEST(Bsdf, DensityNeverIntegratesToMoreThanOne) {
    for (const double roughness : {0.05, 0.2, 0.5, 1.0}) {
        for (const double cosine : {1.0, 0.5, 0.1, 0.02}) {
            for (const double metallic : {0.0, 0.5, 1.0}) {
                const auto p = test::bsdf_of({0.8, 0.4, 0.1}, metallic, roughness);
                const double share = test::quadrature_albedo(p, test::view_direction(cosine)).pdf;
                EXPECT_LT(share, 1.001) << roughness << ", " << cosine << ", " << metallic;
                EXPECT_GT(share, 0.499) << roughness << ", " << cosine << ", " << metallic;
            }
        }
    }
}

TEST(Bsdf, MirrorDirectionIsTheBrightestOfASmoothMetal) {
    const auto p = test::bsdf_of(white, 1.0, 0.2);
    const Vec3d wo = test::view_direction(0.8);
    const Vec3d mirrored{-wo.x, -wo.y, wo.z};
    const double peak = evaluate_bsdf(p, wo, mirrored).value_cos.x;
    // D at the peak is 1 / (pi alpha^2), F is 1, and G / (4 cos^2) follows from Smith's Lambda.
    const double tangent2 = 1 / (wo.z * wo.z) - 1;
    const double lambda = (std::sqrt(1 + p.alpha * p.alpha * tangent2) - 1) / 2;
    const double visibility = 1 / (1 + 2 * lambda) / (4 * wo.z * wo.z);
    const double once = specular_albedo(wo.z, p.alpha).mirror;
    EXPECT_NEAR(peak / (wo.z * visibility / (pi_d * p.alpha * p.alpha)) * once, 1, 1e-6);
    for (const double tilt : {0.05, 0.1, 0.3}) {
        const Vec3d beside = normalize(mirrored + Vec3d{tilt, 0, 0});
        EXPECT_LT(evaluate_bsdf(p, wo, beside).value_cos.x, peak);
    }
}

TEST(Bsdf, ReflectanceAtTheNormalIsWhatTheSpecificationSays) {
    const Vec3d up{0, 0, 1};
    const Vec3d color{0.9, 0.3, 0.6};
    const auto d_times_v = [](double alpha) { return 1 / (pi_d * alpha * alpha * 4); };
    // Light caught at the facets that leaves after another bounce, at normal incidence.
    const auto gain = [](double alpha, double mean) {
        return 1 / (1 - mean * (1 - specular_albedo(1.0, alpha).mirror));
    };
    const auto metal = test::bsdf_of(color, 1.0, 0.7);
    const Vec3d f = evaluate_bsdf(metal, up, up).value_cos;
    const auto mean = [](double f0) { return f0 + (1 - f0) / 21; };
    const double d_v = d_times_v(metal.alpha);
    EXPECT_NEAR(f.x / (color.x * gain(metal.alpha, mean(color.x)) * d_v), 1, 1e-6);
    EXPECT_NEAR(f.y / (color.y * gain(metal.alpha, mean(color.y)) * d_v), 1, 1e-6);
    const auto plastic = test::bsdf_of(black, 0.0, 0.7);
    EXPECT_NEAR(evaluate_bsdf(plastic, up, up).value_cos.z /
                    (0.04 * gain(plastic.alpha, mean(0.04)) * d_times_v(plastic.alpha)),
                1,
                1e-6);
}

TEST(Bsdf, SpecularLobesAreReciprocal) {
    // Except for light of further bounces, which is counted at wo. The diffuse part is not
    // reciprocal: it gets what the dielectric's specular lobe leaves over at wo.
    Pcg32 random(2);
    int compared = 0;
    for (int n = 0; n < random_cases / 5; ++n) {
        BsdfParams<double> p = widen(random_material(random, 0.05F));
        if (n % 2 == 0) {
            p.metallic = 1.0;
        } else {
            p.metallic = 0.0;
            p.base_color = black;
        }
        const Vec3d wo = normalize(widen(random_direction(random)));
        const Vec3d wi = normalize(widen(random_direction(random)));
        const auto gain = [&](const Vec3d& view) {
            const Vec3d f0 = lobe_weights(p, view.z).specular_f0;
            return p.metallic > 0 ? f0.x / p.base_color.x : f0.x / dielectric_f0;
        };
        const double there = evaluate_bsdf(p, wo, wi).value_cos.x / wi.z / gain(wo);
        const double back = evaluate_bsdf(p, wi, wo).value_cos.x / wo.z / gain(wi);
        ASSERT_NEAR(there, back, 1e-4 * back + 1e-30);
        compared += there > 0 ? 1 : 0;
    }
    EXPECT_EQ(compared, random_cases / 5);
}

TEST(Bsdf, NothingGoesThroughTheHorizon) {
    const auto p = test::bsdf_of(white, 0.5, 0.5);
    const Vec3d above = test::view_direction(0.4);
    const Vec3d below{above.x, above.y, -above.z};
    for (const auto& [wo, wi] : {std::pair{above, below}, {below, above}, {below, below}}) {
        const BsdfValue<double> at = evaluate_bsdf(p, wo, wi);
        EXPECT_EQ(at.pdf, 0.0);
        EXPECT_EQ(max_component(at.value_cos), 0.0);
    }
}

void expect_sane(const BsdfSample<float>& s) {
    ASSERT_NEAR(length(s.direction), 1.0F, 2e-5F);
    ASSERT_TRUE(std::isfinite(s.at.pdf)) << s.at.pdf;
    ASSERT_GE(s.at.pdf, 0.0F);
    for (const float f : {s.at.value_cos.x, s.at.value_cos.y, s.at.value_cos.z}) {
        ASSERT_TRUE(std::isfinite(f)) << f;
        ASSERT_GE(f, 0.0F);
        // Every lobe is picked with at least a tenth of the probability that its light asks for.
        ASSERT_LE(f, 11.0F * s.at.pdf + 1e-30F);
    }
    ASSERT_TRUE(s.spread >= 0.0F && s.spread < 1.0F);
    ASSERT_EQ(s.at.pdf > 0.0F, s.direction.z > 0.0F);
}

TEST(Bsdf, RandomParametersNeverLeaveTheNumbers) {
    Pcg32 random(3);
    for (int n = 0; n < random_cases; ++n) {
        const BsdfParams<float> p = random_material(random, n % 3 == 0 ? 0.0F : 0.5F);
        const Vec3f wo = random_direction(random);
        const Vec2f u{random_number(random), random_number(random)};
        expect_sane(sample_bsdf(p, wo, u));
        if (HasFatalFailure()) {
            FAIL() << "case " << n << ": alpha " << p.alpha << ", metallic " << p.metallic
                   << ", cosine " << wo.z << ", u " << u.x << ", " << u.y;
        }
        const BsdfValue<float> at = evaluate_bsdf(p, wo, random_direction(random));
        ASSERT_TRUE(std::isfinite(at.pdf) && at.pdf >= 0.0F) << n;
        ASSERT_TRUE(std::isfinite(max_component(at.value_cos))) << n;
        ASSERT_GE(luminance(at.value_cos), 0.0F) << n;
    }
}

TEST(Bsdf, PrecisionsAgree) {
    Pcg32 random(4);
    for (int n = 0; n < random_cases / 10; ++n) {
        const BsdfParams<float> p = random_material(random, 0.05F);
        const Vec3f wo = random_direction(random);
        const Vec3f wi =
            n % 2 == 0 ? random_direction(random)
                       : sample_bsdf(p, wo, {random.next_float(), random.next_float()}).direction;
        if (!(wi.z > 1e-7F)) continue;
        const BsdfValue<double> truth = evaluate_bsdf(widen(p), widen(wo), widen(wi));
        const BsdfValue<float> one = evaluate_bsdf(p, wo, wi);
        const BsdfValue<Lanes> many = evaluate_bsdf(spread(p), spread(wo), spread(wi));
        // The half vector's rounding, 1e-7, tilts a lobe of width alpha.
        const double bound = 1e-5 + 2e-6 / p.alpha;
        ASSERT_NEAR(one.pdf, truth.pdf, bound * truth.pdf + 1e-12) << n << " alpha " << p.alpha;
        ASSERT_NEAR(one.value_cos.y, truth.value_cos.y, bound * truth.value_cos.y + 1e-12) << n;
        ASSERT_NEAR(lane(many.pdf, 0), truth.pdf, bound * truth.pdf + 1e-12) << n;
        ASSERT_NEAR(lane(many.value_cos.y, lane_count - 1),
                    truth.value_cos.y,
                    bound * truth.value_cos.y + 1e-12)
            << n;
    }
}

TEST(Bsdf, LanesSampleLikeScalars) {
    Pcg32 random(5);
    for (int n = 0; n < random_cases / 20; ++n) {
        const BsdfParams<float> p = random_material(random, 0.05F);
        const Vec3f wo = random_direction(random);
        const Vec2f u{random.next_float(), random.next_float()};
        const float share = lobe_weights(p, wo.z).specular_probability;
        if (std::fabs(u.x - share) < 1e-5F) continue;  // either lobe may come out
        const BsdfSample<float> one = sample_bsdf(p, wo, u);
        const BsdfSample<Lanes> many = sample_bsdf(spread(p), spread(wo), {Lanes(u.x), Lanes(u.y)});
        ASSERT_LT(length(one.direction - lane(many.direction, 0)), 1e-4F) << n;
        ASSERT_EQ(one.spread, lane(many.spread, lane_count - 1)) << n;
    }
}

}  // namespace
}  // namespace obscura
