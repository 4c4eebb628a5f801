// crosscheck/kernel_plan.h - the list of kernels that a scene is checked with.
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "accel/reference_kernels.h"
#include "crosscheck/kernels.h"

#include <memory>

namespace obscura {

/// One way to ask a hierarchy.
struct PlannedKernel {
    std::string name;  ///< "robust 16", "fast 1", "avx2 16", "robust 8 occluded"
    int width = 16;
    bool occlusion = false;
};

/// What is asked of one hierarchy. Embree's fast traversal may leak: nothing is expected of it.
/// Triangles as user geometry know no neighbours, and spheres as points are not ours to answer for:
/// they may differ at edges.
struct KernelGroup {
    KernelChoice choice;
    std::vector<PlannedKernel> kernels;
    Standard standard = Standard::full;
};

/// Every hierarchy and width that says something about this scene. The first kernel of the first
/// group is the one that others are compared with.
std::vector<KernelGroup> plan_kernels(const Scene& scene);

/// Shapes, and of these spheres, that a scene has; instances do not count.
struct ShapeCounts {
    size_t triangles = 0, shapes = 0, spheres = 0;
};
ShapeCounts count_shapes(const Scene& scene);

Kernel make_kernel(const std::shared_ptr<const ReferenceKernels>& kernels,
                   const PlannedKernel& planned);

/// The renderer's own queries.
std::vector<Kernel> production_kernels(const std::shared_ptr<const Accel>& accel);

/// A copy without cut-outs and with two sides everywhere: what the truth looks at.
Scene opaque_copy(const Scene& scene);

}  // namespace obscura
