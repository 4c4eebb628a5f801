// accel/accel.h - a scene's bounding volume hierarchy and the ray queries that the stages ask.
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

/// How rays treat surfaces that a picture can see through.
struct SeeThrough {
    bool culls_back_faces = false;  ///< camera rays pass single-sided back faces
    bool fixed_alpha = false;       ///< alpha BLEND is a cut at one half, not a random choice
    /// Another number for every segment of a path, so that its alpha decisions are independent.
    uint32_t segment = 0;
    /// Appended to, with culls_back_faces: the first back that each ray passes, of those that may
    /// be cut away (meshes that send out no light); null: nobody asks.
    std::vector<PassedBack>* passed_backs = nullptr;
    const Cutaway* cutaway = nullptr;  ///< null: all faces are there
};

/// How shadow rays are asked.
struct ShadowQuery {
    uint32_t segment = 0;  ///< as in SeeThrough
    /// Null, or 0 in every row: what may be a thin wall does not occlude, but makes this 1; see
    /// scene/thin_walls.h
    uint8_t* walls = nullptr;
    const Cutaway* cutaway = nullptr;  ///< null: all faces are there
};

struct RayRecording;
struct ReplayResult;
enum class RayKind : int;
enum class ReplayWay : int;

/// What Embree alone takes for the triangles of a scene.
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
    /// Errors  33 E-MEM; 69 E-EMBREE-CURVES lines, and an Embree without curves; 70 E-EMBREE
    static Result<Accel> build(const Scene& scene, const std::string& embree_isa);

    /// Builds for another pose of the same asset: hierarchies of geometry whose stamp, place in
    /// the scene's arrays and need of an alpha filter are as before are kept. Embree's other errors
    /// leave this object unusable.
    ///
    /// In      scene: as for build()
    /// Errors  33 E-MEM; 70 E-EMBREE
    Result<void> update(const Scene& scene);

    /// Builds the same triangles and instances as build(), with no filters and no tables, and lets
    /// them go: a measure for build(). Same errors.
    static Result<BareBuild> build_bare(const Scene& scene, const std::string& embree_isa);

    /// Builds the same boxes with each triangle and shape handed to a callback that counts: for
    /// count_tests, and for nothing else. Same errors as build().
    static Result<Accel> build_counting(const Scene& scene, const std::string& embree_isa);

    Accel(Accel&&) noexcept;
    Accel& operator=(Accel&&) noexcept;
    ~Accel();

    /// Nearest hit of every ray. Rays that are not finite, in the world or in an instance's space,
    /// are refused: a miss, and counted.
    /// Returns how many were refused. Thread-safe.
    int intersect(const RayColumns& rays,
                  const HitColumns& hits,
                  Coherence coherence,
                  SeeThrough see_through) const;

    /// occluded[i] = 1 when anything lies in (0, tfar), else 0; refused rays count as occluded.
    int occluded(const RayColumns& rays,
                 uint8_t* occluded,
                 Coherence coherence,
                 const ShadowQuery& query = {}) const;

    /// All faces of bodies in (0, tfar) of one row's ray, in no order and now and then twice;
    /// appended to `out`. None for rays that are refused. Thread-safe.
    void list_crossings(const RayColumns& rays,
                        int row,
                        const SeeThrough& see_through,
                        std::vector<Crossing>& out) const;
    /// Which rays are not refused.
    RayReach ray_reach() const;
    /// True when there are Gaussian splats. They are no geometry: no other query here finds them.
    bool has_splats() const;

    /// The light of the splats that each ray passes before its end, in their order, and what they
    /// leave of light from there. Refused rays pass none. Thread-safe.
    ///
    /// In   parallel: as all rays of an orthographic camera are
    void blend_splats(const RayColumns& rays, bool parallel, const SplatColumns& out) const;

    /// What splats leave of light that comes along the rays, but where skips[i] is 1.
    void dim_by_splats(const RayColumns& rays, const uint8_t* skips, float* transmittance) const;

    /// True when some primitive may be a thin wall.
    bool has_thin_walls() const;

    /// How many primitives each ray is tested against until its nearest hit is known: those whose
    /// box it meets before that hit, in the order in which Embree comes to them. Depends on the
    /// scene, the ray and Embree's instruction set only. Single-sided backs and alpha as for
    /// quantities. Returns how many rays were refused; theirs is 0. Thread-safe.
    ///
    /// In      this: from build_counting
    int count_tests(const RayColumns& rays, float* tests) const;

    /// Asks bare Embree for all recorded rays of one kind once more, on all threads: see
    /// accel/ray_recording.h.
    ReplayResult replay(const RayRecording& recording, RayKind kind, ReplayWay way) const;

    size_t memory_bytes() const;  ///< of Embree, by its allocation monitor, and of spheres' boxes
    std::string embree_version() const;

    struct Impl;

private:
    explicit Accel(std::unique_ptr<Impl> impl);
    std::unique_ptr<Impl> impl_;
};

}  // namespace obscura
