// app/bench_views.cpp - the cameras that the bench measures with.
// SPDX-License-Identifier: Apache-2.0
#include "app/bench_views.h"

#include "session/framing.h"
#include <algorithm>
#include <cmath>
#include <fmt/format.h>
#include <span>

namespace obscura {

namespace {

constexpr double degree = pi_d / 180;
constexpr int coverage_height = 128;
/// A close view shows at least this share of the whole one's height.
constexpr double least_share = 1.0 / 256;
/// Where a close view is looked for in the whole one's picture: a little more than is needed, for
/// turning the camera shifts what it sees.
constexpr double wanted_in_picture = close_coverage + 0.02;

/// Which pixels of a small picture show the asset, with sums over all rectangles from the corner.
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
    double share(int x, int y, int w, int h) const {
        const int covered = at(x + w, y + h) - at(x, y + h) - at(x + w, y) + at(x, y);
        return covered / static_cast<double>(w * h);
    }
    double share() const { return share(0, 0, width_, height_); }

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

/// Part of a picture: its middle in [-1, 1] (x to the right, y up) and its share of the height.
struct Window {
    double x = 0;
    double y = 0;
    double share = 1;
    double coverage = 0;
};

/// The best covered window of one size.
Window best_window(const CoverageMap& map, double share) {
    const int w = std::max(1, static_cast<int>(std::lround(map.width() * share)));
    const int h = std::max(1, static_cast<int>(std::lround(map.height() * share)));
    Window best;
    best.share = share;
    best.coverage = -1;
    for (int y = 0; y + h <= map.height(); ++y) {
        for (int x = 0; x + w <= map.width(); ++x) {
            const double coverage = map.share(x, y, w, h);
            if (coverage <= best.coverage) continue;
            best.coverage = coverage;
            best.x = (2.0 * x + w) / map.width() - 1;
            best.y = 1 - (2.0 * y + h) / map.height();
        }
    }
    return best;
}

/// Part of the whole view's height that a close one may have at most.
double widest_share(const CoverageMap& map) {
    return map.share() >= wanted_in_picture ? 0.5 : 1.0;
}

/// The largest window that is covered well enough, by bisection of its size.
Window find_window(const CoverageMap& map) {
    double large = widest_share(map);
    if (best_window(map, large).coverage >= wanted_in_picture) return best_window(map, large);
    double small = 1.0 / map.height();
    for (int i = 0; i < 10; ++i) {
        const double middle = 0.5 * (small + large);
        (best_window(map, middle).coverage >= wanted_in_picture ? small : large) = middle;
    }
    return best_window(map, small);
}

ViewCamera numbers_of(const Camera& camera, double distance_m) {
    const auto& m = camera.world_from_camera.m;
    const auto column = [&](int c) { return Vec3d{m[0][c], m[1][c], m[2][c]}; };
    ViewCamera out;
    out.eye_m = column(3);
    out.target_m = column(3) - column(2) * distance_m;
    out.up = column(1);
    out.yfov_deg = 2 * std::atan(static_cast<double>(camera.pinhole.tan_half_yfov)) / degree;
    return out;
}

/// Distance to the middle of the scene, as far as it lies in front.
double distance_to_middle(const PreparedScene& scene, const Camera& camera) {
    const BoundingSphere sphere = bounding_sphere(scene.scene().bounds);
    const ViewCamera numbers = numbers_of(camera, 1);
    const double along = dot(sphere.centre_m - numbers.eye_m, numbers.target_m - numbers.eye_m);
    return along > 1e-3 * sphere.radius_m ? along : sphere.radius_m;
}

/// The camera turned to the middle of a window and narrowed to a share of its height.
Result<Camera> turned(const Camera& whole, const Window& window, double share, int height_px) {
    const ViewCamera numbers = numbers_of(whole, 1);
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
    camera.pinhole.tan_half_yfov = static_cast<float>(half_height * share);
    camera.pinhole.pixel_spread = static_cast<float>(2 * half_height * share / height_px);
    return camera;
}

BenchView describe(const PreparedScene& scene, const Camera& camera, const std::string& name) {
    BenchView view;
    view.name = name;
    view.camera = camera;
    view.numbers = numbers_of(camera, distance_to_middle(scene, camera));
    return view;
}

/// The view of one share of the whole one's height, with its coverage.
Result<BenchView> close_view(const PreparedScene& scene,
                             const Camera& whole,
                             const Window& window,
                             double share,
                             int height_px) {
    const Result<Camera> camera = turned(whole, window, share, height_px);
    if (!camera) return fail(camera.error());
    const auto aspect = static_cast<double>(whole.pinhole.aspect);
    const Result<double> coverage = measure_coverage(scene, *camera, aspect);
    if (!coverage) return fail(coverage.error());
    BenchView view = describe(scene, *camera, "close");
    view.coverage = *coverage;
    view.description = fmt::format("{:.1f} % of the whole view's height", 100 * share);
    return view;
}

/// Looks at the middle of the best covered part and finds the widest angle at which the asset
/// covers enough of the frame, by bisection: turning the camera shifts what it sees, so that the
/// part of the whole picture is only where the search begins. Without any such angle: the view
/// that was covered best.
Result<BenchView> find_close_view(const PreparedScene& scene,
                                  const Camera& whole,
                                  const CoverageMap& map,
                                  int height_px) {
    const Window window = find_window(map);
    double too_wide = std::min(widest_share(map), 1.5 * window.share);
    double enough = 0;
    BenchView best;
    best.coverage = -1;
    for (double share = window.share;; share = 0.5 * (enough + too_wide)) {
        Result<BenchView> view = close_view(scene, whole, window, share, height_px);
        if (!view) return view;
        const bool covered = view->coverage >= close_coverage;
        (covered ? enough : too_wide) = share;
        if (covered || (enough == 0 && view->coverage > best.coverage)) best = std::move(*view);
        const bool narrow = enough == 0 && share < least_share;
        if (narrow || too_wide <= 1.02 * enough) return best;
    }
}

}  // namespace

Result<double> measure_coverage(const PreparedScene& scene, const Camera& camera, double aspect) {
    const Result<CoverageMap> map = map_coverage(scene, camera, aspect);
    if (!map) return fail(map.error());
    return map->share();
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
        views.back().coverage = map->share();
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

}  // namespace obscura
