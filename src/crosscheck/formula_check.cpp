// crosscheck/formula_check.cpp - tests intersection formulas in double by signs at points.
// SPDX-License-Identifier: Apache-2.0
#include "crosscheck/formula_check.h"

#include "base/parallel.h"
#include "crosscheck/random.h"
#include "crosscheck/shape_side.h"
#include "crosscheck/special_lines.h"

#include <algorithm>
#include <atomic>
#include <cmath>

namespace obscura::crosscheck {

namespace {

constexpr size_t block_size = 1024;

/// Relative to a shape's size: nearer to a boundary, rounding decides.
constexpr double min_room = 1e-9;
/// The same for a quadric's terms, whose coefficients are single precision.
constexpr double min_room_of_terms = 1e-6;

/// Of a segment.
struct Ends {
    Vec3d a, b;
};

/// How far inside of the rim p lies, where a segment crosses the level of a flat shape.
double room_on_flat(const ShapeRecord& record, const Vec3d& p) {
    const Vec3d from = p - centre_of(record);
    const Vec3d size = size_of(record);
    if (static_cast<ShapeKind>(record.kind) == ShapeKind::plane) {
        return std::min(size.x - std::abs(from.x), size.y - std::abs(from.z));
    }
    const double around = std::hypot(from.x, from.z);
    return std::min(size.x - around, size.y > 0 ? around - size.y : around + size.x);
}

/// Two points on a special line; for a quadric inside its box, which cuts it off.
Ends on_special_line(const ShapeRecord& record, RandomStream& random) {
    const TrueRay line = special_line(record, random);
    const ShapeBox box = shape_bounds(record);
    const Vec3f whole = box.high - box.low;
    const double size = std::min(static_cast<double>(max_component(whole)), 4.0 * 1e18);
    const double reach = size < 1e18 ? size : 2;
    const auto in_box = [&](const Vec3d& p) {
        const Vec3d room = size_of(record) * 0.999 - abs(p - centre_of(record));
        return std::min({room.x, room.y, room.z}) > 0;
    };
    const auto somewhere = [&] {
        for (int i = 0; i < 32; ++i) {
            const Vec3d p = line.origin + line.direction * (random.between(-1, 1) * reach);
            if (!is_quadric(record) || in_box(p)) return p;
        }
        return point_near(record, 0.999, random);
    };
    const Vec3d a = somewhere();
    return {a, somewhere()};
}

/// Two points near a shape; for a flat one, above and below.
Ends anywhere(const ShapeRecord& record, RandomStream& random) {
    const double wider = is_quadric(record) ? 0.999 : 1.3;
    Ends out{point_near(record, wider, random), point_near(record, wider, random)};
    if (is_flat(record)) {
        out.a.y += random.between(0.1, 1);
        out.b.y -= random.between(0.1, 1);
    }
    return out;
}

/// Compares the sides of a segment's ends.
enum class Parity { even, odd, unknown };

Parity parity_of(const ShapeRecord& record, const Ends& segment) {
    const double side_a = side_of_shape(record, segment.a);
    const double side_b = side_of_shape(record, segment.b);
    const Vec3d far = max3(abs(segment.a - centre_of(record)), abs(segment.b - centre_of(record)));
    const double scale = is_quadric(record) ? terms_of_quadric(record, far) : max_component(far);
    const double room = (is_quadric(record) ? min_room_of_terms : min_room) * scale;
    if (std::min(std::abs(side_a), std::abs(side_b)) <= room) return Parity::unknown;
    if ((side_a < 0) == (side_b < 0)) return Parity::even;
    if (!is_flat(record)) return Parity::odd;
    const double fraction = side_a / (side_a - side_b);
    const double inside = room_on_flat(record, segment.a + (segment.b - segment.a) * fraction);
    if (std::abs(inside) <= room) return Parity::unknown;
    return inside > 0 ? Parity::odd : Parity::even;
}

bool is_right(const ShapeRecord& record,
              const Ends& segment,
              Parity parity,
              const CrossingFormulas& formulas) {
    const Crossings met = formulas.shape(record, {segment.a, segment.b - segment.a});
    const auto within =
        std::count_if(met.t, met.t + met.count, [](double t) { return t > 0 && t < 1; });
    return (within % 2 == 1) == (parity == Parity::odd);
}

/// A segment through a point in a triangle's plane; u and v are coordinates along its edges.
struct TrianglePoint {
    double u, v;
    TrueRay line;

