// stages/3_frame_motion.cpp - stage 3 for the AOV `motion`: from frame to frame, in pixels.
// SPDX-License-Identifier: Apache-2.0
#include "stages/3_frame_motion.h"

#include "camera/project.h"
#include "scene/frame_motion.h"

#include <cmath>
#include <optional>

namespace obscura {
inline namespace OBSCURA_ISA {

namespace {

/// Number of frames that are compared: before, at and after the image's time.
constexpr int frame_count = 3;

/// The hit points in the world at each frame.
struct FramePoints {
    Vec3<Lanes> at[frame_count];
    Mask move;
};

/// The vertices that move from frame to frame; others have base no_attribute.
struct VertexFrames {
    LanesI base, stride;
    Mask move;
};

OBSCURA_INLINE VertexFrames vertex_frames(const FrameHits& at) {
    if (at.frames.positions == nullptr) return {LanesI(no_attribute), LanesI(0), Mask(false)};
    const TableRecord<Lanes, FrameVertices> record(at.frames.vertices, at.hit.primitive);
    const LanesI base = record.integer<&FrameVertices::base>();
    return {base, record.integer<&FrameVertices::stride>(), base != LanesI(no_attribute)};
}

/// Index of the hit instances' first placing; -1: they stand still.
OBSCURA_INLINE LanesI instance_frames(const FrameHits& at, Mask instanced) {
    if (at.frames.instances == nullptr || none(instanced)) return LanesI(-1);
    const LanesI index = max(at.hit.instance, LanesI(0));
    return select(instanced, gather<Lanes>(at.frames.instance, index), LanesI(-1));
}

OBSCURA_INLINE Vec3<Lanes> vertex_position(const FrameHits& at,
                                           const HitGeometry& g,
                                           const VertexFrames& vertices,
                                           int frame) {
    Vec3<Lanes> p[3];
    for (int k = 0; k < 3; ++k) {
        const LanesI word =
            vertices.base + vertices.stride * LanesI(frame) + g.corner[k] * LanesI(3);
        p[k] = gather3(at.frames.positions, select(vertices.move, word, LanesI(0)));
    }
    return weighted(g, p);
}

FramePoints points_of(const FrameHits& at, const Vec3<Lanes>& position) {
    FramePoints out{{position, position, position}, Mask(false)};
    const Mask instanced = at.hit.instance >= LanesI(0);
    const VertexFrames vertices = vertex_frames(at);
    const LanesI first = instance_frames(at, instanced);
    const Mask placed = first >= LanesI(0);
    out.move = at.hits & (vertices.move | placed);
    if (none(out.move)) return out;
    HitGeometry g;
    find_geometry<HitUse::attributes>(at.scene, at.hit, g);
    Vec3<Lanes> local = g.position;
    InstanceMaps maps;
    if (any(instanced)) maps = instance_maps(at.scene, at.hit.instance, at.hit.time);
    if (g.has_shapes) {
        Vec3<Lanes> inner = position;
        if (any(instanced)) {
            inner = select(instanced, transform_point(maps.object_from_world, position), position);
        }
        local = select(g.shapes, inner, local);
    }
    for (int frame = 0; frame < frame_count; ++frame) {
        Vec3<Lanes> p = local;
        if (any(vertices.move)) {
            p = select(vertices.move, vertex_position(at, g, vertices, frame), p);
        }
        Vec3<Lanes> world = p;
        if (any(instanced)) {
            world = select(instanced, transform_point(maps.world_from_object, p), p);
        }
        if (any(placed)) {
            const LanesI index = select(placed, first + LanesI(frame), LanesI(0));
            const TableRecord<Lanes, Affinef> record(at.frames.instances, index);
            world = select(placed, transform_point(read_affine(record), p), world);
        }
        out.at[frame] = select(out.move, world, position);
    }
    return out;
}

using FilmPosition = std::optional<Vec2<double>>;

/// The difference of two film points, in pixels; 0 if there is none.
Vec2<double> pixels_between(const BatchSettings& batch,
                            const FilmPosition& from,
                            const FilmPosition& to) {
    if (!from || !to) return {0, 0};
    Vec2<double> step{to->x - from->x, to->y - from->y};
    const Camera& camera = batch.camera;
    if (camera.model == CameraModel::environment &&
        camera.environment.projection != EnvironmentProjection::cubemap) {
        step.x -= std::round(step.x);
    }
    return {step.x * batch.width, step.y * batch.height};
}

}  // namespace

Four<Lanes> frame_motion(const FrameHits& at, const Vec3<Lanes>& position) {
    alignas(64) float out[4][lane_count] = {};
    const FramePoints points = points_of(at, position);
    const Mask seen_to_move = at.frames.camera_moves ? at.hits : points.move;
    alignas(64) float p[frame_count][3][lane_count];
    for (int frame = 0; frame < frame_count; ++frame) {
        store(p[frame][0], points.at[frame].x);
        store(p[frame][1], points.at[frame].y);
        store(p[frame][2], points.at[frame].z);
    }
    for (uint32_t bits = mask_bits(seen_to_move); bits != 0; bits &= bits - 1) {
        const int lane = __builtin_ctz(bits);
        FilmPosition film[frame_count];
        for (int frame = 0; frame < frame_count; ++frame) {
            const Vec3<double> world{static_cast<double>(p[frame][0][lane]),
                                     static_cast<double>(p[frame][1][lane]),
                                     static_cast<double>(p[frame][2][lane])};
            film[frame] = project_local(at.frames.cameras[frame],
                                        transform_point(at.frames.camera_from_world[frame], world));
        }
        const Vec2<double> back = pixels_between(at.batch, film[1], film[0]);
        const Vec2<double> forward = pixels_between(at.batch, film[1], film[2]);
        out[0][lane] = static_cast<float>(back.x);
        out[1][lane] = static_cast<float>(back.y);
        out[2][lane] = static_cast<float>(forward.x);
        out[3][lane] = static_cast<float>(forward.y);
    }
    return {load(out[0]), load(out[1]), load(out[2]), load(out[3])};
}

}  // namespace OBSCURA_ISA
}  // namespace obscura
