// app/distinct_files.cpp - no file is written twice, and none that is read.
// SPDX-License-Identifier: Apache-2.0
#include "app/distinct_files.h"

#include "session/image_parts.h"
#include "session/outputs.h"

#include <map>
#include <sys/stat.h>
#include <system_error>
#include <utility>

namespace obscura::app {

namespace {

namespace fs = std::filesystem;

/// The file's place, with all links followed; as it is named where that cannot be told.
fs::path resolved(const fs::path& file) {
    std::error_code error;
    fs::path out = fs::weakly_canonical(fs::absolute(file, error), error);
    return error ? file : out;
}

/// Files by their places and, where they are there, by the system's numbers: a file may have
/// several names.
class KnownFiles {
public:
    /// False: the file was added before.
    bool add(const fs::path& file) {
        bool is_new = places_.insert({resolved(file), 0}).second;
        struct stat status = {};
        if (::stat(file.c_str(), &status) == 0)
            is_new = numbers_.insert({{status.st_dev, status.st_ino}, 0}).second && is_new;
        return is_new;
    }

private:
    std::map<fs::path, int> places_;
    std::map<std::pair<dev_t, ino_t>, int> numbers_;
};

std::vector<fs::path> files_written(const RenderRequest& request,
                                    const std::vector<ListedImage>& images) {
    std::vector<fs::path> written;
    for (const ListedImage& image : images) {
        const std::vector<fs::path> files = all_files(request, image);
        written.insert(written.end(), files.begin(), files.end());
        if (request.long_run.has_checkpoint && !image.checkpoint.empty())
            written.push_back(image.checkpoint);
    }
    for (const auto* file :
         {&request.statistics, &request.crypto_manifest, &request.lists.manifest}) {
        if (*file) written.push_back(**file);
    }
    if (request.long_run.has_checkpoint && request.long_run.checkpoint.empty())
        written.push_back(checkpoint_file(request));
    return written;
}

tl::unexpected<Error> same(const fs::path& file, const std::string& message) {
    return fail(ExitCode::usage, "E-USAGE-SAMEFILE", file.string(), message);
}

}  // namespace

std::vector<fs::path> files_read(const RenderRequest& request) {
    std::vector<fs::path> read = {request.scene};
    for (const auto* file :
         {&request.camera_json, &request.lists.views_file, &request.environment}) {
        if (*file) read.push_back(**file);
    }
    if (request.camera.settings.aperture_file)
        read.emplace_back(*request.camera.settings.aperture_file);
    if (!request.display.ocio_file.empty()) read.push_back(request.display.ocio_file);
    return read;
}

bool same_file(const fs::path& a, const fs::path& b) {
    KnownFiles known;
    known.add(a);
    return !known.add(b);
}

Result<void> check_distinct_files(const RenderRequest& request,
                                  const std::vector<ListedImage>& images) {
    const std::vector<fs::path> written = files_written(request, images);
    KnownFiles outputs;
    for (const fs::path& file : written) {
        if (outputs.add(file)) continue;
        return same(file,
                    request.lists.is_asked()
                        ? "two images have this file; put {variant}, {view} or {frame:04} "
                          "into its name"
                        : "two outputs are the same file; give different names");
    }
    return check_not_read(written, files_read(request));
}

Result<void> check_not_read(const std::vector<fs::path>& written,
                            const std::vector<fs::path>& read) {
    KnownFiles all;
    for (const fs::path& file : read)
        all.add(file);
    for (const fs::path& file : written) {
        if (!all.add(file))
            return same(file, "this output would replace a file that is read; give another name");
    }
    return {};
}

Result<void> check_files(const RenderRequest& request, const std::vector<ListedImage>& images) {
    if (auto apart = check_distinct_files(request, images); !apart) return apart;
    return check_image_files(request, images);
}

}  // namespace obscura::app
