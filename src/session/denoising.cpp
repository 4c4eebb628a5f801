// session/denoising.cpp - the layers that denoising needs, and the denoised film.
// SPDX-License-Identifier: Apache-2.0
#include "session/denoising.h"

#include "base/parallel.h"
#include "base/setting_names.h"
#include "denoise/denoise.h"

#include <algorithm>
#include <cmath>
#include <fmt/format.h>
#include <limits>
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

/// The pixels of the layer with this source; none if the film has no such layer.
template <typename Source>
std::span<const float> layer_pixels(const Film& film, const Source& source) {
    Layer wanted;
    wanted.source = source;
    for (const FilmLayer& one : film.layers) {
        if (is_same(one.layer, wanted)) return one.pixels;
    }
    return {};
}

Halves both_halves(const Film& film, std::optional<Aov> aov) {
    return {layer_pixels(film, PartMean{aov, SamplePart::first_half}),
            layer_pixels(film, PartMean{aov, SamplePart::second_half})};
}

bool is_whole(const Halves& halves) {
    return !halves[0].empty() && !halves[1].empty();
}

std::vector<float> alpha_of(const Film& film) {
    const size_t channels = film.channels.size();
    std::vector<float> alpha;
    if (channels < 4) return alpha;
    for (size_t i = 3; i < film.pixels.size(); i += channels)
        alpha.push_back(film.pixels[i]);
    return alpha;
}

/// What a film tells the filter; looks at the film's layers.
class FilmGuides {
public:
    FilmGuides(const HalvesOfSamples& samples, const Film& film)
        : nothing_(3 * static_cast<size_t>(film.width) * static_cast<size_t>(film.height)),
          alpha_(alpha_of(film)) {
        input_.width = film.width;
        input_.height = film.height;
        input_.color = both_halves(film, {});
        input_.albedo = input_.normal = {nothing_, nothing_};
        input_.depth = input_.opacity = std::span(nothing_).first(nothing_.size() / 3);
        input_.alpha = alpha_;
        input_.motion = layer_pixels(film, Aov::motion);
        input_.first_share = samples.first_share;
        const auto opacity = layer_pixels(film, Aov::opacity);
        if (const Halves albedo = both_halves(film, Aov::albedo);
            is_whole(albedo) && !opacity.empty()) {
            input_.albedo = albedo;
            input_.opacity = opacity;
            names_ += " albedo";
        }
        if (const Halves normal = both_halves(film, Aov::normal); is_whole(normal)) {
            input_.normal = normal;
            names_ += " normal";
        }
        if (const auto depth = layer_pixels(film, Aov::depth); !depth.empty()) {
            input_.depth = depth;
            names_ += " depth";
        }
    }

    // Spans of vectors that move stay; those of copies would not.
    FilmGuides(FilmGuides&&) = default;

    const DenoiseInput& input() const { return input_; }
    const std::string& names() const { return names_; }

private:
    std::vector<float> nothing_, alpha_;
    DenoiseInput input_;
    std::string names_;
};

std::vector<LightImage> images_of_light(Film& film) {
    std::vector<LightImage> out;
    for (FilmLayer& one : film.layers) {
        if (std::holds_alternative<LightLayer>(one.layer.source))
            out.push_back({one.pixels, one.layer.channels.size()});
    }
    return out;
}

/// By how much a beauty may differ from the mean of its halves because numbers were rounded.
struct Rounding {
    float relative, absolute;
    float largest;  ///< what is beyond was lowered to this
};
constexpr Rounding rounding_of_sums = {1e-4f, 0, std::numeric_limits<float>::infinity()};
constexpr Rounding rounding_of_halves = {2e-3f, 2e-7f, 65504};  // 16 bits, twice

