// benchmarks/stage_columns.cpp - follows one tile's paths and keeps the input of a stage.
// SPDX-License-Identifier: Apache-2.0
#include "benchmarks/stage_columns.h"

#include "render/prepared_scene.h"

#include <array>
#include <bit>
#include <cstring>
#include <utility>

namespace obscura::benchmarks {

namespace {

constexpr int image_width = 1280;
constexpr int image_height = 720;
constexpr int samples_at_once = 16;  // of a pixel, as the renderer fills its batches

/// Copies whole columns: path state is nothing but pointers to columns of 32-bit words.
template <typename Columns>
void copy_columns(const Columns& from, const Columns& to, int count) {
    constexpr size_t columns = sizeof(Columns) / sizeof(void*);
    const auto sources = std::bit_cast<std::array<const void*, columns>>(from);
    const auto targets = std::bit_cast<std::array<void*, columns>>(to);
    for (size_t i = 0; i < columns; ++i)
        std::memcpy(targets[i], sources[i], static_cast<size_t>(count) * 4);
}

}  // namespace

StageColumns::StageColumns(const PreparedScene& prepared, const Camera& camera, int at_bounce)
    : scene(prepared.impl()),
      view(scene.view()),
      bounce(at_bounce),
      pixels(batch_size / samples_at_once) {
    for (int i = 0; i < pixels; ++i) {  // 4x4 blocks, as the renderer orders a tile's pixels
        const int block = i / 16;
        xs_.push_back(image_width / 2 + block % 4 * 4 + i % 4);
        ys_.push_back(image_height / 2 + block / 4 * 4 + i / 4 % 4);
    }
    batch.camera = camera;
    batch.width = image_width;
    batch.height = image_height;
    batch.pixel_x = xs_.data();
    batch.pixel_y = ys_.data();
    batch.samples = samples_at_once;
    batch.background[3] = 1.0f;

    count_ = pixels * batch.samples;
    scene.stages->camera(batch, count_, work.paths[0], work.samples, nullptr);
    for (int b = 0;; ++b) {
        scene.accel->intersect(rays(),
                               work.hits,
                               b == 0 ? Coherence::coherent : Coherence::incoherent,
                               {b == 0, false, 2U * static_cast<uint32_t>(b)});
        if (b == bounce) break;
        count_ = scene.stages->shade(view, batch, b, count_, shade_columns()).next;
        std::swap(work.paths[0], work.paths[1]);
    }
    copy_columns(work.paths[0], saved_.paths[0], count_);
    copy_columns(work.hits, saved_.hits, count_);
}

void StageColumns::restore() {
    copy_columns(saved_.paths[0], work.paths[0], count_);
    copy_columns(saved_.hits, work.hits, count_);
}

void StageColumns::make_shadow_rays() {
    restore();
    shaded = scene.stages->shade(view, batch, bounce, count_, shade_columns());
    restore();
    scene.accel->occluded(shadow_rays(), work.occluded.data(), Coherence::incoherent, {1});
}

ShadeColumns StageColumns::shade_columns() const {
    return {work.paths[0], work.hits, work.misses, work.paths[1], work.shadows, work.samples};
}

RayColumns StageColumns::rays() const {
    const PathColumns& p = work.paths[0];
    return {p.ox, p.oy, p.oz, p.dx, p.dy, p.dz, nullptr, p.path_key, count_};
}

RayColumns StageColumns::shadow_rays() const {
    const ShadowColumns& s = work.shadows;
    return {s.ox, s.oy, s.oz, s.dx, s.dy, s.dz, s.tfar, s.path_key, shaded.shadow};
}

}  // namespace obscura::benchmarks
