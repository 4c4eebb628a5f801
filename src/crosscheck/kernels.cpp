// crosscheck/kernels.cpp - queries kernels and compares their answers.
// SPDX-License-Identifier: Apache-2.0
#include "crosscheck/kernels.h"

#include "base/parallel.h"
#include "crosscheck/place_check.h"

#include <algorithm>
#include <mutex>

namespace obscura::crosscheck {

namespace {

/// True when a is shown before b.
bool is_worse(const Difference& a, const Difference& b) {
    if (a.comparison.verdict != b.comparison.verdict) {
        return a.comparison.verdict > b.comparison.verdict;
    }
    if (a.comparison.ulps != b.comparison.ulps) return a.comparison.ulps > b.comparison.ulps;
    return a.number < b.number;
}

void note_on_screen(ScreenVerdicts& screen, ScreenPlace at, Verdict verdict, bool hit) {
    const size_t pixel =
        static_cast<size_t>(at.y) * static_cast<size_t>(screen.width) + static_cast<size_t>(at.x);
    screen.worst[pixel] = std::max(screen.worst[pixel], static_cast<int8_t>(verdict));
    if (hit) screen.hit[pixel] = 1;
}

/// One chunk's answers beside those of one reference.
struct ChunkPair {
    const TrueScene& scene;
    const RayBlock& rays;
    const std::vector<Answer>& got;
    const AnswerList& reference;
    const Answer* expected;
    KnownDifferences& known;
    RayGroup group;
    uint64_t first;

    /// A ray that ends before the expected hit has none.
    Answer expected_of(int index) const {
        return expected[index].t > rays.true_ray(index).end ? Answer{} : expected[index];
    }

