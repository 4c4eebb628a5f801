// explain/objects.cpp - the objects near a ray, each worked out, those that it meets first.
// SPDX-License-Identifier: Apache-2.0
#include "explain/objects.h"

#include "explain/names.h"
#include <algorithm>
#include <cmath>
#include <set>

namespace obscura {

namespace {

/// Boxes that are met and not hit are worked out up to this number, to list the nearest of them.
constexpr size_t most_misses = 20000;

auto key_of(const Item& item) {
    return std::array<int32_t, 3>{item.instance, item.primitive, item.row};
}

/// Items near the ray, those that it meets first, each once.
std::vector<Item> near_ray(const TrueScene& scene, const TrueRay& ray, size_t most) {
    std::vector<Item> items;
    std::set<std::array<int32_t, 3>> known;
    const auto add = [&](const Item& item) {
        if (known.insert(key_of(item)).second) items.push_back(item);
    };
    scene.all_hits(ray, [&](double, const Item& item) { add(item); });
    if (scene.item_count() <= most) {
        for (size_t i = 0; i < scene.item_count(); ++i)
            add(scene.item(i));
        return items;
    }
    const size_t hits = items.size();
    scene.near_items(ray, 0, add);
    const auto end = items.begin() + static_cast<long>(hits);
    std::sort(end, items.end(), [](const Item& a, const Item& b) { return key_of(a) < key_of(b); });
    return items;
}

Candidate work_out(const TrueScene& scene, const TrueRay& ray, const Item& item) {
    Candidate out;
    out.item = item;
    if (scene.is_triangle(item)) {
        out.working = work_out_triangle(scene.triangle(item), ray);
        return out;
    }
    const Affined own = scene.object_from_world(item);
    TrueRay moved{transform_point(own, ray.origin), transform_vector(own, ray.direction)};
    out.working = work_out_shape(scene.shape(item), moved);
    if (item.instance >= 0 || scene.is_piece(item)) out.moved = moved;
    if (!scene.is_piece(item)) return out;
    // What lies inside the pieces before and after it is not there.
    const std::vector<double> open = scene.meetings(ray, item);
    std::erase_if(out.working.t, [&](double t) {
        return t > 0 && std::none_of(open.begin(), open.end(), [&](double other) {
                   return std::abs(t - other) < 1e-4 * std::abs(t);
               });
    });
    if (out.working.t.empty() && out.working.missed.empty()) {
        out.working.missed = "it lies inside the next piece of the same line";
    }
    return out;
}

/// Finds where the ray meets the object, past what camera rays go through.
void meet(const TrueScene& scene, const PixelReport& report, Candidate& object) {
    const TrueRay& ray = report.working.ray;
    const bool single =
        (material_of(scene.scene(), object.item).flags & material_double_sided) == 0;
    bool ahead = false;
    for (const double t : object.working.t) {
        if (!(t > 0)) continue;
        ahead = true;
        const Vec3d place = ray.origin + ray.direction * t;
        if (single && dot(scene.normal(object.item, place), ray.direction) > 0) {
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

bool is_renderers(const PixelReport& report, const Item& item) {
    const RaycastNotes& r = report.renderer;
    return item == Item{r.instance, r.primitive, r.triangle};
}

/// What lies behind something is hidden, even where rays would go through it.
void hide_behind(double t, PixelReport& report) {
    for (Candidate& object : report.objects) {
        if (object.fate != Fate::passed || object.t <= t) continue;
        object.fate = Fate::hidden;
        object.note.clear();
    }
}

/// Of those that the ray may see, sorted, the first; cut-outs are passed where the renderer passed
/// them.
void choose_seen(const TrueScene& scene, PixelReport& report) {
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

/// What is told from here on is told of what the renderer saw, be it at an edge by rounding alone.
void follow_renderer(const TrueScene& scene, PixelReport& report) {
    if (!report.disagrees) return;
    for (Candidate& object : report.objects) {
        if (object.fate != Fate::seen) continue;
        object.fate = Fate::passed;
        object.note = "the nearest in double precision; the renderer has passed it";
    }
    const RaycastNotes& r = report.renderer;
    if (r.primitive < 0) return;
    const Item item{r.instance, r.primitive, r.triangle};
    const auto is_item = [&](const Candidate& object) { return object.item == item; };
    auto found = std::find_if(report.objects.begin(), report.objects.end(), is_item);
    if (found == report.objects.end()) {
        found = report.objects.insert(found, work_out(scene, report.working.ray, item));
    }
    found->t = static_cast<double>(r.t);
    found->fate = Fate::seen;
    found->note = "seen by the renderer alone: rounding decides at an edge";
}

/// Those that are met before the others, by distance; of triangles that are missed the nearest.
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

void list_objects(const TrueScene& scene, size_t most, PixelReport& report) {
    const std::vector<Item> items = near_ray(scene, report.working.ray, most);
    size_t misses = 0;
    for (const Item& item : items) {
        Candidate object = work_out(scene, report.working.ray, item);
        meet(scene, report, object);
        if (std::isfinite(object.t) || ++misses <= most_misses) {
            report.objects.push_back(std::move(object));
        }
    }
    std::sort(report.objects.begin(), report.objects.end(), comes_first);
    choose_seen(scene, report);
    follow_renderer(scene, report);
    std::sort(report.objects.begin(), report.objects.end(), comes_first);
    while (report.objects.size() > most && report.objects.back().fate != Fate::seen)
        report.objects.pop_back();
    const size_t near = std::max(items.size(), report.objects.size());
    report.more_near = near - report.objects.size();
    report.elsewhere = scene.item_count() - near;
    for (Candidate& object : report.objects)
        object.name = name_of_item(scene, object.item);
}

}  // namespace obscura
