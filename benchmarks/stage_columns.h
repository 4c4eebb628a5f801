// benchmarks/stage_columns.h - columns as they enter each stage, from real paths in a real scene.
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "render/render.h"
#include "stages/walk.h"

#include <vector>

namespace obscura::bench {

/// One tile's batch of paths, followed up to a bounce and kept there.
class StageColumns {
public:
    /// In      scene: outlives this object; bounce: 0 keeps camera rays with what they hit
    StageColumns(const PreparedScene& scene, const Camera& camera, int bounce);

    StageColumns(const StageColumns&) = delete;
    StageColumns& operator=(const StageColumns&) = delete;

    /// Puts the columns back as they entered the stage: shading packs them in place.
    void restore();

    /// Fills the shadow rays and whether something occludes them, by shading once.
    void make_shadow_rays();

    int rows() const { return rows_; }
    ShadeRows shade_rows() const;
    RayColumns rays() const;
    RayColumns shadow_rays() const;

    const PreparedScene::Impl& scene;
    SceneView view;
    BatchSettings batch;
    int bounce;
    int pixels;
    ShadeCounts shaded;  ///< after make_shadow_rays()
    Workspace work;

private:
    std::vector<int32_t> xs_, ys_;
    Workspace saved_;
    int rows_ = 0;
};

}  // namespace obscura::bench
