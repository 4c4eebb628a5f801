// benchmarks/stage_columns.h - input columns of each stage, from real paths in a real scene.
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "render/render.h"
#include "stages/wavefront.h"

#include <vector>

namespace obscura::benchmarks {

/// One tile's batch of paths, followed up to a bounce and kept there.
class StageColumns {
public:
    /// In      scene: outlives this object; bounce: 0 keeps camera rays with what they hit
    StageColumns(const PreparedScene& scene, const Camera& camera, int bounce);

    StageColumns(const StageColumns&) = delete;
    StageColumns& operator=(const StageColumns&) = delete;

    /// Restores the input columns of the stage, because shading packs them in place.
    void restore();

    /// Shades once, to fill the shadow rays and whether they are occluded.
    void make_shadow_rays();

    int count() const { return count_; }
    ShadeColumns shade_columns() const;
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
    int count_ = 0;
};

}  // namespace obscura::benchmarks
