// stages/3_layers.h - the lobes of KHR_materials_* at the hits, apart from the core material.
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "stages/3_media.h"
#include "stages/3_tangents.h"
#include "surface/layered_bsdf.h"
#include "surface/lobes/straight_transmission.h"

namespace obscura {
inline namespace OBSCURA_ISA {

/// The pixel key with which sample 0 has the wavelength 587.56 nm, the d line of helium. Indices of
/// refraction are given for that line, so that nothing is dispersed.
inline constexpr uint32_t d_line_key = 0x5505BU;

/// The local geometry of a hit that its layers read.
struct LayerContext {
    const TangentLanes& tangents;
    Frame<Lanes> frame;         ///< around the base's shading normal; turned for anisotropy
    Vec3<Lanes> smooth_normal;  ///< without any normal map, of the front
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
    Vec3<Lanes> tint;     ///< of paths that are given a wavelength here; else 1
    LanesU wavelength;    ///< bits to add to the medium stack: one_wavelength, or 0
    Mask reflects_white;  ///< only transmitted light is given a wavelength
    Mask lets_through;
};

/// A hit as the layers read it.
struct LayerHit {
    const SceneView& scene;
    const HitGeometry& geometry;
    const TextureFilter& filter;
    const PathLanes& path;
    const SharedFaces* shared = nullptr;  ///< as HitLanes has it
};

/// In   base: the core material; context: layered lanes; its frame may be turned
/// Out  out: filled in place because copies are slow
void read_layered_point(const LayerHit& hit,
                        const BsdfParams<Lanes>& base,
                        LayerContext& context,
                        LayeredPoint& out);

/// The same without weights, for those who need none of this view.
void read_layers(const LayerHit& hit,
                 const BsdfParams<Lanes>& base,
                 LayerContext& context,
                 LayeredPoint& out);

/// take_straight_light of the lanes that have layers; the others let nothing pass straight.
StraightLight<Lanes> take_straight(LayeredPoint& point, const Vec3<Lanes>& wo);

BsdfValue<Lanes> evaluate_layers(const LayeredPoint& point,
                                 const Vec3<Lanes>& wo,
                                 const Vec3<Lanes>& wi);

BsdfSample<Lanes> sample_layers(const LayeredPoint& point,
                                const Vec3<Lanes>& wo,
                                const Vec3<Lanes>& u);

}  // namespace OBSCURA_ISA
}  // namespace obscura
