// crosscheck/tessellation.cpp - fine meshes of analytic shapes, by their definitions alone.
// SPDX-License-Identifier: Apache-2.0
#include "crosscheck/tessellation.h"

#include "crosscheck/shape_side.h"
#include "math/warp.h"

#include <algorithm>
#include <cmath>

namespace obscura::crosscheck {

namespace {

using Corners = std::array<Vec3d, 3>;

constexpr int turn_steps = 512;  // around the axis
constexpr int arc_steps = 256;   // along half a circle: as fine
constexpr int grid_steps = 96;   // along each edge of a quadric's box

/// A point of an outline: distance from the axis, and height.
struct OutlinePoint {
    double radius, height;
};
using Outline = std::vector<OutlinePoint>;

/// Angles from the equator, in radians.
void add_arc(Outline& out, double radius, double height, double from, double to) {
    const int steps = std::max(1, static_cast<int>(std::ceil((to - from) / pi_d * arc_steps)));
    for (int i = 0; i <= steps; ++i) {
        const double angle = from + (to - from) * i / steps;
        const bool pole = std::abs(angle) >= pi_d / 2;
        out.push_back({pole ? 0 : radius * std::cos(angle), height + radius * std::sin(angle)});
    }
}

Outline outline_of(const ShapeRecord& record) {
    const double a = static_cast<double>(record.size[0]);
    const double b = static_cast<double>(record.size[1]);
    const double c = static_cast<double>(record.size[2]);
    Outline out;
    switch (static_cast<ShapeKind>(record.kind)) {
        case ShapeKind::sphere:
            add_arc(out, a, 0, -pi_d / 2, pi_d / 2);
            break;
        case ShapeKind::frustum:
            out = {{0, -a}, {b, -a}, {c, a}, {0, a}};
            break;
        case ShapeKind::capsule: {
            // Angle at which the cone touches both spheres.
            const double angle = std::asin(std::clamp((b - c) / (2 * a), -1.0, 1.0));
            add_arc(out, b, -a, -pi_d / 2, angle);
            add_arc(out, c, a, angle, pi_d / 2);
            break;
        }
        case ShapeKind::disk:
            out = {{b, 0}, {a, 0}};
            break;
        default:
            break;
    }
    return out;
}

void add_triangle(ShapeMesh& mesh, const Corners& t) {
    if (!(length(cross(t[1] - t[0], t[2] - t[0])) > 0)) return;
    mesh.triangles.push_back(t);
}

void revolve(const Outline& outline, ShapeMesh& mesh) {
    const auto position = [](const OutlinePoint& p, int step) {
        const double angle = 2 * pi_d * (step % turn_steps) / turn_steps;
        return Vec3d{p.radius * std::cos(angle), p.height, p.radius * std::sin(angle)};
    };
    for (size_t i = 0; i + 1 < outline.size(); ++i) {
        for (int step = 0; step < turn_steps; ++step) {
            const Vec3d low = position(outline[i], step);
            const Vec3d high = position(outline[i + 1], step);
            const Vec3d next_low = position(outline[i], step + 1);
            const Vec3d next_high = position(outline[i + 1], step + 1);
            add_triangle(mesh, {low, next_low, high});
            add_triangle(mesh, {high, next_low, next_high});
        }
    }
    double widest = 0;
    for (const OutlinePoint& p : outline)
        widest = std::max(widest, p.radius);
    // The midpoint of a chord, along the outline and around the axis.
    mesh.error_m = 2 * widest * (1 - std::cos(pi_d / turn_steps));
}

/// A rectangle from its middle and half its edges.
void add_rectangle(const Vec3d& middle, const Vec3d& u, const Vec3d& v, ShapeMesh& mesh) {
    add_triangle(mesh, {middle - u - v, middle + u - v, middle + u + v});
    add_triangle(mesh, {middle - u - v, middle + u + v, middle - u + v});
}

void add_faces(const Vec3d& half, ShapeMesh& mesh) {
    const Vec3d x{half.x, 0, 0};
    const Vec3d y{0, half.y, 0};
    const Vec3d z{0, 0, half.z};
    for (const double side : {-1.0, 1.0}) {
        add_rectangle(x * side, y, z, mesh);
        add_rectangle(y * side, x, z, mesh);
        add_rectangle(z * side, x, y, mesh);
    }
}

/// A corner of the grid with the left side of the equation there.
struct GridPoint {
    Vec3d position;
    double value;
};

/// Triangles where a quadric's value changes its sign, cell by cell.
class QuadricMesher {
public:
    QuadricMesher(const ShapeRecord& record, ShapeMesh& mesh) : record_(record), mesh_(mesh) {}

    void run() {
        for (int z = 0; z < grid_steps; ++z) {
            for (int y = 0; y < grid_steps; ++y) {
                for (int x = 0; x < grid_steps; ++x)
                    add_cell(x, y, z);
            }
        }
    }

private:
    double value(const Vec3d& p) const {
        const Vec3d centre{record_.centre[0], record_.centre[1], record_.centre[2]};
        return side_of_shape(record_, p + centre);
    }

