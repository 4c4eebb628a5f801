// session/aperture_image.cpp - reads the image of a lens opening from a file.
// SPDX-License-Identifier: Apache-2.0
#include "session/aperture_image.h"

#include "base/file_bytes.h"
#include "image/decode.h"
#include "surface/srgb.h"

#include <span>

namespace obscura {

namespace {

float brightness(uint32_t texel) {
    const Vec3f rgb{srgb_to_linear_table[texel & 255U],
                    srgb_to_linear_table[texel >> 8 & 255U],
                    srgb_to_linear_table[texel >> 16 & 255U]};
    return luminance(rgb) * static_cast<float>(texel >> 24) / 255.0f;
}

}  // namespace

Result<ApertureTable> read_aperture(const std::filesystem::path& file, Log& log) {
    const FileBytes read = read_file_bytes(file, {});
    if (read.fault != FileFault::none) {
        return fail(ExitCode::bad_resource,
                    "E-APERTURE-MISSING",
                    file.string(),
                    "the picture of the aperture cannot be read: " + read.reason);
    }
    const Result<ImageRgba8> image = decode_image(std::span(read.bytes), file.string(), log);
    if (!image) return fail(image.error());
    std::vector<float> values(image->texels.size());
    for (size_t i = 0; i < values.size(); ++i)
        values[i] = brightness(image->texels[i]);
    ApertureTable table = make_aperture_table(values, image->width, image->height);
    if (table.rows.empty()) {
        return fail(ExitCode::bad_resource,
                    "E-APERTURE-BLACK",
                    file.string(),
                    "the picture of the aperture is black; expected one with bright parts");
    }
    return table;
}

}  // namespace obscura
