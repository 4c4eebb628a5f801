// render/prepared_scene.h - the private parts of PreparedScene.
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "accel/accel.h"
#include "render/light_table.h"
#include "render/render.h"

#include <memory>
#include <optional>

namespace obscura {

/// Where an environment comes from: the user's choice, else the scene's own, else the studio; how
/// it is turned and sampled.
struct EnvironmentSource {
    bool chosen = false;
    std::string name;  ///< of the chosen one
    std::shared_ptr<const ImageRgb32f> own;
    double intensity = 1;
    double rotation_deg = 0;
    EnvironmentSampling sampling = EnvironmentSampling::compensated;

    bool operator==(const EnvironmentSource&) const = default;
};

struct PreparedScene::Impl {
    Scene scene;
    std::optional<EnvironmentTable> environment;
    EnvironmentSource environment_source;  ///< of the current environment
    LightTable lights;
    std::optional<Accel> accel;
    const StageTable* stages = nullptr;
    float edge_scale = 1;                 ///< see scene/edge_scale.h
    std::vector<int32_t> touching_media;  ///< see scene/touching_media.h
    std::string embree_isa;               ///< as Accel::build takes it
    BuildSeconds build_seconds;

    SceneView view() const;
};

}  // namespace obscura
