// crosscheck/compare.cpp - compares two answers about one ray.
// SPDX-License-Identifier: Apache-2.0
#include "crosscheck/compare.h"

#include "crosscheck/segment_rounding.h"
#include "crosscheck/side_test.h"
#include "math/warp.h"

#include <algorithm>
#include <array>
#include <cmath>

namespace obscura::crosscheck {

namespace {

/// Inputs of one comparison.
struct Question {
    const TrueScene& scene;
    const TrueRay& ray;
    double unit_m;  ///< one ulp
};

/// Distance of two hits along the surface's normal, in ulp; on a curved surface, along the steeper
/// of its two normals.
double depth_gap(const Question& q, const Answer& a, const Answer& b) {
    const double along = std::abs(a.t - b.t) * length(q.ray.direction);
    if (along <= q.unit_m) return along / q.unit_m;
    const Item& item = a.item.primitive >= 0 ? a.item : b.item;
    const Vec3d forward = normalize(q.ray.direction);
    const auto cosine = [&](double t) {
        const Vec3d place = q.ray.origin + q.ray.direction * t;
        return std::abs(dot(q.scene.normal(item, place), forward));
    };
    return along * std::max(cosine(a.t), cosine(b.t)) / q.unit_m;
}

/// True when the answer agrees with `hit`, the truth about a ray that is so many ulp away.
bool says_the_same(const Question& q, const Answer& answer, const TrueHit& hit, double ulps) {
    if (!answer.found() || !hit.found()) return answer.found() == hit.found();
    return answer.any || depth_gap(q, answer_of(hit), answer) <= depth_ulps + ulps;
}

/// Calls visit(ray) for rays so many ulp away from q.ray: beside it, ahead and behind, and tilted
/// ones that start on one side and reach t on the other.
template <typename Visit>
void visit_nearby_rays(const Question& q,
                       double ulps,
                       const std::array<double, 2>& t,
                       const Visit& visit) {
    constexpr int turns = 16;
    const double distance = ulps * q.unit_m;
    const Vec3d& origin = q.ray.origin;
    const Vec3d& direction = q.ray.direction;
    const Vec3d forward = normalize(direction) * distance;
    const Frame<double> frame = frame_around(normalize(direction));
    const double end = q.ray.end;
    visit(TrueRay{origin + forward, direction, end});
    visit(TrueRay{origin - forward, direction, end});
    for (int i = 0; i < turns; ++i) {
        const double angle = 2 * pi_d * (i + 0.5) / turns;
        const Vec3d side =
            (frame.tangent * std::cos(angle) + frame.bitangent * std::sin(angle)) * distance;
        visit(TrueRay{origin + side, direction, end});
        visit(TrueRay{origin + (side + forward) * 0.70710678, direction, end});
        visit(TrueRay{origin + (side - forward) * 0.70710678, direction, end});
        for (const double at : t) {
            if (std::isfinite(at)) visit(TrueRay{origin - side, direction + side * (2 / at), end});
        }
    }
}

/// Distance of rays that have the answers, up to `most` ulp; infinite where there are none.
double explanation(const Question& q, const Answer& expected, const Answer& got, double most) {
    const TrueHit own = q.scene.nearest(q.ray);
    bool expected_seen = says_the_same(q, expected, own, 0);
    bool got_seen = says_the_same(q, got, own, 0);
    for (double ulps = edge_ulps / 16; ulps <= most; ulps *= 2) {
        visit_nearby_rays(q, ulps, {expected.t, got.t}, [&](const TrueRay& ray) {
            if (expected_seen && got_seen) return;
            const TrueHit hit = q.scene.nearest(ray);
            expected_seen = expected_seen || says_the_same(q, expected, hit, ulps);
            got_seen = got_seen || says_the_same(q, got, hit, ulps);
        });
        if (expected_seen && got_seen) return ulps;
    }
    return INFINITY;
}

/// Where the ray passes the item's centre: tilted rays cross over there.
double passing(const Question& q, const Item& item) {
    const double squared = dot(q.ray.direction, q.ray.direction);
    return dot(q.scene.middle(item) - q.ray.origin, q.ray.direction) / squared;
}

/// True when rays around hit this item, and others do not.
bool is_at_its_edge(const Question& q, const Answer& answer) {
    bool hit = false;
    bool missed = false;
    const std::array<double, 2> places = {answer.t, passing(q, answer.item)};
    for (double ulps = edge_ulps / 16; ulps <= edge_ulps && !(hit && missed); ulps *= 2) {
        visit_nearby_rays(q, ulps, places, [&](const TrueRay& ray) {
            const bool found = !q.scene.meetings(ray, answer.item).empty();
            hit = hit || found;
            missed = missed || !found;
        });
    }
    return hit && missed;
}

/// True when the item lies within 4 ulp of the position where the answer places the hit: along its
/// own normal, through that position or one beside it.
bool is_near_its_item(const Question& q, const Answer& answer) {
    const Vec3d place = q.ray.origin + q.ray.direction * answer.t;
    const Vec3d normal = q.scene.normal(answer.item, place);
    const double height = 4 * edge_ulps * q.unit_m;
    const auto finds = [&](const Vec3d& shift) {
        const TrueRay down{place + shift + normal * height, -normal};
        const std::vector<double> found = q.scene.meetings(down, answer.item);
        return std::any_of(found.begin(), found.end(), [&](double t) {
            return std::abs(t - height) <= edge_ulps * q.unit_m;
        });
    };
    constexpr int turns = 16;
    const Frame<double> frame = frame_around(normal);
    bool found = finds({0, 0, 0});
    for (int i = 0; i < turns && !found; ++i) {
        const double angle = 2 * pi_d * i / turns;
        found = finds((frame.tangent * std::cos(angle) + frame.bitangent * std::sin(angle)) *
                      (edge_ulps * q.unit_m));
    }
    return found;
}

/// True when a ray at most 4 ulp away meets the answer's item at its depth, occluded or not.
bool is_met_nearby(const Question& q, const Answer& answer) {
    const auto meets = [&](const TrueRay& ray, double ulps) {
        for (const double t : q.scene.meetings(ray, answer.item)) {
            if (depth_gap(q, {t, answer.item}, answer) <= depth_ulps + ulps) return true;
        }
        return false;
    };
    bool met = meets(q.ray, 0) || is_near_its_item(q, answer);
    for (double ulps = edge_ulps / 16; ulps <= edge_ulps && !met; ulps *= 2) {
        visit_nearby_rays(q, ulps, {answer.t, INFINITY}, [&](const TrueRay& ray) {
            met = met || meets(ray, ulps);
        });
    }
    return met;
}

/// True when rounding alone decides on which side of so many edges' infinite lines, or more, the
/// ray passes a triangle, and it is outside of no other edge.
bool is_chance(const Question& q, const Item& item, int edges) {
    if (!q.scene.is_triangle(item)) return false;
    const SideTest test = side_test(q.scene, q.ray, item, edge_ulps * q.unit_m);
    const double facing = test.facing();
    bool within = true;
    int undecided = 0;
    for (size_t k = 0; k < 3; ++k) {
        const bool is_chance = std::abs(test.side(k)) <= test.rounding(k);
        within = within && (test.side(k) * facing >= 0 || is_chance);
        undecided += is_chance ? 1 : 0;
    }
    return within && undecided >= edges;
}

bool is_edge_on(const Question& q, const Item& item) {
    return is_chance(q, item, 2);
}

/// Half the extent of an item around its centre.
double half_length(const Question& q, const Item& item) {
    const Vec3d middle = q.scene.middle(item);
    if (q.scene.is_triangle(item)) {
        const Triangle<double> t = q.scene.triangle(item);
        return std::max({length(t.a - middle), length(t.b - middle), length(t.c - middle)});
    }
    const ShapeBox box = shape_bounds(q.scene.shape(item));
    const Vec3d half{0.5 * (static_cast<double>(box.high.x) - static_cast<double>(box.low.x)),
                     0.5 * (static_cast<double>(box.high.y) - static_cast<double>(box.low.y)),
                     0.5 * (static_cast<double>(box.high.z) - static_cast<double>(box.low.z))};
    return length(transform_vector(absolute(q.scene.world_from_object(item)), half));
}

/// True when nearby rays hit this item somewhere along the ray's passage and others do not, or when
/// the passage runs along its surface. The item's centre may be a hole.
bool is_at_an_edge_of(const Question& q, const Item& item) {
    constexpr int places = 4;  // before and behind the centre
    const double middle = passing(q, item);
    const double half = half_length(q, item) / length(q.ray.direction);
    for (int k = -places; k <= places; ++k) {
        const Answer there{middle + half * k / places, item, true};
        if (is_at_its_edge(q, there) || is_near_its_item(q, there)) return true;
    }
    return false;
}

/// The same question in the rounding of an item that the ray passes.
Question question_at(const Question& q, const Item& item) {
    const double rounding = q.scene.rounding_m(q.ray, item, std::max(passing(q, item), 0.0));
    return {q.scene, q.ray, std::max(q.unit_m, rounding)};
}

/// Occlusion does not say what was hit: the best explanation by any item beside the ray, else by a
/// triangle seen edge-on, which may be passed by as much as a leaf of Embree's tree is large.
Verdict excuse_occlusion(const Question& q) {
    Verdict best = Verdict::false_hit;
    q.scene.near_items(q.ray, beside_ulps * q.unit_m, [&](const Item& item) {
        if (best != Verdict::agree && is_at_an_edge_of(question_at(q, item), item))
            best = Verdict::agree;
    });
    const TrueBox bounds = q.scene.bounds();
    const double anywhere = 2 * length(bounds.high - bounds.low);
    if (best == Verdict::agree) return best;
    q.scene.near_items(q.ray, anywhere, [&](const Item& item) {
        if (best != Verdict::edge_on && is_edge_on(question_at(q, item), item))
            best = Verdict::edge_on;
    });
    return best;
}

/// True where Embree may take a hit on one segment for its neighbour's: where cone and end cap
/// touch, of this segment or of a neighbour on whose surface the hit lies, too.
bool is_at_seam(const Question& q, const Answer& answer) {
    if (!q.scene.is_segment(answer.item)) return false;
    const Vec3d place = q.ray.origin + q.ray.direction * answer.t;
    const auto touches = [&](const Item& item) {
        return SegmentRounding(q.scene.segment(item), q.ray).is_at_seam(answer.t);
    };
    const auto touches_next = [&](int32_t step) {
        const std::optional<Item> next = q.scene.next_segment(answer.item, step);
        if (!next) return false;
        const double height = q.scene.side_of_segment(*next, place);
        return std::abs(height) <= edge_ulps * q.unit_m && touches(*next);
    };
    return touches(answer.item) || touches_next(-1) || touches_next(1);
}

/// True when rounding alone decides whether a hit's line segment is met. The end cap between two
/// segments belongs to the first: Embree's test of the second leaves it out.
bool is_along(const Question& q, const Answer& passed) {
    if (!q.scene.is_segment(passed.item)) return false;
    const SegmentRounding own(q.scene.segment(passed.item), q.ray);
    const std::optional<Item> previous = q.scene.next_segment(passed.item, -1);
    if (!previous || !own.is_on_first_cap(passed.t)) return own.is_chance();
    return SegmentRounding(q.scene.segment(*previous), q.ray).is_chance();
}

/// agree: the answer's item is there within 4 ulp, and all items that it passed are at their edge
/// or a seam; edge_on: the same, except for triangles seen edge-on and segments seen along their
/// axis; false_hit: neither.
Verdict excuse(const Question& q, const Answer& answer) {
    Verdict worst = Verdict::agree;
    const auto judge = [&](bool good, bool edge_on) {
        if (good) return;
        worst = std::max(worst, edge_on ? Verdict::edge_on : Verdict::false_hit);
    };
    if (answer.any) return excuse_occlusion(q);
    if (answer.found()) {
        const bool good = is_met_nearby(q, answer) || is_at_its_edge(q, answer);
        judge(good, !good && is_edge_on(q, answer.item));
    }
    q.scene.all_hits(q.ray, [&](double t, const Item& item) {
        const Answer passed{t, item};
        if (item == answer.item || t >= answer.t) return;
        if (answer.found() && depth_gap(q, passed, answer) <= depth_ulps) return;
        const bool good = is_at_its_edge(q, passed) || is_at_seam(q, passed);
        judge(good, !good && (is_edge_on(q, item) || is_along(q, passed)));
    });
    return worst;
}

/// Verdict on another item at the same depth: equal_depth when it is there within rounding, too;
/// else the name is wrong. The line of an edge that the ray passes at a slant may be farther than
/// 4 ulp: one chance is enough, as the depth ties the hit to its place.
Verdict judge_other_item(const Question& q, const Answer& got) {
    const bool good = is_met_nearby(q, got) || is_at_its_edge(q, got) || is_at_seam(q, got) ||
                      is_chance(q, got.item, 1) || is_along(q, got);
    return good ? Verdict::equal_depth : Verdict::item;
}

bool is_named_wrong(const TrueScene& scene, const Answer& answer) {
    return answer.item.primitive >= 0 && !scene.has(answer.item);
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
    if (is_named_wrong(scene, expected) || is_named_wrong(scene, got)) {
        return {Verdict::item, INFINITY};
    }
    const bool same = expected.item == got.item;
    if (same && expected.found() == got.found() && expected.t == got.t) return {};
    double unit = std::max(rounding_of(scene, ray, expected), rounding_of(scene, ray, got));
    if (unit == 0) unit = scene.rounding_m(ray, {}, 2 * length(scene.bounds().high - ray.origin));
    const Question question{scene, ray, unit};
    const bool both = expected.found() && got.found();
    if (both && depth_gap(question, expected, got) <= depth_ulps) {
        return {same ? Verdict::agree : judge_other_item(question, got), 0};
    }
    double ulps = explanation(question, expected, got, edge_ulps);
    if (ulps <= edge_ulps) return {Verdict::edge, ulps};
    const Verdict excused = std::max(excuse(question, expected), excuse(question, got));
    if (excused == Verdict::agree) return {Verdict::crack, edge_ulps};
    if (excused == Verdict::edge_on) return {Verdict::edge_on, edge_ulps};
    ulps = explanation(question, expected, got, 64 * edge_ulps);
    if (both && same) return {Verdict::depth, depth_gap(question, expected, got)};
    const bool behind = !got.found() || (both && got.t > expected.t);
    return {behind ? Verdict::missed : Verdict::false_hit, ulps};
}

}  // namespace obscura::crosscheck
