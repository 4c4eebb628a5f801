// app/unused_options.cpp - options that change nothing beside the others that are given.
// SPDX-License-Identifier: Apache-2.0
#include "app/unused_options.h"

#include <algorithm>
#include <variant>

namespace obscura::app {

namespace {

std::vector<OutputFormat> formats_of(const RenderRequest& request) {
    std::vector<OutputFormat> out;
    for (const std::filesystem::path& file : request.outputs) {
        if (const auto format = output_format_of(file)) out.push_back(*format);
    }
    if (request.standard_output) out.push_back(*request.standard_output);
    return out;
}

bool has_cryptomatte(const RenderRequest& request) {
    const std::vector<Layer>& layers = request.options.layers;
    return std::any_of(layers.begin(), layers.end(), [](const Layer& layer) {
        return std::holds_alternative<CryptomatteNames>(layer.source);
    });
}

}  // namespace

void warn_of_unused_options(const RenderArguments& arguments,
                            const RenderRequest& request,
                            Log& log) {
    const std::vector<OutputFormat> formats = formats_of(request);
    if (formats.empty()) return;
    const auto has = [&](const auto& fits) {
        return std::any_of(formats.begin(), formats.end(), fits);
    };
    const bool has_exr = has([](OutputFormat format) { return format == OutputFormat::exr; });
    const bool has_display = has([](OutputFormat format) { return format != OutputFormat::exr; });
    const bool has_lossy = has([](OutputFormat format) { return entry_of(format).quality > 0; });
    const auto tell = [&](bool given, bool used, const char* option, const char* uses) {
        if (given && !used) log.warn(option, std::string("it changes nothing here: it is ") + uses);
    };
    const char* const for_exr = "for EXR files";
    tell(arguments.exr_layout.has_value(), has_exr, "--exr-layout", for_exr);
    tell(arguments.compression.has_value(), has_exr, "--compression", for_exr);
    tell(arguments.exr_tiles.has_value(), has_exr, "--exr-tiles", for_exr);
    tell(arguments.exr_mipmap, has_exr, "--exr-mipmap", for_exr);
    tell(arguments.float32, has_exr, "--float", for_exr);
    const char* const for_displays = "for images for displays, such as PNG; EXRs are linear";
    tell(arguments.bits.has_value(), has_display, "--bits", for_displays);
    tell(arguments.no_dither, has_display, "--no-dither", for_displays);
    tell(arguments.page.has_value(),
         has_display,
         "--page",
         "behind images for displays, such as PNG; EXRs are transparent instead");
    tell(arguments.quality.has_value(), has_lossy, "--quality", "for JPEG, WebP and AVIF");
    tell(arguments.crypto_levels.has_value(),
         has_cryptomatte(request),
         "--crypto-levels",
         "for Cryptomatte; add a layer such as --aov crypto_object");
}

}  // namespace obscura::app
