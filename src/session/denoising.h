// session/denoising.h - the layers that denoising needs, and the denoised film.
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "film/film.h"
#include "render/render.h"
#include "session/render_request.h"

#include <string>

namespace obscura {

/// Refuses what cannot be denoised.
///
/// Errors  64 E-USAGE-CONFLICT: the integrator makes no noise of light, or one sample has no halves
Result<void> check_denoising(const RenderRequest& request);

/// Adds the layers that denoising needs and that are not asked for anyway.
void add_denoising_layers(RenderOptions& options);

/// Sets the runs of the layers of halves by the number of samples.
void set_half_runs(RenderOptions& options);

/// Denoises the beauty and the layers of the light, keeps the noisy beauty in the layer `noisy` if
/// there is one, and takes away the layers that add_denoising_layers added.
///
/// In      options: as rendered; asked: as asked for
/// Returns the EXR attribute obscura:denoise
std::string denoise_film(const RenderOptions& options, const RenderOptions& asked, Film& film);

}  // namespace obscura
