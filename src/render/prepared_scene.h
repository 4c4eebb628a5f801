// render/prepared_scene.h - the private parts of PreparedScene.
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "accel/accel.h"
#include "render/environment_cache.h"
#include "render/light_table.h"
#include "render/render.h"

#include <memory>
#include <optional>

namespace obscura {

struct PreparedScene::Impl {
    Scene scene;
    std::shared_ptr<const EnvironmentTable> environment;  ///< null: there is none
    double environment_rotation_deg = 0;
    EnvironmentCache environments;  ///< where LightingOptions brings none
    LightTable lights;
    std::optional<Accel> accel;
    const StageTable* stages = nullptr;
    float edge_scale = 1;                 ///< see scene/edge_scale.h
    bool stretches = false;               ///< see scene/stretch.h
    std::vector<int32_t> touching_media;  ///< see scene/touching_media.h
    std::string embree_isa;               ///< as Accel::build takes it
    BuildSeconds build_seconds;

    SceneView view() const;
    EnvironmentView environment_view() const;  ///< of an environment that there is, turned
};

}  // namespace obscura
