// stages/3_layers.h - the layers of the hit materials: apart from the core material's short path.
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "stages/3_media.h"
#include "stages/3_tangents.h"
#include "surface/layered_bsdf.h"

namespace obscura {
inline namespace OBSCURA_ISA {

/// The path key whose wavelength is 587.56 nm, the d line of helium: for this the indices of
/// refraction are given, so that nothing is dispersed.
inline constexpr uint32_t d_line_key = 0xD5A58U;

/// Where a hit lies on its surface, for its layers.
struct LayerPlace {
    const TangentLanes& tangents;
    Frame<Lanes> frame;         ///< around the base's shading normal; turned for anisotropy
    Vec3<Lanes> smooth_normal;  ///< without any normal map, towards the viewer
    Vec3<Lanes> ng;
    Vec3<Lanes> wo;  ///< world
    Mask front;
    Mask layered;
};

/// The layers of one group of hits, ready for evaluation.
struct LayeredPoint {
    Mask layered;  ///< lanes for which the rest counts
    LayeredParams<Lanes> params;
    LayeredWeights<Lanes> weights;
    Boundary boundary;
    Vec3<Lanes> tint;  ///< for the path: its wavelength's, once a dispersive surface is met; else 1
    Mask lets_through;
};

/// A hit as the layers read it.
struct LayerHit {
    const SceneView& scene;
    const HitGeometry& geometry;
    const LookUp& look;
    const PathLanes& path;
};

/// In   base: the core material; place: layered lanes; its frame may be turned
LayeredPoint read_layered_point(const LayerHit& hit,
                                const BsdfParams<Lanes>& base,
                                LayerPlace& place);

BsdfValue<Lanes> evaluate_layers(const LayeredPoint& point,
                                 const Vec3<Lanes>& wo,
                                 const Vec3<Lanes>& wi);

BsdfSample<Lanes> sample_layers(const LayeredPoint& point,
                                const Vec3<Lanes>& wo,
                                const Vec3<Lanes>& u);

}  // namespace OBSCURA_ISA
}  // namespace obscura
