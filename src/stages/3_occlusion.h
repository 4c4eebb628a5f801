// stages/3_occlusion.h - occlusion textures, as viewers apply them: they dim the environment.
// SPDX-License-Identifier: Apache-2.0
//
// Where SceneView::occludes, the light that comes to a surface straight from the environment is
// multiplied by the surface's occlusion, whichever way it is found: by light sampling, where the
// surface is shaded; along the path's next ray, where that leaves the scene, which may be behind
// thin walls. For that the slots keep the occlusion of where their path was scattered last.
#pragma once

#include "stages/3_textures.h"
#include "stages/stages.h"

namespace obscura {
inline namespace OBSCURA_ISA {

/// What the hits' occlusion textures leave of light from around them; 1 without one.
/// Source  glTF 2.0, section 3.9.3: 1 + strength * (texel - 1)
OBSCURA_INLINE Lanes read_occlusion(const SceneView& scene,
                                    const HitGeometry& g,
                                    const LookUp& look) {
    const Lanes one(1.0f);
    const FoundSlot slot = find_slot<&Material::occlusion_texture>(scene, g, g.material, look, {});
    if (none(slot.used)) return one;
    const Lanes texel = read_slot(scene, g, slot, look).rgb.x;
    const Lanes strength = g.material.number<&Material::occlusion_strength>();
    return select(slot.used, lerp(one, texel, strength), one);
}

/// Of slots whose paths left the scene.
OBSCURA_INLINE Lanes last_occlusion(const ShadeRows& rows, Mask exists, LanesU slot) {
    return gather<Lanes>(rows.occlusion, select(exists, as_int(slot), LanesI(0)));
}

}  // namespace OBSCURA_ISA
}  // namespace obscura
