// dataset/ray_labels.cpp - what every pixel's middle shows, and what lies hidden behind it.
// SPDX-License-Identifier: Apache-2.0
#include "dataset/ray_labels.h"

#include "accel/accel.h"
#include "base/parallel.h"
#include "camera/project.h"

#include <algorithm>
#include <array>
#include <utility>

namespace obscura::dataset {

namespace {

/// Rays of a part of the frame, and their hits, with the padding that Accel asks for.
class PartRays {
public:
    explicit PartRays(size_t count) : pixel_(count) {
        for (auto& column : number_)
            column.resize((count + 15) / 16 * 16);
        for (auto& column : index_)
            column.resize((count + 15) / 16 * 16);
    }

    int count() const { return count_; }
    uint32_t pixel(int i) const { return pixel_[static_cast<size_t>(i)]; }
    Vec3f origin(int i) const { return {number(0, i), number(1, i), number(2, i)}; }
    Vec3f direction(int i) const { return {number(3, i), number(4, i), number(5, i)}; }
    float hit_distance(int i) const { return number(7, i); }
    SceneRecords hit_surface(int i) const {
        return {index_[0][static_cast<size_t>(i)], index_[1][static_cast<size_t>(i)]};
    }

    void add(uint32_t pixel, const Vec3f& origin, const Vec3f& direction, float end) {
        const auto i = static_cast<size_t>(count_++);
        pixel_[i] = pixel;
        const std::array<float, 7> values = {
            origin.x, origin.y, origin.z, direction.x, direction.y, direction.z, end};
        for (size_t c = 0; c < values.size(); ++c)
            number_[c][i] = values[c];
    }

    void intersect(const Accel& accel) {
        const HitColumns hits{.t = number_[7].data(),
                              .u = number_[8].data(),
                              .v = number_[9].data(),
                              .instance = index_[0].data(),
                              .primitive = index_[1].data(),
                              .triangle = index_[2].data()};
        accel.intersect(columns(), hits, Coherence::coherent, as_seen);
    }

    /// Leaves out the rays that have hit nothing.
    void drop_misses() {
        const int count = count_;
        count_ = 0;
        for (int i = 0; i < count; ++i) {
            if (hit_surface(i).primitive >= 0) add(pixel(i), origin(i), direction(i), number(6, i));
        }
    }

    std::vector<MetSurface> list_surfaces(const Accel& accel) const {
        std::vector<MetSurface> out;
        accel.list_surfaces(columns(), Coherence::coherent, as_seen, out);
        return out;
    }

private:
    static constexpr SeeThrough as_seen{
        .culls_back_faces = true, .fixed_alpha = true, .passes = camera_rays_pass};

    RayColumns columns() const {
        return {.ox = number_[0].data(),
                .oy = number_[1].data(),
                .oz = number_[2].data(),
                .dx = number_[3].data(),
                .dy = number_[4].data(),
                .dz = number_[5].data(),
                .tfar = number_[6].data(),
                .key = nullptr,
                .count = count_};
    }
    float number(size_t column, int i) const { return number_[column][static_cast<size_t>(i)]; }

    std::vector<uint32_t> pixel_;
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

/// The node of a surface; -1: it is no object.
int32_t node_of(const Scene& scene, const SceneRecords& surface) {
    const uint8_t flags = scene.visibility.of(surface.primitive, surface.instance);
    if ((flags & visibility_no_object) != 0) return -1;
    const int32_t node = scene.primitives[static_cast<size_t>(surface.primitive)].node;
    if (surface.instance < 0) return node;
    return std::max(node, scene.instances[static_cast<size_t>(surface.instance)].node);
}

using NodePixel = std::pair<int32_t, uint32_t>;

/// Rows that are traced together, in squares of 16 rays, so that the rays of a packet of Embree's
/// stay close together in small images, too.
constexpr int band_rows = 4;
constexpr int packet_columns = 4;

/// Traces one band of rows after the other.
class Tracer {
public:
    Tracer(const PreparedScene& prepared, const Camera& camera, Depth depth, RayLabels& out)
        : scene_(prepared.scene()),
          accel_(prepared.accel()),
          camera_(camera),
          depth_(depth),
          out_(out),
          camera_from_world_(inverse(camera.world_from_camera)) {}

