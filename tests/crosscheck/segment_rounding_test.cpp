// tests/crosscheck/segment_rounding_test.cpp - bounds of rounding against single precision.
// SPDX-License-Identifier: Apache-2.0
#include "crosscheck/segment_rounding.h"

#include "crosscheck/check_scenes.h"
#include "crosscheck/random.h"

#include <gtest/gtest.h>

#include "support/points_lines_scenes.h"
#include <algorithm>
#include <cmath>
#include <vector>

namespace obscura::crosscheck {
namespace {

using namespace test;

/// Single precision arithmetic with every operation rounded: nothing may be fused.
struct Single {
    float x = 0;
};
[[gnu::noinline]] Single rounded(float value) {
    volatile float kept = value;
    return {kept};
}
Single operator+(Single a, Single b) {
    return rounded(a.x + b.x);
}
Single operator-(Single a, Single b) {
    return rounded(a.x - b.x);
}
Single operator*(Single a, Single b) {
    return rounded(a.x * b.x);
}

struct SingleVec {
    Single x, y, z;
};
Single product(const SingleVec& a, const SingleVec& b) {
    return a.x * b.x + a.y * b.y + a.z * b.z;
}

/// A segment from the origin and a ray that begins closest to the segment's centre, so that what
/// the bounds count as moved is not rounded at all.
struct Case {
    Segment<double> segment;
    TrueRay ray;
};

double single(double x) {
    return static_cast<double>(static_cast<float>(x));
}

Vec3d as_single(const Vec3d& v) {
    return {single(v.x), single(v.y), single(v.z)};
}

SingleVec parts(const Vec3d& v) {
    return {{static_cast<float>(v.x)}, {static_cast<float>(v.y)}, {static_cast<float>(v.z)}};
}

/// Rays past the surface, from across the segment to along it, and radii whose difference is exact.
Case random_case(uint64_t number) {
    RandomStream random(number);
    const auto radius = [&] { return (1 + static_cast<double>(random.below(15))) / 1024; };
    const Vec3d to = as_single(random.direction() * random.between(0.2, 1));
    const Segment<double> segment{{0, 0, 0}, to, radius(), radius()};
    const double slant = std::pow(10.0, -4 * random.unit());
    const Vec3d d = as_single(normalize(normalize(to) + random.direction() * slant));
    const Vec3d side = normalize(cross(d, random.direction()));
    const Vec3d place = to * random.unit() + side * (segment.radius_from * random.between(0, 1.1));
    const double back = dot(place - to * 0.5, d) / dot(d, d);
    return {segment, {as_single(place - d * back), d}};
}

struct Quadratic {
    double a, b, c, discriminant;
};

/// As Embree computes it, except for the halves of b and of the discriminant.
Quadratic in_single(const Case& one) {
    const SingleVec p = parts(one.segment.to);
    const SingleVec o = parts(one.ray.origin);
    const SingleVec d = parts(one.ray.direction);
    const Single r0{static_cast<float>(one.segment.radius_from)};
    const Single dr = Single{static_cast<float>(one.segment.radius_to)} - r0;
    const Single l = product(p, p);
    const Single g = l - dr * dr;
    const Single o_p = product(p, o);
    const Single d_p = product(p, d);
    const Single place = o_p + r0 * dr;
    const Single a = g * product(d, d) - d_p * d_p;
    const Single b = g * product(d, o) - d_p * place;
    const Single two{2};
    const Single c = g * product(o, o) - o_p * o_p - (r0 * r0) * l - (two * (r0 * dr)) * o_p;
    const Single discriminant = b * b - a * c;
    return {a.x, b.x, c.x, discriminant.x};
}

TEST(SegmentRounding, NoRoundingIsMoreThanTheBoundAndSomeComesNear) {
    double nearest[4] = {};
    for (uint64_t i = 0; i < 200000; ++i) {
        const Case one = random_case(i);
        const SegmentRounding test(one.segment, one.ray);
        const Quadratic got = in_single(one);
        // The bounds hold at the closest point, from which the rounded origin is slightly off.
        const double start = dot(one.segment.to * 0.5 - one.ray.origin, one.ray.direction) /
                             dot(one.ray.direction, one.ray.direction);
        const double ta = test.a().value * start;
        const RoundedNumber truths[4] = {test.a(), test.b(), test.c(), test.discriminant()};
        const double values[4] = {
            got.a, got.b + ta, got.c + (2 * test.b().value - ta) * start, got.discriminant};
        for (size_t k = 0; k < 4; ++k) {
            const double error = std::abs(values[k] - truths[k].value);
            EXPECT_LE(error, truths[k].error) << i << " " << k;
            nearest[k] = std::max(nearest[k], error / truths[k].error);
        }
    }
    for (const double share : nearest)
        EXPECT_GT(share, 0.05);
}

/// Embree misses the segment where the discriminant is negative, and where a is 0.
TEST(SegmentRounding, WhereSinglePrecisionDecidesOtherwiseItIsChance) {
    int different = 0;
    int chances = 0;
    for (uint64_t i = 0; i < 200000; ++i) {
        const Case one = random_case(i);
        const SegmentRounding test(one.segment, one.ray);
        const Quadratic got = in_single(one);
        const bool meets = test.discriminant().value >= 0;
        const bool met = got.discriminant >= 0 && got.a != 0;
        chances += test.is_chance() ? 1 : 0;
        different += meets != met ? 1 : 0;
        EXPECT_TRUE(meets == met || test.is_chance()) << i;
    }
    EXPECT_GT(different, 100);
    EXPECT_LT(chances, 200000 / 2);
}

/// Two segments of length 1, a hundred times as long as thick, with a joint at the origin.
class CurveSegment : public testing::Test {
protected:
    CurveSegment() : scene_(empty_scene({})) {
        add_strip(scene_, {{{-1, 0, 0}}, {{0, 0, 0}}, {{0, 1, 0}}}, 0.01F);
    }
    Verdict verdict(const TrueRay& ray, const Answer& got) const {
        return compare(truth(), ray, answer_of(truth().nearest(ray)), got).verdict;
    }
    const TrueScene& truth() const {
        if (!truth_) truth_.emplace(scene_);
        return *truth_;
    }
    SegmentRounding test(const TrueRay& ray, int32_t element) const {
        return {truth().segment({-1, 0, element}), ray};
    }

private:
    Scene scene_;
    mutable std::optional<TrueScene> truth_;
};

/// Any ray moved by less than the radius meets the segment; only the test by its cone misses it.
TEST_F(CurveSegment, AlongItsAxisEmbreeMayMissIt) {
    const TrueRay along{{-4, 0.001, 0}, {1, 1e-5, 0}};
    EXPECT_TRUE(test(along, 0).is_chance());
    Answer behind{0, {}};
    truth().all_hits(along, [&](double t, const Item& item) {
        if (t > behind.t) behind = {t, item};
    });
    ASSERT_EQ(behind.item.element, 1);  // the next segment, from within
    EXPECT_EQ(verdict(along, behind), Verdict::edge_on);
    const TrueRay slanted{{-4, -0.035, 0}, {1, 1e-2, 0}};
    ASSERT_EQ(truth().nearest(slanted).item.element, 0);
    EXPECT_FALSE(test(slanted, 0).is_chance());
    EXPECT_EQ(verdict(slanted, {}), Verdict::missed);
}

/// The end cap between two segments belongs to the first: where that is missed, so is the cap.
TEST_F(CurveSegment, IsMissedAtAnEndCapOfAMissedNeighbour) {
    const TrueRay along{{-4, -0.002, 0.003}, {1, 1e-5, 1e-5}};
    double out = 0;
    std::vector<int32_t> elements;
    truth().all_hits(along, [&](double t, const Item& item) {
        if (t <= 4) return;
        out = t;
        elements.push_back(item.element);
    });
    std::sort(elements.begin(), elements.end());
    ASSERT_EQ(elements, (std::vector<int32_t>{0, 1}));
    EXPECT_TRUE(test(along, 0).is_chance());
    EXPECT_FALSE(test(along, 1).is_chance());
    EXPECT_TRUE(test(along, 1).is_on_first_cap(out));
    EXPECT_FALSE(test(along, 0).is_on_first_cap(out));
    EXPECT_EQ(verdict(along, {}), Verdict::edge_on);
}

/// Along the second segment, across the first, whose end cap the ray meets: Embree must report it.
TEST_F(CurveSegment, TheEndCapBeforeAMissedSegmentIsStillThere) {
    const TrueRay up{{0.003, -3, 0.004}, {0, 1, 0}};
    EXPECT_FALSE(test(up, 0).is_chance());
    EXPECT_TRUE(test(up, 1).is_chance());
    const TrueHit cap = truth().nearest(up);
    ASSERT_TRUE(cap.found());
    EXPECT_TRUE(test(up, 1).is_on_first_cap(cap.t));
    EXPECT_EQ(verdict(up, {}), Verdict::missed);
    EXPECT_FALSE(test(up, 1).is_on_first_cap(4.009)) << "its other end is its own";
}

TEST_F(CurveSegment, AcrossItOnlyItsSilhouetteIsChance) {
    const double off = 4 * truth().rounding_m({{-0.5, 0, 3}, {0, 0, -1}}, {-1, 0, 0}, 3);
    EXPECT_LT(off, 0.01 * 0.02);  // 2 % of the radius: a quarter of its length squared over it
    const auto down = [](double y) { return TrueRay{{-0.5, y, 3}, {0, 0, -1}}; };
    EXPECT_EQ(verdict(down(0.00), {}), Verdict::missed);
    EXPECT_EQ(verdict(down(0.01 - 3 * off), {}), Verdict::missed);
    EXPECT_EQ(verdict(down(0.01 - 0.5 * off), {}), Verdict::edge);
    EXPECT_TRUE(test(down(0.01), 0).is_chance());
}

/// Where cone and end cap touch, each may leave the hit to the other.
TEST_F(CurveSegment, BetweenConeAndEndCapARayMayPass) {
    const TrueRay joint{{1e-8, -0.004, 3}, {0, 0, -1}};
    ASSERT_TRUE(truth().nearest(joint).found());
    EXPECT_TRUE(test(joint, 0).is_at_seam(truth().nearest(joint).t));
    EXPECT_EQ(verdict(joint, {}), Verdict::crack);
    const TrueRay beside{{-1e-3, -0.004, 3}, {0, 0, -1}};
    EXPECT_FALSE(test(beside, 0).is_at_seam(truth().nearest(beside).t));
    EXPECT_EQ(verdict(beside, {}), Verdict::missed);
}

}  // namespace
}  // namespace obscura::crosscheck
