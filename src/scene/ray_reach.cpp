// scene/ray_reach.cpp - limits of ray coordinates within which Embree's single precision suffices.
// SPDX-License-Identifier: Apache-2.0
#include "scene/ray_reach.h"

#include <algorithm>
#include <cmath>

namespace obscura {

namespace {

/// Leaves a margin for the rounding of short sums.
constexpr double limit = 0.95 * largest_component;
/// Products beyond this are infinite in single precision, or nearly so.
constexpr double largest_product = 1e37;
/// Products below this are zero in single precision.
constexpr double smallest_product = 1.2e-38;
/// Rounding of a determinant in single precision, against the sum of its terms' magnitudes.
constexpr double rounding = 1.0 / (1 << 20);

/// The next row or column in cyclic order, for the cofactors of a 3x3 matrix.
constexpr int next(int i) {
    return (i + 1) % 3;
}

/// Determinant of three columns taken from two matrices: bit c of `from_b` chooses b's column c.
double mixed_determinant(const Affinef& a, const Affinef& b, unsigned from_b) {
    Affined mixed;
    for (int r = 0; r < 3; ++r) {
        for (int c = 0; c < 3; ++c) {
            const bool takes_b = ((from_b >> static_cast<unsigned>(c)) & 1U) != 0;
            mixed.m[r][c] = static_cast<double>((takes_b ? b : a).m[r][c]);
        }
    }
    return determinant(mixed);
}

/// A cubic polynomial over [0, 1] in the Bernstein basis: its values lie between its coefficients.
struct Cubic {
    double b[4];
};

/// The determinant while the matrix is interpolated from a to b, which may be the same object.
Cubic determinant_between(const Affinef& a, const Affinef& b) {
    if (&a == &b) {
        const double still = determinant(affine_cast<double>(a));
        return {{still, still, still, still}};
    }
    const auto det = [&](unsigned from_b) { return mixed_determinant(a, b, from_b); };
    return {{det(0), (det(1) + det(2) + det(4)) / 3, (det(3) + det(5) + det(6)) / 3, det(7)}};
}

/// A lower bound of |cubic|; 0 where the polynomial has a root or comes too close to one. By de
/// Casteljau's halving.
double min_magnitude(const Cubic& cubic, int halvings) {
    const auto [low, high] = std::minmax_element(cubic.b, cubic.b + 4);
    if (*low > 0) return *low;
    if (*high < 0) return -*high;
    const double* b = cubic.b;
    const bool crosses = !(b[0] * b[3] > 0);
    if (crosses || halvings == 0) return 0;
    const auto mid = [](double p, double q) { return 0.5 * (p + q); };
    const double p = mid(b[0], b[1]);
    const double q = mid(b[1], b[2]);
    const double r = mid(b[2], b[3]);
    const double pq = mid(p, q);
    const double qr = mid(q, r);
    const double centre = mid(pq, qr);
    return std::min(min_magnitude({{b[0], p, pq, centre}}, halvings - 1),
                    min_magnitude({{centre, qr, r, b[3]}}, halvings - 1));
}

/// Upper bounds of the entries' magnitudes between a and b.
Affined largest_entries(const Affinef& a, const Affinef& b) {
    Affined out;
    for (int r = 0; r < 3; ++r) {
        for (int c = 0; c < 4; ++c) {
            out.m[r][c] = static_cast<double>(std::max(std::abs(a.m[r][c]), std::abs(b.m[r][c])));
        }
    }
    return out;
}

/// A bound on the magnitude of the inverse's entries; infinite where single precision has none.
/// Embree divides the adjugate by the determinant, both in single precision.
double largest_of_inverse(const Affinef& a, const Affinef& b, const Affined& most) {
    const auto& m = most.m;
    double terms = 0;
    double sum = 1;
    double largest_cofactor = 0;
    for (int r = 0; r < 3; ++r) {
        const auto& p = m[next(r)];
        const auto& q = m[next(next(r))];
        const double cofactors[] = {
            p[1] * q[2] + p[2] * q[1], p[2] * q[0] + p[0] * q[2], p[0] * q[1] + p[1] * q[0]};
        for (int c = 0; c < 3; ++c) {
            largest_cofactor = std::max(largest_cofactor, cofactors[c]);
            sum += m[r][c];
        }
        if (r == 0)
            terms = m[0][0] * cofactors[0] + m[0][1] * cofactors[1] + m[0][2] * cofactors[2];
    }
    if (!(terms < largest_product && largest_cofactor < largest_product)) return INFINITY;
    const double error = rounding * terms + smallest_product * sum;
    const double determinant = min_magnitude(determinant_between(a, b), 12);
    if (!(determinant > 2 * error)) return INFINITY;
    return largest_cofactor / (determinant - error);
}

RayReach smaller(const RayReach& a, const RayReach& b) {
    return {std::min(a.origin, b.origin), std::min(a.direction, b.direction)};
}

RayReach reach_between(const Affinef& a, const Affinef& b) {
    const Affined most = largest_entries(a, b);
    const double widest = largest_of_inverse(a, b, most);
    const double moved = most.m[0][3] + most.m[1][3] + most.m[2][3];
    const double farthest = limit / widest - moved;  // from the instance's own origin
    if (!(farthest > 0)) return {0, 0};
    constexpr auto upper_limit = static_cast<double>(largest_component);
    return {static_cast<float>(std::min(farthest, upper_limit)),
            static_cast<float>(std::min(limit / widest, upper_limit))};
}

/// Upper bound of the sum of a point's component magnitudes within the bounds.
double farthest(const Bounds& bounds) {
    if (bounds.empty()) return 0;
    const Vec3f most = max3(abs(bounds.low), abs(bounds.high));
    return static_cast<double>(most.x) + static_cast<double>(most.y) + static_cast<double>(most.z);
}

/// The reach that the rays of an image need. Without scene cameras, the camera is assumed to stand
/// a few times the scene's size away.
RayReach needed_reach(const Scene& scene) {
    constexpr double room = 8;
    double most = room * farthest(scene.bounds);
    for (const SceneCamera& camera : scene.cameras) {
        double sum = 0;
        for (const auto& row : camera.world_from_camera.m)
            sum += std::abs(row[3]);
        most = std::max(most, room * sum);
    }
    constexpr double farthest_anything = 1e18;
    return {static_cast<float>(std::min(most, farthest_anything)), 2.0f};
}

bool is_within(const RayReach& needed, const RayReach& reach) {
    return needed.origin <= reach.origin && needed.direction <= reach.direction;
}

size_t triangles_of(const Scene& scene, const Instance& instance) {
    const Mesh& mesh = scene.meshes[static_cast<size_t>(instance.mesh)];
    const auto first = static_cast<size_t>(mesh.first_primitive);
    size_t sum = 0;
    for (size_t i = 0; i < static_cast<size_t>(mesh.primitive_count); ++i)
        sum += static_cast<size_t>(scene.primitives[first + i].triangle_count);
    return sum;
}

}  // namespace

RayReach instance_reach(const Scene& scene, const Instance& instance) {
    if (!moves(instance)) {
        return reach_between(instance.world_from_object, instance.world_from_object);
    }
    const Affinef* at = &scene.motion.instances[static_cast<size_t>(instance.motion)];
    RayReach out;
    for (int32_t step = 0; step + 1 < scene.motion.steps; ++step)
        out = smaller(out, reach_between(at[step], at[step + 1]));
    return out;
}

RayReach scene_reach(const Scene& scene) {
    RayReach out;
    for (const Instance& instance : scene.instances)
        out = smaller(out, instance_reach(scene, instance));
    return out;
}

UnreachedInstances leave_out_unreached(Scene& scene) {
    UnreachedInstances out;
    const RayReach needed = needed_reach(scene);
    std::erase_if(scene.instances, [&](Instance& instance) {
        if (is_within(needed, instance_reach(scene, instance))) return false;
        if (moves(instance)) {
            Instance still = instance;
            still.motion = -1;
            if (is_within(needed, instance_reach(scene, still))) {
                instance.motion = -1;
                out.halted.push_back(instance);
                return false;
            }
        }
        out.left_out.push_back(instance);
        size_t& triangles = scene.info.triangles_in_world;
        triangles -= std::min(triangles, triangles_of(scene, instance));
        return true;
    });
    return out;
}

}  // namespace obscura
