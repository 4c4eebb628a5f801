// render/render.h - from a scene, a camera and options to a film; what every command calls.
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "accel/ray_recording.h"
#include "base/error.h"
#include "base/log.h"
#include "base/unset_array.h"
#include "camera/camera.h"
#include "film/film.h"
#include "film/film_state.h"
#include "film/light_groups.h"
#include "image/pixels.h"
#include "scene/scene.h"
#include "stages/dispatch.h"
#include "stages/stage_seconds.h"

#include <atomic>
#include <cstdint>
#include <functional>
#include <memory>
#include <optional>
#include <string>
#include <vector>

namespace obscura {

class EnvironmentCache;
class FilmSums;
struct PassFilm;
struct RaycastNotes;

/// To add one: append it here, in include/obscura/view.h, and in render/integrators.h with a name,
/// a kind, channels and, for AOVs, those of stages/aov.h that fill them; for PNG and JPEG, a
/// mapping to colours in session/preview.cpp. Light transport needs a kind in stages/wavefront.h,
/// with cases in stages/wavefront.cpp and render/integrators.cpp. Then docs/cli.md, the help in
/// app/render_options.cpp, and tests/render/integrators_test.cpp.
enum class Integrator {
    path,
    direct,
    raycast,
    ao,
    normal,
    facing,
    depth,
    distance,
    uv,
    albedo,
    id,
    wireframe,
    heat
};

enum class PixelFilter { box, gaussian, blackman_harris };

enum class BackgroundKind { environment, transparent, color };

/// Whether clear glass shows shadow catchers and the background, in alpha: where there are
/// catchers, always, never.
enum class TransparentGlass { automatic, on, off };

struct PixelRect {
    int x = 0, y = 0, width = 0, height = 0;
};

struct LightingOptions {
    /// Null: the scene's own, else the studio. Scenes and cache tell one from another by it.
    std::shared_ptr<const ImageRgb32f> environment;
    std::string environment_name = {};    ///< for messages
    double environment_intensity = 1;     ///< of any environment
    double environment_rotation_deg = 0;  ///< about +Y, counter-clockwise seen from above
    bool catcher_ground = false;          ///< RenderOptions::catcher_ground_m will be set
    /// Has the tables of environments that several scenes have in common; null: each has its own.
    std::shared_ptr<EnvironmentCache> environments = {};
};

/// Adaptive sampling: samples are taken where they lower the noise of the picture. See
/// render/adaptive_sums.h.
struct AdaptiveOptions {
    double noise_target = 0.01;  ///< relative error of the picture; see film/noise.h
    int min_samples = 16;        ///< of every pixel, from 2 to samples_per_pixel
    double white = 1;            ///< radiance that is displayed as white
};

/// RenderOptions::samples_per_pixel with adaptive sampling where nobody says how many.
inline constexpr int default_max_samples = 4096;

/// Which pixels of a film are rendered, where the others come from, and who else reads them.
struct FilmShare {
    std::optional<FilmPart> part;  ///< none: no row is rendered
    /// Called before rendering; returns areas whose pixels it has filled: they are not rendered.
    std::function<Result<std::vector<FilmArea>>(Film&)> fill = {};
    /// In its place where samples are taken: then they are taken in passes over the film, which
    /// others may look at between them; see render/film_sums.h. A part of samples needs it.
    std::function<Result<void>(const PassFilm&)> begin_passes = {};
    /// With passes: somebody may look at the film soon, so that the first of them are short.
    bool shows_early = false;
    /// Asked when passes have ended: false, and the film stays unset, as nobody looks at it. An
    /// empty one: true.
    std::function<bool()> wants_film = {};
    /// Called once after rendering, however it ended, before the film goes elsewhere.
    std::function<void(const Film&)> leave = {};
    /// When rendering is stopped, the film so far is a result, too; see RenderResult::is_stopped.
    bool keeps_unfinished = false;
};

struct RenderOptions {
    int width = 1280;
    int height = 720;
    int samples_per_pixel = 64;
    /// For path, direct and ao: samples_per_pixel is the most; none: every pixel takes so many.
    std::optional<AdaptiveOptions> adaptive;
    int max_bounces = 8;
    uint64_t seed = 0;
    int tile_size = 16;  ///< pixels; any value gives the same image; at least 32 for AOVs
    std::optional<PixelRect> crop;  ///< renders this part; it may reach beyond the image (overscan)
    Integrator integrator = Integrator::path;
    PixelFilter filter = PixelFilter::box;
    BackgroundKind background = BackgroundKind::environment;
    float background_color[3] = {0, 0, 0};
    /// world_from_camera at evenly spaced times while the shutter is open, the first one as in
    /// Camera; empty: it stands still.
    std::vector<Affined> moving_camera;
    /// For the layer `motion`: the camera one frame before the image's time, at it, and one frame
    /// after it; empty: it stands still.
    std::vector<Camera> frame_cameras;
    std::vector<Layer> layers;       ///< beside the beauty; see layers_of, light_group_layers
    LightGroupOptions light_groups;  ///< with `each`, render() adds their layers
    /// For the integrators path and direct: the height of a plane that is a shadow catcher, beside
    /// the surfaces with visibility_catcher; none: there is no such plane.
    std::optional<float> catcher_ground_m;
    bool catcher_reflections = false;  ///< shadow catchers reflect other surfaces
    TransparentGlass transparent_glass = TransparentGlass::automatic;
    double clear_roughness = 0.1;  ///< of glass that counts as clear, at most
    double ao_distance_m = 0;      ///< 0: a fifth of the scene's diagonal
    double wire_width_px = 1;
    /// The most that a contribution to a sample may have in any channel, where light comes straight
    /// to the first surface and where it comes by way of others; 0: anything. They darken the
    /// image.
    double clamp_direct = 0, clamp_indirect = 0;
    bool caustics = true;     ///< false: no light by way of smooth surfaces to rough ones
    bool regularize = false;  ///< smooth surfaces are rougher to light that goes on to rough ones
    /// For tests of the estimator: which strategies sample light. 3 is both, with MIS.
    int strategies = 3;  ///< bit 0 light sampling, bit 1 BSDF sampling
    /// Null: all rows are rendered. Not with adaptive sampling, which looks at all of the film.
    const FilmShare* share = nullptr;
    /// Memory of an earlier film, to reuse; null or empty: new memory.
    UnsetArray<float>* film_memory = nullptr;
    /// Filled with every traced ray, about 32 bytes each; null: no recording.
    RayRecording* recording = nullptr;
    /// Filled with the contribution of every light to the one pixel of `crop`, if the integrator is
    /// raycast; null: no notes.
    RaycastNotes* notes = nullptr;
};

/// Rays and faults, summed over all threads.
struct RenderCounters {
    uint64_t paths = 0;
    uint64_t camera_rays = 0;
    uint64_t bounce_rays = 0;
    uint64_t shadow_rays = 0;
    uint64_t refused_rays = 0;       ///< not finite: never handed to Embree
    uint64_t nonfinite_samples = 0;  ///< written as zero
    StageSeconds stages;
};

/// What adaptive sampling did.
struct SamplesTaken {
    int passes = 0;
    uint64_t total = 0;
    uint64_t pixels = 0;
    int least = 0, most = 0;  ///< of a pixel
    /// Relative error of the picture, by its own estimate; none: it ended before there was one.
    std::optional<double> noise;

