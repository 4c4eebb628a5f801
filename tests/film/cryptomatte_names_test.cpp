// tests/film/cryptomatte_names_test.cpp - the paths of nodes that mattes are called by.
// SPDX-License-Identifier: Apache-2.0
#include "film/cryptomatte_names.h"

#include <gtest/gtest.h>

#include <gmock/gmock.h>
#include <set>

namespace obscura {
namespace {

using testing::ElementsAre;

TEST(CryptomatteNames, PathsLeadFromTheRoot) {
    AssetInfo info;
    info.node_names = {"shade", "room", "lamp"};
    info.node_parents = {2, -1, 1};
    EXPECT_THAT(node_paths(info), ElementsAre("/room/lamp/shade", "/room", "/room/lamp"));
}

TEST(CryptomatteNames, SiblingsOfOneNameHaveMattesOfTheirOwn) {
    Scene scene;
    scene.info.node_names = {"lamp", "lamp", "shade", "shade", "lamp", "lamp (2)"};
    scene.info.node_parents = {-1, -1, 0, 1, -1, -1};
    EXPECT_THAT(
        node_paths(scene.info),
        ElementsAre(
            "/lamp", "/lamp (2)", "/lamp/shade", "/lamp (2)/shade", "/lamp (3)", "/lamp (2) (2)"));
    const CryptomatteTables tables = cryptomatte_tables(scene);
    EXPECT_EQ(tables.assets[3], "/lamp");
    EXPECT_EQ(tables.assets[4], "/lamp (2)");
}

TEST(CryptomatteNames, PathsOfLongChainsAreCutAtTheirRoots) {
    constexpr int nodes = 100'000;
    Scene scene;
    scene.info.node_names.assign(nodes, "arm");
    scene.info.node_parents.resize(nodes);
    for (int node = 0; node < nodes; ++node)
        scene.info.node_parents[static_cast<size_t>(node)] = node + 1 < nodes ? node + 1 : -1;
    const std::vector<std::string> paths = node_paths(scene.info);
    EXPECT_EQ(paths.back(), "/arm");
    EXPECT_EQ(paths[nodes - 2], "/arm/arm");
    EXPECT_EQ(paths[nodes - 250].size(), 1000U);
    EXPECT_EQ(paths[nodes - 251], "/.../arm");
    EXPECT_EQ(paths[nodes - 252], "/.../arm/arm");
    EXPECT_EQ(std::set<std::string>(paths.begin(), paths.end()).size(), paths.size());
    EXPECT_EQ(cryptomatte_tables(scene).assets[1], "/arm");
}

}  // namespace
}  // namespace obscura
