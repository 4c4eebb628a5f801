// stages/1_camera.cpp - stage 1: film points become rays.
// SPDX-License-Identifier: Apache-2.0
#include "stages/1_camera.h"

#include "math/sampler.h"
#include "stages/column_lanes.h"

namespace obscura {
inline namespace OBSCURA_ISA {

namespace {

/// Offset from the pixel's centre, in pixels, drawn from the reconstruction filter.
/// Source  Ernst et al., "Filter Importance Sampling", IEEE RT 2006
OBSCURA_INLINE Lanes filter_offset(const float* inverse_cdf, Lanes u) {
    if (inverse_cdf == nullptr) return u - Lanes(0.5f);
    const Lanes x = u * Lanes(static_cast<float>(filter_entries));
    const LanesI i = min(to_int(x), LanesI(filter_entries - 1));
    const Lanes low = gather<Lanes>(inverse_cdf, i);
    const Lanes high = gather<Lanes>(inverse_cdf + 1, i);
    return lerp(low, high, x - from_int<Lanes>(i));
}

/// Writes the columns of a camera ray that every integrator reads.
template <typename Maker>
OBSCURA_INLINE CameraRay<Lanes> store_ray(const BatchSettings& batch,
                                          const FilmPoint<Lanes>& point,
                                          int i,
                                          const PathColumns& out,
                                          float* length_m) {
    const WorldRay<Lanes> made = world_ray<Maker>(batch.camera, point);
    store3(out.ox, out.oy, out.oz, i, made.ray.origin);
    store3(out.dx, out.dy, out.dz, i, made.ray.direction);
    if (length_m != nullptr) store(length_m + i, length_of(batch.camera, made));
    store(out.cone_width + i, made.ray.cone_width);
    store(out.cone_spread + i, made.ray.cone_spread);
    return made.ray;
}

/// One ray through every pixel's centre and the centre of the lens, for one kind of camera.
template <typename Maker>
void make_centre_rays_of(const BatchSettings& batch,
                         int count,
                         const PathColumns& out,
                         float* length_m) {
    const FilmScale scale(batch);
    const Vec2<Lanes> offset{Lanes(batch.film_offset_px[0]), Lanes(batch.film_offset_px[1])};
    for (int i = 0; i < count; i += lane_count) {
        const Vec2<Lanes> film = scale(load(batch.pixel_x + i), load(batch.pixel_y + i), offset);
        store_ray<Maker>(batch, {film, film, {Lanes(0.5f), Lanes(0.5f)}}, i, out, length_m);
    }
}

template <typename U>
OBSCURA_INLINE PixelSequence<U> sequence_of(const BatchSettings& batch, U x, U y) {
    if (batch.z_order_bits < 0) return {pixel_key(x, y, batch.seed_low, batch.seed_high), U(0U)};
    return z_order_sequence(x, y, batch.seed_low, batch.seed_high, batch.z_order_bits);
}

/// A group of samples: sample index, number among those of its pixel, pixel, its random numbers.
struct SampleLanes {
    LanesI slot, sample, x, y;
    PixelSequence<LanesU> sequence;
};

/// The groups of a batch, asked for one after the other.
class SampleGroups {
public:
    OBSCURA_INLINE SampleGroups(const BatchSettings& batch, int count)
        : batch_(batch),
          count_(count),
          inverse_samples_(1.0f / static_cast<float>(batch.samples)),
          are_of_one_pixel_(batch.samples % lane_count == 0) {}

    OBSCURA_INLINE SampleLanes at(int i) {
        return are_of_one_pixel_ ? of_one_pixel(i) : of_any_pixels(i);
    }

private:
    OBSCURA_INLINE SampleLanes of_any_pixels(int i) const {
        const LanesI slot = min(LanesI(i) + lane_numbers(), LanesI(count_ - 1));
        // Exact: sample indices are far below 2^23, and the half keeps quotients off whole numbers.
        const LanesI pixel =
            to_int((from_int<Lanes>(slot) + Lanes(0.5f)) * Lanes(inverse_samples_));
        const LanesI x = gather<Lanes>(batch_.pixel_x, pixel);
        const LanesI y = gather<Lanes>(batch_.pixel_y, pixel);
        return {slot,
                slot - pixel * LanesI(batch_.samples),
                x,
                y,
                sequence_of(batch_, as_uint(x), as_uint(y))};
    }

    /// What all lanes have in common is worked out once for a pixel: gathers and hashes are dear.
    OBSCURA_INLINE SampleLanes of_one_pixel(int i) {
        if (i == end_) {
            begin_ = end_;
            end_ += batch_.samples;
            const int pixel = pixel_++;
            x_ = batch_.pixel_x[pixel];
            y_ = batch_.pixel_y[pixel];
            sequence_ = sequence_of(batch_, static_cast<uint32_t>(x_), static_cast<uint32_t>(y_));
        }
        return {LanesI(i) + lane_numbers(),
                LanesI(i - begin_) + lane_numbers(),
                LanesI(x_),
                LanesI(y_),
                {LanesU(sequence_.key), LanesU(sequence_.first)}};
    }

    const BatchSettings& batch_;
    int count_;
    float inverse_samples_;
    bool are_of_one_pixel_;  ///< each
    int pixel_ = 0, begin_ = 0, end_ = 0;
    int32_t x_ = 0, y_ = 0;
    PixelSequence<uint32_t> sequence_ = {0, 0};
};

/// The loop over a batch, for one kind of camera.
template <typename Maker>
void make_rays_of(const BatchSettings& batch,
                  int count,
                  const PathColumns& out,
                  const SampleColumns& samples,
                  float* length_m) {
    const FilmScale scale(batch);
    SampleGroups groups(batch, count);
    for (int i = 0; i < count; i += lane_count) {
        const auto [slot, sample, x, y, sequence] = groups.at(i);
        const auto [key, first] = sequence;
        const LanesU index = reverse_bits(first + as_uint(sample) + LanesU(batch.first_sample));
        const auto u =
            unit_pair<Lanes>(sobol_pair(key, index, static_cast<uint32_t>(RandomUse::film)));
        Vec2<Lanes> offset{Lanes(0.0f), Lanes(0.0f)};
        if (!batch.through_centres) {
            offset = {filter_offset(batch.filter, u.x), filter_offset(batch.filter, u.y)};
        }
        const Vec2<Lanes> film = scale(x, y, offset);
        FilmPoint<Lanes> point{film, film, {Lanes(0.5f), Lanes(0.5f)}};
        if constexpr (Maker::model == CameraModel::environment) {
            point.pixel_centre = scale(x, y, {Lanes(0.0f), Lanes(0.0f)});
        }
        if constexpr (Maker::has_lens) {
            point.lens = unit_pair<Lanes>(sobol_pair(key, index, lens_pair));
        }
        const CameraRay<Lanes> ray = store_ray<Maker>(batch, point, i, out, length_m);
        // Rays outside the camera's image carry no light, not even the background's.
        store3(out.tr, out.tg, out.tb, i, splat3(select(ray.valid, Lanes(1.0f), Lanes(0.0f))));
        store(out.pdf + i, Lanes(0.0f));
        store(out.slot + i, as_uint(slot));
        store(out.key + i, key);
        store(out.sample + i, index);
        store(out.medium_stack + i, LanesU(batch.medium_stack));
        store(out.path_key + i, hash_word(key + index * LanesU(0x9E3779B9U)));
        store3(samples.r, samples.g, samples.b, i, splat3(Lanes(0.0f)));
        store(samples.a + i, Lanes(0.0f));
    }
}

}  // namespace

void make_camera_rays(const BatchSettings& batch,
                      int count,
                      const PathColumns& out,
                      const SampleColumns& samples,
                      float* length_m) {
    visit_model(batch.camera, !batch.through_centres, [&](auto maker) {
        make_rays_of<decltype(maker)>(batch, count, out, samples, length_m);
    });
}

void make_centre_rays(const BatchSettings& batch,
                      int count,
                      const PathColumns& out,
                      float* length_m) {
    visit_model(batch.camera, false, [&](auto maker) {
        make_centre_rays_of<decltype(maker)>(batch, count, out, length_m);
    });
}

}  // namespace OBSCURA_ISA
}  // namespace obscura
