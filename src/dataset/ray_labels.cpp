// dataset/ray_labels.cpp - what every pixel's middle shows, and what lies hidden behind it.
// SPDX-License-Identifier: Apache-2.0
#include "dataset/ray_labels.h"

#include "accel/accel.h"
#include "base/parallel.h"
#include "camera/project.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <utility>

namespace obscura::dataset {

namespace {

/// The surface that a ray goes on behind, and how far behind it began, in units of rounding.
struct Passed {
    std::array<int32_t, 3> surface = {-1, -1, -1};  ///< instance, primitive, triangle
    float gap = 1;
};

/// Rays of one row of the frame, and their hits, with the padding that Accel asks for.
class RowRays {
public:
    explicit RowRays(size_t count) : pixel_(count), passed_(count) {
        for (auto& column : number_)
            column.resize((count + 15) / 16 * 16);
        for (auto& column : index_)
            column.resize((count + 15) / 16 * 16);
    }

    int count() const { return count_; }
    uint32_t pixel(int i) const { return pixel_[static_cast<size_t>(i)]; }
    Vec3f origin(int i) const { return vector(i, 0); }
    Vec3f direction(int i) const { return vector(i, 3); }
    float end(int i) const { return number(6, i); }
    float hit_distance(int i) const { return number(7, i); }
    int32_t hit_instance(int i) const { return index_[0][static_cast<size_t>(i)]; }
    int32_t hit_primitive(int i) const { return index_[1][static_cast<size_t>(i)]; }
    std::array<int32_t, 3> hit_surface(int i) const {
        const auto at = static_cast<size_t>(i);
        return {index_[0][at], index_[1][at], index_[2][at]};
    }
    const Passed& passed(int i) const { return passed_[static_cast<size_t>(i)]; }

    void clear() { count_ = 0; }
    /// May overwrite a ray that was read before: rays are only left out.
    void add(uint32_t pixel,
             const Vec3f& origin,
             const Vec3f& direction,
             float end,
             const Passed& passed) {
        const auto i = static_cast<size_t>(count_++);
        pixel_[i] = pixel;
        passed_[i] = passed;
        const std::array<float, 7> values = {
            origin.x, origin.y, origin.z, direction.x, direction.y, direction.z, end};
        for (size_t c = 0; c < values.size(); ++c)
            number_[c][i] = values[c];
    }

    void intersect(const Accel& accel) {
        const RayColumns rays{.ox = number_[0].data(),
                              .oy = number_[1].data(),
                              .oz = number_[2].data(),
                              .dx = number_[3].data(),
                              .dy = number_[4].data(),
                              .dz = number_[5].data(),
                              .tfar = number_[6].data(),
                              .key = nullptr,
                              .count = count_};
        const HitColumns hits{.t = number_[7].data(),
                              .u = number_[8].data(),
                              .v = number_[9].data(),
                              .instance = index_[0].data(),
                              .primitive = index_[1].data(),
                              .triangle = index_[2].data()};
        accel.intersect(
            rays,
            hits,
            Coherence::coherent,
            {.culls_back_faces = true, .fixed_alpha = true, .passes = camera_rays_pass});
    }

private:
    float number(size_t column, int i) const { return number_[column][static_cast<size_t>(i)]; }
    Vec3f vector(int i, size_t column) const {
        return {number(column, i), number(column + 1, i), number(column + 2, i)};
    }

