// app/contact_sheet.h - an HTML page of a job's images, made of its manifest.
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "base/error.h"

#include <filesystem>

namespace obscura::app {

/// Writes the page: a figure for each image, below a heading for each asset, with failures in the
/// place of images that are missing. It links the images' files, by paths from its own folder.
///
/// Errors  74 E-OUT-WRITE the manifest cannot be read; those of write_file_atomically
Result<void> write_contact_sheet(const std::filesystem::path& manifest,
                                 const std::filesystem::path& page);

}  // namespace obscura::app
