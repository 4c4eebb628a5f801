// tests/gltf/faults_test.cpp - each fault in strict and in lenient loading.
// SPDX-License-Identifier: Apache-2.0
#include "gltf/faulty_files.h"

#include <gtest/gtest.h>

#include "support/memory_limit.h"
#include <cmath>
#include <functional>

namespace obscura::gltf {
namespace {

using namespace test;

/// A skin of one joint whose inverse bind matrix begins with a number.
void add_skin(AssetBuilder& builder, float first) {
    std::vector<float> matrix = {1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1};
    matrix[0] = first;
    const int matrices = builder.add_accessor("MAT4", 5126, matrix);
    builder.tree["skins"][0] = {{"joints", {0}}, {"inverseBindMatrices", matrices}};
    builder.tree["nodes"][0]["skin"] = 0;
}

struct Fault {
    const char* name;
    std::function<void(AssetBuilder&)> apply;
    int code;  ///< strict
    const char* id;
    const char* place;
    int lenient_code;
    Degraded lost;
};

json& primitive_of(AssetBuilder& builder) {
    return builder.tree["meshes"][0]["primitives"][0];
}

const std::vector<Fault> mesh_faults = {
    {"C3 no vertices",
     [](AssetBuilder& b) { b.tree["accessors"][3]["count"] = 0; },
     65,
     "E-ACC-COUNT",
     "#/accessors/3/count",
     0,
     {0, 1, 0}},
    {"C7 sparse index",
     [](AssetBuilder& b) {
         const int view = b.add_view(raw(std::vector<float>(4, 0)));
         const int index = b.add_view(std::string(1, 9));
         b.tree["accessors"][0]["sparse"] = {
             {"count", 1},
             {"indices", {{"bufferView", index}, {"componentType", 5121}}},
             {"values", {{"bufferView", view}}}};
     },
     65,
     "E-ACC-SPARSE",
     "#/accessors/0",
     65,
     {}},
    {"C10 vertex index",
     [](AssetBuilder& b) {
         primitive_of(b)["indices"] =
             b.add_accessor("SCALAR", 5123, std::vector<uint16_t>{0, 1, 2, 0, 1, 7});
     },
     65,
     "E-MESH-INDEX",
     "#/meshes/0/primitives/0",
     0,
     {0, 0, 1}},
    {"C11 no vertices",
     [](AssetBuilder& b) {
         primitive_of(b)["indices"] =
             b.add_accessor("SCALAR", 5123, std::vector<uint16_t>{0, 1, 2});
         b.tree["accessors"].back()["count"] = 0;
     },
     65,
     "E-ACC-COUNT",
     "#/accessors/",
     0,
     {0, 1, 0}},
    {"C12 no number",
     [](AssetBuilder& b) { set_first_float(b, 0, NAN); },
     65,
     "E-MESH-POSITION",
     "#/meshes/0/primitives/0",
     0,
     {0, 0, 1}},
    {"C13 too far",
     [](AssetBuilder& b) { set_first_float(b, 0, 2e18f); },
     65,
     "E-MESH-POSITION",
     "#/meshes/0/primitives/0",
     0,
     {0, 0, 1}},
    {"C14 counts",
     [](AssetBuilder& b) { b.tree["accessors"][1]["count"] = 2; },
     65,
     "E-MESH-COUNT",
     "#/meshes/0/primitives/0",
     0,
     {0, 1, 0}},
    {"C15 type",
     [](AssetBuilder& b) { b.tree["accessors"][1]["type"] = "VEC2"; },
     65,
     "E-MESH-ATTRIBUTE",
     "#/meshes/0/primitives/0",
     0,
     {0, 1, 0}},
    {"C22 skin",
     [](AssetBuilder& b) { add_skin(b, NAN); },
     65,
     "E-SKIN-MATRICES",
     "#/skins/0",
     0,
     {0, 1, 0}},
    {"C13 by its node",
     [](AssetBuilder& b) {
         b.tree["nodes"][0]["translation"] = {1e20, 0, 0};
     },
     65,
     "E-NODE-RANGE",
     "#/nodes/0",
     0,
     {0, 1, 0}},
    {"F5 texture coordinates",
     [](AssetBuilder& b) { primitive_of(b)["attributes"].erase("TEXCOORD_0"); },
     65,
     "E-MESH-TEXCOORD",
     "#/meshes/0/primitives/0",
     0,
     {}},
};

std::function<void(AssetBuilder&)> image(const std::string& uri) {
    return [uri](AssetBuilder& b) { b.tree["images"][0]["uri"] = uri; };
}

std::function<void(AssetBuilder&)> png_image(const std::string& bytes) {
    return image("data:image/png;base64," + base64(bytes));
}

const std::vector<Fault> file_faults = {
    {"D1 missing", image("absent.png"), 67, "E-RES-MISSING", "#/images/0", 0, {1, 0, 0}},
    {"D3 truncated",
     png_image(png_bytes(4, 4).substr(0, 60)),
     67,
     "E-IMG-CORRUPT",
     "#/images/0",
     0,
     {1, 0, 0}},
    {"D16 no picture",
     png_image("II*\0 TIFF data"),
     67,
     "E-IMG-FORMAT",
     "#/images/0",
     0,
     {1, 0, 0}},
    {"D14 escape", image("../a.png"), 77, "E-URI-REFUSED", "#/images/0", 77, {}},
    {"F1 extension",
     [](AssetBuilder& b) { b.tree["extensionsRequired"] = {"EXT_wishful"}; },
     69,
     "E-EXT-REQUIRED",
     "#/extensionsRequired",
     0,
     {}},
    {"C1 view",
     [](AssetBuilder& b) { b.tree["bufferViews"][0]["byteLength"] = 100000; },
     65,
     "E-BUF-RANGE",
     "#/bufferViews/0",
     65,
     {}},
    {"B10 version",
     [](AssetBuilder& b) { b.tree["asset"]["version"] = "3.0"; },
     69,
     "E-VERSION",
     "#/asset",
     69,
     {}},
};

void expect_fault(const Fault& fault) {
    SCOPED_TRACE(fault.name);
    AssetBuilder builder = textured_builder();
    fault.apply(builder);
    const json tree = builder.finished();
    const Loaded strict = load_tree(tree);
    EXPECT_EQ(strict.code(), fault.code) << strict.text();
    EXPECT_EQ(strict.id(), fault.id) << strict.text();
    EXPECT_NE(strict.text().find(fault.place), std::string::npos) << strict.text();
    const LenientlyLoaded lenient = load_leniently(tree);
    EXPECT_EQ(lenient.code(), fault.lenient_code) << lenient.text();
    if (!lenient.scene) {
        EXPECT_EQ(lenient.id(), fault.id);
        return;
    }
    EXPECT_NE(lenient.warnings, "");
    EXPECT_EQ(lenient.lost.textures, fault.lost.textures);
    EXPECT_EQ(lenient.lost.primitives, fault.lost.primitives);
    EXPECT_EQ(lenient.lost.triangles, fault.lost.triangles);
}

/// Strictly the accessor is the fault; leniently the primitive is one, E-MESH-EMPTY, and left out.
TEST(Faults, PrimitivesWithoutVerticesAreLeftOut) {
    AssetBuilder builder = textured_builder();
    primitive_of(builder)["indices"] =
        builder.add_accessor("SCALAR", 5123, std::vector<uint16_t>{0, 1, 2});
    builder.tree["accessors"].back()["count"] = 0;
    const LenientlyLoaded lenient = load_leniently(builder.finished());
    ASSERT_TRUE(lenient.scene) << lenient.text();
    EXPECT_TRUE(lenient.warns("#/meshes/0/primitives/0: the primitive has no vertices"))
        << lenient.warnings;
}

TEST(Faults, NoMemoryIsAnErrorOfItsOwn) {
    AssetBuilder builder;
    builder.add_accessor("VEC3", 5126, std::vector<float>(30000));
    builder.add_mesh({{"attributes", {{"POSITION", 0}}}});
    builder.add_root({{"mesh", 0}});
    const TempFolder folder;
    std::ofstream(folder.path() / "scene.gltf") << builder.finished().dump();
    Log log(Verbosity::quiet);
    const obscura::test::MemoryLimit limit(50000);
    const Result<Scene> scene = load_gltf(folder.path() / "scene.gltf", {}, log);
    ASSERT_FALSE(scene);
    EXPECT_EQ(scene.error().id, "E-MEMORY") << scene.error().message;
    EXPECT_EQ(scene.error().code, ExitCode::out_of_memory);
}

TEST(Faults, OfMeshes) {
    for (const Fault& fault : mesh_faults)
        expect_fault(fault);
}

TEST(Faults, OfFiles) {
    for (const Fault& fault : file_faults)
        expect_fault(fault);
}

}  // namespace
}  // namespace obscura::gltf