    std::vector<uint32_t> pixel_;
    std::vector<Passed> passed_;
    std::array<std::vector<float>, 10> number_;
    std::array<std::vector<int32_t>, 3> index_;
    int count_ = 0;
};

/// Whether all of the scene is surely inside the image.
bool is_all_inside(const Scene& scene, const Camera& camera) {
    const bool keeps_lines =
        camera.model == CameraModel::orthographic ||
        ((camera.model == CameraModel::pinhole || camera.model == CameraModel::thin_lens) &&
         !is_distorted(camera));
    if (!keeps_lines || scene.bounds.empty()) return false;
    const std::array<Vec3f, 2> box = {scene.bounds.low, scene.bounds.high};
    for (unsigned corner = 0; corner < 8; ++corner) {
        const Vec3d place = {
            box[corner & 1U].x, box[(corner >> 1U) & 1U].y, box[(corner >> 2U) & 1U].z};
        const auto film = project(camera, place);
        if (!film || film->x < 0 || film->x > 1 || film->y < 0 || film->y > 1) return false;
    }
    return true;
}

PixelRect frame_of(const Scene& scene, const Camera& camera, const RenderOptions& options) {
    const bool has_all = camera.model == CameraModel::environment || is_all_inside(scene, camera);
    if (has_all) return {0, 0, options.width, options.height};
    return {-options.width, -options.height, 3 * options.width, 3 * options.height};
}

/// The node of a hit; -1: none, or one that the image does not show but what is behind it neither.
int32_t node_of(const Scene& scene, const RowRays& rays, int i) {
    const uint8_t flags = scene.visibility.of(rays.hit_primitive(i), rays.hit_instance(i));
    if ((flags & visibility_no_object) != 0) return -1;
    const int32_t node = scene.primitives[static_cast<size_t>(rays.hit_primitive(i))].node;
    if (rays.hit_instance(i) < 0) return node;
    return std::max(node, scene.instances[static_cast<size_t>(rays.hit_instance(i))].node);
}

int32_t material_of(const Scene& scene, const RowRays& rays, int i) {
    return scene.primitives[static_cast<size_t>(rays.hit_primitive(i))].material;
}

using NodePixel = std::pair<int32_t, uint32_t>;

/// Traces one row after the other.
class Tracer {
public:
    Tracer(const PreparedScene& prepared, const Camera& camera, int surfaces, RayLabels& out)
        : scene_(prepared.scene()),
          accel_(prepared.accel()),
          camera_(camera),
          surfaces_(surfaces),
          out_(out),
          camera_from_world_(inverse(camera.world_from_camera)) {}

    /// The surfaces that the row's rays cross, by node; the row's own pixels of the image.
    std::vector<NodePixel> trace(int row) const {
        RowRays rays(static_cast<size_t>(out_.frame.width));
        begin(row, rays);
        std::vector<NodePixel> found;
        for (int surface = 0; surface < surfaces_ && rays.count() > 0; ++surface) {
            rays.intersect(accel_);
            pass(surface == 0, rays, found);
        }
        std::sort(found.begin(), found.end());
        found.erase(std::unique(found.begin(), found.end()), found.end());
        return found;
    }

private:
    void begin(int row, RowRays& rays) const {
        const PixelRect& frame = out_.frame;
        const float y =
            (static_cast<float>(frame.y + row) + 0.5f) / static_cast<float>(out_.height);
        visit_model(camera_, false, [&](auto maker) {
            for (int column = 0; column < frame.width; ++column) {
                const float x =
                    (static_cast<float>(frame.x + column) + 0.5f) / static_cast<float>(out_.width);
                const FilmPoint<float> point{{x, y}, {x, y}, {0.5f, 0.5f}};
                const auto made = world_ray<decltype(maker)>(camera_, point);
                const float length = length_of(camera_, made);
                if (!(length > 0)) continue;
                const auto pixel = static_cast<uint32_t>(row * frame.width + column);
                rays.add(pixel, made.ray.origin, made.ray.direction, length, {});
            }
        });
    }

    float depth_of(const Vec3f& place) const {
        const Vec3f local = transform_point(camera_from_world_, place);
        return measures_from_eye(camera_.model) ? length(local) : -local.z;
    }