    double mean() const { return static_cast<double>(total) / static_cast<double>(pixels); }
};

struct RenderResult {
    Film film;
    RenderCounters counters;
    std::optional<SamplesTaken> adaptive = {};  ///< with RenderOptions::adaptive
    double render_seconds = 0;
    bool is_stopped = false;  ///< with FilmShare::keeps_unfinished: pixels are missing
};

/// How long preparing a scene took.
struct BuildSeconds {
    double all = 0;
    double bvh = 0;
};

/// A scene with its BVH, light tables and environment: rendered any number of times.
class PreparedScene {
public:
    /// Builds the BVH on all threads. A scene without any light and environment gets a neutral
    /// studio, and says so in the log.
    ///
    /// Errors  33 E-MEM out of memory; 69 E-ISA the CPU lacks `isa`; 70 E-EMBREE
    static Result<PreparedScene> create(Scene scene,
                                        const LightingOptions& lighting,
                                        Isa isa,
                                        Log& log);
    /// Prepares another pose of the same asset, after take_scene: unchanged parts are not rebuilt.
    ///
    /// In      lighting: as for create
    /// Errors  as create; afterwards this object cannot render any more
    Result<void> update(Scene scene, const LightingOptions& lighting, Log& log);

    PreparedScene(PreparedScene&&) noexcept;
    PreparedScene& operator=(PreparedScene&&) noexcept;
    ~PreparedScene();

    const Scene& scene() const;
    BuildSeconds build_seconds() const;
    const Accel& accel() const;
    size_t bvh_bytes() const;
    std::string isa_name() const;  ///< "avx512"
    std::string embree_version() const;

    /// Returns the scene so that the next pose can reuse its arrays. No rendering until update().
    Scene take_scene();

    struct Impl;
    const Impl& impl() const { return *impl_; }

private:
    explicit PreparedScene(std::unique_ptr<Impl> impl);
    std::unique_ptr<Impl> impl_;
};

/// 69 E-ISA: PreparedScene::create's error for an instruction set that the CPU lacks.
Error missing_isa();

/// A finished part of the image.
struct FinishedTile {
    double done;                   ///< fraction of the image that is finished, in [0, 1]
    PixelRect area;                ///< from the image's top left corner
    const Film* film;              ///< other threads may be writing its pixels outside `area`
    RenderCounters counters = {};  ///< of this tile; 0 with RenderOptions::adaptive
    /// Where the film has its pixels only at the end: they are in the sums so far, whose tile this
    /// is, see FilmSums::beauty_of; null: in the film. Not where FilmSums keeps blocks.
    const FilmSums* sums = nullptr;
    size_t index = 0;
};

/// Called from any thread after every tile; with RenderOptions::adaptive in each pass, and at last
/// with all of the image done.
using ProgressFunction = std::function<void(const FinishedTile&)>;

/// Renders one image on all threads. The same arguments give the same bits for any number of
/// threads, any tile size and any crop; with RenderOptions::adaptive a crop is an image of its own.
///
/// In      stop: when it becomes true, tiles end after their current batch
/// Errors  75 E-STOPPED when `stop` was set; 33 E-MEM; 70 E-EMBREE (heat builds a hierarchy);
///         those of FilmShare::fill and FilmShare::begin_passes
Result<RenderResult> render(const PreparedScene& scene,
                            const Camera& camera,
                            const RenderOptions& options,
                            const ProgressFunction& progress,
                            const std::atomic<bool>& stop);

}  // namespace obscura
