// session/denoising.cpp - the layers that denoising needs, and the denoised film.
// SPDX-License-Identifier: Apache-2.0
#include "session/denoising.h"

#include "base/parallel.h"
#include "base/setting_names.h"
#include "denoise/denoise.h"

#include <algorithm>
#include <cmath>
#include <fmt/format.h>
#include <span>
#include <variant>
#include <vector>

namespace obscura {

namespace {

/// Whether two layers tell the same of the samples that denoising looks at.
bool is_same(const Layer& a, const Layer& b) {
    if (const auto* mean = std::get_if<PartMean>(&a.source)) {
        const auto* other = std::get_if<PartMean>(&b.source);
        return other != nullptr && mean->aov == other->aov && mean->part == other->part;
    }
    const auto* aov = std::get_if<Aov>(&a.source);
    const auto* other = std::get_if<Aov>(&b.source);
    return aov != nullptr && other != nullptr && *aov == *other;
}

bool has_same(const std::vector<Layer>& layers, const Layer& wanted) {
    return std::any_of(
        layers.begin(), layers.end(), [&](const Layer& one) { return is_same(one, wanted); });
}

FilmLayer& find_same(Film& film, const Layer& wanted) {
    return *std::find_if(film.layers.begin(), film.layers.end(), [&](const FilmLayer& one) {
        return is_same(one.layer, wanted);
    });
}

std::vector<float> alpha_of(const Film& film) {
    const size_t channels = film.channels.size();
    std::vector<float> alpha;
    if (channels < 4) return alpha;
    for (size_t i = 3; i < film.pixels.size(); i += channels)
        alpha.push_back(film.pixels[i]);
    return alpha;
}

/// Samples in a row that go to one half. Adaptive sampling stops pixels at different numbers of
/// samples, the least one, its doubles and the most one: each must have halves of equal size.
size_t run_of(const RenderOptions& options) {
    if (!options.adaptive) return half_run(options.samples_per_pixel);
    size_t run = 8;
    const auto splits = [&](int samples) { return static_cast<size_t>(samples) % (2 * run) == 0; };
    while (run > 1 && !(splits(options.adaptive->min_samples) && splits(options.samples_per_pixel)))
        run /= 2;
    return run;
}

/// What the beauty has beside the mean of its samples: shadow catchers, which are ratios of sums.
///
/// In      halves: of the samples; first_share: how many of them are in the first
std::vector<float> beside_samples(const Film& film, const Halves& halves, float first_share) {
    const size_t channels = film.channels.size();
    std::vector<float> rest(halves[0].size());
    for (size_t i = 0; i < rest.size(); ++i) {
        const float mean = first_share * halves[0][i] + (1 - first_share) * halves[1][i];
        const float value = film.pixels[i / 3 * channels + i % 3];
        // Less than this is how the sums were rounded.
        if (std::abs(value - mean) > 1e-4f * std::abs(mean)) rest[i] = value - mean;
    }
    return rest;
}

void add_to_colors(const std::vector<float>& rest, float sign, Film& film) {
    for (size_t i = 0; i < rest.size(); ++i)
        film.pixels[i / 3 * film.channels.size() + i % 3] += sign * rest[i];
}

void keep_noisy(Film& film) {
    const Layer noisy = noisy_layer();
    const auto found = std::find_if(film.layers.begin(), film.layers.end(), [&](const auto& one) {
        return is_same(one.layer, noisy);
    });
    if (found == film.layers.end()) return;
    for (size_t i = 0; i < found->pixels.size(); ++i)
        found->pixels[i] = film.pixels[i / 3 * film.channels.size() + i % 3];
}

}  // namespace

Result<void> check_denoising(const RenderRequest& request) {
    if (!request.denoise) return {};
    const RenderOptions& options = request.options;
    const auto conflict = [](const std::string& message) {
        return fail(ExitCode::usage, "E-USAGE-CONFLICT", setting("denoise"), message);
    };
    if (options.integrator != Integrator::path && options.integrator != Integrator::direct) {
        return conflict("it takes the noise out of light; use " + setting("integrator") +
                        " path or direct");
    }
    if (options.samples_per_pixel < 2) {
        return conflict("it compares two halves of the samples; use " + setting("spp") +
                        " 2 or more");
    }
    if (options.adaptive &&
        (options.adaptive->min_samples % 2 != 0 || options.samples_per_pixel % 2 != 0)) {
        return conflict("it compares two halves of each pixel's samples; with " +
                        setting("noise-target") + ", " + setting("spp") + " and " +
                        setting("spp-min") + " must be even");
    }
    return {};
}

void add_denoising_layers(RenderOptions& options) {
    for (Layer& layer : denoising_layers()) {
        if (!has_same(options.layers, layer)) options.layers.push_back(std::move(layer));
    }
}

void set_half_runs(RenderOptions& options) {
    for (Layer& layer : options.layers) {
        if (auto* mean = std::get_if<PartMean>(&layer.source)) mean->run = run_of(options);
    }
}

std::string denoise_film(const RenderOptions& options, const RenderOptions& asked, Film& film) {
    keep_noisy(film);
    const auto values = [&](std::optional<Aov> aov, SamplePart part) {
        Layer wanted;
        wanted.source = PartMean{aov, part};
        return std::span<const float>(find_same(film, wanted).pixels);
    };
    const auto halves = [&](std::optional<Aov> aov) {
        return Halves{values(aov, SamplePart::first_half), values(aov, SamplePart::second_half)};
    };
    const auto layer = [&](Aov aov) {
        Layer wanted;
        wanted.source = aov;
        return std::span<const float>(find_same(film, wanted).pixels);
    };
    const std::vector<float> alpha = alpha_of(film);
    DenoiseInput input;
    input.width = film.width;
    input.height = film.height;
    input.color = halves({});
    input.albedo = halves(Aov::albedo);
    input.normal = halves(Aov::normal);
    input.depth = layer(Aov::depth);
    input.opacity = layer(Aov::opacity);
    input.alpha = alpha;
    if (!options.adaptive) {  // else one half: see run_of
        const auto samples = static_cast<size_t>(options.samples_per_pixel);
        const PartMean first{{}, SamplePart::first_half, run_of(options)};
        input.first_share =
            static_cast<float>(samples_in(first, samples)) / static_cast<float>(samples);
    }
    std::vector<LightImage> images = {{film.pixels, film.channels.size()}};
    for (FilmLayer& one : film.layers) {
        if (std::holds_alternative<LightLayer>(one.layer.source))
            images.push_back({one.pixels, one.layer.channels.size()});
    }
    const std::vector<float> rest = beside_samples(film, input.color, input.first_share);
    add_to_colors(rest, -1, film);
    const DenoiseReport report = denoise(input, images);
    add_to_colors(rest, 1, film);
    std::erase_if(film.layers, [&](const FilmLayer& one) {
        return has_same(denoising_layers(), one.layer) && !has_same(asked.layers, one.layer);
    });
    return fmt::format("halves albedo normal depth; outliers in {:.3g} % of the pixels",
                       100 * report.outlier_share);
}

}  // namespace obscura
