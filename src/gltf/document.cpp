// gltf/document.cpp - a glTF file as plain structs: every index checked, nothing converted yet.
// SPDX-License-Identifier: Apache-2.0
#include "gltf/document.h"

#include "gltf/document_parts.h"
#include "gltf/extensions.h"
#include "gltf/list_text.h"
#include "gltf/node_graph.h"
#include "gltf/report.h"
#include "gltf/variants.h"
#include "gltf/xmp.h"

#include <algorithm>
#include <cmath>
#include <cstdlib>

namespace obscura {

namespace {

struct Version {
    int major = -1;
    int minor = -1;
};

/// "2.0" -> 2, 0; -1, -1 when it is not of this form.
Version parse_version(const std::string& text) {
    const size_t dot = text.find('.');
    const auto digits = [](const std::string& part) {
        return !part.empty() && part.size() <= 4 &&
               part.find_first_not_of("0123456789") == std::string::npos;
    };
    if (dot == std::string::npos) return {};
    const std::string major = text.substr(0, dot);
    const std::string minor = text.substr(dot + 1);
    if (!digits(major) || !digits(minor)) return {};
    return {std::atoi(major.c_str()), std::atoi(minor.c_str())};
}

Result<void> read_asset(const JsonReader& root, Document& document) {
    root.require("asset");
    const JsonReader asset = root.child("asset");
    if (!root.failed()) asset.require("version");
    document.version = asset.text("version");
    document.generator = asset.text("generator");
    document.copyright = asset.text("copyright");
    const std::string least = asset.text("minVersion", "2.0");
    if (root.failed()) return {};

    const Version version = parse_version(document.version);
    const Version minimum = parse_version(least);
    if (version.major < 0) {
        asset.fault("version", "E-DOC-VERSION", "the version must look like \"2.0\"");
    } else if (minimum.major < 0) {
        asset.fault("minVersion", "E-DOC-VERSION", "the version must look like \"2.0\"");
    } else if (version.major != 2 || minimum.major != 2 || minimum.minor > 0) {
        return fail(ExitCode::unsupported,
                    "E-VERSION",
                    document.at("/asset"),
                    "this is glTF " + document.version + " (at least " + least +
                        " is needed to read it); accepted is 2.x with a minVersion of at most 2.0");
    }
    return {};
}

/// One warning for many places.
void warn_places(const DocumentReading& reading,
                 const std::vector<std::string>& places,
                 const char* text) {
    if (places.empty()) return;
    reading.log.warn(reading.document.file, text + list_text(places));
}

void read_parts(DocumentReading& reading) {
    read_buffers(reading);
    read_views(reading);
    read_accessors(reading);
    read_images(reading);
    read_samplers(reading);
    read_textures(reading);
    read_materials(reading);
    read_variants(reading);
    read_meshes(reading);
    read_skins(reading);
    read_cameras(reading);
    read_lights(reading);
    read_light_profiles(reading);
    read_environments(reading);
    read_shapes(reading);
    read_nodes(reading);
    read_animations(reading);
    read_scenes(reading);
}

}  // namespace

double clamped_number(DocumentReading& reading,
                      const JsonReader& object,
                      std::string_view key,
                      const NumberRange& range) {
    const double value = object.number(key, range.fallback);
    if (value >= range.low && value <= range.high) return value;
    reading.clamped.push_back(object.pointer() + "/" + std::string(key));
    return std::clamp(value, range.low, range.high);
}

void clamped_numbers(DocumentReading& reading,
                     const JsonReader& object,
                     std::string_view key,
                     std::span<double> out,
                     const NumberRange& range) {
    if (!object.numbers(key, out)) return;
    bool noted = false;
    for (double& value : out) {
        const double inside = std::clamp(value, range.low, range.high);
        if (inside != value && !noted) {
            reading.clamped.push_back(object.pointer() + "/" + std::string(key));
            noted = true;
        }
        value = inside;
    }
}

Result<Document> read_document(const nlohmann::json& tree,
                               const std::string& file,
                               Problems& problems,
                               Log& log,
                               bool occlusion) {
    JsonFault fault;
    fault.file = file;
    Document document;
    document.file = file;
    document.reads_occlusion = occlusion;
    const JsonReader root(tree, "", fault);

    const Result<void> version = read_asset(root, document);
    if (!version) return fail(version.error());
    if (!fault.error) {
        const Result<void> extensions =
            read_extensions(root, tree, problems.lenient(), document, log);
        if (!extensions) return fail(extensions.error());
    }
    DocumentReading reading{root, document, log};
    if (!fault.error) read_parts(reading);
    if (!fault.error) document.xmp = read_xmp(root, tree);
    if (fault.error) return fail(std::move(*fault.error));
    for (const std::string& place : reading.empty) {
        const std::string where = document.at(place + "/count");
        problems.add(
            {ExitCode::bad_data, "E-ACC-COUNT", where, "the count is 0; it must be 1 or more"},
            {Loss::nothing, "what needs the accessor is left out"});
    }
    for (const auto& [place, set] : reading.far_uv_sets) {
        problems.add({ExitCode::bad_data,
                      "E-MAT-TEXCOORD",
                      document.at(place),
                      "texCoord is " + std::to_string(set) + "; the largest that is read is " +
                          std::to_string(max_uv_sets - 1)},
                     {Loss::nothing, "the texture is ignored"});
    }

    const Result<void> graph = check_node_graph(document);
    if (!graph) return fail(graph.error());
    document.report = make_report(tree);
    if (document.xmp.size() > longest_xmp) {
        log.warn(document.at("/asset"), "the XMP packet is longer than 1 MiB; it is left out");
        document.xmp.clear();
    }
    warn_places(reading, reading.clamped, "numbers out of range are clamped: ");
    warn_places(
        reading, reading.misaligned, "data do not start at a multiple of their component's size: ");
    return document;
}

}  // namespace obscura
