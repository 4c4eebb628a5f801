// render/prepared_scene.h - what a PreparedScene owns.
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "accel/accel.h"
#include "render/light_table.h"
#include "render/render.h"

#include <memory>
#include <optional>

namespace obscura {

/// Where an environment comes from: the user's choice, else the scene's own, else the studio.
struct EnvironmentSource {
    bool chosen = false;
    std::shared_ptr<const ImageRgb32f> own;

    bool operator==(const EnvironmentSource&) const = default;
};

struct PreparedScene::Impl {
    Scene scene;
    std::optional<EnvironmentTable> environment;
    EnvironmentSource environment_source;  ///< of which it was made
    LightTable lights;
    std::optional<Accel> accel;
    const StageTable* stages = nullptr;
    float edge_scale = 1;                  ///< see scene/edge_scale.h
    std::vector<int32_t> touching_bodies;  ///< see scene/touching_bodies.h
    std::string embree_isa;                ///< as Accel::build takes it
    BuildSeconds build_seconds;

    SceneView view() const;
};

}  // namespace obscura
