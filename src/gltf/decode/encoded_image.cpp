// gltf/decode/encoded_image.cpp - an image's bytes: from a buffer, file or data URI.
// SPDX-License-Identifier: Apache-2.0
#include "gltf/decode/encoded_image.h"

#include "gltf/parse/uri.h"

#include <utility>

namespace obscura::gltf {

namespace {

constexpr uint64_t largest_image_file = 1U << 30;

}  // namespace

Result<EncodedImage> load_encoded(const ImageSources& sources, size_t image) {
    const GltfImage& record = sources.document.images[image];
    const std::string where = sources.document.at("images", image);
    EncodedImage out;
    out.mime = record.mime;
    if (!record.uri) {
        out.bytes = view_bytes(sources.document, sources.buffers, record.view);
        return out;
    }
    const auto take = [&](uint64_t bytes) -> Result<void> {
        Result<MemoryCharge> taken = charge_memory(MemoryUse::textures, where, bytes);
        if (!taken) return fail(std::move(taken.error()));
        out.charge = std::move(*taken);
        return {};
    };
    const UriContext context{sources.folder, where + "/uri"};
    Result<UriBytes> read = read_uri(*record.uri, context, {largest_image_file, UINT64_MAX, take});
    if (!read) return fail(std::move(read.error()));
    if (is_data_uri(*record.uri)) {
        if (read->mime.rfind("image/", 0) != 0) {
            return fail(ExitCode::bad_data,
                        "E-URI-DATA",
                        where + "/uri",
                        "the media type \"" + read->mime +
                            "\" is not an image's; accepted are image/png, image/jpeg, image/webp, "
                            "image/ktx2");
        }
        out.mime = read->mime;
    }
    out.owned = std::move(read->bytes);
    out.bytes = out.owned;
    return out;
}

}  // namespace obscura::gltf
