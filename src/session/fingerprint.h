// session/fingerprint.h - tells by its files whether an image has been rendered as it is asked for.
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "session/image_parts.h"
#include "session/render_request.h"

#include <optional>
#include <string>

namespace obscura {

/// The fingerprint of an image: 16 hexadecimal digits, the checksum of all that its files depend
/// on. Names of the scene's and of outputs' files do not belong to it, the bytes of the scene's
/// files do. Options that list images do not belong to it, what the list says of this image does.
///
/// In      options: as options_for_merge lists them; facts: those of facts_of; of_image: those of
///         ListedImage
std::string image_fingerprint(const NamedTexts& options,
                              const NamedTexts& facts,
                              const NamedTexts& of_image);

/// What is there of an image.
struct ExistingImage {
    bool is_finished = false;  ///< every file is there, with the fingerprint
    std::string differs;       ///< "a.exr has another fingerprint"; "": no file is there
};

ExistingImage find_existing(const RenderRequest& request,
                            const ListedImage& image,
                            const std::string& fingerprint);

/// "shot.exr.lock", of the image's first output.
std::filesystem::path lock_file(const ListedImage& image);

/// Whether all files can hold a fingerprint, for skips_existing.
///
/// Errors  64 E-USAGE-CONFLICT
Result<void> check_skips_existing(const RenderRequest& request);

}  // namespace obscura
