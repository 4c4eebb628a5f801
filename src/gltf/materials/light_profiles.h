// gltf/materials/light_profiles.h - the photometric files of EXT_lights_ies become tables.
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "gltf/decode/buffers.h"
#include "light/light_profile.h"

#include <filesystem>
#include <vector>

namespace obscura::gltf {

/// By Document::profiles; those that no node uses stay empty and are not opened.
///
/// In      folder: the asset's; max_numbers: of all profiles together
/// Errors  65 E-IES-*, E-URI-DATA; 67 E-RES-MISSING; 77 E-URI-REFUSED, E-LIMIT-FILE,
///         E-LIMIT-PROFILES
Result<std::vector<LightProfile>> load_light_profiles(const Document& document,
                                                      const BufferStore& buffers,
                                                      const std::filesystem::path& folder,
                                                      size_t max_numbers = size_t{1} << 28);

}  // namespace obscura::gltf
