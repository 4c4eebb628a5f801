// app/unused_options.cpp - options that change nothing beside the others that are given.
// SPDX-License-Identifier: Apache-2.0
#include "app/unused_options.h"

#include <algorithm>

namespace obscura::app {

std::vector<UnusedOption> unused_options(const RenderArguments& arguments,
                                         const RenderRequest& request) {
    std::vector<UnusedOption> unused;
    const std::vector<OutputFormat> formats = formats_of(request);
    if (formats.empty()) return unused;
    const auto has = [&](const auto& fits) {
        return std::any_of(formats.begin(), formats.end(), fits);
    };
    const bool has_exr = has([](OutputFormat format) { return format == OutputFormat::exr; });
    const bool has_display = has([](OutputFormat format) { return format != OutputFormat::exr; });
    const bool has_lossy = has([](OutputFormat format) { return entry_of(format).quality > 0; });
    const bool has_depths = has([](OutputFormat format) {
        return format != OutputFormat::exr && entry_of(format).max_bits > 8;
    });
    const auto tell = [&](bool given, bool used, const char* option, const char* uses) {
        if (given && !used)
            unused.push_back({option, std::string("it changes nothing here: it is ") + uses});
    };
    const char* const for_exr = "for EXR files";
    tell(arguments.exr_layout.has_value(), has_exr, "--exr-layout", for_exr);
    tell(arguments.compression.has_value(), has_exr, "--compression", for_exr);
    tell(arguments.exr_tiles.has_value(), has_exr, "--exr-tiles", for_exr);
    tell(arguments.exr_mipmap, has_exr, "--exr-mipmap", for_exr);
    tell(arguments.float32, has_exr, "--float", for_exr);
    const char* const for_displays = "for images for displays, such as PNG; EXRs are scene-linear";
    const bool uses_view = has_display || request.options.adaptive.has_value();
    tell(arguments.view.has_value(), uses_view, "--view", for_displays);
    tell(arguments.display.has_value(), uses_view, "--display", for_displays);
    tell(arguments.no_dither, has_display, "--no-dither", for_displays);
    // Without --background, it makes that transparent.
    tell(arguments.page && arguments.background, has_display, "--page", for_displays);
    tell(arguments.bits.has_value(), has_depths, "--bits", "for PNG and TIFF");
    tell(arguments.quality.has_value(), has_lossy, "--quality", "for JPEG, WebP and AVIF");
    const Integrator integrator = request.options.integrator;
    const bool is_noisy = integrator == Integrator::path || integrator == Integrator::direct;
    const char* const for_noise = "for the integrators path and direct";
    tell(arguments.clamp_direct.has_value(), is_noisy, "--clamp-direct", for_noise);
    tell(arguments.clamp_indirect.has_value(), is_noisy, "--clamp-indirect", for_noise);
    tell(arguments.caustics.has_value(), is_noisy, "--caustics", for_noise);
    tell(arguments.regularize, is_noisy, "--regularize", for_noise);
    const bool takes_samples = is_noisy || integrator == Integrator::ao;
    tell(arguments.animate_seed, takes_samples, "--animate-seed", "for integrators with noise");
    const std::vector<Layer>& layers = request.options.layers;
    tell(arguments.crypto_levels.has_value(),
         std::any_of(layers.begin(), layers.end(), is_cryptomatte),
         "--crypto-levels",
         "for Cryptomatte; add a layer such as --aov crypto_object");
    return unused;
}

void warn_of_unused_options(const std::vector<UnusedOption>& unused, Log& log) {
    for (const UnusedOption& option : unused)
        log.warn(option.name, option.why);
}

}  // namespace obscura::app
