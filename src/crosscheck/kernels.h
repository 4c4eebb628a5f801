// crosscheck/kernels.h - whoever answers rays, and how their answers are compared.
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "crosscheck/compare.h"
#include "crosscheck/ray_set.h"

#include <array>
#include <cstdint>
#include <functional>
#include <string>
#include <unordered_map>
#include <vector>

namespace obscura {

/// One that answers rays. `ask` is called from many threads and fills one answer a ray.
struct Kernel {
    std::string name;
    std::function<void(RayBlock& rays, std::vector<Answer>& answers)> ask;
    bool occlusion = false;  ///< its answers name no item
};

/// Differences of other kernels' answers from one list's, by the ray's number in its chunk: many
/// kernels give the same wrong answer, and it takes long to find out how wrong it is.
class KnownDifferences {
public:
    /// Null where this answer has not been compared.
    ///
    /// In   ends: the ray was asked with an end, as occlusion is
    const Comparison* find(int row, bool ends, const Answer& got) const;
    void add(int row, bool ends, const Answer& got, const Comparison& comparison);

private:
    struct Known {
        bool ends;
        Answer got;
        Comparison comparison;
    };
    std::unordered_multimap<int, Known> by_row_;
};

/// All answers of one kernel to one batch, in the order of the rays.
struct AnswerList {
    std::string name;
    std::vector<Answer> answers;
    bool is_truth = false;
    std::vector<KnownDifferences> known = {};  ///< by chunk; compare_kernel adds to them
};

struct Tally {
    uint64_t rays = 0;
    uint64_t hits = 0;  ///< of the kernel that is compared
    std::array<uint64_t, verdicts> counts = {};
    double widest_edge = 0;  ///< ulp, of those counted as edge

    uint64_t of(Finding verdict) const { return counts[static_cast<size_t>(verdict)]; }
    /// Differences that 4 ulp do not explain.
    uint64_t unexplained() const;
    /// All but those that agree or are at equal depth.
    uint64_t mismatches() const {
        return unexplained() + of(Finding::edge) + of(Finding::crack) + of(Finding::edge_on);
    }
    void add(const Tally& other);
};

/// One ray on which two kernels differ.
struct Difference {
    RayGroup group = RayGroup::camera;
    uint64_t number = 0;  ///< of the ray
    TrueRay ray;
    Answer expected, got;
    Comparison comparison;
};

/// What a kernel is held to.
enum class Standard : int {
    full,   ///< no difference that 4 ulp do not explain, and hardly any other
    edges,  ///< no difference that 4 ulp do not explain
    none,   ///< only published
};

/// A kernel against another or against the truth.
struct PairFigures {
    std::string got, expected;
    bool against_truth = false;
    Standard standard = Standard::full;
    std::array<Tally, ray_groups> groups;
    std::vector<Difference> worst;  ///< at most most_worst, worst first; not those at equal depth

    Tally total() const;
    /// Of camera rays and of those aimed at nothing.
    Tally unaimed() const;
    /// Figures of the same two about other rays.
    void add(const PairFigures& other);
};

inline constexpr size_t most_worst = 8;

/// Puts the worst first and leaves out what comes after most_worst of them.
void keep_worst(std::vector<Difference>& worst);

/// The worst verdict of every pixel whose camera ray was compared with the truth; -1: none was.
struct ScreenVerdicts {
    int width = 0;
    int height = 0;
    std::vector<int8_t> worst;
    std::vector<uint8_t> hit;  ///< 1: a kernel found something
};

/// What compare_kernel writes beside its figures, where it is not null.
struct KernelRecord {
    AnswerList* answers = nullptr;     ///< the kernel's answers
    ScreenVerdicts* screen = nullptr;  ///< worse verdicts of this pair
};

/// Asks a kernel all rays of a batch and compares it with others that have been asked. The same
/// figures for any number of threads. Occlusion is asked of every fourth ray up to a place before
/// its true hit, where nothing may hide it, and of every fourth up to a place just behind it.
///
/// In      references: answers to the same batch, always with the same scene; may be empty
std::vector<PairFigures> compare_kernel(const TrueScene& scene,
                                        const RayBatch& batch,
                                        const Kernel& kernel,
                                        const std::vector<AnswerList*>& references,
                                        const KernelRecord& record);

/// The truth as a kernel.
Kernel truth_kernel(const TrueScene& scene);

}  // namespace obscura
