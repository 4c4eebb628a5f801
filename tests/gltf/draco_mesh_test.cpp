// tests/gltf/draco_mesh_test.cpp - Draco-compressed primitives decode to the original.
// SPDX-License-Identifier: Apache-2.0
#include "gltf/decode/draco_mesh.h"

#include "gltf/gltf_files.h"

#include <gtest/gtest.h>

#include "support/random.h"
#include <array>
#include <cmath>
#include <draco/compression/encode.h>
#include <set>

namespace obscura::gltf {
namespace {

using namespace test;

constexpr int side = 9;  ///< vertices along an edge of the wavy sheet

struct Sheet {
    std::vector<float> positions;
    std::vector<float> normals;
    std::vector<float> uvs;       ///< number of the vertex: (column, row) / side
    std::vector<uint8_t> colors;  ///< VEC4
    std::vector<std::array<uint32_t, 3>> triangles;
};

Sheet make_sheet(int n = side) {
    Sheet out;
    for (int i = 0; i < n * n; ++i) {
        const float x = static_cast<float>(i % n) / static_cast<float>(side);
        const float y = static_cast<float>(i / n) / static_cast<float>(side);
        const float slope = 0.5f * std::cos(5 * x);
        const float length = std::sqrt(1 + slope * slope);
        out.positions.insert(out.positions.end(), {x, y, 0.1f * std::sin(5 * x)});
        out.normals.insert(out.normals.end(), {-slope / length, 0, 1 / length});
        out.uvs.insert(out.uvs.end(), {x, y});
        for (const int value : {i * 3, i * 7, i, 255})
            out.colors.push_back(static_cast<uint8_t>(value));
    }
    for (int row = 0; row + 1 < n; ++row) {
        for (int column = 0; column + 1 < n; ++column) {
            const auto a = static_cast<uint32_t>(row * n + column);
            const auto b = a + static_cast<uint32_t>(n);
            out.triangles.push_back({a, a + 1, b});
            out.triangles.push_back({b, a + 1, b + 1});
        }
    }
    return out;
}

/// Adds an attribute; returns its unique id.
template <typename T>
int add_attribute(draco::Mesh& mesh,
                  draco::GeometryAttribute::Type type,
                  draco::DataType data_type,
                  const std::vector<T>& values) {
    const auto count = mesh.num_points();
    const size_t width = values.size() / count;
    draco::GeometryAttribute shape;
    shape.Init(type,
               nullptr,
               static_cast<uint8_t>(width),
               data_type,
               std::is_integral_v<T>,
               static_cast<int64_t>(width * sizeof(T)),
               0);
    const int id = mesh.AddAttribute(shape, true, count);
    for (uint32_t v = 0; v < count; ++v)
        mesh.attribute(id)->SetAttributeValue(draco::AttributeValueIndex(v), &values[v * width]);
    return static_cast<int>(mesh.attribute(id)->unique_id());
}

struct Encoded {
    std::string data;
    size_t vertices = 0;
};

Encoded encode_sheet(const Sheet& sheet, draco::MeshEncoderMethod method) {
    draco::Mesh mesh;
    mesh.set_num_points(static_cast<uint32_t>(sheet.positions.size() / 3));
    for (const auto& [a, b, c] : sheet.triangles)
        mesh.AddFace({draco::PointIndex(a), draco::PointIndex(b), draco::PointIndex(c)});
    using draco::GeometryAttribute;
    add_attribute(mesh, GeometryAttribute::POSITION, draco::DT_FLOAT32, sheet.positions);
    add_attribute(mesh, GeometryAttribute::NORMAL, draco::DT_FLOAT32, sheet.normals);
    add_attribute(mesh, GeometryAttribute::TEX_COORD, draco::DT_FLOAT32, sheet.uvs);
    add_attribute(mesh, GeometryAttribute::COLOR, draco::DT_UINT8, sheet.colors);
    draco::Encoder encoder;
    encoder.SetEncodingMethod(method);
    encoder.SetTrackEncodedProperties(true);
    encoder.SetAttributeQuantization(GeometryAttribute::POSITION, 16);
    encoder.SetAttributeQuantization(GeometryAttribute::NORMAL, 12);
    encoder.SetAttributeQuantization(GeometryAttribute::TEX_COORD, 14);
    draco::EncoderBuffer buffer;
    EXPECT_TRUE(encoder.EncodeMeshToBuffer(mesh, &buffer).ok());
    return {{buffer.data(), buffer.size()}, encoder.num_encoded_points()};
}

/// An asset with one primitive that only Draco holds: accessors 0 to 3 are POSITION, NORMAL,
/// TEXCOORD_0 and COLOR_0, 4 are the indices.
json draco_asset(const Encoded& encoded, size_t triangles) {
    AssetBuilder builder;
    const int view = builder.add_view(encoded.data);
    for (const char* type : {"VEC3", "VEC3", "VEC2", "VEC4"}) {
        const bool color = std::string(type) == "VEC4";
        builder.tree["accessors"].push_back({{"componentType", color ? 5121 : 5126},
                                             {"normalized", color},
                                             {"count", encoded.vertices},
                                             {"type", type}});
    }
    builder.tree["accessors"][0]["min"] = {0, 0, -1};
    builder.tree["accessors"][0]["max"] = {1, 1, 1};
    builder.tree["accessors"].push_back(
        {{"componentType", 5125}, {"count", 3 * triangles}, {"type", "SCALAR"}});
    json primitive = {
        {"attributes", {{"POSITION", 0}, {"NORMAL", 1}, {"TEXCOORD_0", 2}, {"COLOR_0", 3}}},
        {"indices", 4},
        {"material", 0}};
    primitive["extensions"]["KHR_draco_mesh_compression"] = {
        {"bufferView", view},
        {"attributes", {{"POSITION", 0}, {"NORMAL", 1}, {"TEXCOORD_0", 2}, {"COLOR_0", 3}}}};
    builder.add_mesh(primitive);
    builder.add_root({{"mesh", 0}});
    json tree = builder.finished();
    // A texture, so that the UVs are wanted.
    tree["images"][0]["uri"] =
        "data:image/png;base64,iVBORw0KGgoAAAANSUhEUgAAAAEAAAABCAYAAAAfFcSJAAAADUlEQVR42mP8/"
        "5+hHgAHggJ/PchI7wAAAABJRU5ErkJggg==";
    tree["textures"][0]["source"] = 0;
    tree["materials"][0]["pbrMetallicRoughness"]["baseColorTexture"]["index"] = 0;
    tree["extensionsRequired"] = {"KHR_draco_mesh_compression"};
    return tree;
}

/// The sheet's vertex whose texture coordinates these are.
uint32_t vertex_at(const std::vector<float>& uv) {
    const long column = std::lround(uv[0] * side);
    const long row = std::lround(uv[1] * side);
    return static_cast<uint32_t>(row * side + column);
}

/// Compares a scene's vertex with the sheet's; returns the latter's number.
uint32_t expect_vertex(const Scene& scene, const Sheet& sheet, uint32_t vertex) {
    const Primitive& primitive = scene.primitives[0];
    const uint32_t v = vertex_at(attribute_of(scene, primitive.uv_base[0], vertex, 2));
    const std::vector<float> position = position_of(scene, vertex);
    const std::vector<float> normal = attribute_of(scene, primitive.normal_base, vertex, 3);
    const std::vector<float> color = attribute_of(scene, primitive.color_base, vertex, 4);
    for (size_t axis = 0; axis < 3; ++axis) {
        EXPECT_NEAR(position[axis], sheet.positions[3 * v + axis], 2e-5);
        EXPECT_NEAR(normal[axis], sheet.normals[3 * v + axis], 2e-3);
    }
    for (size_t channel = 0; channel < 4; ++channel)
        EXPECT_FLOAT_EQ(color[channel], static_cast<float>(sheet.colors[4 * v + channel]) / 255.0f);
    return v;
}

std::array<uint32_t, 3> turned(std::array<uint32_t, 3> t) {
    while (t[0] > t[1] || t[0] > t[2])
        t = {t[1], t[2], t[0]};
    return t;
}

TEST(DracoMesh, HoldsTheUncompressedMesh) {
    const Sheet sheet = make_sheet();
    std::set<std::array<uint32_t, 3>> expected;
    for (const auto& triangle : sheet.triangles)
        expected.insert(turned(triangle));
    for (const auto method : {draco::MESH_SEQUENTIAL_ENCODING, draco::MESH_EDGEBREAKER_ENCODING}) {
        const Loaded loaded =
            load_tree(draco_asset(encode_sheet(sheet, method), sheet.triangles.size()));
        ASSERT_TRUE(loaded.scene) << loaded.text();
        EXPECT_EQ(loaded.warnings, "");
        const Scene& scene = *loaded.scene;
        std::set<std::array<uint32_t, 3>> got;
        for (size_t t = 0; t < sheet.triangles.size(); ++t) {
            std::array<uint32_t, 3> triangle = {};
            for (size_t corner = 0; corner < 3; ++corner)
                triangle[corner] = expect_vertex(scene, sheet, scene.indices[3 * t + corner]);
            got.insert(turned(triangle));
        }
        EXPECT_EQ(got, expected);
    }
}

/// Draco stores triangles; the original strip may have any number of indices.
TEST(DracoMesh, StripsAreListsOfTriangles) {
    const Sheet sheet = make_sheet();
    json tree = draco_asset(encode_sheet(sheet, draco::MESH_EDGEBREAKER_ENCODING),
                            sheet.triangles.size() + 20);
    tree["meshes"][0]["primitives"][0]["mode"] = 5;
    const Loaded loaded = load_tree(tree);
    ASSERT_TRUE(loaded.scene) << loaded.text();
    EXPECT_EQ(loaded.scene->info.triangles_in_world, sheet.triangles.size());
}

/// Attributes that the compressed data lack are read as usual.
TEST(DracoMesh, AttributesBesideTheCompressedOnesAreRead) {
    const Sheet sheet = make_sheet();
    const Encoded encoded = encode_sheet(sheet, draco::MESH_SEQUENTIAL_ENCODING);
    json tree = draco_asset(encoded, sheet.triangles.size());
    json& primitive = tree["meshes"][0]["primitives"][0];
    primitive["extensions"]["KHR_draco_mesh_compression"]["attributes"].erase("COLOR_0");
    const std::string colors(encoded.vertices * 4, '\x33');
    tree["buffers"].push_back({{"byteLength", colors.size()},
                               {"uri", "data:application/octet-stream;base64," + base64(colors)}});
    tree["bufferViews"].push_back({{"buffer", 1}, {"byteLength", colors.size()}});
    tree["accessors"][3]["bufferView"] = 1;
    const Loaded loaded = load_tree(tree);
    ASSERT_TRUE(loaded.scene) << loaded.text();
    EXPECT_EQ(attribute_of(*loaded.scene, loaded.scene->primitives[0].color_base, 5, 4),
              (std::vector<float>(4, 0.2f)));
}

TEST(DracoMesh, DisagreementsAreErrors) {
    const Sheet sheet = make_sheet();
    const json good =
        draco_asset(encode_sheet(sheet, draco::MESH_EDGEBREAKER_ENCODING), sheet.triangles.size());
    const std::string primitive = "/meshes/0/primitives/0";
    const std::string draco = primitive + "/extensions/KHR_draco_mesh_compression";
    struct Case {
        std::string pointer;
        json value;
        const char* id;
    };
    for (const Case& c : {Case{"/accessors/0/count", 7, "E-DRACO-DATA"},
                          Case{"/accessors/1/count", 500, "E-DRACO-DATA"},
                          Case{"/accessors/4/count", 3, "E-DRACO-DATA"},
                          Case{"/accessors/4/count", 1ULL << 40, "E-DRACO-DATA"},
                          Case{"/accessors/2/type", "VEC3", "E-DRACO-DATA"},
                          Case{"/accessors/1/componentType", 5120, "E-MESH-ATTRIBUTE"},
                          Case{"/accessors/0/count", 1ULL << 40, "E-LIMIT-VERTICES"},
                          Case{primitive + "/mode", 1, "E-DRACO-MODE"},
                          Case{draco + "/attributes/NORMAL", 9, "E-DRACO-DATA"},
                          Case{draco + "/attributes/NORMAL", -1, "E-JSON-TYPE"},
                          Case{draco + "/attributes/TANGENT", 2, "E-DRACO-DATA"},
                          Case{draco + "/bufferView", 3, "E-DOC-INDEX"}}) {
        json tree = good;
        tree[json::json_pointer(c.pointer)] = c.value;
        const Loaded loaded = load_tree(tree);
        EXPECT_EQ(loaded.id(), c.id) << c.pointer << ' ' << c.value << ": " << loaded.text();
        EXPECT_NE(loaded.text().find("#" + primitive), std::string::npos) << loaded.text();
    }
    json tree = good;
    tree["meshes"][0]["primitives"][0].erase("indices");
    EXPECT_EQ(load_tree(tree).id(), "E-DRACO-DATA");
}

TEST(DracoMesh, CorruptDataAreErrors) {
    const Sheet sheet = make_sheet();
    Pcg32 random(12);
    for (const auto method : {draco::MESH_SEQUENTIAL_ENCODING, draco::MESH_EDGEBREAKER_ENCODING}) {
        const Encoded good = encode_sheet(sheet, method);
        for (size_t length = 1; length < good.data.size(); length += 7) {
            const Encoded cut{good.data.substr(0, length), good.vertices};
            const Loaded loaded = load_tree(draco_asset(cut, sheet.triangles.size()));
            EXPECT_EQ(loaded.id(), "E-DRACO-DATA") << length;
        }
        for (int i = 0; i < 300; ++i) {  // any answer, but always one
            Encoded damaged = good;
            for (int flips = 0; flips < 2; ++flips) {
                damaged.data[11 + random.next_uint() % (good.data.size() - 11)] =
                    static_cast<char>(random.next_uint());
            }
            const Loaded loaded = load_tree(draco_asset(damaged, sheet.triangles.size()));
            if (!loaded.scene) {
                EXPECT_TRUE(loaded.code() == 65 || loaded.code() == 69) << loaded.text();
            }
        }
        Encoded old = good;
        old.data[6] = 1;
        const Loaded loaded = load_tree(draco_asset(old, sheet.triangles.size()));
        EXPECT_EQ(loaded.id(), "E-DRACO-VERSION");
        EXPECT_EQ(loaded.code(), 69);
    }
}

/// A few bytes must not allocate gigabytes, even where the accessors agree.
TEST(DracoMesh, MoreTrianglesThanBytesCanHoldAreRefused) {
    std::string data("DRACO\x02\x02\x01\x01\0\0", 11);
    data += std::string("\0\x80\x80\x80\x20\x80\x80\x80\x20", 9);  // 2^26 vertices and triangles
    const Loaded loaded = load_tree(draco_asset({data, 1U << 26}, 1U << 26));
    EXPECT_EQ(loaded.id(), "E-LIMIT-DECODED") << loaded.text();
    EXPECT_EQ(loaded.code(), 77);
}

/// The most regular possible mesh stays far from that limit.
TEST(DracoMesh, FlatGridsAreNotRefused) {
    constexpr int large = 400;
    Sheet sheet = make_sheet(large);
    for (size_t i = 2; i < sheet.positions.size(); i += 3)
        sheet.positions[i] = 0;
    sheet.normals.assign(sheet.normals.size(), 0);
    sheet.colors.assign(sheet.colors.size(), 255);
    for (size_t i = 2; i < sheet.normals.size(); i += 3)
        sheet.normals[i] = 1;
    const Encoded encoded = encode_sheet(sheet, draco::MESH_EDGEBREAKER_ENCODING);
    const Loaded loaded = load_tree(draco_asset(encoded, sheet.triangles.size()));
    ASSERT_TRUE(loaded.scene) << loaded.text();
    EXPECT_LT(sheet.triangles.size() / encoded.data.size(), 1000U);
}

}  // namespace
}  // namespace obscura::gltf