    Comparison compare_ray(int index) const {
        const Answer& answer = got[static_cast<size_t>(index)];
        const TrueRay ray = rays.true_ray(index);
        Comparison found = compare_answers(index, ray, answer);
        // u, v and Ng are judged by the answer alone: once is enough.
        if (reference.is_truth && found.verdict < Verdict::place &&
            !is_right_place(scene, ray, answer)) {
            found = {Verdict::place, INFINITY};
        }
        return found;
    }

private:
    Comparison compare_answers(int index, const TrueRay& ray, const Answer& answer) const {
        const bool ends = std::isfinite(ray.end);
        if (const Comparison* found = known.find(index, ends, answer)) return *found;
        const Answer wanted = expected_of(index);
        const Comparison found = compare(scene, ray, wanted, answer);
        const bool same = found.verdict == Verdict::agree || wanted.item == answer.item;
        if (found.verdict > Verdict::equal_depth || !same) known.add(index, ends, answer, found);
        return found;
    }
};

/// Ends of the occlusion rays: see compare_kernel.
void set_ends(const Answer* truth, RayBlock& rays) {
    for (int i = 1; i < rays.count(); i += 2) {
        if (!truth[i].found()) continue;
        RandomStream random(static_cast<uint64_t>(i));
        const double fraction = i % 4 == 1 ? random.between(0.1, 0.95) : 1.01;
        rays.set_end(i, fraction * truth[i].t);
    }
}

/// Adds a chunk to a pair's figures; noted(index, verdict) sees every ray.
template <typename Noted>
void compare_chunk(const ChunkPair& chunk, PairFigures& figures, const Noted& noted) {
    Tally& tally = figures.groups[static_cast<size_t>(chunk.group)];
    for (int i = 0; i < chunk.rays.count(); ++i) {
        const Answer& got = chunk.got[static_cast<size_t>(i)];
        const Comparison found = chunk.compare_ray(i);
        ++tally.rays;
        tally.hits += got.found() ? 1 : 0;
        ++tally.counts[static_cast<size_t>(found.verdict)];
        noted(i, found.verdict);
        if (found.verdict <= Verdict::equal_depth) continue;
        if (found.verdict == Verdict::edge) {
            tally.widest_edge = std::max(tally.widest_edge, found.ulps);
        }
        figures.worst.push_back({chunk.group,
                                 chunk.first + static_cast<uint64_t>(i),
                                 chunk.rays.true_ray(i),
                                 chunk.expected_of(i),
                                 got,
                                 found});
    }
    keep_worst(figures.worst);
}

}  // namespace

const Comparison* KnownDifferences::find(int index, bool ends, const Answer& got) const {
    const auto [begin, end] = by_ray_.equal_range(index);
    const auto known = std::find_if(begin, end, [&](const auto& entry) {
        return entry.second.ends == ends && entry.second.got == got;
    });
    return known == end ? nullptr : &known->second.comparison;
}

void KnownDifferences::add(int index, bool ends, const Answer& got, const Comparison& comparison) {
    by_ray_.emplace(index, Known{ends, got, comparison});
}

void keep_worst(std::vector<Difference>& worst) {
    std::sort(worst.begin(), worst.end(), is_worse);
    if (worst.size() > max_worst) worst.resize(max_worst);
}

uint64_t Tally::unexplained() const {
    return of(Verdict::place) + of(Verdict::item) + of(Verdict::depth) + of(Verdict::missed) +
           of(Verdict::false_hit);
}

void Tally::add(const Tally& other) {
    rays += other.rays;
    hits += other.hits;
    for (size_t i = 0; i < verdict_count; ++i)
        counts[i] += other.counts[i];
    widest_edge = std::max(widest_edge, other.widest_edge);
}

Tally PairFigures::total() const {
    Tally sum;
    for (const Tally& group : groups)
        sum.add(group);
    return sum;
}

Tally PairFigures::unaimed() const {
    Tally sum;
    for (size_t g = 0; g < ray_groups; ++g) {
        if (is_unaimed(static_cast<RayGroup>(g))) sum.add(groups[g]);
    }
    return sum;
}

void PairFigures::add(const PairFigures& other) {
    for (size_t g = 0; g < ray_groups; ++g)
        groups[g].add(other.groups[g]);
    worst.insert(worst.end(), other.worst.begin(), other.worst.end());
    keep_worst(worst);
}

std::vector<PairFigures> compare_kernel(const TrueScene& scene,
                                        const RayBatch& batch,
                                        const Kernel& kernel,
                                        const std::vector<AnswerList*>& references,
                                        const KernelOutputs& outputs) {
    std::vector<PairFigures> all(references.size());
    for (size_t r = 0; r < references.size(); ++r) {
        all[r].got = kernel.name;
        all[r].expected = references[r]->name;
        all[r].against_truth = references[r]->is_truth;
        references[r]->known.resize(batch.chunks);
    }
    AnswerList* const kept = outputs.answers;
    if (kept != nullptr) {
        kept->name = kernel.name;
        kept->answers.resize(static_cast<size_t>(batch.count()));
    }
    std::mutex merging;  // sums, and the worst by an order of their own: no order matters
    parallel_for(batch.chunks, [&](size_t number) {
        const size_t chunk = batch.first_chunk + number;
        RayBlock block;
        std::vector<Answer> answers;
        batch.rays.fill(chunk, block);
        const size_t first = number * chunk_rays;
        if (kernel.occlusion && !references.empty() && references[0]->is_truth) {
            set_ends(&references[0]->answers[first], block);
        }
        kernel.ask(block, answers);
        if (kept != nullptr) std::copy(answers.begin(), answers.end(), &kept->answers[first]);
        const RayGroup group = RaySet::group(chunk);
        for (size_t r = 0; r < references.size(); ++r) {
            PairFigures mine;
            std::vector<Verdict> seen(answers.size());
            compare_chunk(
                {scene,
                 block,
                 answers,
                 *references[r],
                 &references[r]->answers[first],
                 references[r]->known[number],
                 group,
                 batch.first_ray() + first},
                mine,
                [&](int index, Verdict verdict) { seen[static_cast<size_t>(index)] = verdict; });
            const std::lock_guard lock(merging);
            all[r].add(mine);
            if (outputs.screen == nullptr || group != RayGroup::camera ||
                !references[r]->is_truth) {
                continue;
            }
            for (size_t i = 0; i < seen.size(); ++i)
                note_on_screen(*outputs.screen,
                               batch.rays.place(chunk, static_cast<int>(i)),
                               seen[i],
                               answers[i].found());
        }
    });
    return all;
}

Kernel truth_kernel(const TrueScene& scene) {
    return {"double precision", [&scene](RayBlock& rays, std::vector<Answer>& answers) {
                answers.resize(static_cast<size_t>(rays.count()));
                for (int i = 0; i < rays.count(); ++i)
                    answers[static_cast<size_t>(i)] = answer_of(scene.nearest(rays.true_ray(i)));
            }};
}

}  // namespace obscura::crosscheck
