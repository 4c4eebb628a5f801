// explain/workings.cpp - worked-out formulas of plane, sphere, triangle, quadric and more.
// SPDX-License-Identifier: Apache-2.0
#include "explain/workings.h"

#include <algorithm>
#include <cmath>
#include <functional>

namespace obscura {

namespace {

constexpr const char* quadratic_text = "a t^2 + 2 b t + c = 0";

/// The ray relative to a shape's centre.
struct CentredRay {
    Vec3d f;  ///< R_o - centre
    Vec3d d;

    Vec3d at(double t) const { return f + d * t; }
};

struct Equation {
    double a, b, c;

    double discriminant() const { return b * b - a * c; }
    /// Both roots without cancellation; one where a is 0; none where a and b are 0.
    std::vector<double> roots() const {
        const double d = discriminant();
        if (a == 0 && b == 0) return {};
        if (a == 0) return {-c / (2 * b)};
        if (d < 0) return {};
        const double q = b < 0 ? std::sqrt(d) - b : -(b + std::sqrt(d));
        if (q == 0) return {0, 0};
        std::vector<double> both = {c / q, q / a};
        std::sort(both.begin(), both.end());
        return both;
    }
};

void add_equation(const Equation& e, const std::string& of, Working& out) {
    out.terms.emplace_back("a" + of, e.a);
    out.terms.emplace_back("b" + of, e.b);
    out.terms.emplace_back("c" + of, e.c);
    out.terms.emplace_back("D" + of + " = b^2 - a c", e.discriminant());
}

/// |f + t d|^2 = r^2
Equation sphere_equation(const CentredRay& ray, double radius) {
    return {dot(ray.d, ray.d), dot(ray.d, ray.f), dot(ray.f, ray.f) - radius * radius};
}

/// x^2 + z^2 = (centre + slope y)^2
Equation cone_equation(const CentredRay& ray, double middle, double slope) {
    const Vec3d& f = ray.f;
    const Vec3d& d = ray.d;
    const double radius = middle + slope * f.y;
    const double growth = slope * d.y;
    return {d.x * d.x + d.z * d.z - growth * growth,
            f.x * d.x + f.z * d.z - growth * radius,
            f.x * f.x + f.z * f.z - radius * radius};
}

/// Keeps the roots that lie on the existing part of the surface.
void keep(const std::vector<double>& roots,
          const std::function<bool(double)>& is_there,
          Working& out) {
    for (const double t : roots) {
        if (std::isfinite(t) && is_there(t)) out.t.push_back(t);
    }
}

void finish(const std::string& why, Working& out) {
    std::sort(out.t.begin(), out.t.end());
    if (out.t.empty()) out.missed = why;
}

std::string why_no_root(const Equation& e) {
    if (e.a == 0 && e.b == 0) return "the ray runs along the surface: nothing depends on t";
    return e.discriminant() < 0 ? "D < 0: the ray passes by" : "";
}

Working work_out_sphere(const CentredRay& ray, double radius) {
    Working out{std::string("|R(t) - c|^2 = r^2: ") + quadratic_text, {}, {}, {}};
    out.terms.emplace_back("r", radius);
    out.terms.emplace_back("R_o - c", ray.f);
    const Equation e = sphere_equation(ray, radius);
    add_equation(e, "", out);
    out.t = e.roots();
    finish(why_no_root(e), out);
    return out;
}

Working work_out_box(const CentredRay& ray, const Vec3d& half) {
    Working out{"between three pairs of planes: x = +-h_x, y = +-h_y, z = +-h_z", {}, {}, {}};
    out.terms.emplace_back("h", half);
    double enter = -INFINITY;
    double leave = INFINITY;
    const double f[3] = {ray.f.x, ray.f.y, ray.f.z};
    const double d[3] = {ray.d.x, ray.d.y, ray.d.z};
    const double h[3] = {half.x, half.y, half.z};
    for (int i = 0; i < 3; ++i) {
        double low = std::abs(f[i]) <= h[i] ? -INFINITY : INFINITY;
        double high = -low;
        if (d[i] != 0) {
            const double one = (-h[i] - f[i]) / d[i];
            const double other = (h[i] - f[i]) / d[i];
            low = std::min(one, other);
            high = std::max(one, other);
        }
        out.terms.emplace_back(std::string("t between the planes of ") + "xyz"[i], low, high);
        enter = std::max(enter, low);
        leave = std::min(leave, high);
    }
    out.terms.emplace_back("last in, first out", enter, leave);
    if (enter <= leave) out.t = {enter, leave};
    finish("it leaves one pair before it enters another", out);
    return out;
}

/// Where a ray meets the plane y = height: none where it runs along it.
std::vector<double> level(const CentredRay& ray, double height) {
    if (ray.d.y == 0) return {};
    return {(height - ray.f.y) / ray.d.y};
}

Working work_out_flat(const CentredRay& ray,
                      const std::string& equation,
                      const std::function<bool(const Vec3d&)>& is_there) {
    Working out{equation, {}, {}, {}};
    out.terms.emplace_back("R_d . n", ray.d.y);
    out.terms.emplace_back("(c - R_o) . n", -ray.f.y);
    const std::vector<double> met = level(ray, 0);
    if (!met.empty()) {
        const Vec3d p = ray.at(met[0]);
        out.terms.emplace_back("t", met[0]);
        out.terms.emplace_back("from the middle along x, z", p.x, p.z);
    }
    keep(
        met, [&](double t) { return is_there(ray.at(t)); }, out);
    finish(met.empty() ? "R_d . n = 0: the ray runs along it" : "beside it", out);
    return out;
}

Working work_out_plane(const CentredRay& ray, double half_x, double half_z) {
    const auto is_there = [&](const Vec3d& p) {
        return std::abs(p.x) <= half_x && std::abs(p.z) <= half_z;
    };
    return work_out_flat(ray, "(R(t) - c) . n = 0: t = (c - R_o) . n / (R_d . n)", is_there);
}

Working work_out_disk(const CentredRay& ray, double radius, double hole) {
    const auto is_there = [&](const Vec3d& p) {
        const double r = std::hypot(p.x, p.z);
        return r <= radius && r >= hole;
    };
    return work_out_flat(
        ray, "t = (c - R_o) . n / (R_d . n), and x^2 + z^2 within the radii", is_there);
}

Working work_out_frustum(const CentredRay& ray, double half, double bottom, double top) {
    Working out{std::string("x^2 + z^2 = (m + s y)^2: ") + quadratic_text +
                    "; caps: t = (+-h - R_o,y) / R_d,y",
                {},
                {},
                {}};
    const double middle = 0.5 * (bottom + top);
    const double slope = 0.5 * (top - bottom) / half;
    out.terms.emplace_back("m", middle);
    out.terms.emplace_back("s", slope);
    out.terms.emplace_back("h", half);
    const Equation e = cone_equation(ray, middle, slope);
    add_equation(e, "", out);
    keep(
        e.roots(), [&](double t) { return std::abs(ray.at(t).y) <= half; }, out);
    for (const double height : {-half, half}) {
        const double radius = height < 0 ? bottom : top;
        const std::vector<double> cap = level(ray, height);
        if (cap.empty()) continue;
        const Vec3d p = ray.at(cap[0]);
        out.terms.emplace_back(height < 0 ? "t of the bottom" : "t of the top", cap[0]);
        keep(
            cap, [&](double) { return std::hypot(p.x, p.z) <= radius; }, out);
    }
    const std::string why = why_no_root(e);
    finish(why.empty() ? "its roots are above or below it" : why, out);
    return out;
}

Working work_out_capsule(const CentredRay& ray, double half, double bottom, double top) {
    Working out{
        std::string("a ball at either end and the cone that touches both, each ") + quadratic_text,
        {},
        {},
        {}};
    const double sine = (bottom - top) / (2 * half);
    const double cosine = std::sqrt(1 - sine * sine);
    const double low = bottom * sine - half;  // heights of the circles where cone and spheres touch
    const double high = top * sine + half;
    const Equation side = cone_equation(ray, 0.5 * (bottom + top) / cosine, -sine / cosine);
    add_equation(side, " cone", out);
    keep(
        side.roots(), [&](double t) { return ray.at(t).y >= low && ray.at(t).y <= high; }, out);
    const CentredRay from_low{ray.f + Vec3d{0, half, 0}, ray.d};
    const CentredRay from_high{ray.f - Vec3d{0, half, 0}, ray.d};
    const Equation lower = sphere_equation(from_low, bottom);
    const Equation upper = sphere_equation(from_high, top);
    add_equation(lower, " lower", out);
    add_equation(upper, " upper", out);
    keep(
        lower.roots(), [&](double t) { return ray.at(t).y < low; }, out);
    keep(
        upper.roots(), [&](double t) { return ray.at(t).y > high; }, out);
    finish("no root lies on the part that it belongs to", out);
    return out;
}

Working work_out_quadric(const CentredRay& ray, const ShapeRecord& record, const Vec3d& half) {
    Working out{std::string("x^T Q x = 0: ") + quadratic_text + ", inside a box", {}, {}, {}};
    double k[10];
    std::copy_n(record.k, 10, k);
    const Vec3d& f = ray.f;
    const Vec3d& d = ray.d;
    // x^T Q y for the part of second order; the whole of it is symmetric in x and y.
    const auto second = [&](const Vec3d& x, const Vec3d& y) {
        return k[0] * x.x * y.x + k[1] * x.y * y.y + k[2] * x.z * y.z +
               0.5 * (k[3] * (x.x * y.y + x.y * y.x) + k[4] * (x.x * y.z + x.z * y.x) +
                      k[5] * (x.y * y.z + x.z * y.y));
    };
    const auto first = [&](const Vec3d& x) { return k[6] * x.x + k[7] * x.y + k[8] * x.z; };
    const Equation e{second(d, d), second(f, d) + 0.5 * first(d), second(f, f) + first(f) + k[9]};
    out.terms.emplace_back("R_o - c", f);
    add_equation(e, "", out);
    const auto inside = [&](double t) {
        const Vec3d p = ray.at(t);
        // Tolerance for rounding: a root may lie on the box.
        const double room = 1e-12 * (length(f) + length(d) * std::abs(t));
        return std::abs(p.x) <= half.x + room && std::abs(p.y) <= half.y + room &&
               std::abs(p.z) <= half.z + room;
    };
    keep(e.roots(), inside, out);
    const std::string why = why_no_root(e);
    finish(why.empty() ? "its roots lie outside of the box" : why, out);
    return out;
}

}  // namespace

Working work_out_triangle(const Triangle<double>& triangle, const crosscheck::TrueRay& ray) {
    Working out{
        "R(t) = a + u e1 + v e2: u = (s . p) / det, v = (R_d . q) / det, "
        "t = (e2 . q) / det",
        {},
        {},
        {}};
    const Vec3d e1 = triangle.b - triangle.a;
    const Vec3d e2 = triangle.c - triangle.a;
    const Vec3d s = ray.origin - triangle.a;
    const Vec3d p = cross(ray.direction, e2);
    const Vec3d q = cross(s, e1);
    const double det = dot(e1, p);
    out.terms = {{"a", triangle.a},
                 {"e1 = b - a", e1},
                 {"e2 = c - a", e2},
                 {"s = R_o - a", s},
                 {"p = R_d x e2", p},
                 {"q = s x e1", q},
                 {"det = e1 . p", det}};
    if (det == 0) {
        out.missed = "det = 0: the ray runs along the triangle";
        out.outside = INFINITY;
        return out;
    }
    const double u = dot(s, p) / det;
    const double v = dot(ray.direction, q) / det;
    const double t = dot(e2, q) / det;
    out.terms.emplace_back("u", u);
    out.terms.emplace_back("v", v);
    out.terms.emplace_back("1 - u - v", 1 - u - v);
    out.terms.emplace_back("t", t);
    out.outside = std::max({-u, -v, u + v - 1});
    if (out.outside <= 0) {
        out.t = {t};
    } else {
        out.missed = u < 0 ? "u < 0" : v < 0 ? "v < 0" : "u + v > 1";
        out.missed += ": outside";
    }
    return out;
}

Working work_out_shape(const ShapeRecord& record, const crosscheck::TrueRay& ray) {
    const Vec3d centre{record.centre[0], record.centre[1], record.centre[2]};
    const CentredRay own{ray.origin - centre, ray.direction};
    const Vec3d size{record.size[0], record.size[1], record.size[2]};
    switch (static_cast<ShapeKind>(record.kind)) {
        case ShapeKind::sphere:
            return work_out_sphere(own, size.x);
        case ShapeKind::box:
            return work_out_box(own, size);
        case ShapeKind::frustum:
            return work_out_frustum(own, size.x, size.y, size.z);
        case ShapeKind::capsule:
            return work_out_capsule(own, size.x, size.y, size.z);
        case ShapeKind::plane:
            return work_out_plane(own, size.x, size.y);
        case ShapeKind::disk:
            return work_out_disk(own, size.x, size.y);
        case ShapeKind::quadric:
        case ShapeKind::quadric_from_above:
            break;
    }
    return work_out_quadric(own, record, size);
}

}  // namespace obscura
