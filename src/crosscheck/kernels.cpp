// crosscheck/kernels.cpp - asking kernels and comparing what they say.
// SPDX-License-Identifier: Apache-2.0
#include "crosscheck/kernels.h"

#include "base/parallel.h"

#include <algorithm>
#include <mutex>

namespace obscura {

namespace {

/// True where a is to be shown before b.
bool is_worse(const Difference& a, const Difference& b) {
    if (a.comparison.verdict != b.comparison.verdict) {
        return a.comparison.verdict > b.comparison.verdict;
    }
    if (a.comparison.ulps != b.comparison.ulps) return a.comparison.ulps > b.comparison.ulps;
    return a.number < b.number;
}

void note_on_screen(ScreenVerdicts& screen, ScreenPlace at, Finding verdict, bool hit) {
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
    const Answer* expected;
    KnownDifferences& known;
    RayGroup group;
    uint64_t first;

    Comparison compare_row(int row) const {
        const Answer& answer = got[static_cast<size_t>(row)];
        if (const Comparison* found = known.find(row, answer)) return *found;
        const Comparison found = compare(scene, rays.true_ray(row), expected[row], answer);
        if (found.verdict > Finding::equal_depth) known.add(row, answer, found);
        return found;
    }
};

/// Adds a chunk to a pair's figures; noted(row, verdict) sees every ray.
template <typename Noted>
void compare_chunk(const ChunkPair& chunk, PairFigures& figures, const Noted& noted) {
    Tally& tally = figures.groups[static_cast<size_t>(chunk.group)];
    for (int i = 0; i < chunk.rays.count(); ++i) {
        const Answer& got = chunk.got[static_cast<size_t>(i)];
        const Comparison found = chunk.compare_row(i);
        ++tally.rays;
        tally.hits += got.found() ? 1 : 0;
        ++tally.counts[static_cast<size_t>(found.verdict)];
        noted(i, found.verdict);
        if (found.verdict <= Finding::equal_depth) continue;
        if (found.verdict == Finding::edge) {
            tally.widest_edge = std::max(tally.widest_edge, found.ulps);
        }
        figures.worst.push_back({chunk.group,
                                 chunk.first + static_cast<uint64_t>(i),
                                 chunk.rays.true_ray(i),
                                 chunk.expected[i],
                                 got,
                                 found});
    }
    keep_worst(figures.worst);
}

}  // namespace

const Comparison* KnownDifferences::find(int row, const Answer& got) const {
    const auto [begin, end] = by_row_.equal_range(row);
    const auto known =
        std::find_if(begin, end, [&](const auto& entry) { return entry.second.got == got; });
    return known == end ? nullptr : &known->second.comparison;
}

void KnownDifferences::add(int row, const Answer& got, const Comparison& comparison) {
    by_row_.emplace(row, Known{got, comparison});
}

void keep_worst(std::vector<Difference>& worst) {
    std::sort(worst.begin(), worst.end(), is_worse);
    if (worst.size() > most_worst) worst.resize(most_worst);
}

uint64_t Tally::unexplained() const {
    return of(Finding::depth) + of(Finding::missed) + of(Finding::false_hit);
}

void Tally::add(const Tally& other) {
    rays += other.rays;
    hits += other.hits;
    for (size_t i = 0; i < verdicts; ++i)
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
                                        AnswerList* kept,
                                        ScreenVerdicts* screen) {
    std::vector<PairFigures> all(references.size());
    for (size_t r = 0; r < references.size(); ++r) {
        all[r].got = kernel.name;
        all[r].expected = references[r]->name;
        all[r].against_truth = references[r]->is_truth;
        references[r]->known.resize(batch.chunks);
    }
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
        kernel.ask(block, answers);
        const size_t first = number * chunk_rays;
        if (kept != nullptr) std::copy(answers.begin(), answers.end(), &kept->answers[first]);
        const RayGroup group = RaySet::group(chunk);
        for (size_t r = 0; r < references.size(); ++r) {
            PairFigures mine;
            std::vector<Finding> seen(answers.size());
            compare_chunk(
                {scene,
                 block,
                 answers,
                 &references[r]->answers[first],
                 references[r]->known[number],
                 group,
                 batch.first_ray() + first},
                mine,
                [&](int row, Finding verdict) { seen[static_cast<size_t>(row)] = verdict; });
            const std::lock_guard lock(merging);
            all[r].add(mine);
            if (screen == nullptr || group != RayGroup::camera || !references[r]->is_truth) {
                continue;
            }
            for (size_t i = 0; i < seen.size(); ++i)
                note_on_screen(*screen,
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

}  // namespace obscura
