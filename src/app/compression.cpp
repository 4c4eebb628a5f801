// app/compression.cpp - the codec of OpenEXR files as --compression names it.
// SPDX-License-Identifier: Apache-2.0
#include "app/compression.h"

#include "app/option_readers.h"

namespace obscura::app {

Result<void> parse_compression(const std::string& text,
                               const std::string& option,
                               ExrOptions& exr) {
    const size_t colon = text.find(':');
    const auto codec = choose_option(text.substr(0, colon), option, compression_names);
    if (!codec) return fail(codec.error());
    exr.compression = *codec;
    if (colon == std::string::npos) return {};
    if (*codec != ExrCompression::dwaa && *codec != ExrCompression::dwab) {
        return fail(ExitCode::usage,
                    "E-USAGE-CONFLICT",
                    option,
                    in_quotes(text) + ": only dwaa and dwab have a level; leave it out");
    }
    const Result<double> level = parse_real(text.substr(colon + 1), option, 0, 100000);
    if (!level) return fail(level.error());
    exr.dwa_level = static_cast<float>(*level);
    return {};
}

}  // namespace obscura::app
