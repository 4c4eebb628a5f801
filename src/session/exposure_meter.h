// session/exposure_meter.h - how much light falls on an asset, for --exposure auto.
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "session/render_request.h"

#include <optional>
#include <vector>

namespace obscura {

inline constexpr double middle_grey = 0.18;  ///< radiance, where 1 is white

/// The request of a small image of what surfaces show, with the layer that metering needs: without
/// the samples, seed, crop and background that the image is asked for.
RenderRequest metering_image(const RenderRequest& request);

/// What is metered in a film of metering_image: the logarithmic mean, over what surfaces cover, of
/// luminance over that of the albedo, in stops. 0 is the light under which a surface is as bright
/// as its albedo: an incident light meter, so that white things stay white and black ones black.
/// Where nothing has an albedo, luminance over middle grey (0.18) is taken: a reflected light
/// meter.
///
/// Out     nothing: no surface is seen, or no light comes from any
/// Source  Reinhard, Stark, Shirley, Ferwerda, "Photographic Tone Reproduction for Digital
///         Images", SIGGRAPH 2002, eq. 1 (the logarithmic mean)
std::optional<double> metered_stops(const Film& film);

/// The exposure that brings the mean of what was metered to 0, in hundredths of a stop, in any
/// order.
///
/// In      stops: one at least
double exposure_for(std::vector<double> stops);

}  // namespace obscura
