// app/list_options.cpp - the options that ask for many images of one asset.
// SPDX-License-Identifier: Apache-2.0
#include "app/list_options.h"

#include "app/command_line.h"
#include "app/option_readers.h"
#include "app/render_command.h"
#include "app/render_options.h"
#include "app/render_request.h"
#include "base/name_search.h"
#include "session/image_names.h"

#include <algorithm>
#include <array>
#include <filesystem>
#include <map>
#include <system_error>
#include <utility>

namespace obscura::app {

namespace {

using A = RenderArguments;
using G = ListArguments;
using K = ListRequest;
using R = RenderRequest;
using Entry = OptionEntry<A, R>;

// clang-format off
constexpr Entry entries[] = {
    {{.name = "--turntable", .argument = "N",
      .help = "N images of a whole turn around the scene, which begins at --azimuth; their numbers "
              "are frames 1 to N. All have one scale, as of --frame sphere",
      .range = {1, 100000}, .fallback = "one image",
      .excludes = {"--frames", "--views", "--cameras"}},
     text_at<&A::list, &G::turntable>, number_at<&R::lists, &K::turntable>},
    {{.name = "--cameras", .argument = "all|PATTERN",
      .help = "An image by each camera of the file, or by those of these names, with commas "
              "between them. * and ? stand for any text and letter",
      .excludes = {"--camera", "--views", "--camera-json"}},
     text_at<&A::list, &G::cameras>, name_at<&R::lists, &K::cameras>},
    {{.name = "--variants", .argument = "all|PATTERN",
      .help = "An image of each variant of the file, or of those of these names, as for --cameras",
      .excludes = {"--variant"}},
     text_at<&A::list, &G::variants>, name_at<&R::lists, &K::variants>},
    {{.name = "--views", .argument = "FILE.json",
      .help = "An image of each view in the file: its camera, and what else differs "
              "(docs/many_images.md)",
      .files = "json"},
     text_at<&A::list, &G::views>, name_at<&R::lists, &K::views_file>},
    {{.name = "--manifest", .argument = "FILE.jsonl",
      .help = "Write a line of JSON as each image is finished or fails: files with SHA-256, asset, "
              "variant, view, camera, seconds, warnings, exit code", .files = "jsonl"},
     text_at<&A::list, &G::manifest>, name_at<&R::lists, &K::manifest>}};
// clang-format on

/// The names of all files that each scene writes, as patterns.
std::vector<std::filesystem::path> patterns_of(const RenderRequest& request) {
    std::vector<std::filesystem::path> patterns = request.outputs;
    if (request.segmentation) patterns.push_back(*request.segmentation);
    if (request.long_run.has_checkpoint && !request.long_run.checkpoint.empty())
        patterns.push_back(request.long_run.checkpoint);
    return patterns;
}

std::string scene_name(const RenderArguments& arguments) {
    if (!arguments.asset.empty()) return arguments.asset;
    return std::filesystem::path(arguments.scene_file).stem().string();
}

/// An option that is given and puts the camera elsewhere than the file; null: there is none.
const char* placing_option(const ProductArguments& product, const CameraRequest& camera) {
    const std::array<std::pair<const char*, bool>, 10> all = {
        {{"--eye", camera.eye_m.has_value()},
         {"--target", camera.target_m.has_value()},
         {"--up", camera.up.has_value()},
         {"--azimuth", product.azimuth.has_value()},
         {"--elevation", product.elevation.has_value()},
         {"--roll", product.roll.has_value()},
         {"--zoom", product.zoom.has_value()},
         {"--margin", product.margin.has_value()},
         {"--frame", product.frame.has_value()},
         {"--focus-node", product.focus_node.has_value()}}};
    const auto* const found =
        std::find_if(all.begin(), all.end(), [](const auto& entry) { return entry.second; });
    return found == all.end() ? nullptr : found->first;
}

/// What does not go with a turn around the scene.
Result<void> complete_turntable(const RenderArguments& arguments, RenderRequest& request) {
    if (request.lists.turntable == 0) return {};
    const CameraRequest& camera = request.camera;
    if (camera.eye_m || camera.target_m || camera.up || request.camera_json ||
        arguments.camera.value_or("auto") != "auto") {
        return conflict("--turntable",
                        "it goes around the framed scene; leave out the camera, or give "
                        "--azimuth, --elevation, --zoom, --margin or --focus-node");
    }
    if (!arguments.product.frame) request.camera.framing.fit = FrameFit::sphere;
    return {};
}

bool tells_images_apart(const std::filesystem::path& pattern, bool has_numbers) {
    if (has_fields(pattern)) return true;
    return has_numbers && frame_file(pattern, 0).has_value();
}

/// A word too many on the command line is a scene that there is not.
Result<void> check_scene_files(const std::vector<SceneRun>& runs) {
    for (const SceneRun& run : runs) {
        std::error_code error;
        if (std::filesystem::exists(run.request.scene, error)) continue;
        return fail(ExitCode::missing_scene,
                    "E-SCENE-MISSING",
                    run.request.scene.string(),
                    "there is no such scene; accepted are .gltf and .glb files");
    }
    return {};
}

/// Why a name that a pattern gives two renderings is refused.
const char* why_one_file(const std::filesystem::path& pattern,
                         const RenderRequest& a,
                         const RenderRequest& b) {
    const bool same_asset = a.lists.asset == b.lists.asset;
    const bool same_look = a.lists.look == b.lists.look;
    if (same_asset && same_look)
        return "two outputs, or looks of one name, have this file; give them different names";
    if (!same_asset && !has_field(pattern, "asset")) {
        return "a file's name must tell scenes apart; expected {asset} in it, such as "
               "out/{asset}.png";
    }
    if (!same_look && !has_field(pattern, "look"))
        return "a file's name must tell looks apart; expected {look} in it";
    return "it gives two renderings one name; put a / between its fields, and give looks names "
           "that "
           "differ in more than signs that files' names cannot have";
}

}  // namespace

Result<std::vector<RenderArguments>> arguments_of_scenes(const RenderArguments& arguments) {
    for (const std::string& word : arguments.more_scenes) {
        const std::string hint = commas_hint(word);
        std::error_code error;
        if (hint.empty() || std::filesystem::exists(word, error)) continue;
        return fail(ExitCode::usage,
                    "E-USAGE",
                    "command-line",
                    in_quotes(word) + " is one argument too many" + hint);
    }
    std::vector<std::string> files = {arguments.scene_file};
    files.insert(files.end(), arguments.more_scenes.begin(), arguments.more_scenes.end());
    std::vector<std::string> names;
    for (const std::string& file : files)
        names.push_back(name_part(std::filesystem::path(file).stem().string()));
    names = distinct_names(std::move(names));
    std::vector<RenderArguments> out;
    for (size_t i = 0; i < files.size(); ++i) {
        RenderArguments& one = out.emplace_back(arguments);
        one.more_scenes.clear();
        one.scene_file = files[i];
        if (files.size() == 1) break;
        one.asset = names[i];
    }
    return out;
}

Result<void> check_scenes(const std::vector<SceneRun>& runs) {
    if (runs.size() == 1) return {};
    const RenderRequest& first = runs.front().request;
    const auto conflict_of = [](const char* option) {
        return conflict(option, "it is of one scene; leave it out, or render scenes one by one");
    };
    if (first.standard_output) return conflict_of("--output");
    if (first.statistics) return conflict_of("--stats");
    if (first.crypto_manifest) return conflict_of("--crypto-manifest");
    std::map<std::filesystem::path, const RenderRequest*> seen;
    for (const SceneRun& run : runs) {
        const RenderRequest& request = run.request;
        // What else is in a name tells the images of one scene apart.
        const NameFields fields{request.lists.asset, "", "", 1, request.lists.look};
        for (const std::filesystem::path& pattern : patterns_of(request)) {
            const auto [before, is_new] =
                seen.try_emplace(name_by_pattern(pattern, fields), &request);
            if (is_new) continue;
            if (auto there = check_scene_files(runs); !there) return there;
            auto refused =
                conflict(pattern.string(), why_one_file(pattern, *before->second, request));
            return fail(at_its_place(std::move(refused.value()), run.places));
        }
    }
    return {};
}

std::string listed_output(const RenderArguments& arguments) {
    std::string out = scene_name(arguments);
    if (arguments.list.variants || arguments.list.views) out += ".{variant}";
    if (arguments.list.cameras || arguments.list.views) out += ".{view}";
    if (arguments.list.turntable || arguments.frames) out += ".{frame:04}";
    return out + arguments.default_ending;
}

Result<void> complete_list(const RenderArguments& arguments, RenderRequest& request) {
    request.lists.asset = arguments.asset;
    request.lists.look = arguments.look;
    request.lists.sampling = arguments.list.sampling;
    request.lists.sampling.seed = request.options.seed;
    if (request.lists.manifest && request.standard_output) {
        return conflict("--manifest", "it is of files; give -o a file's name in place of -");
    }
    if (request.lists.manifest && output_format_of(*request.lists.manifest)) {
        return conflict("--manifest", "it is text, and by its name a picture; expected .jsonl");
    }
    if (!request.lists.is_asked()) return {};
    const char* const placing = placing_option(arguments.product, request.camera);
    if (request.lists.cameras && placing != nullptr) {
        return conflict(
            "--cameras",
            std::string("the file's cameras are neither placed nor framed; leave out ") + placing +
                ", or leave out --cameras");
    }
    if (auto done = complete_turntable(arguments, request); !done) return done;
    if (request.standard_output) {
        return conflict("--output", "- takes one image; give files such as {view}.png");
    }
    std::vector<std::filesystem::path> patterns = request.outputs;
    if (request.segmentation) patterns.push_back(*request.segmentation);
    const bool has_numbers = request.frames || request.lists.turntable > 0;
    for (const std::filesystem::path& pattern : patterns) {
        if (tells_images_apart(pattern, has_numbers)) continue;
        return conflict(pattern.string(),
                        "a file's name must tell the images apart; expected {view}, {variant} or "
                        "{frame:04} in it, such as out/{variant}/{view}.png");
    }
    return {};
}

OptionGroup<RenderArguments, RenderRequest> list_group() {
    return {"Many images", entries};
}

}  // namespace obscura::app
