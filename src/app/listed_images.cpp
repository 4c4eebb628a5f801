// app/listed_images.cpp - lists the images of a command and checks them, without rendering.
// SPDX-License-Identifier: Apache-2.0
#include "app/listed_images.h"

#include "app/distinct_files.h"
#include "app/listed_poses.h"
#include "app/outcome.h"
#include "session/focus.h"
#include "session/repeated_log.h"
#include "stages/dispatch.h"

#include <fmt/format.h>
#include <system_error>
#include <utility>

namespace obscura::app {

namespace {

/// Whether --part-by frames leaves the frame with this index to another part.
bool is_of_another_part(const RenderRequest& request, size_t index) {
    if (!request.part || request.part_by != PartBy::frames) return false;
    return (index + request.lists.part_offset) % static_cast<size_t>(request.part->count) !=
           static_cast<size_t>(request.part->index);
}

/// What rendering would do first.
Result<void> check_image(Job& job, ListedPoses& poses, size_t index, bool is_last, Log& log) {
    poses.begin_image(index);
    if (auto posed = poses.pose(index, is_last, log); !posed) return posed;
    const Result<ChosenCamera> chosen =
        choose_unfocused_camera(job.renderer->framed_scene(), job.request, log);
    if (!chosen) return fail(chosen.error());
    return expose(job, *chosen, log);
}

}  // namespace

std::vector<size_t> indices_to_render(const RenderRequest& request, size_t count) {
    std::vector<size_t> out;
    for (size_t i = 0; i < count; ++i) {
        if (!is_of_another_part(request, i)) out.push_back(i);
    }
    return out;
}

Result<void> note_files(Job& job, const std::vector<ListedImage>& images) {
    KeptForLater& kept = job.kept;
    std::error_code error;
    for (const ListedImage& image : images) {
        for (const std::filesystem::path& file : all_files(job.whole, image)) {
            const auto place = std::filesystem::absolute(file, error).lexically_normal();
            if (kept.written.try_emplace(place, kept.run).first->second == kept.run) continue;
            return fail(
                ExitCode::usage,
                "E-USAGE-SAMEFILE",
                file.string(),
                "another image of this command has this file, or it is read; names must tell "
                "them apart");
        }
    }
    return {};
}

void ImageFailures::add(const ListedImage& image, const Error& error, Log& log) {
    log.warn(image.label.empty() ? image.outputs.front().string() : image.label,
             "this image fails: " + error.where + ": " + error.message + " [" + error.id +
                 "]; the others go on");
    errors_.push_back(error);
    if (!image.label.empty()) {
        std::string& message = errors_.back().message;
        message = image.label + ": " + message;
    }
}

Error ImageFailures::all(size_t asked) && {
    Error out = joined(std::move(errors_));
    out.message = fmt::format(
        "{} of {} images failed; the first: {}", out.also.size() + 1, asked, out.message);
    return out;
}

Result<void> note_all_files(Job& job) {
    ListedPoses poses(job);
    if (auto listed = poses.find_images(job.log); !listed) return listed;
    return note_files(job, poses.list().images);
}

Result<void> list_all(Job& job) {
    ListedPoses poses(job);
    if (auto listed = poses.find_images(job.log); !listed) return listed;
    std::string text;
    const std::vector<ListedImage>& images = poses.list().images;
    if (auto own = note_files(job, images); !own) return own;
    const std::vector<size_t> indices = indices_to_render(job.whole, images.size());
    for (const size_t i : indices) {
        for (const std::filesystem::path& file : all_files(job.whole, images[i]))
            text += escape_control(file.string()) + "\n";
    }
    job.log.info(fmt::format("{} images", indices.size()));
    return print_output(text);
}

Result<void> check_all(Job& job) {
    ListedPoses poses(job);
    if (const Result<void> loaded = poses.load_once(); !loaded) return loaded;
    if (auto listed = poses.find_images(job.log); !listed) return listed;
    const std::vector<ListedImage>& images = poses.list().images;
    if (auto apart = check_distinct_files(job.request, images); !apart) return apart;
    if (auto own = note_files(job, images); !own) return own;
    RepeatedLog later(job.log, SettingNames::options);
    ImageFailures failures;
    const std::vector<size_t> asked = indices_to_render(job.whole, images.size());
    for (const size_t i : asked) {
        Log& log = i == asked.front() ? job.log : later.begin();
        Result<void> checked = check_image(job, poses, i, i == asked.back(), log);
        if (checked) continue;
        Error error = at_its_view(std::move(checked.error()), poses.list().views[images[i].view]);
        if (!job.whole.lists.is_asked() || error.code == ExitCode::stopped_early)
            return fail(std::move(error));
        failures.add(images[i], error, job.log);
    }
    if (failures.count() > 0) return fail(std::move(failures).all(asked.size()));
    if (!has_isa(job.request.isa)) return fail(missing_isa());
    job.log.info(fmt::format("{} is checked: nothing forbids to render {}; nothing was written",
                             job.whole.scene.string(),
                             asked.size() == 1 ? "it" : fmt::format("{} images", asked.size())));
    return {};
}

}  // namespace obscura::app
