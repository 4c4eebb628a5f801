// app/other_parts.cpp - what other parts of a command render, for names that are theirs.
// SPDX-License-Identifier: Apache-2.0
#include "app/other_parts.h"

#include "app/before_its_turn.h"
#include "session/image_list.h"
#include "session/image_names.h"
#include "session/outputs.h"

#include <algorithm>
#include <cstdint>
#include <system_error>
#include <utility>

namespace obscura::app {

namespace {

/// What the names of all files of a rendering look like, before its asset is opened.
std::vector<NameShape> shapes_of(const RenderRequest& request) {
    NameFields fields;
    fields.asset = asset_name(request);
    fields.look = request.lists.look;
    ListedImage patterns;
    patterns.outputs = request.outputs;
    patterns.segmentation = request.segmentation;
    std::vector<NameShape> out;
    std::error_code ignored;
    for (const std::filesystem::path& pattern : all_files(request, patterns))
        out.emplace_back(std::filesystem::absolute(pattern, ignored), fields);
    return out;
}

bool may_share_files(const std::vector<NameShape>& a, const std::vector<NameShape>& b) {
    return std::any_of(a.begin(), a.end(), [&](const NameShape& one) {
        return std::any_of(
            b.begin(), b.end(), [&](const NameShape& other) { return one.may_equal(other); });
    });
}

}  // namespace

OtherParts::OtherParts(std::vector<SceneRun>& runs) {
    std::vector<Other> others;
    size_t own = 0;
    for (const SceneRun& run : runs) {
        if (run.is_of_another_part) {
            others.push_back({run, own});
        } else {
            ++own;
        }
    }
    if (others.empty()) return;
    std::erase_if(runs, [](const SceneRun& run) { return run.is_of_another_part; });
    std::vector<std::vector<NameShape>> shapes;
    for (const SceneRun& run : runs)
        shapes.push_back(shapes_of(run.request));
    for (Other& other : others) {
        const std::vector<NameShape> names = shapes_of(other.run.request);
        const bool may_share = std::any_of(
            shapes.begin() + static_cast<long>(other.next),
            shapes.end(),
            [&](const std::vector<NameShape>& later) { return may_share_files(names, later); });
        if (may_share) others_.push_back(std::move(other));
    }
}

void OtherParts::note_files_before(size_t next, KeptForLater& kept) const {
    for (size_t i = 0; i < others_.size(); ++i) {
        if (others_[i].next != next) continue;
        kept.run = SIZE_MAX - 1 - i;  // a number that no rendering of this part has
        (void)do_before_its_turn(others_[i].run, kept, note_all_files);
    }
}

}  // namespace obscura::app
