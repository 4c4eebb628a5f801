// app/bench_views.cpp - chooses the cameras that the bench measures with.
// SPDX-License-Identifier: Apache-2.0
#include "app/bench_views.h"

#include "math/warp.h"
#include "session/framing.h"

#include <algorithm>
#include <cmath>
#include <fmt/format.h>
#include <span>

namespace obscura::app {

namespace {

constexpr int coverage_height = 128;
/// Least height of a close view, as a fraction of the whole view's height.
constexpr double min_fraction = 1.0 / 256;
/// Coverage of a window in the whole view's image: a little more than needed, because turning the
/// camera shifts the view.
constexpr double wanted_in_image = close_coverage + 0.02;

/// Pixels of a small image that show the asset, with sums over all rectangles from the corner.
class CoverageMap {
public:
    CoverageMap(int width, int height, std::span<const float> rgba)
        : width_(width), height_(height) {
        sums_.assign(static_cast<size_t>(width + 1) * static_cast<size_t>(height + 1), 0);
        for (int y = 0; y < height; ++y) {
            for (int x = 0; x < width; ++x) {
                const size_t pixel =
                    static_cast<size_t>(y) * static_cast<size_t>(width) + static_cast<size_t>(x);
                const int covered = rgba[4 * pixel + 3] > 0 ? 1 : 0;
                at(x + 1, y + 1) = covered + at(x, y + 1) + at(x + 1, y) - at(x, y);
            }
        }
    }

