// accel/ray_recording.h - records the rays of a rendering, to replay them on bare Embree.
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "accel/accel.h"

#include <array>
#include <cstdint>
#include <memory>
#include <vector>

namespace obscura {

enum class RayKind : int { camera, bounce, shadow };
inline constexpr size_t ray_kinds = 3;

/// Rays of one kind from one thread, in the order in which they were traced.
struct RecordedRays {
    std::vector<float> ox, oy, oz, dx, dy, dz;
    std::vector<float> tfar;    ///< shadow rays only
    std::vector<uint32_t> key;  ///< of the alpha decisions, with the path's segment mixed in
    uint64_t hits = 0;          ///< of the renderer: hits, or occluded rays
    uint64_t spared = 0;        ///< rays without a hit that may have passed cut-away faces

    size_t count() const { return key.size(); }
    /// The columns; their count is 0, as there may be more rays than an int holds.
    RayColumns columns() const;
};

/// Records the rays of one thread, except refused ones.
class RayRecorder {
public:
    /// In   reach: Accel::ray_reach
    explicit RayRecorder(const RayReach& reach = {}) : reach_(reach) {}

    void add_hits(const RayColumns& rays, const HitView& hits, SeeThrough see_through);
    void add_shadows(const RayColumns& rays, const uint8_t* occluded, const ShadowQuery& query);
    /// Adds shadow rays that ask for the nearest hit because they may continue behind it.
    void add_shadow_hits(const RayColumns& rays, const HitView& hits, SeeThrough see_through);

    /// Recorded rays; of shadow rays, those that ask for any hit.
    const RecordedRays& rays(RayKind kind) const { return rays_[static_cast<size_t>(kind)]; }
    const RecordedRays& shadow_hits() const { return shadow_hits_; }
    bool fixed_alpha() const { return fixed_alpha_; }
    bool passes_thin_walls() const { return passes_thin_walls_; }  ///< of any-hit shadow rays

private:
    RecordedRays& list(RayKind kind) { return rays_[static_cast<size_t>(kind)]; }
    std::array<RecordedRays, ray_kinds> rays_;
    RecordedRays shadow_hits_;
    RayReach reach_;
    bool fixed_alpha_ = false;
    bool passes_thin_walls_ = false;
};

/// All threads' rays of one rendering.
struct RayRecording {
    std::vector<std::unique_ptr<RayRecorder>> threads;

    uint64_t count(RayKind kind) const;
    uint64_t hits(RayKind kind) const;    ///< of the renderer
    uint64_t spared(RayKind kind) const;  ///< see RecordedRays
};

/// How Embree is called: with one ray, with packets of 16 flagged incoherent or coherent, or with
/// streams of such packets, coherent too (accel/coherent_stream.h).
enum class ReplayMode : int { single, packets, coherent_packets, coherent_streams };

struct ReplayResult {
    double seconds = 0;
    uint64_t hits = 0;      ///< or occluded rays
    uint64_t checksum = 0;  ///< of the hits, so that the compiler cannot drop a query
};

}  // namespace obscura
