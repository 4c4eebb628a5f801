// bench/machine_json.cpp - what all JSON reports of a bench have: machine, figures, changes.
// SPDX-License-Identifier: Apache-2.0
#include "bench/machine_json.h"

#include <utility>

namespace obscura::bench {

Json machine_json(const Machine& m) {
    Json caches = Json::array();
    for (const CpuCache& cache : m.caches)
        caches.push_back({{"level", cache.level}, {"type", cache.type}, {"size", cache.size}});
    return {{"cpu", m.cpu},
            {"cores", m.cores},
            {"clock_mhz", m.clock_mhz},
            {"caches", std::move(caches)},
            {"numa_nodes", m.numa_nodes},
            {"load", m.load},
            {"embree", m.embree},
            {"compiler", m.compiler},
            {"build_type", m.build_type}};
}

Json figures_json(const std::vector<Figure>& figures) {
    Json out = Json::array();
    for (const Figure& figure : figures) {
        out.push_back({{"name", figure.name},
                       {"median", figure.value.median},
                       {"low", figure.value.low},
                       {"high", figure.value.high},
                       {"count", figure.value.count}});
    }
    return out;
}

Json changes_json(const std::vector<Change>& changes) {
    Json out = Json::array();
    for (const Change& change : changes) {
        out.push_back({{"name", change.name},
                       {"verdict", verdict(change)},
                       {"old_median", change.before.median},
                       {"new_median", change.after.median}});
    }
    return out;
}

}  // namespace obscura::bench
