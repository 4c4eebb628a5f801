// gltf/problems.cpp - collects an asset's faults, then refuses it or warns.
// SPDX-License-Identifier: Apache-2.0
#include "gltf/problems.h"

#include <algorithm>
#include <utility>

namespace obscura::gltf {

namespace {

constexpr size_t max_listed = 100;

bool stops_lenient_loading(const Error& error) {
    const bool about_data = error.code == ExitCode::bad_data ||
                            error.code == ExitCode::bad_resource ||
                            error.code == ExitCode::unsupported;
    const bool broken_accessor = error.id.rfind("E-ACC-", 0) == 0 && error.id != "E-ACC-COUNT";
    return !about_data || broken_accessor;
}

}  // namespace

void Problems::count(Loss loss, size_t count) {
    if (loss == Loss::texture) lost_.textures += count;
    if (loss == Loss::primitive) lost_.primitives += count;
    if (loss == Loss::triangle) lost_.triangles += count;
}

void Problems::add(const Error& error, const Remedy& remedy) {
    if (!known_.insert(error.where + " " + error.id + " " + error.message).second) return;
    list_.push_back({error, remedy.text, stops_lenient_loading(error)});
    count(remedy.loss, remedy.count);
}

void Problems::add_final(const Error& error) {
    Error one = error;
    one.also.clear();
    list_.push_back({std::move(one), {}, true});
    for (const Error& other : error.also)
        add_final(other);
}

Result<void> Problems::refuse() const {
    std::vector<Error> errors;
    size_t found = 0;
    for (const Problem& problem : list_) {
        if (lenient_ && !problem.final) continue;
        if (++found <= max_listed) errors.push_back(problem.error);
    }
    if (errors.empty()) return {};
    if (found > max_listed) {
        const std::string text =
            std::to_string(found - max_listed) + " more problems are not listed";
        errors.push_back({errors.front().code, {}, {}, text});
    }
    return fail(joined(std::move(errors)));
}

void Problems::warn(Log& log) const {
    size_t found = 0;
    for (const Problem& problem : list_) {
        if (problem.final || ++found > max_listed) continue;
        log.warn(problem.error.where, problem.error.message + "; " + problem.remedy);
    }
    if (found > max_listed) {
        const Error& first = list_.front().error;
        log.warn(first.where.substr(0, first.where.find('#')),
                 std::to_string(found - max_listed) + " more problems are not listed");
    }
}

Result<Degraded> Problems::settle(const Error* end, Log& log) {
    if (end != nullptr) add_final(*end);
    if (lenient_) warn(log);
    const Result<void> refused = refuse();
    const Degraded lost = lost_;
    *this = Problems(lenient_);
    if (!refused) return fail(refused.error());
    return lost;
}

}  // namespace obscura::gltf
