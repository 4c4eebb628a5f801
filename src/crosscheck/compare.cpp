// crosscheck/compare.cpp - two answers about one ray.
// SPDX-License-Identifier: Apache-2.0
#include "crosscheck/compare.h"

#include "math/warp.h"

#include <algorithm>
#include <array>
#include <cmath>

namespace obscura {

namespace {

/// What one comparison is about.
struct Question {
    const TrueScene& scene;
    const TrueRay& ray;
    double unit_m;  ///< one ulp
};

/// Distance of two hits along the surface's normal, in ulp.
double depth_gap(const Question& q, const Answer& a, const Answer& b) {
    const double along = std::abs(a.t - b.t) * length(q.ray.direction);
    if (along <= q.unit_m) return along / q.unit_m;
    const Item& item = a.item.primitive >= 0 ? a.item : b.item;
    const double t = a.item.primitive >= 0 ? a.t : b.t;
    return along * q.scene.cosine(q.ray, item, t) / q.unit_m;
}

/// True when `hit`, the truth about a ray that is so many ulp away, is what the answer says.
bool says_the_same(const Question& q, const Answer& answer, const TrueHit& hit, double ulps) {
    if (!answer.found() || !hit.found()) return answer.found() == hit.found();
    return answer.any || depth_gap(q, answer_of(hit), answer) <= depth_ulps + ulps;
}

struct Explained {
    bool expected, got;
    bool both() const { return expected && got; }
};

/// Looks at rays on a circle around this one, and at those that begin earlier or later.
void look_around(const Question& q,
                 double ulps,
                 const std::array<Answer, 2>& answers,
                 Explained& explained) {
    constexpr int turns = 16;
    const Vec3d forward = normalize(q.ray.direction);
    const Frame<double> frame = frame_around(forward);
    const auto look = [&](const Vec3d& shift) {
        if (explained.both()) return;
        const TrueHit hit =
            q.scene.nearest({q.ray.origin + shift * (ulps * q.unit_m), q.ray.direction});
        explained.expected = explained.expected || says_the_same(q, answers[0], hit, ulps);
        explained.got = explained.got || says_the_same(q, answers[1], hit, ulps);
    };
    for (int i = 0; i < turns; ++i) {
        const double angle = 2 * pi_d * (i + 0.5) / turns;
        const Vec3d side = frame.tangent * std::cos(angle) + frame.bitangent * std::sin(angle);
        look(side);
        look((side + forward) * 0.70710678);
        look((side - forward) * 0.70710678);
    }
    look(forward);
    look(-forward);
}

/// How far away rays are found that have the answers; infinite where there are none.
double explanation(const Question& q, const Answer& expected, const Answer& got) {
    const TrueHit own = q.scene.nearest(q.ray);
    Explained explained{says_the_same(q, expected, own, 0), says_the_same(q, got, own, 0)};
    for (double ulps = edge_ulps / 16; ulps <= 64 * edge_ulps; ulps *= 2) {
        look_around(q, ulps, {expected, got}, explained);
        if (explained.both()) return ulps;
    }
    return INFINITY;
}

double rounding_of(const TrueScene& scene, const TrueRay& ray, const Answer& answer) {
    if (answer.item.primitive < 0) return 0;
    return scene.rounding_m(ray, answer.item, answer.t);
}

}  // namespace

Comparison compare(const TrueScene& scene,
                   const TrueRay& ray,
                   const Answer& expected,
                   const Answer& got) {
    if (!expected.found() && !got.found()) return {};
    if (expected.found() && got.found() && (expected.any || got.any)) return {};
    const bool same = expected.item == got.item;
    if (same && expected.t == got.t) return {};
    double unit = std::max(rounding_of(scene, ray, expected), rounding_of(scene, ray, got));
    if (unit == 0) unit = scene.rounding_m(ray, {}, 2 * length(scene.bounds().high - ray.origin));
    const Question question{scene, ray, unit};
    const bool both = expected.found() && got.found();
    if (both && depth_gap(question, expected, got) <= depth_ulps) {
        return {same ? Verdict::agree : Verdict::equal_depth, 0};
    }
    const double ulps = explanation(question, expected, got);
    if (ulps <= edge_ulps) return {Verdict::edge, ulps};
    if (both && same) return {Verdict::depth, depth_gap(question, expected, got)};
    const bool behind = !got.found() || (both && got.t > expected.t);
    return {behind ? Verdict::missed : Verdict::false_hit, ulps};
}

}  // namespace obscura
