// accel/accel.cpp - builds and updates Embree's BVHs from a Scene.
// SPDX-License-Identifier: Apache-2.0
#include "accel/accel_impl.h"
#include "accel/coherent_stream.h"
#include "accel/embree_version.h"
#include "accel/moving_geometry.h"
#include "base/parallel.h"
#include "base/stopwatch.h"
#include "scene/media.h"
#include "scene/thin_walls.h"

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

/// Embree's word before and after it allocates or frees; false makes the build fail. Small blocks
/// always get through, because Embree asks for some where it cannot fail.
bool note_memory(void* user, ssize_t bytes, bool) {
    auto* memory = static_cast<BvhMemory*>(user);
    constexpr ssize_t small_block = 64U << 10;
    if (!memory->charge.change(bytes) && bytes >= small_block) {
        memory->refused.store(bytes, std::memory_order_relaxed);
        return false;
    }
    memory->bytes.fetch_add(bytes, std::memory_order_relaxed);
    return true;
}

RTCScene new_scene(const Accel::Impl& impl) {
    RTCScene scene = rtcNewScene(impl.device);
    const RTCSceneFlags robust = impl.kernels.robust ? RTC_SCENE_FLAG_ROBUST : RTC_SCENE_FLAG_NONE;
    rtcSetSceneFlags(scene, robust | query_filter_flag);
    rtcSetSceneBuildQuality(scene, RTC_BUILD_QUALITY_HIGH);
    return scene;
}

/// In   first_id: Embree's number of the range's first primitive
void attach_primitives(Accel::Impl& impl, RTCScene target, const Mesh& range, int32_t first_id) {
    for (int32_t i = 0; i < range.primitive_count; ++i) {
        RTCGeometry geometry = make_geometry(impl, range.first_primitive + i);
        if (geometry == nullptr) continue;
        rtcAttachGeometryByID(target, geometry, static_cast<unsigned>(first_id + i));
        rtcReleaseGeometry(geometry);
    }
}

/// index: of the instance; its geometry id follows those of the world primitives
void attach_instance(Accel::Impl& impl, RTCScene mesh, const Instance& instance, size_t index) {
    RTCGeometry geometry = rtcNewGeometry(impl.device, RTC_GEOMETRY_TYPE_INSTANCE);
    rtcSetGeometryInstancedScene(geometry, mesh);
    set_instance_transforms(*impl.scene, instance, geometry);
    rtcSetGeometryMask(geometry, 0xFFFFFFFFU);
    rtcCommitGeometry(geometry);
    const auto id =
        static_cast<unsigned>(impl.scene->world_primitive_count) + static_cast<unsigned>(index);
    rtcAttachGeometryByID(impl.top, geometry, id);
    rtcReleaseGeometry(geometry);
}

void release(BuiltGeometry& geometry) {
    if (geometry.scene != nullptr) rtcReleaseScene(geometry.scene);
    geometry = {};
}

tl::unexpected<Error> embree_failure(const Accel::Impl& impl) {
    const EmbreeErrors& errors = impl.errors;
    if (const int64_t refused = impl.memory.refused.load(); refused > 0) {
        return fail(memory_refusal(MemoryUse::bvh, "BVH build", static_cast<uint64_t>(refused)));
    }
    const bool memory = errors.code == RTC_ERROR_OUT_OF_MEMORY;
    return fail(memory ? ExitCode::out_of_memory : ExitCode::internal,
                memory ? "E-MEM" : "E-EMBREE",
                "BVH build",
                "Embree reports: " + errors.text);
}

}  // namespace

Accel::Impl::~Impl() {
    release(static_geometry);
    for (BuiltGeometry& mesh : meshes)
        release(mesh);
    if (top != nullptr) rtcReleaseScene(top);
    if (splats != nullptr) rtcReleaseScene(splats);
    if (device != nullptr) rtcReleaseDevice(device);
}

Result<void> require_curves(const Scene& scene, bool has_curves) {
    if (has_curves || scene.curve_segments.empty()) return {};
    return fail(ExitCode::unsupported,
                "E-EMBREE-CURVES",
                "Embree",
                "the scene has lines and this Embree was built without curves; one built with "
                "EMBREE_GEOMETRY_CURVE is needed");
}

Result<void> require_filters(bool has_filters) {
    if (has_filters) return {};
    return fail(ExitCode::unsupported,
                "E-EMBREE-FILTERS",
                "Embree",
                "this Embree was built without filter functions; one built with "
                "EMBREE_FILTER_FUNCTION is needed");
}

Error device_failure(RTCError code) {
    if (code == RTC_ERROR_OUT_OF_MEMORY) {
        return Error{ExitCode::out_of_memory,
                     "E-MEM",
                     "Embree",
                     "there is no memory for its device; a smaller scene or a higher limit helps"};
    }
    return Error{ExitCode::internal,
                 "E-EMBREE",
                 "Embree",
                 "it makes no device: its error " + std::to_string(code)};
}

