// app/dataset_options.cpp - the table of the options of `obscura dataset`.
// SPDX-License-Identifier: Apache-2.0
#include "app/dataset_options.h"

#include "app/dataset_command.h"
#include "app/option_readers.h"
#include "app/render_options.h"

#include <algorithm>

namespace obscura::app {

namespace {

using A = DatasetArguments;
using R = DatasetRequest;
using S = ViewSampling;
using D = dataset::Dataset;
using Entry = OptionEntry<A, R>;

constexpr const char* notes = R"(
Each image has a depth file, a file of ids and its labels: camera, and of each object the pose, the
boxes, the masks and how much of it is seen (docs/dataset.md).

Examples:
  obscura dataset mug.glb --count 500 --write bop,coco -o mugs --size 640x480 --env studio
  obscura dataset parts/*.glb --count 100 --sample hemisphere --hide floor -o parts
  obscura dataset room.glb --count 200 --sample box --write nerf -o room --spp 64
  obscura dataset mug.glb --count 100000 --part 3/50 -o mugs
      the third of fifty machines; each makes 2000 images)";

constexpr std::array<Choice<ViewSpace>, 3> spaces = {{{"sphere", ViewSpace::sphere},
                                                      {"hemisphere", ViewSpace::hemisphere},
                                                      {"box", ViewSpace::box}}};

/// Reads names with commas between them.
template <typename Take>
Result<void> each_name(const std::string& text, const Take& take) {
    for (size_t begin = 0; begin <= text.size();) {
        const size_t end = std::min(text.find(',', begin), text.size());
        if (auto taken = take(text.substr(begin, end - begin)); !taken) return taken;
        begin = end + 1;
    }
    return {};
}

using dataset::Formats;
constexpr bool Formats::*plain = nullptr;
constexpr std::array<Choice<bool Formats::*>, 4> formats = {
    {{"plain", plain}, {"bop", &Formats::bop}, {"coco", &Formats::coco}, {"nerf", &Formats::nerf}}};

constexpr bool S::*nothing = nullptr;
constexpr std::array<Choice<bool S::*>, 3> varied = {
    {{"none", nothing}, {"environment", &S::turns_environment}, {"variant", &S::chooses_variant}}};

Result<void> read_formats(const OptionInfo& info, const std::string& text, R& request) {
    return each_name(text, [&](const std::string& name) -> Result<void> {
        const auto chosen = choose_option(name, long_name(info), formats);
        if (!chosen) return fail(chosen.error());
        if (*chosen != plain) request.dataset.formats.*(*chosen) = true;
        return {};
    });
}

Result<void> read_varied(const OptionInfo& info, const std::string& text, R& request) {
    request.sampling.turns_environment = request.sampling.chooses_variant = false;
    return each_name(text, [&](const std::string& name) -> Result<void> {
        const auto chosen = choose_option(name, long_name(info), varied);
        if (!chosen) return fail(chosen.error());
        if (*chosen != nothing) request.sampling.*(*chosen) = true;
        return {};
    });
}

// clang-format off
constexpr Entry entries[] = {
    {{.name = "-o,--output", .argument = "FOLDER",
      .help = "Where the data set goes; a folder for each scene is made in it", .files = "/"},
     text_at<&A::output>},
    {{.name = "--count", .argument = "N", .help = "Images of each scene", .range = {1, 1000000}},
     text_at<&A::count>, number_at<&R::sampling, &S::count>},
    {{.name = "--sample", .argument = "NAME",
      .help = "Where the cameras are: on all sides of the asset; on all sides, but not below its "
              "middle; or inside its bounding box, looking about level:"},
     text_at<&A::sample>, choice_at<spaces, &R::sampling, &S::space>},
    {{.name = "--fill", .argument = "LOW,HIGH",
      .help = "Around an asset: the share of the image that the asset's sphere takes, at random "
              "between these", .range = {0.01, 1},
      .accepted = "two numbers from 0.01 to 1, such as 0.5,0.9",
      .fallback = "0.5,0.9"},
     text_at<&A::fill>, numbers_at<2, &R::sampling, &S::fill>},
    {{.name = "--vary", .argument = "NAME[,NAME]",
      .help = "What changes from image to image beside the camera: environment, which is turned, "
              "and variant, or none",
      .fallback = "environment,variant; with --write nerf none"},
     text_at<&A::vary>, {.read = read_varied, .show = nullptr, .names = choice_names<varied>}},
    {{.name = "--write", .argument = "NAME[,NAME]",
      .help = "Formats beside the plain one, which is always written: bop, coco, nerf",
      .fallback = "plain"},
     text_at<&A::write>, {.read = read_formats, .show = nullptr, .names = choice_names<formats>}},
    {{.name = "--depth-unit", .argument = "MM",
      .help = "Millimetres of a step of the 16-bit depth files", .range = {1e-6, 1e6},
      .fallback = "a power of ten that reaches beyond the views of the scene"},
     text_at<&A::depth_unit>, number_at<&R::depth_unit_mm>},
    {{.name = "--exr",
      .help = "Also write each image to exr/NAME.exr, with the layers of --aov"},
     text_at<&A::layers_exr>},
    {{.name = "--part", .argument = "I/N|auto",
      .help = "Render share I of N: every N-th image. Each part writes the formats of what is "
              "there when it ends, so that the last one writes all", .fallback = "all"},
     text_at<&A::part>},
    {{.name = "--dry-run", .help = "Print the names of all images, and render nothing"},
     text_at<&A::dry_run>}};
// clang-format on

constexpr DatasetOptionGroup groups[] = {{"", entries}};

/// Options of `obscura render` that images of a data set have, by their headings.
struct Taken {
    const char* heading;
    std::span<const char* const> names;
};

// clang-format off
constexpr const char* image_options[] = {
    "--size", "--spp", "--noise-target", "--spp-min", "--depth", "--seed", "--filter", "--denoise",
    "--clamp-direct", "--clamp-indirect", "--caustics", "--regularize", "--aov", "--background",
    "--exposure", "--view", "--display", "--ocio", "--no-dither"};
constexpr const char* camera_options[] = {
    "--fov", "--focus-node", "--roll", "--distortion", "--fstop", "--focus-distance"};
constexpr const char* light_options[] = {"--env", "--env-intensity", "--env-rotation", "--lights"};
constexpr const char* scene_options[] = {
    "--scene", "--variant", "--time", "--animation", "--hide", "--holdout", "--camera-invisible",
    "--no-shadow", "--catcher", "--lenient"};
constexpr const char* program_options[] = {
    "--manifest", "--skip-existing", "--time-limit", "--threads", "--priority", "--max-memory",
    "--texture-memory", "--texture-cache", "--isa", "--write-retries", "--quiet", "--verbose"};
// clang-format on

constexpr Taken taken_options[] = {{"Image", image_options},
                                   {"Camera", camera_options},
                                   {"Light", light_options},
                                   {"Scene", scene_options},
                                   {"Program", program_options}};

}  // namespace

std::span<const DatasetOptionGroup> dataset_option_groups() {
    return groups;
}

Command dataset_command(DatasetArguments& arguments) {
    Command command{"dataset", "Render images with labels from random views", notes};
    add_render_option(command, arguments.render, "SCENE", "");
    add_render_option(command, arguments.render, "MORE_SCENES", "").info.help =
        "Further ones; each has a folder of its own";
    for (BoundOption& option : bind_all(dataset_option_groups(), arguments))
        command.options.push_back(std::move(option));
    for (const Taken& group : taken_options) {
        for (const char* name : group.names)
            add_render_option(command, arguments.render, name, group.heading);
    }
    command.run = [&arguments] { return run_dataset(arguments); };
    return command;
}

}  // namespace obscura::app