/// What the beauty has beside the mean of its samples: shadow catchers, which are ratios of sums.
std::vector<float> beside_samples(const Film& film,
                                  const Halves& halves,
                                  const HalvesOfSamples& samples) {
    const Rounding& rounding = samples.is_rounded ? rounding_of_halves : rounding_of_sums;
    const float first_share = samples.first_share;
    const size_t channels = film.channels.size();
    std::vector<float> rest(halves[0].size());
    for (size_t i = 0; i < rest.size(); ++i) {
        const float mean = first_share * halves[0][i] + (1 - first_share) * halves[1][i];
        const float value = film.pixels[i / 3 * channels + i % 3];
        if (std::max({value, halves[0][i], halves[1][i]}) >= rounding.largest) continue;
        const float rounded = rounding.relative * std::abs(mean) + rounding.absolute;
        if (std::abs(value - mean) > rounded) rest[i] = value - mean;
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

Result<void> check_denoising(const RenderOptions& options, const std::string& asked_by) {
    const auto conflict = [&](const std::string& message) {
        return fail(ExitCode::usage, "E-USAGE-CONFLICT", asked_by, message);
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

size_t halves_run(const RenderOptions& options) {
    if (!options.adaptive) return half_run(options.samples_per_pixel);
    size_t run = 8;
    const auto splits = [&](int samples) { return static_cast<size_t>(samples) % (2 * run) == 0; };
    while (run > 1 && !(splits(options.adaptive->min_samples) && splits(options.samples_per_pixel)))
        run /= 2;
    return run;
}

void add_denoising_layers(RenderOptions& options) {
    for (Layer& layer : denoising_layers()) {
        if (!has_same(options.layers, layer)) options.layers.push_back(std::move(layer));
    }
}

void set_half_runs(RenderOptions& options) {
    for (Layer& layer : options.layers) {
        if (auto* mean = std::get_if<PartMean>(&layer.source)) mean->run = halves_run(options);
    }
}

HalvesOfSamples halves_of(const RenderOptions& options) {
    HalvesOfSamples out;
    if (options.adaptive) return out;  // see halves_run
    const auto samples = static_cast<size_t>(options.samples_per_pixel);
    const PartMean first{{}, SamplePart::first_half, halves_run(options)};
    out.first_share = static_cast<float>(samples_in(first, samples)) / static_cast<float>(samples);
    return out;
}

std::string denoise_light(const HalvesOfSamples& samples,
                          Film& film,
                          std::span<NeighborFilm> neighbor_films) {
    keep_noisy(film);
    const FilmGuides guides(samples, film);
    std::string used = "halves" + guides.names();
    std::vector<FilmGuides> neighbor_guides;
    std::vector<NeighborFrame> neighbors;
    for (NeighborFilm& one : neighbor_films) {
        neighbor_guides.emplace_back(one.samples, one.film);
        neighbors.push_back(
            {one.is_after, neighbor_guides.back().input(), images_of_light(one.film)});
        used += one.is_after ? ", frame after" : ", frame before";
    }
    std::vector<LightImage> images = images_of_light(film);
    images.insert(images.begin(), {film.pixels, film.channels.size()});
    const std::vector<float> rest = beside_samples(film, guides.input().color, samples);
    add_to_colors(rest, -1, film);
    const DenoiseReport report = denoise(guides.input(), images, neighbors);
    add_to_colors(rest, 1, film);
    return fmt::format("{}; outliers in {:.3g} % of the pixels", used, 100 * report.outlier_share);
}

ImageAttribute unequal_halves() {
    return {"obscura:halves", std::string("unequal")};
}

void remove_denoising_layers(const RenderOptions& asked, Film& film) {
    std::erase_if(film.layers, [&](const FilmLayer& one) {
        return has_same(denoising_layers(), one.layer) && !has_same(asked.layers, one.layer);
    });
}

std::string denoise_film(const RenderOptions& options, const RenderOptions& asked, Film& film) {
    std::string done = denoise_light(halves_of(options), film);
    remove_denoising_layers(asked, film);
    return done;
}

}  // namespace obscura
