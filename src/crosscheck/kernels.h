// crosscheck/kernels.h - queries kernels and compares their answers.
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

namespace obscura::crosscheck {

/// Answers rays. `ask` is called from many threads and fills one answer a ray.
struct Kernel {
    std::string name;
    std::function<void(RayBlock& rays, std::vector<Answer>& answers)> ask;
    bool occlusion = false;  ///< answers do not name the item
};

/// Differences from one list's answers, by the ray's index in its chunk. Many kernels give the same
/// wrong answer, and judging it takes long.
class KnownDifferences {
public:
    /// Null where this answer has not been compared.
    ///
    /// In   ends: the ray was asked with an end, as occlusion is
    const Comparison* find(int index, bool ends, const Answer& got) const;
    void add(int index, bool ends, const Answer& got, const Comparison& comparison);

private:
    struct Known {
        bool ends;
        Answer got;
        Comparison comparison;
    };
    std::unordered_multimap<int, Known> by_ray_;
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
    std::array<uint64_t, verdict_count> counts = {};
    double widest_edge = 0;  ///< ulp, of those counted as edge

    uint64_t of(Verdict verdict) const { return counts[static_cast<size_t>(verdict)]; }
    /// Differences beyond 4 ulp.
    uint64_t unexplained() const;
    /// All but those that agree or are at equal depth.
    uint64_t mismatches() const {
        return unexplained() + of(Verdict::edge) + of(Verdict::crack) + of(Verdict::edge_on);
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

/// The standard that a kernel must meet.
enum class Standard : int {
    full,   ///< no difference beyond 4 ulp, and hardly any other
    edges,  ///< no difference beyond 4 ulp
    none,   ///< only published
};

/// A kernel compared with another or with the truth.
struct PairFigures {
    std::string got, expected;
    bool against_truth = false;
    Standard standard = Standard::full;
    std::array<Tally, ray_groups> groups;
    std::vector<Difference> worst;  ///< at most max_worst, worst first; not those at equal depth

    Tally total() const;
    /// Of camera rays and of the other unaimed ones.
    Tally unaimed() const;
    /// Figures of the same two about other rays.
    void add(const PairFigures& other);
};

inline constexpr size_t max_worst = 8;

/// Sorts the worst first and drops all beyond max_worst.
void keep_worst(std::vector<Difference>& worst);

/// The worst verdict of every pixel whose camera ray was compared with the truth; -1: none was.
struct ScreenVerdicts {
    int width = 0;
    int height = 0;
    std::vector<int8_t> worst;
    std::vector<uint8_t> hit;  ///< 1: a kernel found something
};

/// What compare_kernel writes beside its figures, where it is not null.
struct KernelOutputs {
    AnswerList* answers = nullptr;     ///< the kernel's answers
    ScreenVerdicts* screen = nullptr;  ///< gets the verdicts on this pair
};

/// Sends all rays of a batch to a kernel and compares it with others. The figures do not depend on
/// the number of threads. Occlusion is tested on every fourth ray up to a point before its true
/// hit, where nothing may block it, and on every fourth up to a point just behind it.
///
/// In      references: answers to the same batch, always with the same scene; may be empty
std::vector<PairFigures> compare_kernel(const TrueScene& scene,
                                        const RayBatch& batch,
                                        const Kernel& kernel,
                                        const std::vector<AnswerList*>& references,
                                        const KernelOutputs& outputs);

/// The truth as a kernel.
Kernel truth_kernel(const TrueScene& scene);

}  // namespace obscura::crosscheck
