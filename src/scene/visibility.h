// scene/visibility.h - which kinds of rays pass a surface, and what camera rays see of it.
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <cstdint>
#include <vector>

namespace obscura {

// Flags of a surface; see docs/visibility.md. A query of rays passes the surfaces that have any of
// the flags that it names.
inline constexpr uint8_t visibility_holdout = 1;  ///< camera rays end there, black and transparent
inline constexpr uint8_t visibility_no_camera = 2;  ///< camera rays pass it
inline constexpr uint8_t visibility_no_shadow = 4;  ///< shadow rays pass it
inline constexpr uint8_t visibility_catcher = 8;    ///< shadow catcher: for camera rays alone

// What each kind of ray passes.
inline constexpr uint8_t camera_rays_pass = visibility_no_camera;
inline constexpr uint8_t bounce_rays_pass = visibility_catcher;
inline constexpr uint8_t shadow_rays_pass = visibility_no_shadow | visibility_catcher;

/// The flags of a scene's surfaces: those of a primitive and those of its instance together.
struct VisibilityFlags {
    std::vector<uint8_t> primitives;  ///< as Scene::primitives; empty: no surface has any
    std::vector<uint8_t> instances;   ///< as Scene::instances; empty likewise

    bool empty() const { return primitives.empty(); }

    /// In   instance: -1 for a primitive in world space
    uint8_t of(int32_t primitive, int32_t instance) const {
        if (empty()) return 0;
        const uint8_t own = primitives[static_cast<size_t>(primitive)];
        if (instance < 0) return own;
        return static_cast<uint8_t>(own | instances[static_cast<size_t>(instance)]);
    }
};

}  // namespace obscura
