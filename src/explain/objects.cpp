// explain/objects.cpp - lists the objects near a ray, those that it meets first.
// SPDX-License-Identifier: Apache-2.0
#include "explain/objects.h"

#include "explain/names.h"

#include <algorithm>
#include <cmath>
#include <set>

namespace obscura {

namespace {

/// Limit on missed boxes that are worked out, to list the nearest of them.
constexpr size_t max_misses = 20000;

auto key_of(const crosscheck::Item& item) {
    return std::array<int32_t, 3>{item.instance, item.primitive, item.element};
}

/// Items near the ray, each once; those that it meets come first.
std::vector<crosscheck::Item> near_ray(const crosscheck::TrueScene& scene,
                                       const crosscheck::TrueRay& ray,
                                       size_t max_objects) {
    std::vector<crosscheck::Item> items;
    std::set<std::array<int32_t, 3>> known;
    const auto add = [&](const crosscheck::Item& item) {
        if (known.insert(key_of(item)).second) items.push_back(item);
    };
    scene.all_hits(ray, [&](double, const crosscheck::Item& item) { add(item); });
    if (scene.item_count() <= max_objects) {
        for (size_t i = 0; i < scene.item_count(); ++i)
            add(scene.item(i));
        return items;
    }
    const size_t hits = items.size();
    scene.near_items(ray, 0, add);
    const auto end = items.begin() + static_cast<long>(hits);
    std::sort(end, items.end(), [](const crosscheck::Item& a, const crosscheck::Item& b) {
        return key_of(a) < key_of(b);
    });
    return items;
}

Candidate work_out(const crosscheck::TrueScene& scene,
                   const crosscheck::TrueRay& ray,
                   const crosscheck::Item& item) {
    Candidate out;
    out.item = item;
    if (scene.is_triangle(item)) {
        out.working = work_out_triangle(scene.triangle(item), ray);
        return out;
    }
    const Affined own = scene.object_from_world(item);
    crosscheck::TrueRay moved{transform_point(own, ray.origin),
                              transform_vector(own, ray.direction)};
    out.working = work_out_shape(scene.shape(item), moved);
    if (item.instance >= 0 || scene.is_segment(item)) out.moved = moved;
    if (!scene.is_segment(item)) return out;
    // What lies inside the neighbouring segments does not exist.
    const std::vector<double> open = scene.meetings(ray, item);
    std::erase_if(out.working.t, [&](double t) {
        return t > 0 && std::none_of(open.begin(), open.end(), [&](double other) {
                   return std::abs(t - other) < 1e-4 * std::abs(t);
               });
    });
    if (out.working.t.empty() && out.working.missed.empty()) {
        out.working.missed = "it lies inside the next segment of the same line";
    }
    return out;
}

/// Finds where the ray meets the object, behind surfaces that camera rays pass.
void meet(const crosscheck::TrueScene& scene, const PixelReport& report, Candidate& object) {
    const crosscheck::TrueRay& ray = report.working.ray;
    const bool single =
        (material_of(scene.scene(), object.item).flags & material_double_sided) == 0;
    bool ahead = false;
    for (const double t : object.working.t) {
        if (!(t > 0)) continue;
        ahead = true;
        const Vec3d position = ray.origin + ray.direction * t;
        if (single && dot(scene.normal(object.item, position), ray.direction) > 0) {
            object.note = "its back, and its material has one side";
            object.fate = Fate::passed;
            if (!std::isfinite(object.t)) object.t = t;
            continue;
        }
        object.t = t;
        object.fate = t <= report.working.length_m ? Fate::hidden : Fate::beyond;
        object.note.clear();
        return;
    }
    if (!ahead && !object.working.t.empty()) object.fate = Fate::before;
}

bool is_renderers(const PixelReport& report, const crosscheck::Item& item) {
    const RaycastNotes& r = report.renderer;
    return item == crosscheck::Item{r.instance, r.primitive, r.triangle};
}

/// Objects behind a hit are hidden, even where rays would pass them.
void hide_behind(double t, PixelReport& report) {
    for (Candidate& object : report.objects) {
        if (object.fate != Fate::passed || object.t <= t) continue;
        object.fate = Fate::hidden;
        object.note.clear();
    }
}

/// The first of those that the ray may see, sorted; cut-outs are passed where the renderer passed
/// them.
void choose_seen(const crosscheck::TrueScene& scene, PixelReport& report) {
    if (report.renderer.primitive < 0 && report.renderer.passes == 0.0f) return;  // behind splats
    const double limit =
        report.renderer.primitive >= 0 ? static_cast<double>(report.renderer.t) : INFINITY;
    for (Candidate& object : report.objects) {
        if (object.fate != Fate::hidden) continue;
        const bool cut_out = (material_of(scene.scene(), object.item).flags &
                              (material_alpha_mask | material_alpha_blend)) != 0;
        if (cut_out && !is_renderers(report, object.item) && object.t < limit * (1 - 1e-6)) {
            object.fate = Fate::passed;
            object.note = "cut out there by alpha";
            continue;
        }
        object.fate = Fate::seen;
        const double apart = std::abs(object.t - limit);
        report.disagrees = !is_renderers(report, object.item) && !(apart < 1e-5 * limit);
        hide_behind(object.t, report);
        return;
    }
    report.disagrees = report.renderer.primitive >= 0;
}

/// The report follows the renderer's hit, even where an edge is decided by rounding alone.
void follow_renderer(const crosscheck::TrueScene& scene, PixelReport& report) {
    if (!report.disagrees) return;
    for (Candidate& object : report.objects) {
        if (object.fate != Fate::seen) continue;
        object.fate = Fate::passed;
        object.note = "the nearest in double precision; the renderer has passed it";
    }
    const RaycastNotes& r = report.renderer;
    if (r.primitive < 0) return;
    const crosscheck::Item item{r.instance, r.primitive, r.triangle};
    const auto is_item = [&](const Candidate& object) { return object.item == item; };
    auto found = std::find_if(report.objects.begin(), report.objects.end(), is_item);
    if (found == report.objects.end()) {
        found = report.objects.insert(found, work_out(scene, report.working.ray, item));
    }
    found->t = static_cast<double>(r.t);
    found->fate = Fate::seen;
    found->note = "seen by the renderer alone: rounding decides at an edge";
}

/// Met objects first, by distance; of missed triangles the nearest.
bool comes_first(const Candidate& a, const Candidate& b) {
    const bool met_a = std::isfinite(a.t);
    const bool met_b = std::isfinite(b.t);
    if (met_a != met_b) return met_a;
    if (met_a && a.t != b.t) return a.t < b.t;
    if (!met_a && a.working.outside != b.working.outside) {
        return a.working.outside < b.working.outside;
    }
    return key_of(a.item) < key_of(b.item);
}

}  // namespace

const char* fate_name(Fate fate) {
    switch (fate) {
        case Fate::seen:
            return "seen";
        case Fate::hidden:
            return "hidden";
        case Fate::passed:
            return "passed through";
        case Fate::beyond:
            return "too far away";
        case Fate::before:
            return "behind the eye";
        case Fate::missed:
            break;
    }
    return "missed";
}

void list_objects(const crosscheck::TrueScene& scene, size_t max_objects, PixelReport& report) {
    const std::vector<crosscheck::Item> items = near_ray(scene, report.working.ray, max_objects);
    size_t misses = 0;
    for (const crosscheck::Item& item : items) {
        Candidate object = work_out(scene, report.working.ray, item);
        meet(scene, report, object);
        if (std::isfinite(object.t) || ++misses <= max_misses) {
            report.objects.push_back(std::move(object));
        }
    }
    std::sort(report.objects.begin(), report.objects.end(), comes_first);
    choose_seen(scene, report);
    follow_renderer(scene, report);
    std::sort(report.objects.begin(), report.objects.end(), comes_first);
    while (report.objects.size() > max_objects && report.objects.back().fate != Fate::seen)
        report.objects.pop_back();
    const size_t near = std::max(items.size(), report.objects.size());
    report.more_near = near - report.objects.size();
    report.elsewhere = scene.item_count() - near;
    for (Candidate& object : report.objects)
        object.name = name_of_item(scene, object.item);
}

}  // namespace obscura
