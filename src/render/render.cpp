// render/render.cpp - divides the film into tiles, one task each, and traces their batches.
// SPDX-License-Identifier: Apache-2.0
#include "render/render.h"

#include "base/parallel.h"
#include "base/stopwatch.h"
#include "film/cryptomatte_names.h"
#include "film/light_path_plan.h"
#include "render/adaptive_sums.h"
#include "render/camera_media.h"
#include "render/counts.h"
#include "render/filter_table.h"
#include "render/frame_view.h"
#include "render/integrators.h"
#include "render/light_classes.h"
#include "render/pass_sums.h"
#include "render/prepared_scene.h"
#include "render/raycast_lights.h"
#include "stages/wavefront.h"
#include "surface/bsdf.h"

#include <algorithm>
#include <memory>
#include <optional>

namespace obscura {

namespace {

bool any_catcher(const VisibilityFlags& visibility) {
    const auto is_one = [](uint8_t flags) { return (flags & visibility_catcher) != 0; };
    return std::any_of(visibility.primitives.begin(), visibility.primitives.end(), is_one) ||
           std::any_of(visibility.instances.begin(), visibility.instances.end(), is_one);
}

CatcherSettings catchers_of(const Scene& scene, const RenderOptions& options) {
    if (!has_catchers(options.integrator)) return {};
    constexpr float rounding = 1e-5f;  // of coordinates; more than rays start clear of surfaces
    const Bounds& bounds = scene.bounds;
    const Vec3f farthest = bounds.empty() ? Vec3f{} : max3(bounds.high, -bounds.low);
    return {.surfaces = any_catcher(scene.visibility),
            .ground_m = options.catcher_ground_m,
            .below_ground_m = rounding * max_component(farthest),
            .reflects = options.catcher_reflections};
}

/// Whether paths through clear glass see something else than the environment that lights the scene.
bool sees_through_glass(const WavefrontInput& input, const RenderOptions& options) {
    const bool caught = input.catchers.any();
    const bool wanted = options.transparent_glass == TransparentGlass::on ||
                        (options.transparent_glass == TransparentGlass::automatic && caught);
    const bool environment = input.batch.background_visible && input.scene.has_environment;
    return wanted && (caught || !environment);
}

/// How much glass of a roughness spreads light, with room for rounding; see BsdfSample::spread.
double clear_spread(double roughness) {
    const double alpha = std::max(roughness * roughness, static_cast<double>(min_ggx_alpha));
    return 0.5 * alpha * (1 + 1e-5);
}

WavefrontInput make_wavefront_input(const PreparedScene::Impl& scene,
                                    const Camera& camera,
                                    const RenderOptions& options) {
    WavefrontInput input{};
    input.stages = scene.stages;
    input.accel = &*scene.accel;
    input.scene = scene.view();
    BatchSettings& batch = input.batch;
    batch.camera = camera;
    batch.width = options.width;
    batch.height = options.height;
    batch.seed_low = static_cast<uint32_t>(options.seed);
    batch.seed_high = static_cast<uint32_t>(options.seed >> 32);
    batch.z_order_bits = z_order_bits(options);
    batch.max_bounces = options.max_bounces;
    batch.strategies = options.strategies;
    batch.background_visible = options.background == BackgroundKind::environment;
    if (options.background == BackgroundKind::color) {
        std::copy_n(options.background_color, 3, batch.background);
        batch.background[3] = 1.0f;
    } else if (batch.background_visible) {
        batch.background[3] = input.scene.has_environment ? 1.0f : 0.0f;
    }
    const Bounds& bounds = scene.scene.bounds;
    const float diagonal = bounds.empty() ? 1.0f : length(bounds.high - bounds.low);
    batch.ao_distance =
        options.ao_distance_m > 0 ? static_cast<float>(options.ao_distance_m) : 0.2f * diagonal;
    batch.footprint_fraction = footprint_fraction(samples_taken(options));
    batch.wire_width_px = static_cast<float>(options.wire_width_px);
    batch.clamp_direct = static_cast<float>(options.clamp_direct);
    batch.clamp_indirect = static_cast<float>(options.clamp_indirect);
    batch.caustics = options.caustics;
    batch.regularize = options.regularize && options.caustics;
    const auto& eye = camera.world_from_camera.m;
    batch.medium_stack =
        medium_stack_around(*scene.accel, scene.scene, {eye[0][3], eye[1][3], eye[2][3]});
    if (options.integrator == Integrator::direct) batch.max_bounces = 0;
    const VisibilityFlags& visibility = scene.scene.visibility;
    if (!visibility.empty()) input.visibility = &visibility;
    input.catchers = catchers_of(scene.scene, options);
    if (has_catchers(options.integrator) && sees_through_glass(input, options))
        batch.clear_spread = static_cast<float>(clear_spread(options.clear_roughness));
    input.kind = entry_of(options.integrator).kind;
    input.aovs = entry_of(options.integrator).aovs;
    batch.through_centres = input.kind == WavefrontKind::raycast;
    return input;
}

/// Side of a tile. AOVs take one ray per pixel and need larger tiles to fill a batch.
int tile_side(const RenderOptions& options) {
    constexpr int side_for_aovs = 32;
    static_assert(side_for_aovs * side_for_aovs == aov_batch_size);
    return is_aov(options.integrator) ? std::max(options.tile_size, side_for_aovs)
                                      : options.tile_size;
}

RenderCounters sum_counters(const std::vector<std::unique_ptr<ThreadState>>& states) {
    RenderCounters total;
    for (const auto& state : states) {
        if (!state) continue;
        add_counts(state->counters, total);
        total.stages.add(state->counters.seconds);
    }
    return total;
}

void hand_over(std::vector<std::unique_ptr<ThreadState>>& states, RayRecording& recording) {
    for (const auto& state : states) {
        if (state) recording.threads.push_back(std::move(state->recorder));
    }
}

/// Data of an integrator besides the prepared scene.
struct Supplies {
    RaycastLights raycast;
    std::optional<Accel> counting;
    std::vector<Affinef> camera;  ///< MotionView::camera
};

/// The camera's movement since the first time, at each time, as a transform of the world.
std::vector<Affinef> camera_motion(const std::vector<Affined>& world_from_camera) {
    std::vector<Affinef> moved;
    for (const Affined& placing : world_from_camera) {
        moved.push_back(affine_cast<float>(compose(placing, inverse(world_from_camera.front()))));
    }
    if (moved.size() < 2) moved.clear();
    return moved;
}

Result<Supplies> make_supplies(const PreparedScene::Impl& scene, const RenderOptions& options) {
    Supplies out;
    out.camera = camera_motion(options.moving_camera);
    if (options.integrator == Integrator::raycast) out.raycast = make_raycast_lights(scene);
    if (options.integrator == Integrator::heat) {
        Result<Accel> counting = Accel::build_counting(scene.scene, scene.embree_isa);
        if (!counting) return fail(counting.error());
        out.counting = std::move(*counting);
    }
    return out;
}

void use_supplies(const Supplies& supplies, WavefrontInput& in) {
    in.scene.raycast = supplies.raycast.view();
    if (!supplies.camera.empty()) {
        in.scene.motion.camera = supplies.camera.data();
        in.scene.motion.camera_steps = static_cast<int>(supplies.camera.size());
    }
    in.counting = supplies.counting ? &*supplies.counting : nullptr;
}

/// True when a layer counts the samples of ids.
bool counts_ids(const std::vector<Layer>& layers) {
    return std::any_of(layers.begin(), layers.end(), [](const Layer& layer) {
        return is_cryptomatte(layer) || std::holds_alternative<MajorityNode>(layer.source);
    });
}

/// The names that a layer's ids stand for; none if they are not Cryptomatte's.
std::vector<std::string> names_of(const Layer& layer, const CryptomatteTables& tables) {
    const auto* names = std::get_if<CryptomatteNames>(&layer.source);
    if (names == nullptr) return {};
    switch (*names) {
        case CryptomatteNames::objects:
            return tables.objects;
        case CryptomatteNames::materials:
            return tables.materials;
        case CryptomatteNames::assets:
            break;
    }
    return tables.assets;
}

/// The layers of an image, and what they need.
struct LayerPlans {
    LayerPlan layers;
    std::optional<LightPathPlan> light;  ///< nothing: there are no light layers
};

/// Adds layers to a film.
LayerPlan add_layers(const Scene& scene,
                     const std::vector<Layer>& layers,
                     bool catches,
                     Film& film) {
    CryptomatteTables tables;
    if (counts_ids(layers)) tables = cryptomatte_tables(scene);
    const size_t pixels = static_cast<size_t>(film.width) * static_cast<size_t>(film.height);
    for (const Layer& layer : layers) {
        film.layers.push_back(
            {layer, zero_array<float>(pixels * layer.channels.size()), names_of(layer, tables)});
    }
    return LayerPlan(layers, cryptomatte_hashes(tables), catches);
}

/// Adds the layers that were asked for to a film.
Result<LayerPlans> plan_layers(const PreparedScene::Impl& prepared,
                               const RenderOptions& options,
                               Film& film) {
    const Scene& scene = prepared.scene;
    std::vector<Layer> layers = options.layers;
    LayerPlans out;
    if (has_light_layers(layers) || !options.light_groups.empty()) {
        const Result<LightGroups> groups = make_light_groups(scene, options.light_groups);
        if (!groups) return fail(groups.error());
        if (options.light_groups.each) {
            for (Layer& layer : light_group_layers(groups->names, options.light_groups.components))
                layers.push_back(std::move(layer));
        }
        std::vector<uint16_t> classes = light_classes(scene, *groups, prepared.lights.view());
        Result<LightPathPlan> light =
            LightPathPlan::make(layers, scene, *groups, std::move(classes));
        if (!light) return fail(light.error());
        out.light = std::move(*light);
    }
    out.layers = add_layers(scene, layers, catchers_of(scene, options).any(), film);
    return out;
}

/// A film of the crop's size, in the memory of an earlier film if there is one.
Film make_film(const RenderOptions& options) {
    Film film;
    film.width = options.crop ? options.crop->width : options.width;
    film.height = options.crop ? options.crop->height : options.height;
    if (options.crop) {
        film.part_of = ImagePart{options.width, options.height, options.crop->x, options.crop->y};
    }
    film.channels = film_channels(options.integrator);
    if (options.film_memory != nullptr) film.pixels = std::move(*options.film_memory);
    // Not cleared here: the memory pages are first touched by the threads that write the pixels.
    film.pixels.resize(static_cast<size_t>(film.width) * static_cast<size_t>(film.height) *
                       film.channels.size());
    return film;
}

/// The tiles of the rows that are rendered.
std::vector<Tile> tiles_of(const RenderOptions& options, int side) {
    const PixelRect whole = options.crop.value_or(PixelRect{0, 0, options.width, options.height});
    if (options.share == nullptr) return cut_tiles(whole, side);
    std::vector<Tile> out;
    if (!options.share->part) return out;
    for (const RowRange& rows : rows_of_part(whole.height, *options.share->part)) {
        const PixelRect band{whole.x, whole.y + rows.first, whole.width, rows.count};
        const std::vector<Tile> tiles = cut_tiles(band, side);
        out.insert(out.end(), tiles.begin(), tiles.end());
    }
    return out;
}

/// Takes away the tiles all of whose pixels lie in areas of the film that are filled already.
void leave_out_filled(const std::vector<FilmArea>& filled,
                      const Film& film,
                      std::vector<Tile>& tiles) {
    if (filled.empty()) return;
    const auto width = static_cast<size_t>(film.width);
    std::vector<uint8_t> is_filled(width * static_cast<size_t>(film.height), 0);
    for (const FilmArea& area : filled) {
        for (int y = area.y; y < area.y + area.height; ++y) {
            const size_t first = static_cast<size_t>(y) * width + static_cast<size_t>(area.x);
            std::fill_n(is_filled.begin() + static_cast<ptrdiff_t>(first), area.width, uint8_t{1});
        }
    }
    const auto is_done = [&](const Tile& tile) {
        for (int y = tile.y; y < tile.y + tile.height; ++y) {
            const auto row =
                is_filled.begin() + static_cast<ptrdiff_t>(pixel_index(film, tile.x, y));
            if (std::find(row, row + tile.width, uint8_t{0}) != row + tile.width) return false;
        }
        return true;
    };
    tiles.erase(std::remove_if(tiles.begin(), tiles.end(), is_done), tiles.end());
}

/// Renders tile after tile, each with all of its samples.
///
/// In      filled: areas of the film that need no rendering
void render_tiles(const FilmWork& work, const std::vector<FilmArea>& filled) {
    const RenderOptions& options = work.options;
    const TileWork& tile_work = work.tile_work;
    // Tiles that are kept in a file fit those of any later run.
    const int side = options.share != nullptr ? pass_tile_side : tile_side(options);
    std::vector<Tile> tiles = tiles_of(options, side);
    const size_t all = tiles.size();
    leave_out_filled(filled, work.film, tiles);
    const bool aov = is_aov(options.integrator);
    const SampleRange samples{0, samples_taken(options)};
    std::atomic<size_t> finished = all - tiles.size();
    parallel_for(tiles.size(), [&](size_t i) {
        if (tile_work.stop.load(std::memory_order_relaxed)) return;
        ThreadState& state = thread_state(work);
        const Tile& tile = tiles[i];
        RenderCounters before;
        add_counts(state.counters, before);
        if (aov) {
            render_aov_tile(tile_work, tile, state, work.film);
        } else {
            begin_tile(tile_work, tile, state.sums);
            sample_pixels(
                tile_work, pattern_of(tile, state.pattern).all, samples, state, state.sums);
            if (tile_work.stop.load(std::memory_order_relaxed)) return;
            store_beauty(state.sums, state.pattern, work.film);
            store_layers(tile_work.layers, state.sums, state.pattern, work.film);
        }
        const size_t done = ++finished;
        if (!work.progress || tile_work.stop.load(std::memory_order_relaxed)) return;
        work.progress({static_cast<double>(done) / static_cast<double>(all),
                       {tile.x, tile.y, tile.width, tile.height},
                       &work.film,
                       counted_since(before, state.counters)});
    });
}

/// Renders in passes over the whole film. Returns whether the film has the pixels.
Result<bool> run_passes(const FilmWork& work, const std::shared_ptr<FilmSums>& sums) {
    const FilmShare* const share = work.options.share;
    if (share != nullptr && share->begin_passes) {
        const Result<void> begun = share->begin_passes({sums, work.tile_work, work.film});
        if (!begun) return fail(begun.error());
    }
    sums->sample(work);
    const bool wants_film = share == nullptr || !share->wants_film || share->wants_film();
    if (wants_film) sums->store(work.tile_work.layers, work.film);
    return wants_film;
}

Result<void> render_in_passes(const FilmWork& work) {
    const RenderOptions& options = work.options;
    const FilmPart part = options.share->part.value_or(FilmPart{});
    const auto sums = std::make_shared<PassSums>(tiles_of(options, pass_tile_side),
                                                 samples_of_part(samples_taken(options), part),
                                                 part.of == PartOf::samples,
                                                 options.share->shows_early);
    const Result<bool> done = run_passes(work, sums);
    if (!done) return fail(done.error());
    return {};
}

Result<void> render_adaptively(const FilmWork& work, RenderResult& result) {
    const auto sums = std::make_shared<AdaptiveSums>(
        tiles_of(work.options, pass_tile_side), work.options, work.film);
    const Result<bool> done = run_passes(work, sums);
    if (!done) return fail(done.error());
    if (*done) result.adaptive = sums->taken();
    return {};
}

/// Renders the film in the way that is asked for.
Result<void> render_film(const FilmWork& work, RenderResult& result) {
    const RenderOptions& options = work.options;
    const FilmShare* const share = options.share;
    if (options.adaptive) return render_adaptively(work, result);
    const bool takes_passes = share != nullptr && share->begin_passes;
    if (takes_passes && !is_aov(options.integrator)) return render_in_passes(work);
    Result<std::vector<FilmArea>> filled;
    if (share != nullptr && share->fill) filled = share->fill(result.film);
    if (!filled) return fail(filled.error());
    render_tiles(work, *filled);
    return {};
}

/// Calls FilmShare::leave at the end of a rendering, also where an exception ends it.
class FilmLeaving {
public:
    FilmLeaving(const FilmShare* share, const Film& film) : share_(share), film_(film) {}
    ~FilmLeaving() {
        if (share_ != nullptr && share_->leave) share_->leave(film_);
    }
    FilmLeaving(const FilmLeaving&) = delete;
    FilmLeaving& operator=(const FilmLeaving&) = delete;

private:
    const FilmShare* share_;
    const Film& film_;
};

}  // namespace

Result<RenderResult> render(const PreparedScene& scene,
                            const Camera& camera,
                            const RenderOptions& options,
                            const ProgressFunction& progress,
                            const std::atomic<bool>& stop) {
    const Stopwatch rendering;
    const Result<Supplies> supplies = make_supplies(scene.impl(), options);
    if (!supplies) return fail(supplies.error());
    RenderResult result;
    result.film = make_film(options);
    const Result<LayerPlans> plans = plan_layers(scene.impl(), options, result.film);
    if (!plans) return fail(plans.error());
    const FilmShare* const share = options.share;
    const LayerPlan& layers = plans->layers;
    const LightPathTable light_paths = plans->light ? plans->light->table() : LightPathTable{};

    const std::vector<float> filter = make_filter_table(options.filter);
    WavefrontInput wavefront_input = make_wavefront_input(scene.impl(), camera, options);
    wavefront_input.batch.filter = filter.empty() ? nullptr : filter.data();
    wavefront_input.notes = options.notes;
    if (!layers.empty()) wavefront_input.aovs = layers.aovs();
    wavefront_input.counts_rays = layers.counts_rays();
    if (plans->light) wavefront_input.light_paths = &light_paths;
    const std::optional<FrameView> frames = frame_view(scene.scene(), camera, options);
    wavefront_input.frames = frames ? &*frames : nullptr;
    use_supplies(*supplies, wavefront_input);
    const TileWork tile_work{wavefront_input, layers, stop};
    std::vector<std::unique_ptr<ThreadState>> states(max_thread_index());
    const FilmWork film_work{tile_work, options, progress, states, result.film};
    {
        const FilmLeaving leaving(share, result.film);
        if (auto done = render_film(film_work, result); !done) return fail(done.error());
    }
    result.is_stopped = stop.load() && share != nullptr && share->keeps_unfinished;
    if (stop.load() && !result.is_stopped) {
        return fail(ExitCode::stopped_early, "E-STOPPED", "render", "stopped on request");
    }
    result.counters = sum_counters(states);
    result.render_seconds = rendering.seconds();
    if (options.recording != nullptr) hand_over(states, *options.recording);
    return result;
}

}  // namespace obscura
