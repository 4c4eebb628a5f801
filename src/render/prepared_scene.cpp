// render/prepared_scene.cpp - builds what rendering needs once: lights, environment, BVH.
// SPDX-License-Identifier: Apache-2.0
#include "render/prepared_scene.h"

#include "base/stopwatch.h"
#include "light/studio.h"

namespace obscura {

namespace {

bool has_emitters(const Scene& scene) {
    for (const Primitive& primitive : scene.primitives) {
        const Material& m = scene.materials[static_cast<size_t>(primitive.material)];
        const bool unlit = (m.flags & material_unlit) != 0;
        if (unlit || m.emission[0] > 0 || m.emission[1] > 0 || m.emission[2] > 0) return true;
    }
    return false;
}

/// The given environment, or the studio when nothing else lights the scene.
Result<std::optional<EnvironmentTable>> make_environment(const Scene& scene,
                                                         const LightingOptions& lighting,
                                                         bool& studio,
                                                         Log& log) {
    EnvironmentImage image;
    std::vector<float> studio_pixels;
    if (lighting.environment) {
        image = {lighting.environment->width,
                 lighting.environment->height,
                 lighting.environment->pixels.data()};
    } else if (scene.lights.empty() && !has_emitters(scene)) {
        studio = true;
        log.info("the scene has no light: using the built-in studio (--env FILE chooses another)");
        studio_pixels = make_studio_pixels();
        image = {studio_width, studio_height, studio_pixels.data()};
    } else {
        return std::optional<EnvironmentTable>();
    }
    auto table = EnvironmentTable::create(
        image, lighting.environment_intensity, lighting.environment_rotation_deg);
    if (!table) return fail(table.error());
    return std::optional<EnvironmentTable>(std::move(*table));
}

}  // namespace

SceneView PreparedScene::Impl::view() const {
    SceneView out;
    out.positions = scene.positions.data();
    out.indices = reinterpret_cast<const int32_t*>(scene.indices.data());
    out.attributes = scene.attributes.data();
    out.primitives = reinterpret_cast<const int32_t*>(scene.primitives.data());
    out.instances = reinterpret_cast<const float*>(scene.instances.data());
    out.materials = reinterpret_cast<const float*>(scene.materials.data());
    out.textures = {scene.textures.texels.data(),
                    reinterpret_cast<const int32_t*>(scene.textures.rows.data())};
    out.lights = lights.view();
    out.has_environment = environment && !environment->black();
    if (out.has_environment) out.environment = environment->view();
    return out;
}

Error missing_isa() {
    return {ExitCode::unsupported,
            "E-ISA",
            "--isa",
            "this CPU does not have that instruction set; auto or baseline always work"};
}

Result<PreparedScene> PreparedScene::create(Scene scene,
                                            const LightingOptions& lighting,
                                            Isa isa,
                                            Log& log) {
    if (!has_isa(isa)) return fail(missing_isa());
    const Stopwatch building;
    auto impl = std::make_unique<Impl>();
    impl->scene = std::move(scene);
    impl->stages = &stage_table_for(isa);
    auto environment = make_environment(impl->scene, lighting, impl->studio, log);
    if (!environment) return fail(environment.error());
    impl->environment = std::move(*environment);
    impl->lights = make_light_table(impl->scene, impl->environment ? &*impl->environment : nullptr);
    const Stopwatch building_bvh;
    auto accel = Accel::build(impl->scene, embree_isa_for(isa));
    if (!accel) return fail(accel.error());
    impl->accel = std::move(*accel);
    impl->build_seconds = {building.seconds(), building_bvh.seconds()};
    return PreparedScene(std::move(impl));
}

PreparedScene::PreparedScene(std::unique_ptr<Impl> impl) : impl_(std::move(impl)) {}
PreparedScene::PreparedScene(PreparedScene&&) noexcept = default;
PreparedScene& PreparedScene::operator=(PreparedScene&&) noexcept = default;
PreparedScene::~PreparedScene() = default;

const Scene& PreparedScene::scene() const {
    return impl_->scene;
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
bool PreparedScene::uses_studio() const {
    return impl_->studio;
}
std::string PreparedScene::isa_name() const {
    return impl_->stages->isa;
}
std::string PreparedScene::embree_version() const {
    return impl_->accel->embree_version();
}

}  // namespace obscura