void commit_scene(RTCScene scene) {
    run_in_arena([&] { rtcJoinCommitScene(scene); });
}

namespace {

std::string version_of(RTCDevice device) {
    const auto part = [&](RTCDeviceProperty property) {
        return std::to_string(rtcGetDeviceProperty(device, property));
    };
    return part(RTC_DEVICE_PROPERTY_VERSION_MAJOR) + "." + part(RTC_DEVICE_PROPERTY_VERSION_MINOR) +
           "." + part(RTC_DEVICE_PROPERTY_VERSION_PATCH);
}

Result<std::unique_ptr<Accel::Impl>> open_device(const Scene& scene, const KernelChoice& kernels) {
    auto impl = std::make_unique<Accel::Impl>();
    impl->scene = &scene;
    impl->kernels = kernels;
    const std::string config = kernels.isa.empty() ? "" : "isa=" + kernels.isa;
    impl->device = rtcNewDevice(config.c_str());
    if (impl->device == nullptr) return fail(device_failure(rtcGetDeviceError(nullptr)));
    const auto property =
        rtcGetDeviceProperty(impl->device, RTC_DEVICE_PROPERTY_CURVE_GEOMETRY_SUPPORTED);
    if (auto done = require_curves(scene, property != 0); !done) return fail(done.error());
    const auto filters =
        rtcGetDeviceProperty(impl->device, RTC_DEVICE_PROPERTY_FILTER_FUNCTION_SUPPORTED);
    if (auto done = require_filters(filters != 0); !done) return fail(done.error());
    rtcSetDeviceErrorFunction(impl->device, note_error, &impl->errors);
    impl->functions = accel_functions_for(kernels.isa);
    impl->stream_width = stream_width(impl->device);
    Result<MemoryCharge> charge = charge_memory(MemoryUse::bvh, "", 0);
    if (!charge) return fail(std::move(charge.error()));
    impl->memory.charge = std::move(*charge);
    rtcSetDeviceMemoryMonitorFunction(impl->device, note_memory, &impl->memory);
    return impl;
}

std::vector<FilterKinds> filters_of_range(const Accel::Impl& impl, const Mesh& range) {
    std::vector<FilterKinds> out(static_cast<size_t>(range.primitive_count));
    for (size_t i = 0; i < out.size(); ++i) {
        out[i] = filters_of(impl, range.first_primitive + static_cast<int32_t>(i));
    }
    return out;
}

/// The BVH over a range of primitives: reuses `known` if nothing has changed.
BuiltGeometry build_range(Accel::Impl& impl, const Mesh& range, BuiltGeometry& known) {
    BuiltGeometry out{nullptr, range, filters_of_range(impl, range)};
    const bool is_same =
        known.scene != nullptr && range.stamp != 0 && known.range.stamp == range.stamp &&
        known.range.first_primitive == range.first_primitive &&
        known.range.primitive_count == range.primitive_count && known.filters == out.filters;
    if (is_same) {
        std::swap(out, known);
        return out;
    }
    out.scene = new_scene(impl);
    attach_primitives(impl, out.scene, range, 0);
    commit_scene(out.scene);
    return out;
}

/// Builds the BVHs of static primitives and of meshes; reuses those of an earlier pose.
void build_parts(Accel::Impl& impl) {
    const Scene& scene = *impl.scene;
    BuiltGeometry known = std::move(impl.static_geometry);
    impl.static_geometry = {};
    if (scene.static_primitive_count > 0) {
        impl.static_geometry =
            build_range(impl, {0, scene.static_primitive_count, scene.static_stamp}, known);
    }
    release(known);
    std::vector<BuiltGeometry> known_meshes = std::move(impl.meshes);
    impl.meshes.clear();
    known_meshes.resize(std::max(known_meshes.size(), scene.meshes.size()));
    for (size_t i = 0; i < scene.meshes.size(); ++i)
        impl.meshes.push_back(build_range(impl, scene.meshes[i], known_meshes[i]));
    for (BuiltGeometry& mesh : known_meshes)
        release(mesh);
}

void build_top(Accel::Impl& impl) {
    const Scene& scene = *impl.scene;
    const int32_t static_count = scene.static_primitive_count;
    impl.has_instances = !scene.instances.empty();
    if (static_count > 0 && static_count == scene.world_primitive_count && !impl.has_instances) {
        rtcRetainScene(impl.static_geometry.scene);
        impl.top = impl.static_geometry.scene;
        return;
    }
    impl.top = new_scene(impl);
    attach_primitives(
        impl, impl.top, {static_count, scene.world_primitive_count - static_count}, static_count);
    for (size_t i = 0; i < scene.instances.size(); ++i) {
        const Instance& instance = scene.instances[i];
        const RTCScene mesh = impl.meshes[static_cast<size_t>(instance.mesh)].scene;
        attach_instance(impl, mesh, instance, i);
    }
    if (static_count > 0) {
        attach_instance(impl, impl.static_geometry.scene, Instance{}, scene.instances.size());
    }
    impl.has_instances = impl.has_instances || static_count > 0;
    commit_scene(impl.top);
}

/// Drops BVHs whose arrays have moved in memory since.
void drop_moved(Accel::Impl& impl) {
    const Scene& scene = *impl.scene;
    const SharedArrays now{scene.positions.data(), scene.indices.data(), scene.primitives.size()};
    const bool stay = now.positions == impl.arrays.positions &&
                      now.indices == impl.arrays.indices &&
                      now.primitives == impl.arrays.primitives;
    impl.arrays = now;
    if (impl.top != nullptr) rtcReleaseScene(impl.top);
    impl.top = nullptr;
    if (stay) return;
    release(impl.static_geometry);
    for (BuiltGeometry& mesh : impl.meshes)
        release(mesh);
}

/// Passes everything to Embree and builds; without filters if impl.alpha is empty.
Result<void> build_scenes(Accel::Impl& impl) {
    drop_moved(impl);
    impl.reach = scene_reach(*impl.scene);
    impl.shapes.assign(impl.scene->primitives.size(), {});
    impl.block_boxes.assign(impl.scene->primitives.size(), {});
    build_parts(impl);
    build_top(impl);
    build_splats(impl);
    impl.list_infinite_planes();
    if (impl.errors.code != RTC_ERROR_NONE) return embree_failure(impl);
    return {};
}

/// Builds or rebuilds, with the filters and tables that the scene needs.
Result<void> build_all(Accel::Impl& impl) {
    const Scene& scene = *impl.scene;
    impl.textures = view_of(scene.textures);
    if (impl.kernels.filters) {
        impl.materials_with_holes = find_materials_with_holes(scene);
        impl.thin_walls = find_thin_walls(scene);
        impl.visibility_filters = find_visibility_filters(scene);
        impl.alpha.resize(scene.primitives.size());
        for (size_t i = 0; i < impl.alpha.size(); ++i) {
            const auto index = static_cast<int32_t>(i);
            impl.alpha[i] = {impl.scene, impl.textures, index, filters_of(impl, index)};
        }
        impl.has_thin_walls = std::any_of(
            scene.primitives.begin(), scene.primitives.end(), [&](const Primitive& primitive) {
                return impl.thin_walls[static_cast<size_t>(primitive.material)] != 0;
            });
    }
    impl.fill_primitive_tables();
    return build_scenes(impl);
}

}  // namespace

