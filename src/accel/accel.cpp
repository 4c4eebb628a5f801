// accel/accel.cpp - builds Embree scenes from a Scene: world-space primitives and instances.
// SPDX-License-Identifier: Apache-2.0
#include "accel/accel_impl.h"
#include "accel/moving_geometry.h"
#include "accel/reference_geometry.h"
#include "base/stopwatch.h"

#include <algorithm>

namespace obscura {

namespace {

/// Keeps the first error text that Embree reports.
void note_error(void* user, RTCError code, const char* text) {
    auto* first = static_cast<EmbreeErrors*>(user);
    const std::lock_guard lock(first->mutex);
    if (first->code == RTC_ERROR_NONE) {
        first->code = code;
        first->text = text != nullptr ? text : "";
    }
}

bool note_memory(void* user, ssize_t bytes, bool) {
    static_cast<std::atomic<int64_t>*>(user)->fetch_add(bytes, std::memory_order_relaxed);
    return true;
}

void set_alpha_filter(Accel::Impl& impl, int32_t primitive_index, RTCGeometry geometry) {
    const Scene& scene = *impl.scene;
    const Primitive& primitive = scene.primitives[static_cast<size_t>(primitive_index)];
    if (impl.alpha.empty() || !needs_alpha_filter(scene, primitive, impl.materials_with_holes)) {
        return;
    }
    AlphaGeometry& alpha = impl.alpha[static_cast<size_t>(primitive_index)];
    alpha = {impl.scene, impl.textures, primitive_index};
    rtcSetGeometryUserData(geometry, &alpha);
    rtcSetGeometryIntersectFilterFunction(geometry, alpha_filter);
    rtcSetGeometryOccludedFilterFunction(geometry, alpha_filter);
}

void set_still_triangles(const Scene& scene, const Primitive& primitive, RTCGeometry geometry) {
    rtcSetSharedGeometryBuffer(geometry,
                               RTC_BUFFER_TYPE_VERTEX,
                               0,
                               RTC_FORMAT_FLOAT3,
                               scene.positions.data(),
                               0,
                               3 * sizeof(float),
                               (scene.positions.size() - 4) / 3);
    rtcSetSharedGeometryBuffer(geometry,
                               RTC_BUFFER_TYPE_INDEX,
                               0,
                               RTC_FORMAT_UINT3,
                               scene.indices.data(),
                               static_cast<size_t>(primitive.first_triangle) * 3 * sizeof(uint32_t),
                               3 * sizeof(uint32_t),
                               static_cast<size_t>(primitive.triangle_count));
}

RTCGeometry make_triangles(Accel::Impl& impl, int32_t primitive_index) {
    const Scene& scene = *impl.scene;
    const Primitive& primitive = scene.primitives[static_cast<size_t>(primitive_index)];
    RTCGeometry geometry = rtcNewGeometry(impl.device, RTC_GEOMETRY_TYPE_TRIANGLE);
    if (moves(primitive)) {
        set_moving_triangles(scene, primitive, geometry);
    } else {
        set_still_triangles(scene, primitive, geometry);
    }
    rtcSetGeometryBuildQuality(geometry, RTC_BUILD_QUALITY_HIGH);
    rtcSetGeometryMask(geometry, 0xFFFFFFFFU);
    set_alpha_filter(impl, primitive_index, geometry);
    rtcCommitGeometry(geometry);
    return geometry;
}

/// Lines as Embree's own capsules; which of them hang together it sees from their numbers.
RTCGeometry make_curves(Accel::Impl& impl, int32_t primitive_index) {
    const Scene& scene = *impl.scene;
    const Primitive& primitive = scene.primitives[static_cast<size_t>(primitive_index)];
    RTCGeometry geometry = rtcNewGeometry(impl.device, RTC_GEOMETRY_TYPE_ROUND_LINEAR_CURVE);
    rtcSetSharedGeometryBuffer(geometry,
                               RTC_BUFFER_TYPE_VERTEX,
                               0,
                               RTC_FORMAT_FLOAT4,
                               scene.curve_points.data(),
                               0,
                               4 * sizeof(float),
                               scene.curve_points.size() / 4);
    rtcSetSharedGeometryBuffer(geometry,
                               RTC_BUFFER_TYPE_INDEX,
                               0,
                               RTC_FORMAT_UINT,
                               scene.curve_segments.data(),
                               static_cast<size_t>(primitive.first_triangle) * sizeof(uint32_t),
                               sizeof(uint32_t),
                               static_cast<size_t>(primitive.triangle_count));
    rtcSetGeometryBuildQuality(geometry, RTC_BUILD_QUALITY_HIGH);
    rtcSetGeometryMask(geometry, 0xFFFFFFFFU);
    set_alpha_filter(impl, primitive_index, geometry);
    rtcCommitGeometry(geometry);
    return geometry;
}

/// False for a plane without end: no box can hold it, so it is no geometry.
bool fill_shape_geometry(Accel::Impl& impl, int32_t primitive_index) {
    const Scene& scene = *impl.scene;
    const Primitive& primitive = scene.primitives[static_cast<size_t>(primitive_index)];
    const Material& material = scene.materials[static_cast<size_t>(primitive.material)];
    ShapeGeometry& out = impl.shapes[static_cast<size_t>(primitive_index)];
    const auto first = static_cast<size_t>(primitive.first_triangle);
    const bool spheres = primitive.geometry == static_cast<int32_t>(GeometryKind::spheres);
    out.rows = spheres ? nullptr : &scene.shapes[first];
    out.spheres = spheres ? &scene.spheres[first * 4] : nullptr;
    out.count = primitive.triangle_count;
    out.single_sided = (material.flags & material_double_sided) == 0;
    if (!impl.alpha.empty() && needs_alpha_filter(scene, primitive, impl.materials_with_holes)) {
        AlphaGeometry& alpha = impl.alpha[static_cast<size_t>(primitive_index)];
        alpha = {impl.scene, impl.textures, primitive_index};
        out.alpha = &alpha;
    }
    return spheres || !is_unbounded(scene.shapes[first]);
}

RTCGeometry make_shapes(Accel::Impl& impl, int32_t primitive_index) {
    ShapeGeometry& shapes = impl.shapes[static_cast<size_t>(primitive_index)];
    const int32_t blocks = (shapes.count + sphere_block - 1) / sphere_block;
    RTCGeometry geometry = rtcNewGeometry(impl.device, RTC_GEOMETRY_TYPE_USER);
    rtcSetGeometryUserPrimitiveCount(
        geometry, static_cast<unsigned>(shapes.rows != nullptr ? shapes.count : blocks));
    rtcSetGeometryUserData(geometry, &shapes);
    rtcSetGeometryBoundsFunction(geometry, impl.shape_callbacks->bounds, nullptr);
    rtcSetGeometryIntersectFunction(
        geometry,
        impl.kernels.counts_tests ? intersect_counted_shape : impl.shape_callbacks->intersect);
    rtcSetGeometryOccludedFunction(geometry, impl.shape_callbacks->occluded);
    rtcSetGeometryBuildQuality(geometry, RTC_BUILD_QUALITY_HIGH);
    rtcSetGeometryMask(geometry, 0xFFFFFFFFU);
    rtcCommitGeometry(geometry);
    return geometry;
}

RTCScene new_scene(const Accel::Impl& impl) {
    RTCScene scene = rtcNewScene(impl.device);
    const RTCSceneFlags robust = impl.kernels.robust ? RTC_SCENE_FLAG_ROBUST : RTC_SCENE_FLAG_NONE;
    rtcSetSceneFlags(scene, robust | query_filter_flag);
    rtcSetSceneBuildQuality(scene, RTC_BUILD_QUALITY_HIGH);
    return scene;
}

/// Null for a plane without end.
RTCGeometry make_geometry(Accel::Impl& impl, int32_t row) {
    const int32_t kind = impl.scene->primitives[static_cast<size_t>(row)].geometry;
    if (kind == static_cast<int32_t>(GeometryKind::curves)) {
        return impl.kernels.counts_tests ? make_counted_curves(impl, row) : make_curves(impl, row);
    }
    if (is_mesh(impl.scene->primitives[static_cast<size_t>(row)])) {
        if (impl.kernels.counts_tests) return make_counted_triangles(impl, row);
        return impl.kernels.user_triangles ? make_checked_triangles(impl, row)
                                           : make_triangles(impl, row);
    }
    if (!fill_shape_geometry(impl, row)) return nullptr;
    const bool points = impl.kernels.sphere_points && are_spheres(impl, row);
    return points ? make_sphere_points(impl, row) : make_shapes(impl, row);
}

void attach_primitives(Accel::Impl& impl, RTCScene target, Mesh range) {
    for (int32_t i = 0; i < range.primitive_count; ++i) {
        const int32_t row = range.first_primitive + i;
        RTCGeometry geometry = make_geometry(impl, row);
        if (geometry == nullptr) continue;
        rtcAttachGeometryByID(target, geometry, static_cast<unsigned>(i));
        rtcReleaseGeometry(geometry);
    }
}

void attach_instance(Accel::Impl& impl, size_t index) {
    const Instance& instance = impl.scene->instances[index];
    RTCGeometry geometry = rtcNewGeometry(impl.device, RTC_GEOMETRY_TYPE_INSTANCE);
    rtcSetGeometryInstancedScene(geometry, impl.mesh_scenes[static_cast<size_t>(instance.mesh)]);
    set_instance_transforms(*impl.scene, instance, geometry);
    rtcSetGeometryMask(geometry, 0xFFFFFFFFU);
    rtcCommitGeometry(geometry);
    const auto id =
        static_cast<unsigned>(impl.scene->world_primitive_count) + static_cast<unsigned>(index);
    rtcAttachGeometryByID(impl.top, geometry, id);
    rtcReleaseGeometry(geometry);
}

tl::unexpected<Error> embree_failure(const EmbreeErrors& errors) {
    const bool memory = errors.code == RTC_ERROR_OUT_OF_MEMORY;
    return fail(memory ? ExitCode::out_of_memory : ExitCode::internal,
                memory ? "E-MEM" : "E-EMBREE",
                "BVH build",
                "Embree reports: " + errors.text);
}

}  // namespace

Accel::Impl::~Impl() {
    for (RTCScene mesh : mesh_scenes)
        rtcReleaseScene(mesh);
    if (top != nullptr) rtcReleaseScene(top);
    if (device != nullptr) rtcReleaseDevice(device);
}

namespace {

Result<std::unique_ptr<Accel::Impl>> open_device(const Scene& scene, const KernelChoice& kernels) {
    auto impl = std::make_unique<Accel::Impl>();
    impl->scene = &scene;
    impl->kernels = kernels;
    impl->textures = {scene.textures.texels.data(),
                      reinterpret_cast<const int32_t*>(scene.textures.rows.data())};
    const std::string config = kernels.isa.empty() ? "" : "isa=" + kernels.isa;
    impl->device = rtcNewDevice(config.c_str());
    if (impl->device == nullptr) {
        return fail(ExitCode::internal, "E-EMBREE", "rtcNewDevice", "no Embree device: " + config);
    }
    const bool lines = !scene.curve_segments.empty();
    if (lines &&
        !rtcGetDeviceProperty(impl->device, RTC_DEVICE_PROPERTY_CURVE_GEOMETRY_SUPPORTED)) {
        return fail(ExitCode::unsupported,
                    "E-EMBREE-CURVES",
                    "Embree",
                    "the scene has lines and this Embree was built without curves; one built with "
                    "EMBREE_GEOMETRY_CURVE is needed");
    }
    rtcSetDeviceErrorFunction(impl->device, note_error, &impl->errors);
    impl->shape_callbacks = &shape_callbacks_for(kernels.isa);
    rtcSetDeviceMemoryMonitorFunction(impl->device, note_memory, &impl->memory);
    return impl;
}

/// Hands everything over to Embree and builds; without filters where impl.alpha is empty.
Result<void> build_scenes(Accel::Impl& impl) {
    const Scene& scene = *impl.scene;
    impl.shapes.resize(scene.primitives.size());
    for (const Mesh& mesh : scene.meshes) {
        RTCScene target = new_scene(impl);
        attach_primitives(impl, target, mesh);
        rtcCommitScene(target);
        impl.mesh_scenes.push_back(target);
    }
    impl.top = new_scene(impl);
    attach_primitives(impl, impl.top, {0, scene.world_primitive_count});
    for (size_t i = 0; i < scene.instances.size(); ++i)
        attach_instance(impl, i);
    rtcCommitScene(impl.top);
    impl.list_endless_planes();
    if (impl.errors.code != RTC_ERROR_NONE) return embree_failure(impl.errors);
    return {};
}

}  // namespace

Result<std::unique_ptr<Accel::Impl>> build_impl(const Scene& scene, const KernelChoice& kernels) {
    auto impl = open_device(scene, kernels);
    if (!impl) return impl;
    if (kernels.filters) {
        (*impl)->alpha.resize(scene.primitives.size());
        (*impl)->materials_with_holes = find_materials_with_holes(scene);
    }
    (*impl)->fill_primitive_tables();
    const Result<void> built = build_scenes(**impl);
    if (!built) return fail(built.error());
    return impl;
}

Result<Accel> Accel::build(const Scene& scene, const std::string& embree_isa) {
    auto impl = build_impl(scene, {.isa = embree_isa});
    if (!impl) return fail(impl.error());
    return Accel(std::move(*impl));
}

Result<Accel> Accel::build_counting(const Scene& scene, const std::string& embree_isa) {
    auto impl = build_impl(scene, {.isa = embree_isa, .counts_tests = true});
    if (!impl) return fail(impl.error());
    return Accel(std::move(*impl));
}

Result<BareBuild> Accel::build_bare(const Scene& scene, const std::string& embree_isa) {
    auto impl = open_device(scene, {.isa = embree_isa, .filters = false});
    if (!impl) return fail(impl.error());
    const Stopwatch building;
    const Result<void> built = build_scenes(**impl);
    if (!built) return fail(built.error());
    return BareBuild{building.seconds(),
                     static_cast<size_t>(std::max<int64_t>((*impl)->memory.load(), 0))};
}

void Accel::Impl::fill_primitive_tables() {
    single_sided.resize(scene->primitives.size());
    for (size_t i = 0; i < single_sided.size(); ++i) {
        const auto material = static_cast<size_t>(scene->primitives[i].material);
        single_sided[i] = (scene->materials[material].flags & material_double_sided) == 0;
    }
    for (const Instance& instance : scene->instances) {
        const Mesh& mesh = scene->meshes[static_cast<size_t>(instance.mesh)];
        instance_first_primitive.push_back(mesh.first_primitive);
    }
}

void Accel::Impl::list_endless_planes() {
    const auto add = [&](int32_t primitive, int32_t instance) {
        const ShapeGeometry& geometry = shapes[static_cast<size_t>(primitive)];
        if (geometry.rows == nullptr || !is_unbounded(*geometry.rows)) return;
        EndlessPlane plane{geometry, *geometry.rows, primitive, instance, {}};
        if (instance >= 0) {
            plane.object_from_world =
                scene->instances[static_cast<size_t>(instance)].object_from_world;
        }
        endless_planes.push_back(plane);
    };
    for (int32_t i = 0; i < scene->world_primitive_count; ++i)
        add(i, -1);
    for (size_t i = 0; i < scene->instances.size(); ++i) {
        const Mesh& mesh = scene->meshes[static_cast<size_t>(scene->instances[i].mesh)];
        for (int32_t k = 0; k < mesh.primitive_count; ++k)
            add(mesh.first_primitive + k, static_cast<int32_t>(i));
    }
}

Accel::Accel(std::unique_ptr<Impl> impl) : impl_(std::move(impl)) {}
Accel::Accel(Accel&&) noexcept = default;
Accel& Accel::operator=(Accel&&) noexcept = default;
Accel::~Accel() = default;

size_t Accel::memory_bytes() const {
    const int64_t bytes = impl_->memory.load();
    return bytes > 0 ? static_cast<size_t>(bytes) : 0;
}

std::string Accel::embree_version() const {
    const auto part = [&](RTCDeviceProperty property) {
        return std::to_string(rtcGetDeviceProperty(impl_->device, property));
    };
    return part(RTC_DEVICE_PROPERTY_VERSION_MAJOR) + "." + part(RTC_DEVICE_PROPERTY_VERSION_MINOR) +
           "." + part(RTC_DEVICE_PROPERTY_VERSION_PATCH);
}

}  // namespace obscura
