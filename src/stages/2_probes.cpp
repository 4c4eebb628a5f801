// stages/2_probes.cpp - stage 2, where media touch: probe rays that find coincident faces.
// SPDX-License-Identifier: Apache-2.0
#include "stages/2_probes.h"

#include "stages/3_geometry.h"

namespace obscura {
inline namespace OBSCURA_ISA {

namespace {

/// Hits on the boundary of a medium that touches another one.
OBSCURA_INLINE Mask may_share(const SceneView& scene,
                              int i,
                              int count,
                              const ProbeColumns& columns) {
    const LanesI primitive = load(columns.hits.primitive + i);
    const LanesI none_yet(0);
    Mask shares = lanes_in_range(i, count) & (primitive >= none_yet);
    if (none(shares)) return shares;
    shares = shares &
             (gather<Lanes>(scene.touching_media, select(shares, primitive, none_yet)) > none_yet);
    if (columns.shared == nullptr || none(shares)) return shares;
    const LanesI slot = select(shares, as_int(load(columns.paths.slot + i)), none_yet);
    const auto words = reinterpret_cast<const int32_t*>(columns.shared);
    return shares & (gather<Lanes>(words, slot * LanesI(shared_faces_words)) < none_yet);
}

}  // namespace

int make_probes(const SceneView& scene, int count, const ProbeColumns& columns) {
    int probes = 0;
    for (int i = 0; i < count; i += lane_count) {
        const Mask shares = may_share(scene, i, count, columns);
        if (none(shares)) continue;
        const PathLanes path = load_paths(columns.paths, i);
        HitLanes hit = hits_or_first(columns.hits, i, shares);
        if (columns.time != nullptr) {
            hit.time = gather<Lanes>(columns.time, select(shares, as_int(path.slot), LanesI(0)));
        }
        HitGeometry g;
        find_geometry<HitUse::start_rays>(scene, hit, g);
        instance_to_world(scene, hit, g);
        shapes_to_world(scene, hit, path, g);
        const Lanes cosine = -dot(g.ng, path.direction);
        const Mask front = cosine >= Lanes(0.0f);
        const Vec3<Lanes> normal = select(front, g.ng, -g.ng);
        const Lanes height = abs(cosine) * hit.t;
        // Embree may confuse the order of two faces that are closer together than this.
        const Lanes depth =
            Lanes(coincidence_distance) * g.offset + Lanes(8.0f / 16777216.0f) * height;
        const Lanes length = depth + Lanes(probe_distance) * g.offset;
        const LanesU side = select(front, LanesU(seen_from_front), LanesU(0U));
        store(columns.path_index + probes,
              pack(Packer(shares), as_uint(lane_numbers() + LanesI(i)) | side));
        probes = append_shadows(columns.probes,
                                probes,
                                shares,
                                {.origin = g.position + normal * depth,
                                 .direction = -normal,
                                 .tfar = length,
                                 .radiance = {depth, height, g.offset},
                                 .slot = path.slot,
                                 .path_key = path.path_key});
    }
    return probes;
}

}  // namespace OBSCURA_ISA
}  // namespace obscura
