// crosscheck/embree_viewer.cpp - runs Embree's own viewer without a window and compares images.
// SPDX-License-Identifier: Apache-2.0
#include "crosscheck/embree_viewer.h"

#include "crosscheck/kernel_plan.h"

#include <algorithm>
#include <cmath>
#include <cstdlib>
#include <fcntl.h>
#include <fstream>
#include <iterator>
#include <spawn.h>
#include <sstream>
#include <sys/wait.h>
#include <unistd.h>

namespace obscura::crosscheck {

namespace {

namespace fs = std::filesystem;

/// Steps of 255 by which a shaded colour may be off: the viewer's and our cosines round.
constexpr int color_slack = 2;
/// The viewer computes its rays with other operations than we do: theirs are so many ulp off ours.
constexpr double ray_ulps = 8;

/// Runs a program with its output thrown away; true when it ended with 0.
bool run_quietly(const std::vector<std::string>& words) {
    std::vector<char*> arguments;
    for (const std::string& word : words)
        arguments.push_back(const_cast<char*>(word.c_str()));
    arguments.push_back(nullptr);
    posix_spawn_file_actions_t actions;
    posix_spawn_file_actions_init(&actions);
    posix_spawn_file_actions_addopen(&actions, STDOUT_FILENO, "/dev/null", O_WRONLY, 0);
    posix_spawn_file_actions_addopen(&actions, STDERR_FILENO, "/dev/null", O_WRONLY, 0);
    pid_t child = 0;
    const int failed =
        posix_spawn(&child, words[0].c_str(), &actions, nullptr, arguments.data(), environ);
    posix_spawn_file_actions_destroy(&actions);
    if (failed != 0) return false;
    int status = 0;
    return waitpid(child, &status, 0) == child && WIFEXITED(status) && WEXITSTATUS(status) == 0;
}

using Color = std::array<int, 3>;

/// One of the viewer's images at the centres of our pixels, rows from the top; empty: unreadable.
std::vector<Color> read_centres(const fs::path& file, std::array<int, 2> size_px) {
    std::ifstream in(file, std::ios::binary);
    std::string magic;
    int width = 0;
    int height = 0;
    int most = 0;
    in >> magic >> width >> height >> most;
    in.get();
    const std::string bytes{std::istreambuf_iterator<char>(in), {}};
    const size_t pixels = static_cast<size_t>(width) * static_cast<size_t>(height);
    const bool as_asked = width == 2 * size_px[0] && height == 2 * size_px[1];
    if (magic != "P6" || most != 255 || !as_asked || bytes.size() < 3 * pixels) return {};
    std::vector<Color> out;
    for (int y = 0; y < size_px[1]; ++y) {
        for (int x = 0; x < size_px[0]; ++x) {
            // A pixel's ray goes through its corner: that of (2x + 1, 2y + 1) is our centre.
            const auto row = 2 * static_cast<size_t>(y) + 1;
            const size_t at =
                3 * (row * static_cast<size_t>(width) + 2 * static_cast<size_t>(x) + 1);
            const auto channel = [&](size_t c) {
                return static_cast<int>(static_cast<unsigned char>(bytes[at + c]));
            };
            out.push_back({channel(0), channel(1), channel(2)});
        }
    }
    return out;
}

bool is_near(const Color& a, const Color& b, int slack) {
    return std::abs(a[0] - b[0]) <= slack && std::abs(a[1] - b[1]) <= slack &&
           std::abs(a[2] - b[2]) <= slack;
}

Color scaled(const Color& color, double factor) {
    Color out{};
    for (size_t c = 0; c < 3; ++c)
        out[c] = static_cast<int>(std::lround(color[c] * factor));
    return out;
}

/// The viewer's images.
struct Images {
    std::vector<Color> occlusion, geometry, primitive, normal;
};

/// What differs at one pixel.
struct PixelDifference {
    bool occlusion = false, geometry = false, primitive = false, normal = false;
    bool any() const { return occlusion || geometry || primitive || normal; }
};

PixelDifference compare_pixel(const TrueScene& truth,
                              const TrueRay& ray,
                              const Answer& own,
                              const Images& images,
                              size_t pixel) {
    PixelDifference out;
    const Color black{0, 0, 0};
    out.occlusion = (images.occlusion[pixel] != black) != own.found();
    if (!own.found()) {
        out.geometry = images.geometry[pixel] != black;
        out.primitive = images.primitive[pixel] != black;
        return out;
    }
    const auto geometry = static_cast<unsigned>(own.item.primitive);
    const auto primitive = static_cast<unsigned>(own.item.element);
    out.geometry = images.geometry[pixel] != viewer_color(geometry);
    const Vec3d normal = truth.normal(own.item, {});
    const double cosine = std::abs(dot(normal, normalize(ray.direction)));
    // The colour combines both numbers and darkens with the angle of view.
    out.primitive = !is_near(
        images.primitive[pixel], scaled(viewer_color(geometry ^ primitive), cosine), color_slack);
    const Color facing{static_cast<int>(std::lround(255 * std::abs(normal.x))),
                       static_cast<int>(std::lround(255 * std::abs(normal.y))),
                       static_cast<int>(std::lround(255 * std::abs(normal.z)))};
    out.normal = !is_near(images.normal[pixel], facing, color_slack);
    return out;
}

/// True when the ray meets several items at its hit: either answer is right.
bool is_shared_place(const TrueScene& truth, const TrueRay& ray, const Answer& own) {
    if (!own.found()) return false;
    const double room = ray_ulps * truth.rounding_m(ray, own.item, own.t) / length(ray.direction);
    const double cosine =
        std::abs(dot(truth.normal(own.item, {}), ray.direction)) / length(ray.direction);
    bool shared = false;
    truth.all_hits(ray, [&](double t, const Item& item) {
        shared = shared || (item != own.item && std::abs(t - own.t) * cosine <= room);
    });
    return shared;
}

/// True when a ray a few ulp beside this one hits something else.
bool is_tie(const TrueScene& truth, const TrueRay& ray, const Answer& own) {
    constexpr int turns = 16;
    const double reach = own.found() ? own.t : length(truth.bounds().high - ray.origin);
    const double unit = truth.rounding_m(ray, own.item, reach);
    const Frame<double> frame = frame_around(normalize(ray.direction));
    bool other = false;
    for (int i = 0; i < turns; ++i) {
        const double angle = 2 * pi_d * i / turns;
        const Vec3d side = frame.tangent * std::cos(angle) + frame.bitangent * std::sin(angle);
        const TrueRay turned{ray.origin, ray.direction + side * (ray_ulps * unit / reach)};
        other = other || !(truth.nearest(turned).item == own.item);
    }
    return other;
}

/// Renders all four images; false when the viewer fails.
bool draw(const fs::path& viewer, const ViewerTask& task, Images& out) {
    const auto image = [&](const char* shader) {
        const fs::path file = task.mesh.parent_path() / (std::string(shader) + ".ppm");
        std::vector<std::string> words = {viewer.string(), "-i", task.mesh.string()};
        words.insert(words.end(), task.camera_options.begin(), task.camera_options.end());
        words.insert(words.end(),
                     {"--size",
                      std::to_string(2 * task.size_px[0]),
                      std::to_string(2 * task.size_px[1]),
                      "--shader",
                      shader,
                      "-o",
                      file.string()});
        if (!run_quietly(words)) return std::vector<Color>{};
        return read_centres(file, task.size_px);
    };
    out = {image("occlusion"), image("geomID"), image("primID"), image("Ng")};
    return !out.occlusion.empty() && !out.geometry.empty() && !out.primitive.empty() &&
           !out.normal.empty();
}

}  // namespace

std::optional<fs::path> find_embree_viewer() {
    const char* path = std::getenv("PATH");
    std::istringstream folders(path != nullptr ? path : "");
    for (std::string folder; std::getline(folders, folder, ':');) {
        const fs::path viewer = fs::path(folder) / "viewer";
        const fs::path tutorial = fs::path(folder) / "triangle_geometry";
        if (access(viewer.c_str(), X_OK) == 0 && access(tutorial.c_str(), X_OK) == 0) return viewer;
    }
    return {};
}

Result<ViewerReport> compare_with_viewer(const ViewerTask& task) {
    const std::optional<fs::path> viewer = find_embree_viewer();
    if (!viewer) return ViewerReport{"Embree's viewer is not installed (package embree-tools)"};
    Images images;
    if (!draw(*viewer, task, images)) return ViewerReport{"Embree's viewer made no pictures"};
    KernelChoice choice;
    choice.robust = false;  // as the viewer builds its scenes
    auto built = ReferenceKernels::build(task.flat, choice);
    if (!built) return fail(built.error());
    const Kernel kernel =
        make_kernel(std::make_shared<const ReferenceKernels>(std::move(*built)), {"", 1, false});
    const TrueScene truth(task.flat);
    RayBlock rays;
    for (int y = 0; y < task.size_px[1]; ++y) {
        for (int x = 0; x < task.size_px[0]; ++x) {
            const Vec2f film{(static_cast<float>(x) + 0.5f) / static_cast<float>(task.size_px[0]),
                             (static_cast<float>(y) + 0.5f) / static_cast<float>(task.size_px[1])};
            const CameraRay<float> ray = generate_ray(task.camera, film);
            rays.add({ray.origin.x, ray.origin.y, ray.origin.z},
                     {ray.direction.x, ray.direction.y, ray.direction.z});
        }
    }
    std::vector<Answer> answers;
    kernel.ask(rays, answers);
    ViewerReport report{"compared"};
    report.pixels = answers.size();
    for (size_t i = 0; i < answers.size(); ++i) {
        const TrueRay ray = rays.true_ray(static_cast<int>(i));
        const PixelDifference found = compare_pixel(truth, ray, answers[i], images, i);
        if (!found.any()) continue;
        if (is_shared_place(truth, ray, answers[i]) || is_tie(truth, ray, answers[i])) {
            ++report.ties;
            continue;
        }
        report.occlusion += found.occlusion ? 1 : 0;
        report.geometry += found.geometry ? 1 : 0;
        report.primitive += found.primitive ? 1 : 0;
        report.normal += found.normal ? 1 : 0;
    }
    return report;
}

}  // namespace obscura::crosscheck
