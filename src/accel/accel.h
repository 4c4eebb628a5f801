// accel/accel.h - a scene's BVH and its ray queries.
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "accel/columns.h"
#include "base/error.h"
#include "scene/ray_reach.h"
#include "scene/scene.h"
#include "surface/texture.h"

#include <cstdint>
#include <memory>
#include <string>
#include <vector>

namespace obscura {

enum class Coherence { coherent, incoherent };

/// How rays treat back faces, alpha and cut-away faces.
struct SeeThrough {
    bool culls_back_faces = false;  ///< camera rays pass single-sided back faces
    bool fixed_alpha = false;       ///< alpha BLEND becomes a threshold at 0.5, not a random choice
    /// Different for every segment of a path, so that its alpha decisions are independent.
    uint32_t segment = 0;
    uint8_t passes = 0;  ///< surfaces with any of these flags are absent, see scene/visibility.h
    /// With culls_back_faces, the first back face that each ray passes is appended, if its mesh may
    /// be cut away (meshes without emission); null: not recorded.
    std::vector<PassedBack>* passed_backs = nullptr;
    const Cutaway* cutaway = nullptr;  ///< null: all faces are there
};

/// Settings of a shadow query.
struct ShadowQuery {
    uint32_t segment = 0;  ///< as in SeeThrough
    /// By ray, 0 at first: possible thin walls (scene/thin_walls.h) do not occlude a ray, but set
    /// its entry to 1. Null: they occlude.
    uint8_t* thin_walls = nullptr;
    const Cutaway* cutaway = nullptr;  ///< null: all faces are there
    uint8_t passes = 0;                ///< as in SeeThrough
};

struct RayRecording;
struct ReplayResult;
enum class RayKind : int;
enum class ReplayMode : int;

/// Cost of Embree alone for the triangles of a scene.
struct BareBuild {
    double seconds = 0;
    size_t bytes = 0;
};

class Accel {
public:
    /// Builds on all threads.
    ///
    /// In      scene: outlives this object; its vertex and index arrays are shared, not copied
    ///         embree_isa: "" or an Embree isa name such as "avx2"
    /// Errors  33 E-MEM; 69 E-EMBREE-CURVES lines, and an Embree without curves; 69
    ///         E-EMBREE-FILTERS an Embree without filter functions; 70 E-EMBREE
    static Result<Accel> build(const Scene& scene, const std::string& embree_isa);

    /// Updates to another pose of the same asset. Keeps the BVHs of geometry whose stamp, position
    /// in the scene's arrays and alpha filter are unchanged. Errors leave this object unusable.
    ///
    /// In      scene: as for build()
    /// Errors  33 E-MEM; 70 E-EMBREE
    Result<void> update(const Scene& scene);

    /// Builds the triangles and instances of build() without filters and tables, and discards them:
    /// a baseline for timing build(). Same errors.
    static Result<BareBuild> build_bare(const Scene& scene, const std::string& embree_isa);

    /// Builds the same boxes, with a counting callback for each triangle and shape: only for
    /// count_tests. Same errors as build().
    static Result<Accel> build_counting(const Scene& scene, const std::string& embree_isa);

    Accel(Accel&&) noexcept;
    Accel& operator=(Accel&&) noexcept;
    ~Accel();

    /// Nearest hit of every ray. Rays that are not finite, in the world or in an instance's space,
    /// are refused and count as misses. Returns the number of refused rays. Thread-safe.
    int intersect(const RayColumns& rays,
                  const HitColumns& hits,
                  Coherence coherence,
                  SeeThrough see_through) const;

    /// occluded[i] = 1 when anything lies in (0, tfar), else 0; refused rays count as occluded.
    int occluded(const RayColumns& rays,
                 uint8_t* occluded,
                 Coherence coherence,
                 const ShadowQuery& query = {}) const;

    /// Appends all boundaries of media in (0, tfar) of one ray to `out`, unordered, with occasional
    /// duplicates. None for refused rays. Thread-safe.
    void list_crossings(const RayColumns& rays,
                        int index,
                        const SeeThrough& see_through,
                        std::vector<Crossing>& out) const;
    /// Appends the surfaces that the rays meet in (0, tfar) to `out`: in no order, and a surface
    /// perhaps several times. None for refused rays. Cut-away faces count. Thread-safe.
    void list_surfaces(const RayColumns& rays,
                       Coherence coherence,
                       const SeeThrough& see_through,
                       std::vector<MetSurface>& out) const;
    /// Limits of the rays that are not refused.
    RayReach ray_reach() const;
    /// True when there are Gaussian splats. They are no geometry: no other query here finds them.
    bool has_splats() const;

    /// Blends the splats that each ray passes before its end, in order: their light and their
    /// transmittance. Refused rays pass none. Thread-safe.
    ///
    /// In   parallel: all rays have one direction, as for an orthographic camera
    void blend_splats(const RayColumns& rays, bool parallel, const SplatColumns& out) const;

    /// Computes the transmittance of the splats along each ray; 1 where skips[i] is 1.
    void dim_by_splats(const RayColumns& rays, const uint8_t* skips, float* transmittance) const;

    /// True when some primitive may be a thin wall.
    bool has_thin_walls() const;

    /// Counts the primitives that each ray is tested against until its nearest hit is known: those
    /// whose box it meets before that hit, in Embree's order of traversal. Depends only on the
    /// scene, the ray and Embree's instruction set. Treats back faces and alpha as AOVs do, and
    /// ignores visibility flags. Returns the number of refused rays; their count is 0. Thread-safe.
    ///
    /// In      this: from build_counting
    int count_tests(const RayColumns& rays, float* tests) const;

    /// Traces all recorded rays of one kind again with bare Embree, on all threads: see
    /// accel/ray_recording.h.
    ReplayResult replay(const RayRecording& recording, RayKind kind, ReplayMode mode) const;

    size_t memory_bytes() const;  ///< of Embree, by its allocation monitor, and of spheres' boxes
    std::string embree_version() const;

    struct Impl;

private:
    explicit Accel(std::unique_ptr<Impl> impl);
    std::unique_ptr<Impl> impl_;
};

}  // namespace obscura