    /// Notes the hits, and lets the rays that have hit something go on behind it.
    void pass(bool is_first, RowRays& rays, std::vector<NodePixel>& found) const {
        constexpr float rounding = 2.4e-7f;  // of a hit's place
        const int count = rays.count();
        rays.clear();
        for (int i = 0; i < count; ++i) {
            if (rays.hit_primitive(i) < 0) continue;
            const uint32_t pixel = rays.pixel(i);
            const Vec3f origin = rays.origin(i);
            const Vec3f direction = rays.direction(i);
            const float t = rays.hit_distance(i);
            const int32_t node = node_of(scene_, rays, i);
            if (node >= 0) found.emplace_back(node, pixel);
            if (is_first && out_.is_inside(pixel)) {
                const size_t index = out_.image_index(pixel);
                out_.node[index] = node;
                if (node >= 0) {
                    out_.material[index] = material_of(scene_, rays, i);
                    out_.depth_m[index] = depth_of(origin + direction * t);
                }
            }
            // A ray that grazes a surface meets it again until it begins far enough behind it.
            Passed passed{rays.hit_surface(i)};
            if (passed.surface == rays.passed(i).surface) passed.gap = 4 * rays.passed(i).gap;
            const float step = t + passed.gap * rounding * (length(origin) + t);
            if (step < rays.end(i))
                rays.add(pixel, origin + direction * step, direction, rays.end(i) - step, passed);
        }
    }

    const Scene& scene_;
    const Accel& accel_;
    const Camera& camera_;
    int surfaces_;  ///< that are looked for along each ray
    RayLabels& out_;
    Affinef camera_from_world_;
};

/// Sorts the rows' pixels by node.
std::vector<Silhouette> join(const std::vector<std::vector<NodePixel>>& rows) {
    std::vector<Silhouette> out;
    std::vector<int32_t> place;  // by node: index in `out`, plus 1
    for (const std::vector<NodePixel>& row : rows) {
        for (const auto& [node, pixel] : row) {
            const auto number = static_cast<size_t>(node);
            if (place.size() <= number) place.resize(number + 1);
            if (place[number] == 0) {
                out.push_back({node, {}});
                place[number] = static_cast<int32_t>(out.size());
            }
            out[static_cast<size_t>(place[number]) - 1].pixels.push_back(pixel);
        }
    }
    std::sort(out.begin(), out.end(), [](const Silhouette& a, const Silhouette& b) {
        return a.node < b.node;
    });
    return out;
}

}  // namespace

bool RayLabels::is_inside(uint32_t pixel) const {
    const auto columns = static_cast<uint32_t>(frame.width);
    const int x = frame.x + static_cast<int>(pixel % columns);
    const int y = frame.y + static_cast<int>(pixel / columns);
    return x >= 0 && x < width && y >= 0 && y < height;
}

size_t RayLabels::image_index(uint32_t pixel) const {
    const auto columns = static_cast<uint32_t>(frame.width);
    const int x = frame.x + static_cast<int>(pixel % columns);
    const int y = frame.y + static_cast<int>(pixel / columns);
    return static_cast<size_t>(y) * static_cast<size_t>(width) + static_cast<size_t>(x);
}

RayLabels trace_labels(const PreparedScene& prepared,
                       const Camera& camera,
                       const RenderOptions& options,
                       Depth depth) {
    RayLabels out;
    out.width = options.width;
    out.height = options.height;
    const bool takes_all = depth == Depth::all;
    out.frame = takes_all ? frame_of(prepared.scene(), camera, options)
                          : PixelRect{0, 0, options.width, options.height};
    const size_t pixels = static_cast<size_t>(out.width) * static_cast<size_t>(out.height);
    out.node.assign(pixels, -1);
    out.material.assign(pixels, -1);
    out.depth_m.assign(pixels, 0.0f);
    std::vector<std::vector<NodePixel>> rows(static_cast<size_t>(out.frame.height));
    const Tracer tracer(prepared, camera, takes_all ? max_surfaces : 1, out);
    parallel_for(rows.size(), [&](size_t row) {
        const FlushDenormals flush;
        rows[row] = tracer.trace(static_cast<int>(row));
    });
    out.silhouettes = join(rows);
    return out;
}

}  // namespace obscura::dataset
