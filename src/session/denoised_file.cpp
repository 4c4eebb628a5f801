// session/denoised_file.cpp - denoises an image whose file holds what denoising needs.
// SPDX-License-Identifier: Apache-2.0
#include "session/denoised_file.h"

#include "base/setting_names.h"
#include "base/text.h"
#include "session/denoising.h"
#include "session/exr_layers.h"

#include <algorithm>
#include <filesystem>
#include <fmt/format.h>
#include <utility>

namespace obscura {

namespace {

tl::unexpected<Error> bad_file(const char* id,
                               const std::string& where,
                               const std::string& message) {
    return fail(ExitCode::bad_data, id, where, message);
}

std::string text_of(const ExrLayers& layers, const std::string& attribute) {
    const auto* const text = layers.attribute<std::string>(attribute);
    return text != nullptr ? *text : std::string();
}

/// The samples that the header tells of. Adaptive sampling has halves of equal size in every pixel
/// where all numbers of samples are even.
///
/// Errors  65 E-DENOISE-SOURCE, E-DENOISE-DONE, E-DENOISE-HALVES
Result<RenderOptions> sampling_of(const ExrLayers& layers, const std::string& where) {
    const int* const samples = layers.attribute<int>("obscura:samplesPerPixel");
    const std::string integrator = text_of(layers, "obscura:integrator");
    if (samples == nullptr || (integrator != "path" && integrator != "direct")) {
        return bad_file("E-DENOISE-SOURCE",
                        where,
                        "it takes the noise out of light, and this is of the integrator " +
                            integrator + "; expected one of path or direct");
    }
    if (const auto* const done = layers.attribute<std::string>("obscura:denoise")) {
        return bad_file("E-DENOISE-DONE",
                        where,
                        "it is denoised already (" + *done + "); give the file as it was before");
    }
    RenderOptions out;
    out.samples_per_pixel = *samples;
    const int* const least = layers.attribute<int>("obscura:samplesMin");
    const int* const most = layers.attribute<int>("obscura:samplesMax");
    if (least != nullptr && most != nullptr) out.adaptive.emplace();
    if (!text_of(layers, unequal_halves().name).empty()) {
        return bad_file("E-DENOISE-HALVES",
                        where,
                        "its rendering was stopped when there were too few samples to tell their "
                        "noise, or its --spp is no multiple of 16 and then takes all samples; "
                        "render longer, or carry on from a checkpoint");
    }
    const bool is_even = !out.adaptive || (*least % 2 == 0 && *most % 2 == 0);
    if (is_even && *samples >= 2) return out;
    return bad_file(
        "E-DENOISE-HALVES",
        where,
        "the two halves of its samples are of different size in some pixels; render with "
        "2 or more samples, with --noise-target with even --spp and --spp-min");
}

/// Adds the layers that denoising needs, as far as the file has them.
///
/// In/out  samples: rounded, if a half of the beauty is
/// Errors  65 E-DENOISE-LAYER without the beauty's halves; those of ExrLayers::read
Result<void> read_guides(const ExrLayers& layers,
                         const std::string& where,
                         HalvesOfSamples& samples,
                         Film& film,
                         Log& log) {
    std::string missing;
    bool has_halves = true;
    for (Layer& layer : denoising_layers()) {
        const bool is_half = layer.name.starts_with("half_");
        const std::optional<ExrPlace> place = layers.place_of(layer.channels);
        if (!place) {
            missing += (missing.empty() ? "" : ", ") + layer.name;
            has_halves &= !is_half;
            continue;
        }
        Result<UnsetArray<float>> pixels = layers.read(*place);
        if (!pixels) return fail(pixels.error());
        samples.is_rounded |= is_half && place->is_half;
        film.layers.push_back({std::move(layer), std::move(*pixels)});
    }
    if (has_halves) {
        if (missing.empty()) return {};
        log.warn(where,
                 "it lacks the guides " + missing +
                     ", without which more is blurred; render's --denoising-data stores all");
        return {};
    }
    const bool is_apart = std::filesystem::exists(layer_file(where, "half_1"));
    return bad_file("E-DENOISE-LAYER",
                    where,
                    "it lacks the layers " + missing +
                        (is_apart ? ", which are in files of their own; render with --exr-layout "
                                    "single or multipart"
                                  : "; `obscura render --denoising-data` stores them"));
}

/// Reads the beauty and the layers of the light, of which only the places matter afterwards.
///
/// Out     places: of the layers of the light, which come first in the film
Result<Film> read_light(const ExrLayers& layers, std::vector<ExrPlace>& places) {
    Film film;
    film.width = layers.width();
    film.height = layers.height();
    film.channels = layers.beauty().channels;
    Result<UnsetArray<float>> beauty = layers.read(layers.beauty());
    if (!beauty) return fail(beauty.error());
    film.pixels = std::move(*beauty);
    for (const auto& [name, expression] : layers.layers_of_light()) {
        Layer layer = light_layer(name, {});
        const std::optional<ExrPlace> place = layers.place_of(layer.channels);
        if (!place) continue;
        Result<UnsetArray<float>> pixels = layers.read(*place);
        if (!pixels) return fail(pixels.error());
        film.layers.push_back({std::move(layer), std::move(*pixels)});
        places.push_back(*place);
    }
    return film;
}

/// Adds `motion`, by which neighbouring frames are compared.
///
/// Returns whether the file has it
Result<bool> read_motion(const ExrLayers& layers, Film& film) {
    Layer motion = layers_of(std::vector<std::string>{"motion"}, 0).value().front();
    const std::optional<ExrPlace> place = layers.place_of(motion.channels);
    if (!place) return false;
    Result<UnsetArray<float>> pixels = layers.read(*place);
    if (!pixels) return fail(pixels.error());
    film.layers.push_back({std::move(motion), std::move(*pixels)});
    return true;
}

/// What frames must have in common that are filtered with each other.
std::vector<std::pair<std::string, std::string>> shared_facts(const ExrLayers& layers) {
    const ImagePart place = layers.place();
    std::vector<std::pair<std::string, std::string>> out = {
        {"its size", fmt::format("{}x{}", layers.width(), layers.height())},
        {"its place", fmt::format("{},{} of {}x{}", place.x, place.y, place.width, place.height)},
        {"obscura:integrator", text_of(layers, "obscura:integrator")},
        {"colorInteropID", text_of(layers, "colorInteropID")}};
    std::string names;
    for (const auto& [name, expression] : layers.layers_of_light()) {
        names += (names.empty() ? "" : ", ") + name;
        out.emplace_back("the light path expression of " + name, expression);
    }
    out.insert(out.begin() + 2, {"its layers of the light", names});
    return out;
}

/// Errors  65 E-DENOISE-SOURCE
Result<void> check_neighbor(const ExrLayers& layers,
                            const ExrLayers& neighbor,
                            const std::string& where) {
    const auto wanted = shared_facts(layers);
    const auto found = shared_facts(neighbor);
    const auto [one, other] =
        std::mismatch(wanted.begin(), wanted.end(), found.begin(), found.end());
    if (one == wanted.end()) return {};
    return bad_file("E-DENOISE-SOURCE",
                    where,
                    "it does not go with the frame beside it: " + one->first + " is " +
                        in_quotes(other->second) + "; expected " + in_quotes(one->second));
}

/// A frame beside a film that has `motion`.
///
/// Errors  65 E-DENOISE-LAYER: it lacks a layer that the film has; those of sampling_of and
///         read_guides
Result<NeighborFilm> read_neighbor(const ExrLayers& layers,
                                   const std::string& where,
                                   const Film& film,
                                   Log& log) {
    const Result<RenderOptions> sampling = sampling_of(layers, where);
    if (!sampling) return fail(sampling.error());
    std::vector<ExrPlace> places;
    Result<Film> read = read_light(layers, places);
    if (!read) return fail(read.error());
    NeighborFilm out;
    out.film = std::move(*read);
    out.samples = halves_of(*sampling);
    if (auto guides = read_guides(layers, where, out.samples, out.film, log); !guides)
        return fail(guides.error());
    if (auto motion = read_motion(layers, out.film); !motion) return fail(motion.error());
    const auto names = [](const Film& of) {
        std::string all;
        for (const FilmLayer& one : of.layers)
            all += (all.empty() ? "" : ", ") + one.layer.name;
        return all;
    };
    if (names(out.film) == names(film)) return out;
    return bad_file("E-DENOISE-LAYER",
                    where,
                    "expected the layers of the frame beside it, of which count " + names(film) +
                        "; this one has " + names(out.film));
}

/// Where nothing moves, frames of the same random numbers have the same noise.
void warn_of_equal_noise(const ExrLayers& layers, const ExrLayers& neighbor, Log& log) {
    const auto seed_of = [](const ExrLayers& of) {
        const int* const seed = of.attribute<int>("obscura:seed");
        return seed != nullptr ? std::to_string(*seed) : text_of(of, "obscura:seed");
    };
    if (seed_of(layers) != seed_of(neighbor)) return;
    log.warn(setting("frames"),
             "the frames have the same random numbers, and so the same noise where nothing moves; "
             "render with --animate-seed");
}

/// Whether the camera has moved without `motion` telling of it: it knows of cameras of the file.
bool has_untold_move(const ExrLayers& layers, const ExrLayers& neighbor) {
    const bool is_of_file = text_of(layers, "obscura:camera").ends_with(" of the file");
    return !is_of_file && layers.world_to_camera() != neighbor.world_to_camera();
}

/// Neighbouring frames of a film, if it has the layer `motion`, which is added.
Result<std::vector<NeighborFilm>> read_neighbors(const ExrLayers& layers,
                                                 const NeighborDocuments& neighbors,
                                                 Film& film,
                                                 Log& log) {
    std::vector<NeighborFilm> out;
    if (neighbors.before == nullptr && neighbors.after == nullptr) return out;
    const Result<bool> has_motion = read_motion(layers, film);
    if (!has_motion) return fail(has_motion.error());
    if (!*has_motion) {
        log.warn(
            setting("frames"),
            "without the layer motion frames beside a frame tell nothing; render's --aov motion "
            "stores it");
        return out;
    }
    for (const ExrDocument* document : {neighbors.before, neighbors.after}) {
        if (document == nullptr) continue;
        const Result<ExrLayers> found = ExrLayers::find(*document);
        if (!found) return fail(found.error());
        if (auto fits = check_neighbor(layers, *found, document->where()); !fits)
            return fail(fits.error());
        if (has_untold_move(layers, *found)) {
            log.warn(setting("frames"),
                     "the camera differs from frame to frame, and is none of the scene's file, of "
                     "which alone the layer motion tells; frames beside a frame are not used");
            continue;
        }
        Result<NeighborFilm> one = read_neighbor(*found, document->where(), film, log);
        if (!one) return fail(one.error());
        one->is_after = document == neighbors.after;
        out.push_back(std::move(*one));
        warn_of_equal_noise(layers, *found, log);
    }
    return out;
}

void add_changes(std::vector<ExrChange> more, std::vector<ExrChange>& changes) {
    std::move(more.begin(), more.end(), std::back_inserter(changes));
}

/// The beauty as other formats hold it, and the origin that they name.
void describe(const ExrLayers& layers, Film&& film, DenoisedFile& out) {
    OutputImage& image = out.finished.image;
    image.width = film.width;
    image.height = film.height;
    image.channels = std::move(film.channels);
    image.pixels = std::move(film.pixels);
    image.part_of = layers.place();
    ImageMetadata& metadata = out.finished.metadata;
    metadata.software = text_of(layers, "Software");
    metadata.asset = text_of(layers, "obscura:asset");
    metadata.copyright = text_of(layers, "copyright");
    if (const auto* const ev100 = layers.attribute<double>("obscura:ev100")) out.ev100 = *ev100;
    const std::string interop_id = text_of(layers, "colorInteropID");
    for (const std::string& name : rendering_space_names()) {
        Log quiet(Verbosity::quiet);
        const Result<RenderingSpace> space = find_rendering_space(name, "", quiet);
        if (space && space->interop_id == interop_id) out.space = name;
    }
}

}  // namespace

Result<DenoisedFile> denoise_document(const ExrDocument& document,
                                      const NeighborDocuments& neighbors,
                                      bool keep_noisy,
                                      Log& log) {
    const std::string& where = document.where();
    const Result<ExrLayers> layers = ExrLayers::find(document);
    if (!layers) return fail(layers.error());
    const Result<RenderOptions> sampling = sampling_of(*layers, where);
    if (!sampling) return fail(sampling.error());
    const Layer noisy = noisy_layer();
    if (keep_noisy && layers->place_of(noisy.channels)) {
        return fail(ExitCode::usage,
                    "E-USAGE-CONFLICT",
                    setting("keep-noisy"),
                    where + " has a layer " + noisy.name + " already");
    }
    std::vector<ExrPlace> places;
    Result<Film> film = read_light(*layers, places);
    if (!film) return fail(film.error());
    HalvesOfSamples samples = halves_of(*sampling);
    samples.is_rounded = layers->beauty().is_half;
    if (auto read = read_guides(*layers, where, samples, *film, log); !read) {
        return fail(read.error());
    }
    Result<std::vector<NeighborFilm>> films = read_neighbors(*layers, neighbors, *film, log);
    if (!films) return fail(films.error());
    if (keep_noisy) {
        const size_t pixels = film->pixels.size() / film->channels.size();
        film->layers.push_back({noisy, UnsetArray<float>(3 * pixels)});
    }
    DenoisedFile out;
    out.done = denoise_light(samples, *film, *films);
    std::vector<ExrChange> changes = layers->changes_of(layers->beauty(), film->pixels);
    for (size_t i = 0; i < places.size(); ++i)
        add_changes(layers->changes_of(places[i], film->layers[i].pixels), changes);
    if (keep_noisy) {
        add_changes(layers->new_layer(noisy.name, noisy.channels, film->layers.back().pixels),
                    changes);
    }
    const std::vector<ImageAttribute> attributes = {
        {"obscura:denoise", out.done}, {"obscura:denoisedBy", "Obscura " OBSCURA_VERSION}};
    Result<EncodedFile> exr = document.with_changes(changes, attributes);
    if (!exr) return fail(exr.error());
    out.exr = std::move(*exr);
    describe(*layers, std::move(*film), out);
    return out;
}

}  // namespace obscura
