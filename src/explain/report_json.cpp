// explain/report_json.cpp - the report of one pixel as JSON.
// SPDX-License-Identifier: Apache-2.0
#include "base/json/json.h"
#include "explain/explain_pixel.h"

#include <array>
#include <span>

namespace obscura {

namespace {

Json vector_json(const Vec3d& v) {
    return Json::array({v.x, v.y, v.z});
}

Json vector_json(const Vec3f& v) {
    return vector_json(Vec3d{v.x, v.y, v.z});
}

Json terms_json(const std::vector<Term>& terms) {
    Json out = Json::array();
    for (const Term& term : terms)
        out.push_back({{"name", term.name}, {"value", term.value}});
    return out;
}

void add_camera(const PixelReport& report, Json& json) {
    json["camera"] = {{"name", report.camera},
                      {"model", report.working.model},
                      {"sees", report.working.sees},
                      {"terms", terms_json(report.working.terms)}};
    if (!report.working.sees) return;
    json["ray"] = {{"origin", vector_json(report.working.ray.origin)},
                   {"direction", vector_json(report.working.ray.direction)},
                   {"length", report.working.length_m}};
}

void add_item(const crosscheck::Item& item, Json& json) {
    json["instance"] = item.instance;
    json["primitive"] = item.primitive;
    json["row"] = item.element;
}

void add_objects(const PixelReport& report, Json& json) {
    Json& objects = json["objects"] = Json::array();
    for (const Candidate& object : report.objects) {
        Json& out = objects.emplace_back();
        out["name"] = object.name;
        add_item(object.item, out);
        out["fate"] = fate_name(object.fate);
        out["t"] = object.t;
        out["note"] = object.note.empty() ? object.working.missed : object.note;
        out["equation"] = object.working.equation;
        out["terms"] = terms_json(object.working.terms);
        out["roots"] = object.working.t;
    }
    json["more_near"] = report.more_near;
    json["elsewhere"] = report.elsewhere;
}

Json renderer_json(const PixelReport& report) {
    const RaycastNotes& r = report.renderer;
    Json out;
    out["origin"] = vector_json(r.origin);
    out["direction"] = vector_json(r.direction);
    out["hit"] = r.primitive >= 0;
    if (r.primitive >= 0) {
        out["t"] = static_cast<double>(r.t);
        out["name"] = report.renderer_item;
        add_item({r.instance, r.primitive, r.triangle}, out);
    }
    out["agrees"] = !report.disagrees;
    return out;
}

Json seen_json(const SeenPoint& seen) {
    return {{"object", seen.object},
            {"place", vector_json(seen.position)},
            {"surface_normal", vector_json(seen.face)},
            {"normal", vector_json(seen.normal)},
            {"uv", Json::array({static_cast<double>(seen.uv[0]), static_cast<double>(seen.uv[1])})},
            {"material", seen.material},
            {"base_color", vector_json(seen.base_color)}};
}

void add_light(const PixelReport& report, Json& json) {
    Json& lights = json["lights"] = Json::array();
    for (const LightContribution& light : report.lights) {
        lights.push_back({{"name", light.name},
                          {"terms", terms_json(light.terms)},
                          {"direction", vector_json(light.direction)},
                          {"distance", light.distance_m},
                          {"irradiance", vector_json(light.irradiance)},
                          {"cosine", light.cosine},
                          {"asked", light.noted.asked},
                          {"bsdf", vector_json(light.bsdf)},
                          {"offered", vector_json(light.noted.offered)},
                          {"arrived", vector_json(light.noted.arrived)},
                          {"blocked_by", light.blocked_by}});
    }
    json["unshadowed"] = vector_json(report.renderer.unshadowed);
}

}  // namespace

std::string pixel_json(const PixelReport& report) {
    Json json;
    json["version"] = OBSCURA_VERSION;
    json["file"] = report.file;
    json["pixel"] = Json::array({report.pixel.x, report.pixel.y});
    json["size"] = Json::array({report.pixel.width, report.pixel.height});
    add_camera(report, json);
    if (report.working.sees) {
        add_objects(report, json);
        json["renderer"] = renderer_json(report);
        if (report.seen) json["seen"] = seen_json(*report.seen);
        add_light(report, json);
    }
    Json& rgba = json["rgba"] = Json::array();
    for (const float channel : report.rgba)
        rgba.push_back(static_cast<double>(channel));
    return json_document(json);
}

}  // namespace obscura
