// gltf/parse/document.cpp - reads a glTF file into plain structs, every index checked.
// SPDX-License-Identifier: Apache-2.0
#include "gltf/parse/document.h"

#include "gltf/parse/document_animations.h"
#include "gltf/parse/document_buffers.h"
#include "gltf/parse/document_lights.h"
#include "gltf/parse/document_materials.h"
#include "gltf/parse/document_meshes.h"
#include "gltf/parse/document_nodes.h"
#include "gltf/parse/document_shapes.h"
#include "gltf/parse/extensions.h"
#include "gltf/parse/list_text.h"
#include "gltf/parse/model.h"
#include "gltf/parse/node_graph.h"
#include "gltf/parse/preflight.h"
#include "gltf/parse/variants.h"
#include "gltf/parse/xmp.h"
#include "gltf/report.h"

#include <cstdlib>
#include <limits>

namespace obscura::gltf {

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

/// Checked first: in another version everything else may differ.
Result<void> check_version(const JsonReader& root, const Document& document) {
    root.require("asset");
    const JsonReader asset = root.child("asset");
    if (!root.failed()) asset.require("version");
    const std::string said = asset.text("version");
    asset.text("generator");
    asset.text("copyright");
    const std::string least = asset.text("minVersion", "2.0");
    if (root.failed()) return {};

    const Version version = parse_version(said);
    const Version minimum = parse_version(least);
    if (version.major < 0) {
        asset.fault("version", "E-DOC-VERSION", "the version must look like \"2.0\"");
    } else if (minimum.major < 0) {
        asset.fault("minVersion", "E-DOC-VERSION", "the version must look like \"2.0\"");
    } else if (version.major != 2 || minimum.major != 2 || minimum.minor > 0) {
        return fail(ExitCode::unsupported,
                    "E-VERSION",
                    document.at("/asset"),
                    "this is glTF " + said + " (at least " + least +
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

void read_top_level_arrays(DocumentReading& reading) {
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

/// What the readers found that does not stop them.
void tell(const DocumentReading& reading, Problems& problems) {
    const Document& document = reading.document;
    for (const std::string& place : reading.empty) {
        const std::string where = document.at(place + "/count");
        problems.add(
            {ExitCode::bad_data, "E-ACC-COUNT", where, "the count is 0; it must be 1 or more"},
            {Loss::nothing, "what needs the accessor is left out"});
    }
    for (const auto& [place, set] : reading.far_uv_sets) {
        const bool is_clamped = set == uint64_t{std::numeric_limits<int>::max()};  // by tinygltf
        problems.add({ExitCode::bad_data,
                      "E-MAT-TEXCOORD",
                      document.at(place),
                      "texCoord is " + std::to_string(set) + (is_clamped ? " or more" : "") +
                          "; the largest that is read is " + std::to_string(max_uv_sets - 1)},
                     {Loss::nothing, "the texture is ignored"});
    }
}

/// Members of the asset as a whole, and those that tinygltf's model lacks.
Result<void> read_tree(nlohmann::json& tree, bool lenient, Document& document, Log& log) {
    JsonFault fault;
    fault.file = document.file;
    const JsonReader root(tree, "", fault);
    const Result<void> version = check_version(root, document);
    if (!version) return fail(version.error());
    if (!fault.error) {
        const Result<void> extensions = read_extensions(root, tree, lenient, document, log);
        if (!extensions) return fail(extensions.error());
    }
    if (fault.error) return fail(std::move(*fault.error));
    document.report = make_report(tree);
    JsonFault of_xmp = fault;  // the least important fault, reported last
    document.xmp = read_xmp(JsonReader(tree, "", of_xmp), tree);
    check_tree(tree, document, log, fault);
    if (fault.error) return fail(std::move(*fault.error));
    if (of_xmp.error) return fail(std::move(*of_xmp.error));
    return {};
}

}  // namespace

size_t component_size(ComponentType type) {
    switch (type) {
        case ComponentType::int8:
        case ComponentType::uint8:
            return 1;
        case ComponentType::int16:
        case ComponentType::uint16:
            return 2;
        default:
            return 4;
    }
}

Result<Document> read_document(nlohmann::json tree,
                               const std::string& file,
                               Problems& problems,
                               Log& log,
                               const MaterialReading& materials) {
    Document document;
    document.file = file;
    document.reads_occlusion = materials.occlusion;
    document.from_rec709 = materials.from_rec709;
    const Result<void> checked = read_tree(tree, problems.lenient(), document, log);
    if (!checked) return fail(checked.error());
    const Result<tinygltf::Model> model = read_model(tree, file);
    if (!model) return fail(model.error());

    JsonFault fault;
    fault.file = file;
    document.version = model->asset.version;
    document.generator = model->asset.generator;
    document.copyright = model->asset.copyright;
    DocumentReading reading{.model = *model,
                            .document = document,
                            .log = log,
                            .fault = fault,
                            .nodes = tree,
                            .node_count = tree["nodes"].size()};
    read_top_level_arrays(reading);
    if (fault.error) return fail(std::move(*fault.error));
    tell(reading, problems);
    const Result<void> graph = check_node_graph(document);
    if (!graph) return fail(graph.error());
    if (document.xmp.size() > longest_xmp) {
        log.warn(document.at("/asset"), "the XMP packet is longer than 1 MiB; it is left out");
        document.xmp.clear();
    }
    warn_places(reading, reading.clamped, "numbers out of range are clamped: ");
    warn_places(
        reading, reading.misaligned, "data do not start at a multiple of their component's size: ");
    return document;
}

}  // namespace obscura::gltf
