// render/prepared_scene.h - what a PreparedScene owns.
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "accel/accel.h"
#include "render/light_table.h"
#include "render/render.h"

#include <optional>

namespace obscura {

struct PreparedScene::Impl {
    Scene scene;
    std::optional<EnvironmentTable> environment;
    LightTable lights;
    std::optional<Accel> accel;
    const StageTable* stages = nullptr;
    std::string embree_isa;  ///< as Accel::build takes it
    BuildSeconds build_seconds;

    SceneView view() const;
};

}  // namespace obscura
