// explain/light_shares.h - the light sum of ray casting, term by term.
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "render/prepared_scene.h"

#include "explain/pixel_report.h"

namespace obscura {

/// One share for every light that the renderer asked: irradiance and cosine in double precision,
/// what the material makes of them from the renderer's own product.
///
/// In      report: the renderer's notes and what is seen
/// Source  KHR_lights_punctual: range window, inverse square law and spot cone
std::vector<LightShare> share_out_light(const PreparedScene::Impl& prepared,
                                        const TrueScene& scene,
                                        const PixelReport& report);

}  // namespace obscura