Result<std::unique_ptr<Accel::Impl>> build_impl(const Scene& scene, const KernelChoice& kernels) {
    auto impl = open_device(scene, kernels);
    if (!impl) return impl;
    const Result<void> built = build_all(**impl);
    if (!built) return fail(built.error());
    return impl;
}

Result<void> Accel::update(const Scene& scene) {
    impl_->scene = &scene;
    return build_all(*impl_);
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
                     static_cast<size_t>(std::max<int64_t>((*impl)->memory.bytes.load(), 0))};
}

void Accel::Impl::fill_primitive_tables() {
    single_sided.resize(scene->primitives.size());
    media.resize(scene->primitives.size());
    instance_first_primitive.clear();
    for (size_t i = 0; i < single_sided.size(); ++i) {
        const auto material = static_cast<size_t>(scene->primitives[i].material);
        single_sided[i] = (scene->materials[material].flags & material_double_sided) == 0;
        media[i] = medium_of(*scene, scene->primitives[i]);
    }
    for (const Instance& instance : scene->instances) {
        const Mesh& mesh = scene->meshes[static_cast<size_t>(instance.mesh)];
        instance_first_primitive.push_back(mesh.first_primitive);
    }
}

Accel::Accel(std::unique_ptr<Impl> impl) : impl_(std::move(impl)) {}
Accel::Accel(Accel&&) noexcept = default;
Accel& Accel::operator=(Accel&&) noexcept = default;
Accel::~Accel() = default;

RayReach Accel::ray_reach() const {
    return impl_->reach;
}

bool Accel::has_thin_walls() const {
    return impl_->has_thin_walls;
}

size_t Accel::memory_bytes() const {
    size_t bytes = static_cast<size_t>(std::max<int64_t>(impl_->memory.bytes.load(), 0));
    for (const auto& boxes : impl_->block_boxes)
        bytes += boxes.size() * sizeof(float);
    return bytes;
}

std::string Accel::embree_version() const {
    return version_of(impl_->device);
}

std::string embree_version() {
    const RTCDevice device = rtcNewDevice("");
    if (device == nullptr) return "";
    std::string out = version_of(device);
    rtcReleaseDevice(device);
    return out;
}

}  // namespace obscura
