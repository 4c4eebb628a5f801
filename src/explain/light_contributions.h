// explain/light_contributions.h - the sum of ray casting's lights, term by term.
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "explain/pixel_report.h"
#include "render/prepared_scene.h"

namespace obscura {

/// One contribution for every light that the renderer sampled: irradiance and cosine in double
/// precision, their product with the material from the renderer.
///
/// In      report: the renderer's notes and the hit
/// Source  KHR_lights_punctual: range window, inverse square law and spot cone
std::vector<LightContribution> find_light_contributions(const PreparedScene::Impl& prepared,
                                                        const crosscheck::TrueScene& scene,
                                                        const PixelReport& report);

}  // namespace obscura
