// stages/workspace.cpp - allocates the columns of one batch in one block of memory.
// SPDX-License-Identifier: Apache-2.0
#include "stages/wavefront.h"

#include <memory>

namespace obscura {

namespace {

constexpr size_t alignment = 64;

/// Hands out aligned columns from one block of memory.
class Carver {
public:
    explicit Carver(std::byte* memory) : next_(memory) {}

    template <typename T>
    void operator()(T*& column) const {
        column = reinterpret_cast<T*>(next_);
        next_ += (padded_batch_size * sizeof(T) + alignment - 1) / alignment * alignment;
    }
    template <template <typename> typename Columns>
    void all(Columns<float>& columns) {
        Columns<float>::for_each_column(*this, columns);
    }

private:
    mutable std::byte* next_;
};

}  // namespace

void Workspace::allot_aovs(std::span<const Aov> aovs) {
    size_t channels = 0;
    for (const Aov aov : aovs)
        channels += static_cast<size_t>(channel_count(aov));
    aov_memory_.resize(channels * padded_batch_size);
    aov_outputs.clear();
    float* next = aov_memory_.data();
    for (const Aov aov : aovs) {
        AovOutput output{aov, {}};
        for (int c = 0; c < channel_count(aov); ++c, next += padded_batch_size)
            output.columns[c] = next;
        aov_outputs.push_back(output);
    }
}

Workspace::Workspace() {
    constexpr size_t words = 2 * column_count<PathColumns> + 2 * column_count<HitColumns> +
                             column_count<MissColumns> + column_count<ShadowColumns> +
                             column_count<SampleColumns>;
    memory_.resize(words * (padded_batch_size * 4 + alignment) + alignment);
    void* start = memory_.data();
    size_t space = memory_.size();
    Carver carve(
        static_cast<std::byte*>(std::align(alignment, memory_.size() - alignment, start, space)));
    for (PathColumns& p : paths)
        carve.all(p);
    carve.all(hits);
    carve.all(random_walk_hits);
    carve.all(misses);
    carve.all(shadows);
    carve.all(samples);
    random_walk_path.resize(padded_batch_size);
    occluded.resize(padded_batch_size);
    camera_length_m.resize(padded_batch_size);
    slot_time.resize(padded_batch_size);
    ray_time.resize(padded_batch_size);
    cut_faces.resize(padded_batch_size);
    ray_end.resize(padded_batch_size);
    for (std::vector<float>& column : splats)
        column.resize(padded_batch_size);
}

}  // namespace obscura