    GridPoint at(int x, int y, int z) const {
        const auto along = [](int step, float half) {
            return static_cast<double>(half) * (2.0 * step / grid_steps - 1);
        };
        const Vec3d p{
            along(x, record_.size[0]), along(y, record_.size[1]), along(z, record_.size[2])};
        return {p, value(p)};
    }

    /// Six tetrahedra around the diagonal of a cell.
    void add_cell(int x, int y, int z) {
        std::array<GridPoint, 8> corner;
        for (int k = 0; k < 8; ++k)
            corner[static_cast<size_t>(k)] = at(x + (k & 1), y + (k >> 1 & 1), z + (k >> 2));
        const auto positive = std::count_if(
            corner.begin(), corner.end(), [](const GridPoint& p) { return p.value >= 0; });
        if (positive == 0 || positive == 8) return;
        constexpr size_t ways[6][2] = {{1, 3}, {3, 2}, {2, 6}, {6, 4}, {4, 5}, {5, 1}};
        for (const auto& way : ways)
            add_tetrahedron({corner[0], corner[way[0]], corner[way[1]], corner[7]});
    }

    void add_tetrahedron(const std::array<GridPoint, 4>& corners) {
        std::vector<GridPoint> inside;
        std::vector<GridPoint> outside;
        for (const GridPoint& p : corners)
            (p.value < 0 ? inside : outside).push_back(p);
        std::vector<Vec3d> cut;
        for (const GridPoint& a : inside) {
            for (const GridPoint& b : outside)
                cut.push_back(root_between(a, b));
        }
        if (cut.size() < 3) return;
        add_triangle(mesh_, {cut[0], cut[1], cut[2]});
        // Of four points, the first and the last are opposite: they share no end.
        if (cut.size() == 4) add_triangle(mesh_, {cut[1], cut[2], cut[3]});
    }

    /// By bisection from inside to outside, so that neighbours find the same numbers.
    Vec3d root_between(const GridPoint& inside, const GridPoint& outside) const {
        double low = 0;
        double high = 1;
        for (int i = 0; i < 52; ++i) {
            const double middle = 0.5 * (low + high);
            const bool is_inside =
                value(inside.position + (outside.position - inside.position) * middle) < 0;
            (is_inside ? low : high) = middle;
        }
        return inside.position + (outside.position - inside.position) * high;
    }

    const ShapeRecord& record_;
    ShapeMesh& mesh_;
};

/// First-order distance of a point from a curved surface.
double distance_to(const ShapeRecord& record, const Vec3d& position, double size) {
    const double step = 1e-6 * size;
    const auto slope = [&](const Vec3d& along) {
        const Vec3d way = along * step;
        return (side_of_shape(record, position + way) - side_of_shape(record, position - way)) /
               (2 * step);
    };
    const Vec3d gradient{slope({1, 0, 0}), slope({0, 1, 0}), slope({0, 0, 1})};
    const double value = std::abs(side_of_shape(record, position));
    return value == 0 ? 0 : value / length(gradient);
}

double measured_error(const ShapeRecord& record, const ShapeMesh& mesh, double size) {
    const Vec3d centre{record.centre[0], record.centre[1], record.centre[2]};
    double worst = 0;
    for (const Corners& t : mesh.triangles) {
        const Vec3d middles[4] = {(t[0] + t[1] + t[2]) * (1.0 / 3),
                                  (t[0] + t[1]) * 0.5,
                                  (t[1] + t[2]) * 0.5,
                                  (t[2] + t[0]) * 0.5};
        for (const Vec3d& p : middles)
            worst = std::max(worst, distance_to(record, p + centre, size));
    }
    return worst;
}

void tessellate_quadric(const ShapeRecord& record, ShapeMesh& mesh) {
    constexpr double coarsest = 1e-3;
    const double size =
        static_cast<double>(std::max({record.size[0], record.size[1], record.size[2]}));
    QuadricMesher(record, mesh).run();
    mesh.error_m = 2 * measured_error(record, mesh, size);
    if (!(mesh.error_m <= coarsest * size)) mesh = {};
}

}  // namespace

ShapeMesh tessellate(const ShapeRecord& record) {
    ShapeMesh mesh;
    if (is_unbounded(record)) return mesh;
    const Vec3d half{record.size[0], record.size[1], record.size[2]};
    switch (static_cast<ShapeKind>(record.kind)) {
        case ShapeKind::box:
            add_faces(half, mesh);
            break;
        case ShapeKind::plane:
            add_rectangle({0, 0, 0}, {half.x, 0, 0}, {0, 0, half.y}, mesh);
            break;
        case ShapeKind::quadric:
        case ShapeKind::quadric_from_above:
            tessellate_quadric(record, mesh);
            break;
        default:
            revolve(outline_of(record), mesh);
            break;
    }
    const Vec3d centre{record.centre[0], record.centre[1], record.centre[2]};
    for (Corners& t : mesh.triangles) {
        for (Vec3d& p : t)
            p = p + centre;
    }
    return mesh;
}

}  // namespace obscura::crosscheck
