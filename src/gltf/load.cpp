// gltf/load.cpp - a glTF 2.0 file (.gltf or .glb) becomes a scene.
// SPDX-License-Identifier: Apache-2.0
#include "gltf/load.h"

#include "base/setting_names.h"
#include "gltf/asset_files.h"
#include "gltf/assign_material.h"
#include "gltf/chosen_parts.h"
#include "gltf/decode/meshopt.h"
#include "gltf/geometry/instancing.h"
#include "gltf/geometry/left_out_nodes.h"
#include "gltf/geometry/meshes.h"
#include "gltf/geometry/shapes.h"
#include "gltf/geometry/splats.h"
#include "gltf/materials/environment_light.h"
#include "gltf/materials/light_profiles.h"
#include "gltf/materials/lights_cameras.h"
#include "gltf/materials/textures.h"
#include "gltf/parse/asset_file.h"
#include "gltf/parse/variants.h"
#include "gltf/pose.h"
#include "gltf/scene_warnings.h"
#include "image/oiio.h"
#include "scene/frame_motion.h"
#include "scene/points_lines_radii.h"

#include <algorithm>
#include <chrono>
#include <cmath>
#include <exception>
#include <new>
#include <optional>
#include <span>
#include <stdexcept>

namespace obscura::gltf {

namespace {

/// A quarter turn about +X: LoadOptions::z_up.
constexpr Affined y_up_from_z_up = {{{1, 0, 0, 0}, {0, 0, 1, 0}, {0, -1, 0, 0}}};

double seconds_since(std::chrono::steady_clock::time_point start) {
    return std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();
}

void fill_info(const Document& document, AssetInfo& info) {
    info.version = document.version;
    info.generator = document.generator;
    info.copyright = document.copyright;
    for (const GltfScene& scene : document.scenes)
        info.scenes.push_back(scene.name);
    for (const GltfMesh& mesh : document.meshes) {
        size_t triangles = 0;
        for (const GltfPrimitive& primitive : mesh.primitives) {
            triangles += primitive_triangles(document, primitive);
        }
        info.meshes.push_back({mesh.name, triangles});
    }
    info.node_names.reserve(document.nodes.size());
    for (size_t i = 0; i < document.nodes.size(); ++i) {
        const std::string& name = document.nodes[i].name;
        info.node_names.push_back(name.empty() ? "node " + std::to_string(i) : name);
        info.node_meshes.push_back(document.nodes[i].mesh);
    }
    info.node_parents.assign(document.nodes.size(), -1);
    for (size_t i = 0; i < document.nodes.size(); ++i) {
        for (const int child : document.nodes[i].children)
            info.node_parents[static_cast<size_t>(child)] = static_cast<int32_t>(i);
    }
    info.extensions = document.extensions;
    info.variants = document.variants;
    info.xmp = document.xmp;
    info.report = document.report;
}

/// Whether an image is, or may be, one that OpenImageIO decodes; its name need not be right.
bool may_need_oiio(const Document& document) {
    const auto may_need = [](const GltfImage& image) {
        const std::string& name = image.mime.empty() ? image.uri.value_or("") : image.mime;
        return !name.ends_with("webp") && !name.ends_with("ktx2");
    };
    return std::any_of(document.images.begin(), document.images.end(), may_need);
}

/// Time of each animation's last keyframe.
Result<std::vector<AnimationInfo>> animation_infos(const Document& document,
                                                   const BufferStore& buffers) {
    std::vector<AnimationInfo> out;
    for (const GltfAnimation& animation : document.animations) {
        const Result<double> end = animation_end(document, buffers, animation);
        if (!end) return fail(end.error());
        out.push_back({animation.name, animation.channels.size(), *end});
    }
    return out;
}

/// Turns exceptions of the standard library into errors.
template <typename Work>
auto guarded(const std::string& file, const Work& work) -> decltype(work()) {
    try {
        return work();
    } catch (const std::bad_alloc&) {
        return fail(ExitCode::out_of_memory,
                    "E-MEMORY",
                    file,
                    "the system gives no more memory to load the scene; in use: " + memory_items());
    } catch (const std::length_error&) {
        return fail(ExitCode::out_of_memory,
                    "E-MEMORY",
                    file,
                    "the scene asks for more memory than any machine has");
    } catch (const std::exception& problem) {
        return fail(ExitCode::internal, "E-INTERNAL", file, problem.what());
    }
}

}  // namespace

struct PosedAsset::Impl {
    std::filesystem::path file;
    LoadOptions options;
    OpenedAsset asset;
    int scene = -1;  ///< the chosen one; -1: the file has none
    BufferStore buffers;
    Animator animator;
    AssetInfo info;  ///< what all scenes of the asset have in common
    std::vector<std::filesystem::path> files;
    TextureStore textures;
    GeometryStore geometry;
    std::optional<std::vector<Affined>> anchors;  ///< see MeshSources
    std::vector<LightProfile> light_profiles;
    EnvironmentStore environment;
    std::vector<char> hidden_nodes;  ///< of hide_parts
    VisibilityMarks visibility;
    Problems problems;
    Degraded degraded;           ///< of the latest scene
    double open_seconds = 0;     ///< not yet told in a scene
    bool shows_several = false;  ///< at one time

