// accel/reference_kernels.h - Embree called with 1, 4, 8 and 16 rays, for the cross-check.
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "accel/accel.h"

#include <memory>
#include <string>
#include <vector>

namespace obscura {

/// How a BVH is built.
struct KernelChoice {
    std::string isa = {};         ///< Embree's name, such as "avx2"; "": the widest
    bool robust = true;           ///< false: Embree's fast traversal
    bool filters = true;          ///< alpha cut-outs; only where a material has some
    bool user_triangles = false;  ///< meshes as user geometry with the formula of shape/triangle.h
    bool sphere_points = false;   ///< spheres as Embree's own primitive
    bool counts_tests = false;    ///< user geometry that counts: see Accel::build_counting
};

/// Embree's instruction sets that this CPU has, narrowest first; only "" if there is no choice.
std::vector<std::string> embree_isas();

/// Embree's Ng of each hit: not normalised, in the space of the instance's mesh.
struct NormalColumns {
    float *x, *y, *z;
};

/// One BVH, queried with single rays or packets.
class ReferenceKernels {
public:
    /// In      scene: outlives this object
    /// Errors  as Accel::build
    static Result<ReferenceKernels> build(const Scene& scene, const KernelChoice& choice);

    /// Nearest hits, as Accel::intersect. Rays that are not finite miss.
    ///
    /// In   width: 1, 4, 8 or 16 rays per call; normals: may be null
    void intersect(const RayColumns& rays,
                   const HitColumns& hits,
                   int width,
                   const NormalColumns* normals = nullptr) const;

    /// occluded[i] = 1 if anything is hit; 0 for rays that are not finite.
    void occluded(const RayColumns& rays, uint8_t* occluded, int width) const;

private:
    explicit ReferenceKernels(std::shared_ptr<const Accel::Impl> impl) : impl_(std::move(impl)) {}
    std::shared_ptr<const Accel::Impl> impl_;
};

}  // namespace obscura
