// tests/film/cryptomatte_names_test.cpp - the paths of nodes that mattes are called by.
// SPDX-License-Identifier: Apache-2.0
#include "film/cryptomatte_names.h"

#include <gtest/gtest.h>

#include <gmock/gmock.h>

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

}  // namespace
}  // namespace obscura
