// tests/stages/path_state_test.cpp - the table in stages/path_state.h agrees with the types.
// SPDX-License-Identifier: Apache-2.0
#include "stages/stages.h"

#include <gtest/gtest.h>

#include <fstream>
#include <map>
#include <set>
#include <sstream>
#include <string>
#include <type_traits>

namespace obscura::test {
namespace {

/// The columns that a stage may write, of those that it gets.
using Access = std::map<std::string, bool>;

template <typename T>
struct Type {};

template <typename F>
void note(Type<PathColumnsOf<F>>, Access& access) {
    access["PathColumns"] |= !std::is_const_v<F>;
}
template <typename F>
void note(Type<HitColumnsOf<F>>, Access& access) {
    access["HitColumns"] |= !std::is_const_v<F>;
}
template <typename F>
void note(Type<MissColumnsOf<F>>, Access& access) {
    access["MissColumns"] |= !std::is_const_v<F>;
}
template <typename F>
void note(Type<ShadowColumnsOf<F>>, Access& access) {
    access["ShadowColumns"] |= !std::is_const_v<F>;
}
template <typename F>
void note(Type<SampleColumnsOf<F>>, Access& access) {
    access["SampleColumns"] |= !std::is_const_v<F>;
}
template <typename Other>
void note(Type<Other>, Access&) {}

template <typename... Members>
void note_members(Access& access, const Members&...) {
    (note(Type<Members>(), access), ...);
}

// All members: one more would not compile.
void note(Type<ShadeColumns>, Access& access) {
    const auto& [a, b, c, d, e, f, g, h, i, j, k, l, m] = ShadeColumns{};
    note_members(access, a, b, c, d, e, f, g, h, i, j, k, l, m);
}
void note(Type<RaycastColumns>, Access& access) {
    const auto& [a, b, c, d, e, f] = RaycastColumns{};
    note_members(access, a, b, c, d, e, f);
}
void note(Type<AovColumns>, Access& access) {
    const auto& [a, b, c, d, e, f] = AovColumns{};
    note_members(access, a, b, c, d, e, f);
}
void note(Type<AlbedoColumns>, Access& access) {
    const auto& [a, b, c, d, e, f, g, h] = AlbedoColumns{};
    note_members(access, a, b, c, d, e, f, g, h);
}
void note(Type<WireframeColumns>, Access& access) {
    const auto& [a, b, c, d] = WireframeColumns{};
    note_members(access, a, b, c, d);
}
void note(Type<ThinWallColumns>, Access& access) {
    const auto& [a, b, c, d, e] = ThinWallColumns{};
    note_members(access, a, b, c, d, e);
}
void note(Type<ShadowMediaColumns>, Access& access) {
    const auto& [a, b, c, d] = ShadowMediaColumns{};
    note_members(access, a, b, c, d);
}
void note(Type<CatcherColumns>, Access& access) {
    const auto& [a, b, c, d, e, f, g, h, i, j, k, l] = CatcherColumns{};
    note_members(access, a, b, c, d, e, f, g, h, i, j, k, l);
}
void note(Type<ScatterStart>, Access& access) {
    const auto& [a, b, c, d, e] = ScatterStart{};
    note_members(access, a, b, c, d, e);
}
void note(Type<ScatterColumns>, Access& access) {
    const auto& [a, b, c, d, e, f, g, h, i, j] = ScatterColumns{};
    note_members(access, a, b, c, d, e, f, g, h, i, j);
}
void note(Type<ProbeColumns>, Access& access) {
    const auto& [a, b, c, d, e, f] = ProbeColumns{};
    note_members(access, a, b, c, d, e, f);
}

/// Stages by their effect on columns: "PathColumns written".
using Table = std::map<std::string, std::set<std::string>>;

template <typename Result, typename... Arguments>
void add_stage(const std::string& name, Result (*StageTable::*)(Arguments...), Table& table) {
    Access access;
    (note(Type<std::remove_cvref_t<Arguments>>(), access), ...);
    for (const auto& [columns, writes] : access)
        table[columns + (writes ? " written:" : " read:")].insert(name);
}

Table table_of_types() {
    using S = StageTable;
    Table table;
    add_stage("camera", &S::camera, table);
    add_stage("centre_camera", &S::centre_camera, table);
    add_stage("open_shutter", &S::open_shutter, table);
    add_stage("begin_scatter", &S::begin_scatter, table);
    add_stage("scatter", &S::scatter, table);
    add_stage("make_probes", &S::make_probes, table);
    add_stage("shade", &S::shade, table);
    add_stage("shade_catchers", &S::shade_catchers, table);
    add_stage("shade_ao", &S::shade_ao, table);
    add_stage("begin_raycast", &S::begin_raycast, table);
    add_stage("shade_raycast", &S::shade_raycast, table);
    add_stage("aovs", &S::aovs, table);
    add_stage("follow_albedo", &S::follow_albedo, table);
    add_stage("wireframe", &S::wireframe, table);
    add_stage("absorb_shadows", &S::absorb_shadows, table);
    add_stage("take_waiting", &S::take_waiting, table);
    add_stage("cross_thin_walls", &S::cross_thin_walls, table);
    add_stage("add_shadows", &S::add_shadows, table);
    add_stage("add_shadow_layers", &S::add_shadow_layers, table);
    add_stage("accumulate", &S::accumulate, table);
    add_stage("clear_nonfinite", &S::clear_nonfinite, table);
    return table;
}

/// The head of path_state.h, without the slashes.
std::string head_of_path_state() {
    std::ifstream in(std::string(OBSCURA_SOURCE_DIR) + "/src/stages/path_state.h");
    std::string head;
    for (std::string line; std::getline(in, line) && line.rfind("//", 0) == 0;)
        head += line.substr(2) + "\n";
    return head;
}

Table table_of_head(const std::string& head, std::map<std::string, int>& bytes) {
    Table table;
    std::string columns;
    std::string access;
    std::istringstream words(head.substr(head.find("PathColumns")));
    for (std::string word; words >> word && word != "A";) {
        if (word.ends_with("Columns")) {
            columns = word;
            access.clear();
            words >> bytes[word];
        } else if (word.ends_with(":")) {
            access = word;
        } else if (!access.empty() && word != "only") {
            table[columns + " " + access].insert(word);
        }
    }
    return table;
}

TEST(PathState, TheTableSaysWhoMayWriteWhat) {
    std::map<std::string, int> bytes;
    const Table head = table_of_head(head_of_path_state(), bytes);
    EXPECT_EQ(head, table_of_types());
    const std::map<std::string, int> expected = {
        {"PathColumns", 4 * column_count<PathColumns>},
        {"HitColumns", 4 * column_count<HitColumns>},
        {"MissColumns", 4 * column_count<MissColumns>},
        {"ShadowColumns", 4 * column_count<ShadowColumns>},
        {"SampleColumns", 4 * column_count<SampleColumns>}};
    EXPECT_EQ(bytes, expected);
}

}  // namespace
}  // namespace obscura::test
