// gltf/parse/light_camera_entries.h - tables and checks of the numbers of lights and cameras.
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "gltf/parse/document.h"

#include <optional>
#include <string>

namespace obscura::gltf {

/// In the object of a light of KHR_lights_punctual; those that begin with "spot/" are a spot's.
extern const std::span<const NumberEntry<GltfLight>> light_entries;
/// In a node's EXT_lights_ies.
extern const std::span<const NumberEntry<GltfProfileUse>> profile_entries;
/// In a light of EXT_lights_image_based; its rotation, a quaternion, has no entry.
extern const std::span<const NumberEntry<GltfEnvironment>> environment_entries;
/// In the object of a camera.
extern const std::span<const NumberEntry<GltfCamera>> perspective_entries;
extern const std::span<const NumberEntry<GltfCamera>> orthographic_entries;

/// What is wrong with a number.
struct NumberFault {
    std::string key;  ///< in the object that was checked
    const char* id;
    std::string message;
};

/// A range that is not above 0 is taken as unlimited: 0. False: it was one.
bool finish_range(GltfLight& light);

/// Which of the numbers that may be absent a camera has.
struct CameraGiven {
    bool aspect = false;
    bool zfar = false;
};

/// Checks the numbers of a perspective or orthographic camera; nothing: they are good.
/// Magnifications become positive.
std::optional<NumberFault> finish_camera(GltfCamera& camera, const CameraGiven& given);

}  // namespace obscura::gltf