    int width() const { return width_; }
    int height() const { return height_; }
    double fraction(int x, int y, int w, int h) const {
        const int covered = at(x + w, y + h) - at(x, y + h) - at(x + w, y) + at(x, y);
        return covered / static_cast<double>(w * h);
    }
    double fraction() const { return fraction(0, 0, width_, height_); }

private:
    int& at(int x, int y) { return sums_[index(x, y)]; }
    int at(int x, int y) const { return sums_[index(x, y)]; }
    size_t index(int x, int y) const {
        return static_cast<size_t>(y) * static_cast<size_t>(width_ + 1) + static_cast<size_t>(x);
    }
    int width_, height_;
    std::vector<int> sums_;
};

Result<CoverageMap> map_coverage(const PreparedScene& scene, const Camera& camera, double aspect) {
    RenderOptions options;
    options.height = coverage_height;
    options.width = std::clamp(static_cast<int>(std::lround(coverage_height * aspect)), 1, 4096);
    options.integrator = Integrator::albedo;
    options.background = BackgroundKind::transparent;
    const std::atomic<bool> never = false;
    const Result<RenderResult> result = render(scene, camera, options, {}, never);
    if (!result) return fail(result.error());
    return CoverageMap(options.width, options.height, result->film.pixels);
}

/// A window of an image: centre in [-1, 1] (x to the right, y up) and fraction of the height.
struct Window {
    double x = 0;
    double y = 0;
    double fraction = 1;
    double coverage = 0;
};

/// The best covered window of one size.
Window best_window(const CoverageMap& map, double fraction) {
    const int w = std::max(1, static_cast<int>(std::lround(map.width() * fraction)));
    const int h = std::max(1, static_cast<int>(std::lround(map.height() * fraction)));
    Window best;
    best.fraction = fraction;
    best.coverage = -1;
    for (int y = 0; y + h <= map.height(); ++y) {
        for (int x = 0; x + w <= map.width(); ++x) {
            const double coverage = map.fraction(x, y, w, h);
            if (coverage <= best.coverage) continue;
            best.coverage = coverage;
            best.x = (2.0 * x + w) / map.width() - 1;
            best.y = 1 - (2.0 * y + h) / map.height();
        }
    }
    return best;
}

/// Greatest height of a close view, as a fraction of the whole view's height.
double widest_fraction(const CoverageMap& map) {
    return map.fraction() >= wanted_in_image ? 0.5 : 1.0;
}

/// The largest window that is covered well enough, by bisection of its size.
Window find_window(const CoverageMap& map) {
    double large = widest_fraction(map);
    if (best_window(map, large).coverage >= wanted_in_image) return best_window(map, large);
    double small = 1.0 / map.height();
    for (int i = 0; i < 10; ++i) {
        const double middle = 0.5 * (small + large);
        (best_window(map, middle).coverage >= wanted_in_image ? small : large) = middle;
    }
    return best_window(map, small);
}

bench::ViewCamera numbers_of(const Camera& camera, double distance_m) {
    const auto& m = camera.world_from_camera.m;
    const auto column = [&](int c) { return Vec3d{m[0][c], m[1][c], m[2][c]}; };
    bench::ViewCamera out;
    out.eye_m = column(3);
    out.target_m = column(3) - column(2) * distance_m;
    out.up = column(1);
    out.yfov_deg =
        2 * std::atan(static_cast<double>(camera.pinhole.tan_half_yfov)) / radians_per_degree;
    return out;
}

/// Distance to the middle of the scene, as far as it lies in front.
double distance_to_centre(const PreparedScene& scene, const Camera& camera) {
    const BoundingSphere sphere = bounding_sphere(scene.scene().bounds);
    const bench::ViewCamera numbers = numbers_of(camera, 1);
    const double along = dot(sphere.centre_m - numbers.eye_m, numbers.target_m - numbers.eye_m);
    return along > 1e-3 * sphere.radius_m ? along : sphere.radius_m;
}

/// The camera turned to a window's centre and narrowed to a fraction of its height.
Result<Camera> turned(const Camera& whole, const Window& window, double fraction, int height_px) {
    const bench::ViewCamera numbers = numbers_of(whole, 1);
    const auto& m = whole.world_from_camera.m;
    const Vec3d right = {m[0][0], m[1][0], m[2][0]};
    const double half_height = static_cast<double>(whole.pinhole.tan_half_yfov);
    const double half_width = half_height * static_cast<double>(whole.pinhole.aspect);
    const Vec3d target =
        numbers.target_m + right * (window.x * half_width) + numbers.up * (window.y * half_height);
    const Result<Affined> placed = look_at({numbers.eye_m, target, numbers.up});
    if (!placed) return fail(placed.error());
    Camera camera = whole;
    camera.world_from_camera = affine_cast<float>(*placed);
    camera.pinhole.tan_half_yfov = static_cast<float>(half_height * fraction);
    camera.pinhole.pixel_spread = static_cast<float>(2 * half_height * fraction / height_px);
    return camera;
}

BenchView describe(const PreparedScene& scene, const Camera& camera, const std::string& name) {
    BenchView view;
    view.name = name;
    view.camera = camera;
    view.numbers = numbers_of(camera, distance_to_centre(scene, camera));
    return view;
}

/// The view for a fraction of the whole one's height, with its coverage.
Result<BenchView> close_view(const PreparedScene& scene,
                             const Camera& whole,
                             const Window& window,
                             double fraction,
                             int height_px) {
    const Result<Camera> camera = turned(whole, window, fraction, height_px);
    if (!camera) return fail(camera.error());
    const auto aspect = static_cast<double>(whole.pinhole.aspect);
    const Result<double> coverage = measure_coverage(scene, *camera, aspect);
    if (!coverage) return fail(coverage.error());
    BenchView view = describe(scene, *camera, "close");
    view.coverage = *coverage;
    view.description = fmt::format("{:.1f} % of the whole view's height", 100 * fraction);
    return view;
}

/// Looks at the centre of the best covered window and finds by bisection the widest angle at which
/// the asset covers enough of the frame. Turning the camera shifts the view, so the window is only
/// where the search begins. Without any such angle: the best covered view.
Result<BenchView> find_close_view(const PreparedScene& scene,
                                  const Camera& whole,
                                  const CoverageMap& map,
                                  int height_px) {
    const Window window = find_window(map);
    double too_wide = std::min(widest_fraction(map), 1.5 * window.fraction);
    double enough = 0;
    BenchView best;
    best.coverage = -1;
    for (double fraction = window.fraction;; fraction = 0.5 * (enough + too_wide)) {
        Result<BenchView> view = close_view(scene, whole, window, fraction, height_px);
        if (!view) return view;
        const bool covered = view->coverage >= close_coverage;
        (covered ? enough : too_wide) = fraction;
        if (covered || (enough == 0 && view->coverage > best.coverage)) best = std::move(*view);
        const bool narrow = enough == 0 && fraction < min_fraction;
        if (narrow || too_wide <= 1.02 * enough) return best;
    }
}

}  // namespace

Result<double> measure_coverage(const PreparedScene& scene, const Camera& camera, double aspect) {
    const Result<CoverageMap> map = map_coverage(scene, camera, aspect);
    if (!map) return fail(map.error());
    return map->fraction();
}

Result<std::vector<BenchView>> choose_bench_views(const PreparedScene& scene,
                                                  const RenderRequest& request,
                                                  ViewChoice choice,
                                                  Log& log) {
    const RenderOptions& options = request.options;
    CameraRequest asked = request.camera;
    asked.model = CameraModel::pinhole;
    const Result<ChosenCamera> chosen =
        choose_camera(scene.scene(), asked, options.width, options.height, log);
    if (!chosen) return fail(chosen.error());
    const double aspect = static_cast<double>(options.width) / options.height;
    const Result<CoverageMap> map = map_coverage(scene, chosen->camera, aspect);
    if (!map) return fail(map.error());
    const bool own = asked.eye_m || asked.target_m || asked.up;
    std::vector<BenchView> views;
    if (own || choice != ViewChoice::close) {
        views.push_back(describe(scene, chosen->camera, own ? "own" : "whole"));
        views.back().description = chosen->description;
        views.back().coverage = map->fraction();
    }
    if (!own && choice != ViewChoice::whole) {
        Result<BenchView> close = find_close_view(scene, chosen->camera, *map, options.height);
        if (!close) return fail(close.error());
        if (close->coverage < close_coverage) {
            log.warn(scene.scene().info.file_name,
                     fmt::format("no close view covers {:.0f} % of the frame; this one covers "
                                 "{:.1f} %",
                                 100 * close_coverage,
                                 100 * close->coverage));
        }
        views.push_back(std::move(*close));
    }
    return views;
}

}  // namespace obscura::app
