// app/distinct_files.h - no file is written twice, and none that is read.
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "session/render_request.h"

namespace obscura::app {

/// True when both names lead to one file, through links too, also when it does not exist yet.
bool same_file(const std::filesystem::path& a, const std::filesystem::path& b);

/// The files that a rendering reads, beside those that its scene names.
std::vector<std::filesystem::path> files_read(const RenderRequest& request);

/// Refuses what would replace a file that is read.
///
/// Errors  64 E-USAGE-SAMEFILE
Result<void> check_not_read(const std::vector<std::filesystem::path>& written,
                            const std::vector<std::filesystem::path>& read);

/// No output of an image or of the command may overwrite an input or another output.
///
/// Errors  64 E-USAGE-SAMEFILE
Result<void> check_distinct_files(const RenderRequest& request,
                                  const std::vector<ListedImage>& images);

/// The same, and that all can be written.
///
/// Errors  likewise, and those of check_image_files
Result<void> check_files(const RenderRequest& request, const std::vector<ListedImage>& images);

}  // namespace obscura::app
