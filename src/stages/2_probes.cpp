// stages/2_probes.cpp - stage 2, where bodies touch: rays that look for faces in the same place.
// SPDX-License-Identifier: Apache-2.0
#include "stages/2_probes.h"

#include "stages/3_geometry.h"

namespace obscura {
inline namespace OBSCURA_ISA {

namespace {

/// Hits on bodies that touch others.
OBSCURA_INLINE Mask may_share(const SceneView& scene, int i, int count, const ProbeRows& rows) {
    const LanesI primitive = load(rows.hits.primitive + i);
    const LanesI none_yet(0);
    Mask shares = rows_in_range(i, count) & (primitive >= none_yet);
    if (none(shares)) return shares;
    shares = shares &
             (gather<Lanes>(scene.touching_bodies, select(shares, primitive, none_yet)) > none_yet);
    if (rows.shared == nullptr || none(shares)) return shares;
    const LanesI slot = select(shares, as_int(load(rows.paths.slot + i)), none_yet);
    const auto words = reinterpret_cast<const int32_t*>(rows.shared);
    return shares & (gather<Lanes>(words, slot * LanesI(shared_faces_words)) < none_yet);
}

}  // namespace

int make_probes(const SceneView& scene, int count, const ProbeRows& rows) {
    int probes = 0;
    for (int i = 0; i < count; i += lane_count) {
        const Mask shares = may_share(scene, i, count, rows);
        if (none(shares)) continue;
        const PathLanes path = load_paths(rows.paths, i);
        HitLanes hit = hits_or_first(rows.hits, i, shares);
        if (rows.time != nullptr) {
            hit.time = gather<Lanes>(rows.time, select(shares, as_int(path.slot), LanesI(0)));
        }
        HitGeometry g;
        find_geometry<HitUse::start_rays>(scene, hit, g);
        instance_to_world(scene, hit, g);
        shapes_to_world(scene, hit, path, g);
        const Lanes cosine = -dot(g.ng, path.direction);
        const Mask front = cosine >= Lanes(0.0f);
        const Vec3<Lanes> normal = select(front, g.ng, -g.ng);
        const Lanes height = abs(cosine) * hit.t;
        // How far Embree may be wrong about which of two faces is nearer.
        const Lanes before =
            Lanes(company_distance) * g.offset + Lanes(8.0f / 16777216.0f) * height;
        const Lanes length = before + Lanes(probe_distance) * g.offset;
        const LanesU side = select(front, LanesU(seen_from_front), LanesU(0U));
        store(rows.row + probes, pack(Packer(shares), as_uint(lane_numbers() + LanesI(i)) | side));
        probes = append_shadows(rows.probes,
                                probes,
                                shares,
                                {.origin = g.position + normal * before,
                                 .direction = -normal,
                                 .tfar = length,
                                 .radiance = {before, height, g.offset},
                                 .slot = path.slot,
                                 .path_key = path.path_key});
    }
    return probes;
}

}  // namespace OBSCURA_ISA
}  // namespace obscura