    double room() const { return std::min({u, v, 1 - u - v}); }
};

bool is_right(const Triangle<double>& t,
              const TrianglePoint& point,
              const CrossingFormulas& formulas) {
    if (std::abs(point.room()) < 1e-6) return true;
    const Crossings met = formulas.triangle(t, point.line);
    if ((met.count > 0) != (point.room() > 0)) return false;
    return met.count == 0 || std::abs(met.t[0] - 0.5) < 1e-6;
}

/// Whether a line that may run in the triangle's plane meets it nowhere but on it.
bool is_on_triangle(const Triangle<double>& t,
                    const TrueRay& line,
                    const CrossingFormulas& formulas) {
    const Crossings met = formulas.triangle(t, line);
    if (met.count == 0) return true;
    const Vec3d normal = cross(t.b - t.a, t.c - t.a);
    const double size = std::max(length(t.b - t.a), length(t.c - t.a));
    if (std::abs(dot(normalize(normal), line.direction)) < 1e-9) return true;  // in the plane
    const Vec3d p = line.origin + line.direction * met.t[0];
    const auto fraction = [&](const Vec3d& a, const Vec3d& b) {
        return dot(cross(a - p, b - p), normal) / dot(normal, normal);
    };
    const double least = std::min({fraction(t.a, t.b), fraction(t.b, t.c), fraction(t.c, t.a)});
    return least > -1e-6 && std::abs(dot(p - t.a, normalize(normal))) < 1e-6 * size;
}

/// Which of two formulas are wrong about one segment.
struct Wrong {
    bool formulas = false, truth = false;
};

template <typename Test>
Wrong wrong_of(const CrossingFormulas& formulas,
               const CrossingFormulas& truth,
               const Test& is_right_by) {
    return {!is_right_by(formulas), !is_right_by(truth)};
}

class Checker {
public:
    Checker(const TrueScene& scene, const CrossingFormulas& formulas)
        : scene_(scene), formulas_(formulas) {}

    Wrong check(RandomStream& random, bool special) const {
        const Item item = scene_.item(random.below(scene_.item_count()));
        return scene_.is_triangle(item) ? check(scene_.triangle(item), random, special)
                                        : check(scene_.shape(item), random, special);
    }

private:
    Wrong check(const ShapeRecord& record, RandomStream& random, bool special) const {
        const Ends segment = special ? on_special_line(record, random) : anywhere(record, random);
        const Parity parity = parity_of(record, segment);
        if (parity == Parity::unknown) return {};
        return wrong_of(formulas_, truth_, [&](const CrossingFormulas& formulas) {
            return is_right(record, segment, parity, formulas);
        });
    }

    Wrong check(const Triangle<double>& t, RandomStream& random, bool special) const {
        const Vec3d normal = cross(t.b - t.a, t.c - t.a);
        const double size = std::max(length(t.b - t.a), length(t.c - t.a));
        // Too thin to have an inside, or no triangle at all.
        if (!(length(normal) > 1e-7 * size * size)) return {};
        if (special) {
            const TrueRay line = special_line(t, random);
            return wrong_of(formulas_, truth_, [&](const CrossingFormulas& formulas) {
                return is_on_triangle(t, line, formulas);
            });
        }
        const double u = random.between(-0.5, 1.5);
        const double v = random.between(-0.5, 1.5);
        const Vec3d middle = t.a + (t.b - t.a) * u + (t.c - t.a) * v;
        const Vec3d off = (normalize(normal) + random.direction() * 0.7) * size;
        const TrianglePoint point{u, v, {middle + off, off * -2.0}};
        return wrong_of(formulas_, truth_, [&](const CrossingFormulas& formulas) {
            return is_right(t, point, formulas);
        });
    }

    const TrueScene& scene_;
    const CrossingFormulas& formulas_;
    CrossingFormulas truth_ = true_crossings();
};

}  // namespace

CrossingFormulas formulas_in_double() {
    return {[](const ShapeRecord& record, const TrueRay& line) {
                const Roots<double> roots =
                    intersect_shape<double>(record, ShapeRay<double>{line.origin, line.direction});
                Crossings out;
                for (int k = 0; k < (is_flat(record) ? 1 : 2); ++k) {
                    if (roots.hit[k]) out.add(roots.t[k]);
                }
                return out;
            },
            [](const Triangle<double>& triangle, const TrueRay& line) {
                const TriangleHit<double> hit =
                    intersect_triangle(triangle, ShapeRay<double>{line.origin, line.direction});
                Crossings out;
                if (hit.hit) out.add(hit.t);
                return out;
            }};
}

CrossingFormulas true_crossings() {
    return {cross_shape, cross_triangle};
}

FormulaCheck check_formulas(const TrueScene& scene,
                            uint64_t segments,
                            uint64_t seed,
                            const CrossingFormulas& formulas) {
    if (scene.item_count() == 0) return {};
    std::atomic<uint64_t> wrong = 0;
    std::atomic<uint64_t> wrong_truth = 0;
    const Checker checker(scene, formulas);
    parallel_ranges(static_cast<size_t>(segments), block_size, [&](size_t begin, size_t end) {
        for (size_t i = begin; i < end; ++i) {
            RandomStream random(i ^ (seed << 40));
            const Wrong found = checker.check(random, i % 2 == 1);
            if (found.formulas) wrong.fetch_add(1, std::memory_order_relaxed);
            if (found.truth) wrong_truth.fetch_add(1, std::memory_order_relaxed);
        }
    });
    return {segments, wrong.load(), wrong_truth.load()};
}

}  // namespace obscura::crosscheck
