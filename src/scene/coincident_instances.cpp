// scene/coincident_instances.cpp - removes instances that lie on top of each other many times.
// SPDX-License-Identifier: Apache-2.0
#include "scene/coincident_instances.h"

#include <algorithm>
#include <bit>
#include <cstring>
#include <unordered_map>

namespace obscura {

namespace {

uint64_t place_key(const Instance& instance) {
    uint64_t words[sizeof(Affinef) / sizeof(uint64_t)];
    std::memcpy(words, &instance.world_from_object, sizeof words);
    uint64_t key = static_cast<uint64_t>(instance.mesh);
    for (const uint64_t word : words) {
        key = (key ^ word) * 0x9E3779B97F4A7C15U;  // the golden ratio in 64 bits: Knuth's hashing
        key ^= key >> 32U;
    }
    return key;
}

const Affinef* first_place(const Scene& scene, const Instance& instance) {
    return moves(instance) ? &scene.motion.instances[static_cast<size_t>(instance.motion)]
                           : &instance.world_from_object;
}

bool are_copies(const Scene& scene, const Instance& a, const Instance& b) {
    if (a.mesh != b.mesh || moves(a) != moves(b)) return false;
    const auto steps = moves(a) ? static_cast<size_t>(scene.motion.steps) : 1U;
    return std::memcmp(first_place(scene, a), first_place(scene, b), steps * sizeof(Affinef)) == 0;
}

/// Hashed counters, each shared by a few keys: they find keys that may be frequent without sorting.
class Tally {
public:
    explicit Tally(size_t keys) : counts_(std::bit_ceil(2 * keys)) {}
    void add(uint64_t key) { ++counts_[slot(key)]; }
    bool is_frequent(uint64_t key) const { return counts_[slot(key)] > max_copies; }
    bool has_frequent() const {
        const auto frequent = [](uint32_t count) { return count > max_copies; };
        return std::any_of(counts_.begin(), counts_.end(), frequent);
    }

private:
    size_t slot(uint64_t key) const { return key & (counts_.size() - 1); }
    std::vector<uint32_t> counts_;
};

/// Instances of one key: counts those that equal the first.
struct Crowd {
    const Instance* first = nullptr;
    uint32_t count = 0;
};

}  // namespace

std::vector<Instance> leave_out_copies(Scene& scene) {
    std::vector<Instance> out;
    const std::vector<Instance>& all = scene.instances;
    if (all.size() <= max_copies) return out;
    Tally tally(all.size());
    for (const Instance& instance : all)
        tally.add(place_key(instance));
    if (!tally.has_frequent()) return out;
    std::unordered_map<uint64_t, Crowd> crowds;
    for (const Instance& instance : all) {
        const uint64_t key = place_key(instance);
        if (!tally.is_frequent(key)) continue;
        Crowd& crowd = crowds[key];
        if (crowd.first == nullptr) crowd.first = &instance;
        if (are_copies(scene, *crowd.first, instance)) ++crowd.count;
    }
    std::vector<Instance> kept;
    for (const Instance& instance : all) {
        const auto found = crowds.find(place_key(instance));
        const bool is_copy = found != crowds.end() && found->second.count > max_copies &&
                             found->second.first != &instance &&
                             are_copies(scene, *found->second.first, instance);
        (is_copy ? out : kept).push_back(instance);
    }
    scene.instances = std::move(kept);
    return out;
}

}  // namespace obscura
