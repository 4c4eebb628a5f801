// image/encode_exact.cpp - encodes numbers that are no colours: labels, depths.
// SPDX-License-Identifier: Apache-2.0
#include "image/encode.h"
#include "image/oiio.h"

namespace obscura {

Result<std::vector<std::byte>> encode_exact(const OutputTarget& target, const ExactImage& image) {
    if (target.format == OutputFormat::png) {
        return encode_png({.width = image.width,
                           .height = image.height,
                           .channels = image.channels,
                           .bits = image.type == OiioType::uint16 ? 16 : 8,
                           .codes = image.codes},
                          target.name);
    }
    const Result<const OiioModule*>& oiio = oiio_module();
    if (!oiio) return fail(oiio.error());
    // Every reader of TIFF reads it plain; a date would make any two files differ.
    const OiioImage whole{.width = image.width,
                          .height = image.height,
                          .channels = image.channels,
                          .type = image.type,
                          .codes = image.codes,
                          .attributes = {{"compression", "none"}, {"DateTime", ""}}};
    std::vector<std::byte> encoded;
    const std::string failure = (*oiio)->encode(entry_of(target.format).name, whole, encoded);
    if (!failure.empty())
        return fail(ExitCode::internal, "E-OUT-ENCODE", target.name, "encoding failed: " + failure);
    return encoded;
}

}  // namespace obscura