    Result<void> open(bool has_time, Log& log);
    Result<void> choose_parts();
    std::vector<PlacedNode> drawn_nodes(Log& log) const;
    Result<void> add_geometry(MaterialTable& materials, Scene& out, Log& log);
    Result<Scene> pose_at(double time_s, MaterialTable& materials, Log& log);
    Result<std::vector<ScenePose>> poses_at(const std::vector<double>& times_s, double& seconds);
    Result<std::vector<ScenePose>> frames_around(double time_s, double& seconds);
    void add_frames(const std::vector<ScenePose>& frames, Scene& out, Log& log) const;
    Result<void> finish(MaterialTable& materials, bool last, Scene& out, Log& log);
    Result<Scene> scene_at(double time_s, bool last, Log& log);
    Result<Scene> scene_between(const ShutterTimes& shutter, bool last, Log& log);
    Result<Scene> settled(Result<Scene> made, Log& log);
};

/// The look and the parts of it that the options choose.
Result<void> PosedAsset::Impl::choose_parts() {
    Document& document = asset.document;
    if (!options.variant.empty()) {
        if (auto chosen = gltf::choose_variant(options.variant, document); !chosen) return chosen;
    }
    if (auto known = check_light_choice(options.lights, document); !known) return known;
    Result<std::vector<char>> hidden = hide_parts(options.hidden, document);
    if (!hidden) return fail(hidden.error());
    hidden_nodes = std::move(*hidden);
    Result<VisibilityMarks> marks = mark_visibility(options.visibility, document);
    if (!marks) return fail(marks.error());
    visibility = std::move(*marks);
    return {};
}

/// The chosen scene's nodes; the hidden ones are never visible.
std::vector<PlacedNode> PosedAsset::Impl::drawn_nodes(Log& log) const {
    std::vector<PlacedNode> placed = place_nodes(asset.document, scene, log);
    for (PlacedNode& place : placed) {
        if (hidden_nodes.empty() || hidden_nodes[static_cast<size_t>(place.node)] == 0) continue;
        place.visible = false;
        place.may_show = false;
    }
    return placed;
}

Result<void> PosedAsset::Impl::open(bool has_time, Log& log) {
    const auto start = std::chrono::steady_clock::now();
    problems = Problems(options.lenient);
    Result<OpenedAsset> opened =
        open_asset(file, problems, log, {options.occlusion, options.from_rec709});
    if (!opened) return fail(std::move(opened.error()));
    asset = std::move(*opened);
    Document& document = asset.document;
    files = files_of_document(document, file);
    document.keeps_uv = options.keeps_uv;
    if (options.z_up) document.world_from_root = y_up_from_z_up;
    if (!options.info_only && may_need_oiio(document)) open_oiio_ahead();
    const Result<int> chosen = choose_scene(document, options, log);
    if (!chosen) return fail(chosen.error());
    scene = *chosen;
    Result<void> done = choose_parts();
    if (!done) return done;
    const auto animations = choose_animations(document, options.animation, has_time);
    if (!animations) return fail(animations.error());
    if (has_time && document.animations.empty()) {
        log.warn(document.file, "the asset has no animation; it is the same at every time");
    }
    Result<BufferStore> loaded =
        load_buffers(document, {file.parent_path(), asset.glb_binary}, log);
    if (!loaded) return fail(std::move(loaded.error()));
    buffers = std::move(*loaded);
    done = decode_meshopt(document, buffers);
    if (!done) return done;
    auto profiles = load_light_profiles(document, buffers, file.parent_path());
    if (!profiles) return fail(std::move(profiles.error()));
    light_profiles = std::move(*profiles);
    Result<Animator> made = Animator::create(document, buffers, *animations);
    if (!made) return fail(std::move(made.error()));
    animator = std::move(*made);
    animator.mark(document);

    info.file_name = file.filename().string();
    info.scene = std::max(scene, 0);
    info.variant = options.variant;
    fill_info(document, info);
    Result<std::vector<AnimationInfo>> infos = animation_infos(document, buffers);
    if (!infos) return fail(std::move(infos.error()));
    info.animations = std::move(*infos);
    open_seconds = seconds_since(start);
    return {};
}

/// Everything but textures.
Result<void> PosedAsset::Impl::add_geometry(MaterialTable& materials, Scene& out, Log& log) {
    const Document& document = asset.document;
    const std::vector<PlacedNode> placed = drawn_nodes(log);
    const Result<std::vector<PlacedNode>> placed_meshes =
        expand_instances(document, buffers, placed);
    if (!placed_meshes) return fail(placed_meshes.error());
    const MeshSources sources{document,
                              buffers,
                              *placed_meshes,
                              animator.empty() && !shows_several ? nullptr : &geometry,
                              anchors ? &*anchors : nullptr};
    Result<void> done = add_meshes(sources, materials, problems, out, log);
    if (done) done = add_splats(sources, problems, out, log);
    if (!done) return done;
    add_shapes({document, buffers, placed}, materials, problems, out, log);
    done = add_lights_and_cameras(document, placed, options.lights, out, log);
    return done;
}

/// Where the nodes' meshes are in the world.
std::vector<NodePlace> places_of_nodes(const Document& document) {
    std::vector<NodePlace> out;
    for (const Affined& place : world_transforms(document)) {
        const GltfNode& node = document.nodes[out.size()];
        const bool bends =
            node.mesh >= 0 && document.meshes[static_cast<size_t>(node.mesh)].target_count > 0;
        const bool has_own_shape = node.skin >= 0 || bends || is_instanced(node.instancing);
        out.push_back({node.skin >= 0 ? Affined{} : place, has_own_shape});
    }
    return out;
}

/// A scene without textures and materials.
Result<Scene> PosedAsset::Impl::pose_at(double time_s, MaterialTable& materials, Log& log) {
    const auto start = std::chrono::steady_clock::now();
    Document& document = asset.document;
    Scene out;
    out.info = info;
    out.light_profiles = light_profiles;
    Result<void> done = animator.pose(document, time_s);
    if (!done) return fail(std::move(done.error()));
    if (animator.plays()) out.info.time_s = time_s;
    if (options.places_nodes) out.node_places = places_of_nodes(document);
    materials = make_material_table(document);
    done = add_geometry(materials, out, log);
    if (!done) return fail(std::move(done.error()));
    out.info.parse_seconds = open_seconds + seconds_since(start);
    open_seconds = 0;
    return out;
}

/// Poses of the scene at several times, without what all have in common.
///
/// Out     seconds: how long that took is added
Result<std::vector<ScenePose>> PosedAsset::Impl::poses_at(const std::vector<double>& times_s,
                                                          double& seconds) {
    Log quiet(Verbosity::quiet);  // the scene itself says what there is to say
    MaterialTable materials;
    std::vector<ScenePose> poses;
    for (const double time_s : times_s) {
        Result<Scene> pose = pose_at(time_s, materials, quiet);
        if (!pose) return fail(std::move(pose.error()));
        seconds += pose->info.parse_seconds;
        poses.push_back(take_pose(*pose, geometry.static_sizes()));
        geometry.take_back(*pose);
    }
    return poses;
}

/// The poses one frame before a time, at it, and one frame after it; none unless they are wanted.
Result<std::vector<ScenePose>> PosedAsset::Impl::frames_around(double time_s, double& seconds) {
    if (!options.frame_step_s || !animator.plays()) return std::vector<ScenePose>{};
    const double step_s = *options.frame_step_s;
    return poses_at({time_s - step_s, time_s, time_s + step_s}, seconds);
}

/// Gives a scene, not yet finished, its motion from frame to frame.
void PosedAsset::Impl::add_frames(const std::vector<ScenePose>& frames,
                                  Scene& out,
                                  Log& log) const {
    if (frames.empty()) return;
    FrameMotion motion;
    if (!make_frame_motion(out, frames, motion)) {
        log.warn(asset.document.file,
                 "something appears or vanishes from the frame before to the frame after: motion "
                 "vectors are those of the camera alone");
    }
    out.frame_motion = std::make_shared<const FrameMotion>(std::move(motion));
}

Result<void> PosedAsset::Impl::finish(MaterialTable& materials, bool last, Scene& out, Log& log) {
    Document& document = asset.document;
    if (options.from_rec709 && !out.splats.empty()) {
        return fail(ExitCode::unsupported,
                    "E-SPLAT-SPACE",
                    document.file,
                    "colours of Gaussian splats are blended as they are stored, in Rec.709; render "
                    "them in lin_rec709");
    }
    if (last) release_geometry(document, buffers);
    leave_out_nodes(document, out, log);
    if (!out.bounds.empty()) set_default_points_lines_radii(out);
    const auto decode_start = std::chrono::steady_clock::now();
    const std::filesystem::path folder = file.parent_path();
    const TextureLimit* const limit = options.texture_limit ? &*options.texture_limit : nullptr;
    const TextureSources sources{document, buffers, folder, textures, options.info_only, limit};
    Result<void> done = add_textures(sources, materials, problems, out, log);
    const ImageSources images{document, buffers, folder, options.info_only};
    if (done) done = add_environment_light(images, scene, environment, out, log);
    if (!done) return done;
    out.info.decode_seconds = seconds_since(decode_start);
    move_materials(materials, out);
    set_visibility(visibility, out);
    return {};
}

/// A finished scene, unless there are problems that forbid it.
Result<Scene> PosedAsset::Impl::settled(Result<Scene> made, Log& log) {
    const Result<Degraded> lost = problems.settle(made ? nullptr : &made.error(), log);
    if (!lost) return fail(lost.error());
    degraded = *lost;
    warn_about_whole(asset.document, *made, log);
    return made;
}

Result<Scene> PosedAsset::Impl::scene_at(double time_s, bool last, Log& log) {
    MaterialTable materials;
    anchors.reset();
    double parse_seconds = 0;
    const Result<std::vector<ScenePose>> frames = frames_around(time_s, parse_seconds);
    if (!frames) return fail(frames.error());
    Result<Scene> out = pose_at(time_s, materials, log);
    if (!out) return out;
    out->info.parse_seconds += parse_seconds;
    add_frames(*frames, *out, log);
    const Result<void> done = finish(materials, last, *out, log);
    if (!done) return fail(done.error());
    return out;
}

Result<Scene> PosedAsset::Impl::scene_between(const ShutterTimes& shutter, bool last, Log& log) {
    constexpr int steps = 9;  // half a turn in eight straight lines: 2 % of the radius off its arc
    const Result<void> opened = animator.pose(asset.document, shutter.open_s);
    if (!opened) return fail(opened.error());
    if (!animator.empty()) anchors = world_transforms(asset.document);
    std::vector<double> times_s;
    for (int step = 1; step < steps && !animator.empty(); ++step) {
        const double fraction = static_cast<double>(step) / (steps - 1);
        times_s.push_back(shutter.open_s + (shutter.close_s - shutter.open_s) * fraction);
    }
    double parse_seconds = 0;
    const Result<std::vector<ScenePose>> later = poses_at(times_s, parse_seconds);
    if (!later) return fail(later.error());
    const Result<std::vector<ScenePose>> frames = frames_around(shutter.time_s, parse_seconds);
    if (!frames) return fail(frames.error());
    MaterialTable materials;
    Result<Scene> out = pose_at(shutter.open_s, materials, log);
    if (!out) return out;
    out->info.parse_seconds += parse_seconds;
    add_frames(*frames, *out, log);
    if (!join_motion(*out, *later)) {
        log.warn(asset.document.file,
                 "something appears or vanishes while the shutter is open; everything stands still "
                 "as at its opening");
    }
    const Result<void> done = finish(materials, last, *out, log);
    if (!done) return fail(done.error());
    return out;
}

PosedAsset::PosedAsset(std::unique_ptr<Impl> impl) : impl_(std::move(impl)) {}
PosedAsset::PosedAsset(PosedAsset&&) noexcept = default;
PosedAsset& PosedAsset::operator=(PosedAsset&&) noexcept = default;
PosedAsset::~PosedAsset() = default;

Result<PosedAsset> PosedAsset::open(const std::filesystem::path& file,
                                    const LoadOptions& options,
                                    bool has_time,
                                    Log& log) {
    auto impl = std::make_unique<Impl>();
    impl->file = file;
    impl->options = options;
    const Result<void> done =
        guarded(file.string(), [&]() -> Result<void> { return impl->open(has_time, log); });
    if (!done) return fail(impl->problems.settle(&done.error(), log).error());
    return PosedAsset(std::move(impl));
}

Result<Scene> PosedAsset::scene_at(double time_s, bool last, Log& log) {
    return guarded(impl_->file.string(),
                   [&] { return impl_->settled(impl_->scene_at(time_s, last, log), log); });
}

Result<Scene> PosedAsset::scene_between(const ShutterTimes& shutter, bool last, Log& log) {
    return guarded(impl_->file.string(),
                   [&] { return impl_->settled(impl_->scene_between(shutter, last, log), log); });
}

Result<void> PosedAsset::plan_variants(const std::vector<std::string>& names, bool several) {
    impl_->shows_several = several || names.size() > 1;
    return gltf::plan_variants(names, impl_->asset.document);
}

Result<void> PosedAsset::choose_variant(const std::string& name) {
    if (auto chosen = gltf::choose_variant(name, impl_->asset.document); !chosen) return chosen;
    impl_->options.variant = name;
    impl_->info.variant = name;
    const Result<std::vector<char>> hidden =
        hide_parts(impl_->options.hidden, impl_->asset.document);
    if (!hidden) return fail(hidden.error());
    return {};
}

Result<void> PosedAsset::set_value(const std::string& pointer, const std::vector<double>& value) {
    Document& document = impl_->asset.document;
    const Result<SetValue> wanted = check_set_value(pointer, value, document);
    if (!wanted) return fail(wanted.error());
    impl_->animator.set(*wanted, document);
    if (impl_->animator.mark(document)) impl_->geometry = {};
    return {};
}

Result<void> PosedAsset::assign_material(size_t node, size_t material) {
    Document& document = impl_->asset.document;
    const size_t meshes = document.meshes.size();
    auto assigned = gltf::assign_material(node, material, document);
    if (!assigned) return assigned;
    if (document.meshes.size() != meshes) impl_->geometry = {};
    impl_->shows_several = true;
    return choose_variant(impl_->options.variant);  // materials may be hidden by their names
}

const AssetInfo& PosedAsset::info() const {
    return impl_->info;
}

const std::vector<std::filesystem::path>& PosedAsset::files() const {
    return impl_->files;
}

Result<std::vector<char>> PosedAsset::subtree(const std::string& pattern) const {
    return find_subtree(pattern, impl_->asset.document);
}

const Degraded& PosedAsset::degraded() const {
    return impl_->degraded;
}

const std::vector<MemoryCharge>& PosedAsset::texture_charges() const {
    return impl_->textures.charges;
}

void PosedAsset::take_back(Scene&& scene) {
    impl_->textures.texels = std::move(scene.textures.texels);
    impl_->geometry.take_back(scene);
}

Result<Scene> load_gltf(const std::filesystem::path& file, const LoadOptions& options, Log& log) {
    Result<PosedAsset> asset = PosedAsset::open(file, options, options.time_s.has_value(), log);
    if (!asset) return fail(std::move(asset.error()));
    return asset->scene_at(options.time_s.value_or(0), true, log);
}

}  // namespace obscura::gltf
