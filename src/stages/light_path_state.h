// stages/light_path_state.h - the memory of light layers, and what happens to it between stages.
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "stages/light_paths.h"

#include <array>
#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

namespace obscura {

/// What has arrived in one layer, by sample index.
struct ColorView {
    const float* r = nullptr;  ///< null: nothing
    const float* g = nullptr;
    const float* b = nullptr;
};

/// The light layers of one batch. One per thread, reused from batch to batch.
class LightPathState {
public:
    /// Begins a batch: all paths are in the first state.
    ///
    /// In      goes_straight: paths may pass thin walls; catches: they may meet shadow catchers
    void begin(const LightPathTable& table, int count, bool goes_straight, bool catches);

    /// Begins a bounce: no shadow ray has weights of its own.
    void begin_bounce();

    /// Begins the shadow rays of a flight inside a medium: none has weights of its own.
    void begin_flight();

    const LightPathColumns& columns() const { return columns_; }

    /// Adds light along a path that no stage of shading tells of.
    void add_path_light(uint32_t slot, uint32_t light_class, const Vec3f& radiance);

    /// Adds what a shadow ray brings.
    void add_shadow_light(uint32_t slot, const Vec3f& radiance);

    /// Moves all weights of a path by one event, or those of its shadow ray.
    void move_path(uint32_t slot, size_t event);
    void move_shadow(uint32_t slot, size_t event);

    /// Gives a shadow ray the weights that its path has after an event, which may not happen to the
    /// path itself.
    void split_shadow_after(uint32_t slot, size_t event);

    /// Gives a shadow ray the weights of its path, which has moved already.
    void split_moved_shadow(uint32_t slot);

    /// The same where scattering settles the path, but it passed the surface straight on: what its
    /// shadow ray brings counts as scattered.
    void split_straight_shadow(uint32_t slot);

    /// Notes the light of a first hit's shadow ray, as if nothing were in its way.
    void add_unshadowed(uint32_t slot, const Vec3f& radiance);
    /// Notes the part of it that arrives, which add_shadow_light does by itself.
    void note_shadow_light(uint32_t slot, const Vec3f& radiance);
    /// Whether what shadow rays bring now belongs to the first hits.
    void note_shadows(bool first_hits) { notes_shadows_ = first_hits; }
    bool notes_shadows() const { return notes_shadows_; }

    // A shadow catcher shows shadow: the light that it receives belongs to no layer. What lies
    // behind it does, as far as the catcher lets it through, and what it reflects.

    /// Moves all that has arrived at a sample behind the catcher that its camera ray met.
    void move_behind(uint32_t slot);
    /// Adds light behind a catcher that a path has met.
    void add_behind(uint32_t slot, uint32_t light_class, const Vec3f& radiance);
    /// A path has met a catcher: no more light counts.
    void hold(uint32_t slot);
    /// When catchers have received all light: the paths that were held have left by an event.
    void release(size_t event);

    /// Shares out the light of settled paths. Samples that are not finite, which the beauty leaves
    /// out, are left out here too.
    void finish(const SampleView& samples);

    ColorView layer(size_t number) const;
    ColorView behind(size_t number) const;  ///< of a layer, what lies behind catchers
    ColorView unshadowed() const;           ///< light of shadow rays of first hits
    ColorView shadowed() const;             ///< the part of it that arrives

private:
    /// Owns what ColorColumns points to.
    struct Colors {
        std::vector<float> memory;
        std::vector<uint8_t> is_used;
        std::vector<uint16_t> used;
        int used_count = 0;

        /// All numbers become unused.
        void begin(int numbers);
        ColorColumns view();
        ColorView color(size_t number) const;
    };

    /// A part of the weight of a path that is held.
    struct HeldWeight {
        uint32_t slot;
        uint16_t state;
        Vec3f weight;
    };

    /// Weights of paths or shadow rays, and light that arrived while they rested.
    struct RestingLight {
        const Colors& weights;
        Colors& sums;
        const uint16_t* class_of_sum;
        bool at_settled_paths;
    };
    std::array<RestingLight, 3> resting_light();

    template <typename StateAfter>
    void split_shadow(uint32_t slot, const StateAfter& state_after);
    void forget_shadows();
    void share_out(const RestingLight& light);
    void share_out(const RestingLight& light, uint32_t slot);
    void share_out(uint32_t slot);
    void move(const ColorColumns& weights, uint32_t slot, size_t event);

    Colors weights_, shadow_weights_, layers_, shadows_, behind_;
    Colors sums_, resting_sums_, shadow_sums_;
    std::vector<HeldWeight> held_;
    std::vector<uint32_t> words_;  ///< the columns of numbers
    LightPathColumns columns_;
    ColorColumns shadow_columns_;
    int count_ = 0;
    int bounces_ = 0;
    bool has_moved_ = false;  ///< a path, between stages
    bool notes_shadows_ = false;
};

}  // namespace obscura
