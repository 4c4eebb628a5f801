// stages/workspace.cpp - the columns of one batch in one block of memory.
// SPDX-License-Identifier: Apache-2.0
#include "stages/walk.h"

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
        next_ += (padded_rows * sizeof(T) + alignment - 1) / alignment * alignment;
    }
    template <template <typename> typename Columns>
    void all(Columns<float>& columns) {
        Columns<float>::for_each_column(*this, columns);
    }

private:
    mutable std::byte* next_;
};

}  // namespace

Workspace::Workspace() {
    constexpr size_t words = 2 * words_in_row<PathRows> + 2 * words_in_row<HitRows> +
                             words_in_row<MissRows> + words_in_row<ShadowRows> +
                             words_in_row<SampleRows>;
    memory_.resize(words * (padded_rows * 4 + alignment) + alignment);
    void* start = memory_.data();
    size_t space = memory_.size();
    Carver carve(
        static_cast<std::byte*>(std::align(alignment, memory_.size() - alignment, start, space)));
    for (PathRows& p : paths)
        carve.all(p);
    carve.all(hits);
    carve.all(walker_hits);
    carve.all(misses);
    carve.all(shadows);
    carve.all(samples);
    walker_row.resize(padded_rows);
    occluded.resize(padded_rows);
    camera_length_m.resize(padded_rows);
    slot_time.resize(padded_rows);
    ray_time.resize(padded_rows);
    cut_faces.resize(padded_rows);
    ray_end.resize(padded_rows);
    for (std::vector<float>& column : splats)
        column.resize(padded_rows);
}

}  // namespace obscura
