// image/encode_exact.cpp - encodes numbers that are no colours: labels, depths.
// SPDX-License-Identifier: Apache-2.0
#include "image/encode.h"
#include "image/oiio.h"
#include "image/png_chunks.h"

namespace obscura {

Result<std::vector<std::byte>> encode_exact(const OutputTarget& target, const ExactImage& image) {
    const Result<const OiioModule*>& oiio = oiio_module();
    if (!oiio) return fail(oiio.error());
    const bool is_png = target.format == OutputFormat::png;
    OiioImage whole{.width = image.width,
                    .height = image.height,
                    .channels = image.channels,
                    .type = image.type,
                    .codes = image.codes};
    if (is_png) {
        whole.attributes = {{"compression", "zip:4"}};
    } else {
        // Every reader of TIFF reads it plain; a date would make any two files differ.
        whole.attributes = {{"compression", "none"}, {"DateTime", ""}};
    }
    std::vector<std::byte> encoded;
    const std::string failure = (*oiio)->encode(entry_of(target.format).name, whole, encoded);
    if (!failure.empty())
        return fail(ExitCode::internal, "E-OUT-ENCODE", target.name, "encoding failed: " + failure);
    if (is_png) return with_color_chunk(encoded, {});
    return encoded;
}

}  // namespace obscura
