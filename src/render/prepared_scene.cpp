// render/prepared_scene.cpp - prepares a scene for rendering: lights, environment, BVH.
// SPDX-License-Identifier: Apache-2.0
#include "render/prepared_scene.h"

#include "base/setting_names.h"
#include "base/stopwatch.h"
#include "render/shape_light_table.h"
#include "scene/alike_textures.h"
#include "scene/edge_scale.h"
#include "scene/split_curves.h"
#include "scene/stretch.h"
#include "scene/thin_walls.h"
#include "scene/touching_media.h"

#include <algorithm>
#include <cmath>

namespace obscura {

namespace {

/// Surfaces with a lower mean radiance do not count as lights (the studio's is about 0.7).
constexpr double min_lamp_radiance = 0.05;

/// True when the light table may not tell how bright an emitter is: with alpha, of which it knows a
/// mean of samples, or with too complex motion, which it leaves out.
bool has_unlisted_emitter(const Scene& scene) {
    return std::any_of(
        scene.primitives.begin(), scene.primitives.end(), [&](const Primitive& primitive) {
            const Material& m = scene.materials[static_cast<size_t>(primitive.material)];
            const bool holed = (m.flags & (material_alpha_mask | material_alpha_blend)) != 0;
            const bool unlisted = holed || (moves(primitive) && !scene.motion.instances.empty()) ||
                                  (!is_mesh(primitive) && !scene.motion.instances.empty());
            return unlisted && std::max({m.emission[0], m.emission[1], m.emission[2]}) > 0;
        });
}

/// True when the scene has surfaces to light but no light.
bool needs_studio(const Scene& scene, const LightTable& lights) {
    if (!scene.lights.empty()) return false;
    const auto is_unlit = [&](const Primitive& primitive) {
        const Material& material = scene.materials[static_cast<size_t>(primitive.material)];
        return (material.flags & material_unlit) != 0;
    };
    const auto& all = scene.primitives;
    const bool shows = !all.empty() || !scene.splats.empty();
    if (shows && std::all_of(all.begin(), all.end(), is_unlit)) return false;
    return !has_unlisted_emitter(scene) &&
           brightest_mean_radiance(scene, lights) < min_lamp_radiance &&
           brightest_shape_radiance(scene) < min_lamp_radiance;
}

/// Shadow catchers take light samples alone.
EnvironmentSampling environment_sampling(const Scene& scene, const LightingOptions& lighting) {
    const auto has_catcher = [](const std::vector<uint8_t>& flags) {
        return std::any_of(flags.begin(), flags.end(), [](uint8_t surface) {
            return (surface & visibility_catcher) != 0;
        });
    };
    const bool alone = lighting.catcher_ground || has_catcher(scene.visibility.primitives) ||
                       has_catcher(scene.visibility.instances);
    return alone ? EnvironmentSampling::by_radiance : EnvironmentSampling::compensated;
}

/// Errors  those of EnvironmentCache::table; 64 E-ENV-OPTION the rotation is not finite
Result<void> make_environment(PreparedScene::Impl& impl,
                              const LightingOptions& lighting,
                              const EnvironmentSource& source) {
    if (auto turns = check_rotation(lighting.environment_rotation_deg); !turns) return turns;
    EnvironmentCache& cache =
        lighting.environments != nullptr ? *lighting.environments : impl.environments;
    impl.environment.reset();  // the cache may make room for the new one
    const std::string& name =
        lighting.environment ? lighting.environment_name : impl.scene.info.file_name;
    auto table = cache.table(source, name);
    if (!table) return fail(std::move(table.error()));
    impl.environment = std::move(*table);
    impl.environment_rotation_deg = lighting.environment_rotation_deg;
    return {};
}

/// Uses the environment that the user chose, else the scene's own, else the studio if nothing
/// lights the scene.
Result<void> make_lighting(PreparedScene::Impl& impl, const LightingOptions& lighting, Log& log) {
    const std::shared_ptr<const ImageRgb32f>& own = impl.scene.environment;
    const EnvironmentSource source{lighting.environment ? lighting.environment : own,
                                   lighting.environment_intensity,
                                   environment_sampling(impl.scene, lighting)};
    if (lighting.environment && own) {
        log.info(setting("env") + " takes the place of the environment that the file brings");
    }
    if (!source.image) {
        impl.lights = make_light_table(impl.scene, nullptr);
        if (!needs_studio(impl.scene, impl.lights)) {
            impl.environment.reset();
            impl.environments.drop_unheld();
            return {};
        }
        log.info("the scene has no light: using the built-in studio (" + setting("env") +
                 " chooses another)");
    }
    Result<void> made = make_environment(impl, lighting, source);
    if (made) impl.lights = make_light_table(impl.scene, impl.environment.get());
    return made;
}

/// Prepares everything except the stage table of an instruction set. Builds or updates the Accel.
Result<void> prepare(PreparedScene::Impl& impl,
                     Scene scene,
                     const LightingOptions& lighting,
                     Log& log) {
    const Stopwatch building;
    impl.scene = std::move(scene);
    mark_alike_textures(impl.scene);
    split_long_curves(impl.scene);
    impl.edge_scale = edge_scale(impl.scene);
    impl.stretches = has_stretched_instances(impl.scene);
    impl.touching_media = find_touching_media(impl.scene);
    auto lit = make_lighting(impl, lighting, log);
    if (!lit) return lit;
    const Stopwatch building_bvh;
    if (impl.accel) {
        const Result<void> updated = impl.accel->update(impl.scene);
        if (!updated) return updated;
    } else {
        auto accel = Accel::build(impl.scene, impl.embree_isa);
        if (!accel) return fail(accel.error());
        impl.accel = std::move(*accel);
    }
    impl.build_seconds = {building.seconds(), building_bvh.seconds()};
    return {};
}

}  // namespace

SceneView PreparedScene::Impl::view() const {
    SceneView out;
    out.positions = scene.positions.data();
    out.edge_scale = edge_scale;
    out.indices = reinterpret_cast<const int32_t*>(scene.indices.data());
    out.attributes = scene.attributes.data();
    out.primitives = scene.primitives.data();
    out.instances = scene.instances.data();
    out.stretches = stretches;
    if (!scene.shapes.empty() || !scene.spheres.empty() || !scene.curve_points.empty()) {
        // Lanes that hit shapes also read the mesh tables, at index 0, and ignore the values.
        static constexpr float zeros[16] = {};
        static constexpr ShapeRecord no_shape = {};
        const auto zero_indices = reinterpret_cast<const int32_t*>(zeros);
        if (scene.indices.size() < 4) out.indices = zero_indices;
        if (scene.positions.size() < 3) out.positions = zeros;
        if (scene.attributes.empty()) out.attributes = zeros;
        out.shapes = scene.shapes.empty() ? &no_shape : scene.shapes.data();
        out.spheres = scene.spheres.empty() ? nullptr : scene.spheres.data();
        out.curve_points = scene.curve_points.empty() ? nullptr : scene.curve_points.data();
        out.curve_segments = reinterpret_cast<const int32_t*>(scene.curve_segments.data());
    }
    out.materials = scene.materials.data();
    out.layers = scene.layers.data();
    out.media = scene.media.size() > 1 ? scene.media.data() : nullptr;
    out.touching_media = touching_media.empty() ? nullptr : touching_media.data();
    out.scatters = std::any_of(scene.media.begin(), scene.media.end(), scatters);
    out.thin_walls = accel && (accel->has_thin_walls() || has_media_like_air(scene));
    out.passable_media = accel && has_passable_boundaries(scene);
    out.occludes =
        std::any_of(scene.materials.begin(), scene.materials.end(), [](const Material& material) {
            return material.occlusion_texture.texture >= 0;
        });
    out.material_numbers = scene.material_numbers.data();
    const Motion& motion = scene.motion;
    out.motion.steps = motion.steps;
    if (!motion.positions.empty()) {
        out.motion.positions = motion.positions.data();
        out.motion.normals = motion.normals.data();
    }
    if (!motion.instances.empty()) out.motion.instances = motion.instances.data();
    out.textures = view_of(scene.textures);
    out.lights = lights.view();
    out.has_environment = environment && !environment->black();
    if (out.has_environment) out.environment = environment_view();
    return out;
}

EnvironmentView PreparedScene::Impl::environment_view() const {
    return turned(environment->view(), environment_rotation_deg);
}

Error missing_isa() {
    return {ExitCode::unsupported,
            "E-ISA",
            setting("isa"),
            has_isa(Isa::automatic)
                ? "this CPU or this build does not have that instruction set; auto always works"
                : "this build has no instruction set that this CPU has; build it with "
                  "-DOBSCURA_ISAS=all, or here"};
}

Result<PreparedScene> PreparedScene::create(Scene scene,
                                            const LightingOptions& lighting,
                                            Isa isa,
                                            Log& log) {
    if (!has_isa(isa)) return fail(missing_isa());
    auto impl = std::make_unique<Impl>();
    impl->stages = &stage_table_for(isa);
    impl->embree_isa = embree_isa_for(isa);
    const Result<void> prepared = prepare(*impl, std::move(scene), lighting, log);
    if (!prepared) return fail(prepared.error());
    return PreparedScene(std::move(impl));
}

Result<void> PreparedScene::update(Scene scene, const LightingOptions& lighting, Log& log) {
    return prepare(*impl_, std::move(scene), lighting, log);
}

PreparedScene::PreparedScene(std::unique_ptr<Impl> impl) : impl_(std::move(impl)) {}
PreparedScene::PreparedScene(PreparedScene&&) noexcept = default;
PreparedScene& PreparedScene::operator=(PreparedScene&&) noexcept = default;
PreparedScene::~PreparedScene() = default;

const Scene& PreparedScene::scene() const {
    return impl_->scene;
}
Scene PreparedScene::take_scene() {
    return std::move(impl_->scene);
}
BuildSeconds PreparedScene::build_seconds() const {
    return impl_->build_seconds;
}
const Accel& PreparedScene::accel() const {
    return *impl_->accel;
}
size_t PreparedScene::bvh_bytes() const {
    return impl_->accel->memory_bytes();
}
std::string PreparedScene::isa_name() const {
    return impl_->stages->isa;
}
std::string PreparedScene::embree_version() const {
    return impl_->accel->embree_version();
}

}  // namespace obscura
