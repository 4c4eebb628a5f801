// explain/explain_pixel.cpp - collects everything that the report of one pixel tells.
// SPDX-License-Identifier: Apache-2.0
#include "explain/explain_pixel.h"

#include "explain/light_contributions.h"
#include "explain/names.h"
#include "explain/objects.h"
#include "explain/report_svg.h"
#include "render/prepared_scene.h"

#include <algorithm>
#include <fmt/format.h>

namespace obscura {

namespace {

/// The channels of the task's pixel.
Result<std::vector<float>> render_pixel(const PixelTask& task,
                                        Integrator integrator,
                                        RaycastNotes* notes) {
    RenderOptions options = task.options;
    options.integrator = integrator;
    options.crop = PixelRect{task.pixel.x, task.pixel.y, 1, 1};
    options.notes = notes;
    const std::atomic<bool> never = false;
    const Result<RenderResult> result = render(*task.scene, task.camera, options, {}, never);
    if (!result) return fail(result.error());
    return std::vector<float>(result->film.pixels.begin(), result->film.pixels.end());
}

std::string describe_surface(const Scene& scene, const Material& material) {
    if ((material.flags & material_unlit) != 0) return "unlit: its base colour is what is seen";
    std::string text = fmt::format(
        "metallic {:g}, roughness {:g}{}",
        material.metallic,
        material.roughness,
        material.metallic_roughness_texture.texture >= 0 ? ", each times its texture" : "");
    if (std::max({material.emission[0], material.emission[1], material.emission[2]}) > 0) {
        text += fmt::format(", emission ({:g}, {:g}, {:g})",
                            material.emission[0],
                            material.emission[1],
                            material.emission[2]);
    }
    if (material.layers >= 0 && static_cast<size_t>(material.layers) < scene.layers.size()) {
        text += ", with the layers of its extensions";
    }
    return text;
}

/// Asks the renderer for the inputs of shading.
Result<void> look_closer(const PixelTask& task, SeenPoint& seen) {
    const Result<std::vector<float>> normal = render_pixel(task, Integrator::normal, nullptr);
    if (!normal) return fail(normal.error());
    const Result<std::vector<float>> albedo = render_pixel(task, Integrator::albedo, nullptr);
    if (!albedo) return fail(albedo.error());
    const Result<std::vector<float>> uv = render_pixel(task, Integrator::uv, nullptr);
    if (!uv) return fail(uv.error());
    seen.normal = {(*normal)[0], (*normal)[1], (*normal)[2]};
    seen.base_color = {(*albedo)[0], (*albedo)[1], (*albedo)[2]};
    seen.uv = {(*uv)[0], (*uv)[1]};
    return {};
}

/// The object that the renderer shaded.
std::optional<size_t> number_of_seen(const PixelReport& report) {
    for (size_t i = 0; i < report.objects.size(); ++i) {
        if (report.objects[i].fate == Fate::seen) return i;
    }
    return {};
}

Result<void> look_at_seen(const PixelTask& task,
                          const crosscheck::TrueScene& scene,
                          PixelReport& report) {
    const std::optional<size_t> number = number_of_seen(report);
    if (!number || report.renderer.primitive < 0) return {};
    const Candidate& object = report.objects[*number];
    const crosscheck::TrueRay& ray = report.working.ray;
    SeenPoint seen;
    seen.object = *number;
    seen.position = ray.origin + ray.direction * object.t;
    seen.face = scene.normal(object.item, seen.position);
    if (dot(seen.face, ray.direction) > 0) seen.face = seen.face * -1.0;
    seen.material = name_of_material(scene.scene(), object.item);
    seen.surface = describe_surface(scene.scene(), material_of(scene.scene(), object.item));
    if (auto looked = look_closer(task, seen); !looked) return looked;
    report.seen = seen;
    return {};
}

}  // namespace

Result<PixelReport> explain_pixel(const PixelTask& task) {
    PixelReport report;
    report.file = task.file;
    report.camera = task.camera_name;
    report.pixel = task.pixel;
    report.working = work_out_camera(task.camera, task.pixel);
    const Result<std::vector<float>> rgba =
        render_pixel(task, Integrator::raycast, &report.renderer);
    if (!rgba) return fail(rgba.error());
    std::copy_n(rgba->begin(), 4, report.rgba.begin());
    if (!report.working.sees && !task.draws) return report;
    const crosscheck::TrueScene scene(task.scene->scene());
    if (report.working.sees) list_objects(scene, task.max_objects, report);
    const RaycastNotes& r = report.renderer;
    if (r.primitive >= 0) {
        report.renderer_item = name_of_item(scene, {r.instance, r.primitive, r.triangle});
    }
    if (auto looked = look_at_seen(task, scene, report); !looked) return fail(looked.error());
    report.lights = find_light_contributions(task.scene->impl(), scene, report);
    if (task.draws) report.drawing = pixel_svg(scene, report);
    return report;
}

}  // namespace obscura
