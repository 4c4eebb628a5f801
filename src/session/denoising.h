// session/denoising.h - the layers that denoising needs, and the denoised film.
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "film/film.h"
#include "image/image_metadata.h"
#include "render/render.h"

#include <span>
#include <string>

namespace obscura {

/// Refuses what cannot be denoised.
///
/// In      asked_by: the option, for messages
/// Errors  64 E-USAGE-CONFLICT: the integrator makes no noise of light, or one sample has no halves
Result<void> check_denoising(const RenderOptions& options, const std::string& asked_by);

/// Marks an image whose rendering was stopped before both halves had as many samples.
ImageAttribute unequal_halves();

/// Adds the layers that denoising needs and that are not asked for anyway.
void add_denoising_layers(RenderOptions& options);

/// Samples in a row that go to one half. Adaptive sampling stops pixels at different numbers of
/// samples, the least one, its doubles and the most one: each must have halves of equal size.
size_t halves_run(const RenderOptions& options);

/// Sets the runs of the layers of halves by the number of samples.
void set_half_runs(RenderOptions& options);

/// What is known of the samples of a film that is denoised.
struct HalvesOfSamples {
    float first_share = 0.5f;  ///< of the samples that are in the first half
    bool is_rounded = false;   ///< the beauty or its halves have been stored in 16 bits
};

/// Of a film that has the layers of these options, none of them rounded.
HalvesOfSamples halves_of(const RenderOptions& options);

/// One frame before or after a film that is denoised: of its size, with its layers and `motion`.
struct NeighborFilm {
    bool is_after = false;
    HalvesOfSamples samples;
    Film film;
};

/// Denoises the beauty and the layers of the light, and keeps the noisy beauty in the layer `noisy`
/// if there is one.
///
/// In      film: with the colours of both halves; with neighbours, `motion`. It does without
///         guides that are not there; of albedo, normal and depth, and with them opacity, for which
///         albedo has no use
/// Returns the EXR attribute obscura:denoise
std::string denoise_light(const HalvesOfSamples& samples,
                          Film& film,
                          std::span<NeighborFilm> neighbors = {});

/// Takes away the layers that add_denoising_layers added to those that were asked for.
void remove_denoising_layers(const RenderOptions& asked, Film& film);

/// Denoises the beauty and the layers of the light, keeps the noisy beauty in the layer `noisy` if
/// there is one, and takes away the layers that add_denoising_layers added.
///
/// In      options: as rendered; asked: as asked for
/// Returns the EXR attribute obscura:denoise
std::string denoise_film(const RenderOptions& options, const RenderOptions& asked, Film& film);

}  // namespace obscura
