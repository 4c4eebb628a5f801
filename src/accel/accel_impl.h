// accel/accel_impl.h - the Embree handles and tables of Accel.
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "accel/accel.h"
#include "accel/alpha_filter.h"
#include "accel/dispatch.h"
#include "accel/embree.h"
#include "accel/reference_kernels.h"
#include "accel/shape_geometry.h"
#include "accel/splat_layers.h"
#include "base/memory_budget.h"
#include "base/unset_array.h"
#include "scene/ray_reach.h"

#include <atomic>
#include <mutex>
#include <string>
#include <vector>

namespace obscura {

struct EmbreeErrors {
    std::mutex mutex;
    RTCError code = RTC_ERROR_NONE;
    std::string text;
};

/// What Embree holds, counted and charged to the process's budget.
struct BvhMemory {
    std::atomic<int64_t> bytes = 0;
    std::atomic<int64_t> refused = 0;  ///< size of a block that did not fit
    MemoryCharge charge;
};

/// User pointer of a primitive whose triangles or curve segments are user geometry.
struct UserElements {
    const Accel::Impl* impl = nullptr;
    int32_t primitive = 0;
};

/// The BVH over primitives that share one space.
struct BuiltGeometry {
    RTCScene scene = nullptr;
    Mesh range;                        ///< its primitives, and their stamp
    std::vector<FilterKinds> filters;  ///< by primitive of the range
};

/// Addresses and sizes of the scene's arrays that Embree shares.
struct SharedArrays {
    const float* positions = nullptr;
    const uint32_t* indices = nullptr;
    size_t primitives = 0;  ///< size of the tables that geometries point to
};

/// Lines are curves to Embree, which it may have been built without.
///
/// Errors  69 E-EMBREE-CURVES
Result<void> require_curves(const Scene& scene, bool has_curves);

/// Every hit passes one, and alpha needs them: Embree may have been built without.
///
/// Errors  69 E-EMBREE-FILTERS
Result<void> require_filters(bool has_filters);

/// Why there is no device. Embree has a code for it, but no text.
Error device_failure(RTCError code);

/// Builds a scene's BVH on the threads that our loops use, not on all that Embree finds.
void commit_scene(RTCScene scene);

struct Accel::Impl {
    Impl() = default;
    Impl(const Impl&) = delete;
    Impl& operator=(const Impl&) = delete;
    ~Impl();

    void fill_primitive_tables();
    void list_infinite_planes();

    const Scene* scene = nullptr;
    KernelChoice kernels;
    TextureView textures;
    EmbreeErrors errors;
    BvhMemory memory;
    RTCDevice device = nullptr;
    /// Geometry ids: world primitives, then instances, then `static_geometry` unless it is all
    /// there is.
    RTCScene top = nullptr;
    BuiltGeometry static_geometry;      ///< the static primitives; no scene if there are none
    std::vector<BuiltGeometry> meshes;  ///< as Scene::meshes
    SharedArrays arrays;
    int stream_width = 0;        ///< see accel/coherent_stream.h
    bool has_instances = false;  ///< in `top`
    RayReach reach;              ///< limits of the rays that `top` can take
    RTCScene splats = nullptr;   ///< all splats, which are not in `top`; null: there are none
    SplatGeometry splat_geometry;
    std::vector<uint8_t> materials_with_holes;
    std::vector<uint8_t> thin_walls;             ///< by material
    std::vector<uint8_t> visibility_filters;     ///< by primitive: 1 if it needs one; empty: none
    bool has_thin_walls = false;                 ///< some primitive's material is one
    std::vector<AlphaGeometry> alpha;            ///< by primitive; empty: no filters
    std::vector<ShapeGeometry> shapes;           ///< by primitive; filled for primitives of shapes
    std::vector<UnsetArray<float>> block_boxes;  ///< by primitive; what ShapeGeometry::boxes reads
    std::vector<UserElements> user_elements;     ///< by primitive; empty: Embree's own kinds
    AccelFunctions functions;
    std::vector<InfinitePlane> infinite_planes;
    std::vector<uint8_t> single_sided;              ///< by primitive
    std::vector<int32_t> media;                     ///< by primitive, see medium_of
    std::vector<int32_t> instance_first_primitive;  ///< by instance
};

/// In   impl.alpha: empty if nothing has filters
FilterKinds filters_of(const Accel::Impl& impl, int32_t primitive);

/// The Embree geometry of a primitive; null for an infinite plane.
RTCGeometry make_geometry(Accel::Impl& impl, int32_t index);

/// Rebuilds the BVH over the splats of impl.scene.
void build_splats(Accel::Impl& impl);

/// Triangles as user geometry whose callback counts: see accel/traversal_cost.cpp.
RTCGeometry make_counted_triangles(Accel::Impl& impl, int32_t primitive_index);

/// Likewise for lines, as our own capsules.
RTCGeometry make_counted_curves(Accel::Impl& impl, int32_t primitive_index);

/// Counts, then calls the shape's own callback.
void intersect_counted_shape(const RTCIntersectFunctionNArguments* args);

/// Opens a device and builds all scenes on it. Errors as Accel::build.
Result<std::unique_ptr<Accel::Impl>> build_impl(const Scene& scene, const KernelChoice& kernels);

}  // namespace obscura
