// stages/3_occlusion.h - occlusion textures dim the environment light, as glTF viewers apply them.
// SPDX-License-Identifier: Apache-2.0
//
// If SceneView::occludes, environment light that reaches a surface directly is multiplied by the
// surface's occlusion. Light sampling applies it while the surface is shaded. BSDF sampling applies
// it when the next ray leaves the scene, perhaps after thin walls: a column by sample index keeps
// the occlusion of the path's last scattering until then.
#pragma once

#include "stages/3_textures.h"
#include "stages/stages.h"

namespace obscura {
inline namespace OBSCURA_ISA {

/// Occlusion at the hits, 1 without a texture.
/// Source  glTF 2.0, section 3.9.3: 1 + strength * (texel - 1)
OBSCURA_INLINE Lanes read_occlusion(const SceneView& scene,
                                    const HitGeometry& g,
                                    const TextureFilter& filter) {
    const Lanes one(1.0f);
    const FoundSlot slot =
        find_slot<&Material::occlusion_texture>(scene, g, g.material, filter, {});
    if (none(slot.used)) return one;
    const Lanes texel = read_slot(scene, g, slot, filter).rgb.x;
    const Lanes strength = g.material.number<&Material::occlusion_strength>();
    return select(slot.used, lerp(one, texel, strength), one);
}

/// Occlusion at the last scattering of paths that left the scene.
OBSCURA_INLINE Lanes last_occlusion(const ShadeColumns& columns, Mask exists, LanesU slot) {
    return gather<Lanes>(columns.occlusion, select(exists, as_int(slot), LanesI(0)));
}

}  // namespace OBSCURA_ISA
}  // namespace obscura