    /// The surfaces that the band's rays cross, by node; the band's own pixels of the image.
    std::vector<NodePixel> trace(int band) const {
        PartRays rays(static_cast<size_t>(out_.frame.width) * band_rows);
        begin(band, rays);
        rays.intersect(accel_);
        std::vector<NodePixel> found = note_nearest(rays);
        if (depth_ == Depth::all) {
            rays.drop_misses();
            for (const MetSurface& met : rays.list_surfaces(accel_)) {
                const int32_t node = node_of(scene_, met.surface);
                if (node >= 0) found.emplace_back(node, rays.pixel(met.index));
            }
        }
        std::sort(found.begin(), found.end());
        found.erase(std::unique(found.begin(), found.end()), found.end());
        return found;
    }

private:
    void begin(int band, PartRays& rays) const {
        const PixelRect& frame = out_.frame;
        const int first = band * band_rows;
        const int end = std::min(first + band_rows, frame.height);
        visit_model(camera_, false, [&](auto maker) {
            for (int left = 0; left < frame.width; left += packet_columns) {
                const int right = std::min(left + packet_columns, frame.width);
                for (int row = first; row < end; ++row)
                    begin_run<decltype(maker)>({left, row, right - left, 1}, rays);
            }
        });
    }

    /// Begins the rays of pixels beside each other in one row of the frame.
    template <typename Maker>
    void begin_run(const PixelRect& run, PartRays& rays) const {
        const PixelRect& frame = out_.frame;
        const float y =
            (static_cast<float>(frame.y + run.y) + 0.5f) / static_cast<float>(out_.height);
        for (int column = run.x; column < run.x + run.width; ++column) {
            const float x =
                (static_cast<float>(frame.x + column) + 0.5f) / static_cast<float>(out_.width);
            const FilmPoint<float> point{{x, y}, {x, y}, {0.5f, 0.5f}};
            const auto made = world_ray<Maker>(camera_, point);
            const float length = length_of(camera_, made);
            if (!(length > 0)) continue;
            const auto pixel = static_cast<uint32_t>(run.y * frame.width + column);
            rays.add(pixel, made.ray.origin, made.ray.direction, length);
        }
    }

    float depth_of(const Vec3f& place) const {
        const Vec3f local = transform_point(camera_from_world_, place);
        return measures_from_eye(camera_.model) ? length(local) : -local.z;
    }

    /// The nearest surfaces, in the image's pixels also by themselves.
    std::vector<NodePixel> note_nearest(const PartRays& rays) const {
        std::vector<NodePixel> found;
        for (int i = 0; i < rays.count(); ++i) {
            const SceneRecords surface = rays.hit_surface(i);
            if (surface.primitive < 0) continue;
            const int32_t node = node_of(scene_, surface);
            if (node < 0) continue;
            const uint32_t pixel = rays.pixel(i);
            found.emplace_back(node, pixel);
            if (!out_.is_inside(pixel)) continue;
            const size_t index = out_.image_index(pixel);
            const auto primitive = static_cast<size_t>(surface.primitive);
            out_.node[index] = node;
            out_.material[index] = scene_.primitives[primitive].material;
            out_.depth_m[index] =
                depth_of(rays.origin(i) + rays.direction(i) * rays.hit_distance(i));
        }
        return found;
    }

    const Scene& scene_;
    const Accel& accel_;
    const Camera& camera_;
    Depth depth_;
    RayLabels& out_;
    Affinef camera_from_world_;
};

/// Sorts the bands' pixels by node.
std::vector<Silhouette> join(const std::vector<std::vector<NodePixel>>& bands) {
    std::vector<Silhouette> out;
    std::vector<int32_t> place;  // by node: index in `out`, plus 1
    for (const std::vector<NodePixel>& band : bands) {
        for (const auto& [node, pixel] : band) {
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
                       Depth depth,
                       const std::atomic<bool>* stop) {
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
    const int bands = (out.frame.height + band_rows - 1) / band_rows;
    std::vector<std::vector<NodePixel>> found(static_cast<size_t>(bands));
    const Tracer tracer(prepared, camera, depth, out);
    parallel_for(found.size(), [&](size_t band) {
        if (stop != nullptr && stop->load(std::memory_order_relaxed)) return;
        const FlushDenormals flush;
        found[band] = tracer.trace(static_cast<int>(band));
    });
    out.silhouettes = join(found);
    return out;
}

}  // namespace obscura::dataset
