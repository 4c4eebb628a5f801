// session/manifest.cpp - a line of JSON for each image of a command.
// SPDX-License-Identifier: Apache-2.0
#include "session/manifest.h"

#include "base/json/json.h"
#include "base/setting_names.h"
#include "base/sha256.h"
#include "session/opencv_camera.h"
#include "session/outputs.h"

#include <cerrno>
#include <fcntl.h>
#include <system_error>
#include <unistd.h>
#include <utility>

namespace obscura {

namespace {

Json files_json(const RenderRequest& request, const ListedImage& image) {
    Json out = Json::array();
    for (const std::filesystem::path& file : all_files(request, image)) {
        const std::optional<FileDigest> digest = digest_file(file);
        if (!digest) continue;
        Json one = {{"file", file.string()}, {"sha256", digest->sha256}, {"bytes", digest->bytes}};
        if (file == image.segmentation) one["mask"] = true;  // by its name it is a picture
        out.push_back(std::move(one));
    }
    return out;
}

Json camera_json(const RenderRequest& request, const ChosenCamera& chosen) {
    const RenderOptions& options = request.options;
    Json out = {{"description", chosen.description},
                {"width", options.width},
                {"height", options.height},
                {"K", intrinsics_json(chosen, {options.width, options.height})}};
    const auto& distortion = chosen.settings.distortion;
    if (is_distorted(chosen.camera) && distortion) out["distortion"] = *distortion;
    add_pose_json(chosen.camera, out);
    return out;
}

tl::unexpected<Error> cannot_write(const std::filesystem::path& file) {
    return fail(ExitCode::io_error,
                "E-OUT-WRITE",
                file.string(),
                "cannot be written: " + std::generic_category().message(errno));
}

}  // namespace

std::string manifest_line(const RenderRequest& request, const ImageOutcome& outcome) {
    const ListedImage& image = outcome.image;
    const bool is_there = !outcome.error;
    Json line;
    line["files"] = is_there ? files_json(request, image) : Json::array();
    line["asset"] = request.scene.string();
    line["look"] = request.lists.look;
    line["variant"] = image.variant.empty() ? Json() : Json(image.variant);
    line["view"] = outcome.view.name.empty() ? Json() : Json(outcome.view.name);
    line["frame"] = image.number ? Json(*image.number) : Json();
    line["time_s"] = image.time_s;
    line["camera"] = outcome.camera ? camera_json(request, *outcome.camera) : Json();
    line["exposure"] = request.display.exposure_ev;
    line["seconds"] = outcome.seconds;
    line["was_there"] = outcome.was_there;
    line["warnings"] = outcome.warnings;
    line["exit_code"] = outcome.error ? static_cast<int>(outcome.error->code) : 0;
    line["id"] = outcome.error ? outcome.error->id : "OK";
    if (outcome.error) {
        line["message"] = spell_settings(outcome.error->where + ": " + outcome.error->message,
                                         SettingNames::options);
    }
    return json_line(line);
}

Manifest::Manifest(std::filesystem::path file, int descriptor)
    : file_(std::move(file)), descriptor_(descriptor) {}

Manifest::Manifest(Manifest&& other) noexcept
    : file_(std::move(other.file_)), descriptor_(std::exchange(other.descriptor_, -1)) {}

Manifest::~Manifest() {
    if (descriptor_ >= 0) ::close(descriptor_);
}

Result<Manifest> Manifest::open(const std::filesystem::path& file, bool anew) {
    std::error_code ignored;
    std::filesystem::create_directories(file.parent_path(), ignored);
    const auto status = std::filesystem::status(file, ignored);
    if (std::filesystem::exists(status) && !std::filesystem::is_regular_file(status)) {
        return fail(ExitCode::cannot_create,
                    "E-OUT-CREATE",
                    file.string(),
                    "it is not a regular file, to which several commands may add lines");
    }
    constexpr int mode = 0666;
    const int flags = O_RDWR | O_CREAT | O_APPEND | O_CLOEXEC | (anew ? O_TRUNC : 0);
    const int descriptor = ::open(file.c_str(), flags, mode);
    if (descriptor < 0) {
        return fail(ExitCode::cannot_create,
                    "E-OUT-CREATE",
                    file.string(),
                    std::generic_category().message(errno));
    }
    Manifest manifest(file, descriptor);
    // Behind a line that was cut off, a new one begins.
    char last = '\n';
    const off_t size = ::lseek(descriptor, 0, SEEK_END);
    const bool is_cut_off =
        size > 0 && ::pread(descriptor, &last, 1, size - 1) == 1 && last != '\n';
    if (is_cut_off) {
        if (auto ended = manifest.add(""); !ended) return fail(ended.error());
    }
    return manifest;
}

Result<void> Manifest::add(const std::string& line) {
    const std::string text = line + "\n";
    for (size_t done = 0; done < text.size();) {
        const ssize_t count = ::write(descriptor_, text.data() + done, text.size() - done);
        if (count < 0 && errno == EINTR) continue;
        if (count < 0) return cannot_write(file_);
        done += static_cast<size_t>(count);
    }
    return {};
}

}  // namespace obscura
