// crosscheck/kernel_plan.h - lists the kernels that a scene is checked with.
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "accel/reference_kernels.h"
#include "crosscheck/kernels.h"

#include <memory>

namespace obscura::crosscheck {

/// One way to query a hierarchy.
struct PlannedKernel {
    std::string name;  ///< "robust 16", "fast 1", "avx2 16", "robust 8 occluded"
    int width = 16;
    bool occlusion = false;
};

/// The queries of one hierarchy. Embree's fast traversal may leak, so it has no standard to meet.
/// User geometry triangles know no neighbours, and Embree's sphere points are not our code: both
/// may differ at edges.
struct KernelGroup {
    KernelChoice choice;
    std::vector<PlannedKernel> kernels;
    Standard standard = Standard::full;
};

/// Every hierarchy and packet width that applies to this scene. Others are compared with the first
/// kernel of the first group.
std::vector<KernelGroup> plan_kernels(const Scene& scene);

/// Number of shapes in a scene, and how many of them are spheres; instances do not count.
struct ShapeCounts {
    size_t triangles = 0, shapes = 0, spheres = 0;
};
ShapeCounts count_shapes(const Scene& scene);

Kernel make_kernel(const std::shared_ptr<const ReferenceKernels>& kernels,
                   const PlannedKernel& planned);

/// The renderer's own queries.
std::vector<Kernel> production_kernels(const std::shared_ptr<const Accel>& accel);

/// A copy without cut-outs and with double-sided materials, as the truth sees it.
Scene opaque_copy(const Scene& scene);

}  // namespace obscura::crosscheck
