// explain/report_json.cpp - one pixel for scripts.
// SPDX-License-Identifier: Apache-2.0
#include "base/json_writer.h"

#include "explain/explain_pixel.h"
#include <array>
#include <span>

namespace obscura {

namespace {

void write_numbers(JsonWriter& json, const char* name, std::span<const double> numbers) {
    json.key(name).begin_array();
    for (const double number : numbers)
        json.value(number);
    json.end_array();
}

void write_vector(JsonWriter& json, const char* name, const Vec3d& v) {
    write_numbers(json, name, std::array{v.x, v.y, v.z});
}

void write_vector(JsonWriter& json, const char* name, const Vec3f& v) {
    write_vector(json, name, Vec3d{v.x, v.y, v.z});
}

void write_terms(JsonWriter& json, const std::vector<Term>& terms) {
    json.key("terms").begin_array();
    for (const Term& term : terms) {
        json.begin_object();
        json.member("name", term.name);
        write_numbers(json, "value", term.value);
        json.end_object();
    }
    json.end_array();
}

void write_camera(JsonWriter& json, const PixelReport& report) {
    json.key("camera").begin_object();
    json.member("name", report.camera);
    json.member("model", report.working.model);
    json.member("sees", report.working.sees);
    write_terms(json, report.working.terms);
    json.end_object();
    if (!report.working.sees) return;
    json.key("ray").begin_object();
    write_vector(json, "origin", report.working.ray.origin);
    write_vector(json, "direction", report.working.ray.direction);
    json.member("length", report.working.length_m);
    json.end_object();
}

void write_item(JsonWriter& json, const Item& item) {
    json.member("instance", item.instance);
    json.member("primitive", item.primitive);
    json.member("row", item.row);
}

void write_objects(JsonWriter& json, const PixelReport& report) {
    json.key("objects").begin_array();
    for (const Candidate& object : report.objects) {
        json.begin_object();
        json.member("name", object.name);
        write_item(json, object.item);
        json.member("fate", fate_name(object.fate));
        json.member("t", object.t);
        json.member("note", object.note.empty() ? object.working.missed : object.note);
        json.member("equation", object.working.equation);
        write_terms(json, object.working.terms);
        write_numbers(json, "roots", object.working.t);
        json.end_object();
    }
    json.end_array();
    json.member("more_near", report.more_near);
    json.member("elsewhere", report.elsewhere);
}

void write_renderer(JsonWriter& json, const PixelReport& report) {
    const RaycastNotes& r = report.renderer;
    json.key("renderer").begin_object();
    write_vector(json, "origin", r.origin);
    write_vector(json, "direction", r.direction);
    json.member("hit", r.primitive >= 0);
    if (r.primitive >= 0) {
        json.member("t", static_cast<double>(r.t));
        json.member("name", report.renderer_item);
        write_item(json, {r.instance, r.primitive, r.triangle});
    }
    json.member("agrees", !report.disagrees);
    json.end_object();
}

void write_seen(JsonWriter& json, const PixelReport& report) {
    if (!report.seen) return;
    const SeenPoint& seen = *report.seen;
    json.key("seen").begin_object();
    json.member("object", seen.object);
    write_vector(json, "place", seen.place);
    write_vector(json, "surface_normal", seen.face);
    write_vector(json, "normal", seen.normal);
    write_numbers(
        json, "uv", std::array{static_cast<double>(seen.uv[0]), static_cast<double>(seen.uv[1])});
    json.member("material", seen.material);
    write_vector(json, "base_color", seen.base_color);
    json.end_object();
}

void write_light(JsonWriter& json, const PixelReport& report) {
    json.key("lights").begin_array();
    for (const LightShare& light : report.lights) {
        json.begin_object();
        json.member("name", light.name);
        write_terms(json, light.terms);
        write_vector(json, "direction", light.direction);
        json.member("distance", light.distance_m);
        write_vector(json, "irradiance", light.irradiance);
        json.member("cosine", light.cosine);
        json.member("asked", light.noted.asked);
        write_vector(json, "bsdf", light.bsdf);
        write_vector(json, "offered", light.noted.offered);
        write_vector(json, "arrived", light.noted.arrived);
        json.member("blocked_by", light.blocked_by);
        json.end_object();
    }
    json.end_array();
    write_vector(json, "unshadowed", report.renderer.unshadowed);
}

}  // namespace

std::string pixel_json(const PixelReport& report) {
    JsonWriter json;
    json.begin_object();
    json.member("version", OBSCURA_VERSION);
    json.member("file", report.file);
    json.key("pixel").begin_array().value(report.pixel.x).value(report.pixel.y).end_array();
    json.key("size").begin_array().value(report.pixel.width).value(report.pixel.height).end_array();
    write_camera(json, report);
    if (report.working.sees) {
        write_objects(json, report);
        write_renderer(json, report);
        write_seen(json, report);
        write_light(json, report);
    }
    json.key("rgba").begin_array();
    for (const float channel : report.rgba)
        json.value(static_cast<double>(channel));
    json.end_array();
    json.end_object();
    return std::move(json).take();
}

}  // namespace obscura
