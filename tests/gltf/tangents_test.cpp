// tests/gltf/tangents_test.cpp - MikkTSpace tangents on shapes whose answer is known.
// SPDX-License-Identifier: Apache-2.0
#include "gltf/geometry/tangents.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <initializer_list>
#include <limits>
#include <numbers>

namespace obscura::gltf {
namespace {

using Vec = std::array<double, 3>;

double dot_of(const Vec& a, const Vec& b) {
    return a[0] * b[0] + a[1] * b[1] + a[2] * b[2];
}

/// Vertex arrays that a test fills in.
struct Model {
    std::vector<float> positions, normals, uvs;
    std::vector<uint32_t> indices;

    uint32_t add(const Vec& position, const Vec& normal, double u, double v) {
        for (const double x : position)
            positions.push_back(static_cast<float>(x));
        for (const double x : normal)
            normals.push_back(static_cast<float>(x));
        uvs.push_back(static_cast<float>(u));
        uvs.push_back(static_cast<float>(v));
        return static_cast<uint32_t>(positions.size() / 3 - 1);
    }
    void triangle(uint32_t a, uint32_t b, uint32_t c) { indices.insert(indices.end(), {a, b, c}); }
    std::vector<float> tangents() const {
        return make_tangents({positions, normals, uvs, indices});
    }
    Vec normal(size_t corner) const {
        const size_t v = indices[corner];
        return {normals[3 * v], normals[3 * v + 1], normals[3 * v + 2]};
    }
};

Vec tangent(const std::vector<float>& tangents, size_t corner) {
    return {tangents[4 * corner], tangents[4 * corner + 1], tangents[4 * corner + 2]};
}

void expect_tangent(const std::vector<float>& tangents,
                    size_t corner,
                    const Vec& direction,
                    float w) {
    const Vec got = tangent(tangents, corner);
    for (size_t c = 0; c < 3; ++c)
        EXPECT_NEAR(got[c], direction[c], 1e-6) << "corner " << corner;
    EXPECT_EQ(tangents[4 * corner + 3], w) << "corner " << corner;
}

void expect_unit_and_orthogonal(const Model& model, const std::vector<float>& tangents) {
    ASSERT_EQ(tangents.size(), 4 * model.indices.size());
    for (size_t corner = 0; corner < model.indices.size(); ++corner) {
        const Vec t = tangent(tangents, corner);
        EXPECT_NEAR(dot_of(t, t), 1.0, 1e-5) << "corner " << corner;
        EXPECT_NEAR(dot_of(t, model.normal(corner)), 0.0, 1e-5) << "corner " << corner;
        EXPECT_EQ(std::fabs(tangents[4 * corner + 3]), 1.0f) << "corner " << corner;
    }
}

constexpr Vec up_z = {0, 0, 1};

/// The quad [x0, x1] x [0, 1] in z = 0, seen from +z; u runs from u0 to u1, v from 1 up to 0.
void add_quad(Model& model, double x0, double x1, double u0, double u1) {
    const uint32_t a = model.add({x0, 0, 0}, up_z, u0, 1);
    const uint32_t b = model.add({x1, 0, 0}, up_z, u1, 1);
    const uint32_t c = model.add({x1, 1, 0}, up_z, u1, 0);
    const uint32_t d = model.add({x0, 1, 0}, up_z, u0, 0);
    model.triangle(a, b, c);
    model.triangle(a, c, d);
}

TEST(Tangents, UprightImageOnAPlaneHasTangentXAndBitangentUp) {
    Model model;
    add_quad(model, 0, 1, 0, 1);
    const std::vector<float> tangents = model.tangents();
    // cross(+z, +x) * 1 = +y, where the image's upper edge (v = 0) is.
    for (size_t corner = 0; corner < 6; ++corner)
        expect_tangent(tangents, corner, {1, 0, 0}, 1);
}

TEST(Tangents, RotatedAndScaledUvsTurnTheTangent) {
    Model model;
    const uint32_t a = model.add({0, 0, 0}, up_z, 0, 0);
    const uint32_t b = model.add({2, 0, 0}, up_z, 0, -3);  // v decreases along +x: it is "up"
    const uint32_t c = model.add({0, 2, 0}, up_z, -5, 0);  // u grows along -y
    model.triangle(a, b, c);
    const std::vector<float> tangents = model.tangents();
    for (size_t corner = 0; corner < 3; ++corner)
        expect_tangent(tangents, corner, {0, -1, 0}, 1);
}

TEST(Tangents, MirroredHalvesMeetWithoutAveraging) {
    Model model;
    add_quad(model, 0, 1, 0, 1);
    add_quad(model, 1, 2, 1, 0);  // shares position, normal and UV at x = 1
    const std::vector<float> tangents = model.tangents();
    for (size_t corner = 0; corner < 6; ++corner)
        expect_tangent(tangents, corner, {1, 0, 0}, 1);
    for (size_t corner = 6; corner < 12; ++corner) {
        expect_tangent(tangents, corner, {-1, 0, 0}, -1);
    }
}

TEST(Tangents, SplitVerticesWithEqualDataGiveTheSameAsSharedOnes) {
    Model shared;
    const uint32_t a = shared.add({0, 0, 0}, up_z, 0, 1);
    const uint32_t b = shared.add({1, 0, 0}, up_z, 1.3, 1);
    const uint32_t c = shared.add({1, 1, 0}, up_z, 1, 0.1);
    const uint32_t d = shared.add({-0.2, 1, 0}, up_z, 0, 0);
    shared.triangle(a, b, c);
    shared.triangle(a, c, d);
    Model split;
    for (const uint32_t v : shared.indices) {
        const float* p = shared.positions.data() + 3 * v;
        // -0 equals 0 and must weld to it.
        split.add(
            {p[0], p[1], p[2] == 0 ? -0.0 : p[2]}, up_z, shared.uvs[2 * v], shared.uvs[2 * v + 1]);
        split.indices.push_back(static_cast<uint32_t>(split.indices.size()));
    }
    const std::vector<float> tangents = shared.tangents();
    EXPECT_EQ(tangents, split.tangents());
    EXPECT_EQ(tangent(tangents, 0), tangent(tangents, 3)) << "both triangles average at a";
    EXPECT_NE(tangent(tangents, 1), tangent(tangents, 0)) << "b belongs to one triangle only";
}

TEST(Tangents, CornersAreWeightedByTheirAngle) {
    // Faces of 90, 45 and 45 degrees meet at the origin.
    Model model;
    const uint32_t o = model.add({0, 0, 0}, up_z, 0, 0);
    const uint32_t x = model.add({1, 0, 0}, up_z, 1, 0);
    const uint32_t y = model.add({0, 1, 0}, up_z, 0, -1);
    const uint32_t left = model.add({-1, 1, 0}, up_z, -1, -1);
    const uint32_t below = model.add({1, -1, 0}, up_z, 1, 1);
    model.triangle(o, x, y);
    model.triangle(o, y, left);
    model.triangle(o, below, x);
    for (const size_t corner : {size_t{0}, size_t{3}, size_t{6}}) {
        expect_tangent(model.tangents(), corner, {1, 0, 0}, 1);
    }
    // In the second face P = u U + v V; (0,1) = -V and (-1,1) = -2 U - 1.5 V: U = (0.5, 0.25).
    model.uvs[2 * static_cast<size_t>(left)] = -2.0f;
    model.uvs[2 * static_cast<size_t>(left) + 1] = -1.5f;
    const double pi = std::numbers::pi, size_of_u = std::sqrt(0.3125);
    const Vec sum = {0.75 * pi + 0.25 * pi * 0.5 / size_of_u, 0.25 * pi * 0.25 / size_of_u, 0};
    const double size = std::sqrt(dot_of(sum, sum));
    for (const size_t corner : {size_t{0}, size_t{3}, size_t{6}}) {
        expect_tangent(model.tangents(), corner, {sum[0] / size, sum[1] / size, 0}, 1);
    }
}

/// A sphere with u along the longitude; column j of the seam is a vertex of its own (u = 1).
Model sphere(int columns, int rows) {
    Model model;
    for (int i = 0; i <= rows; ++i) {
        for (int j = 0; j <= columns; ++j) {
            const double v = static_cast<double>(i) / rows, u = static_cast<double>(j) / columns;
            const double theta = v * std::numbers::pi;
            const double phi = (j % columns) * 2 * std::numbers::pi / columns;
            const Vec p = {
                std::sin(theta) * std::cos(phi), std::cos(theta), -std::sin(theta) * std::sin(phi)};
            model.add(p, p, u, v);
        }
    }
    const auto at = [&](int i, int j) { return static_cast<uint32_t>(i * (columns + 1) + j); };
    for (int i = 0; i < rows; ++i) {
        for (int j = 0; j < columns; ++j) {
            if (i > 0) model.triangle(at(i, j), at(i + 1, j), at(i, j + 1));
            if (i < rows - 1) model.triangle(at(i, j + 1), at(i + 1, j), at(i + 1, j + 1));
        }
    }
    return model;
}

TEST(Tangents, SphereFollowsItsLongitude) {
    constexpr int columns = 128, rows = 64;
    const Model model = sphere(columns, rows);
    const std::vector<float> tangents = model.tangents();
    expect_unit_and_orthogonal(model, tangents);
    for (size_t corner = 0; corner < model.indices.size(); ++corner) {
        const auto row = static_cast<int>(model.indices[corner]) / (columns + 1);
        if (row < 2 || row > rows - 2) continue;  // dP/du is short or zero at the poles
        const double u = model.uvs[2 * model.indices[corner]];
        const double phi = u * 2 * std::numbers::pi;
        const Vec along_u = {-std::sin(phi), 0, -std::cos(phi)};
        ASSERT_GT(dot_of(tangent(tangents, corner), along_u), std::cos(0.05)) << "row " << row;
        ASSERT_EQ(tangents[4 * corner + 3], 1.0f);
    }
}

TEST(Tangents, UvsWithoutAreaGiveUnitOrthogonalTangents) {
    Model model = sphere(16, 8);
    std::fill(model.uvs.begin(), model.uvs.end(), 0.25f);
    expect_unit_and_orthogonal(model, model.tangents());
    for (size_t i = 0; i < model.uvs.size(); ++i) {  // all on one line
        model.uvs[i] = static_cast<float>(i / 2) * 0.125f;
    }
    expect_unit_and_orthogonal(model, model.tangents());
}

TEST(Tangents, FacesWithoutUvAreaTakeTheirNeighboursTangent) {
    Model model;
    const uint32_t a = model.add({0, 0, 0}, up_z, 0, 1);
    const uint32_t b = model.add({1, 0, 0}, up_z, 1, 1);
    const uint32_t c = model.add({0, 1, 0}, up_z, 0, 0);
    const uint32_t d = model.add({1, 1, 0}, up_z, 0.5, 0.5);  // in the middle of b and c
    model.triangle(b, d, c);                                  // its UVs have no area
    model.triangle(a, b, c);
    const std::vector<float> tangents = model.tangents();
    expect_tangent(tangents, 0, {1, 0, 0}, 1);  // b and c: the group reaches over the shared edge
    expect_tangent(tangents, 2, {1, 0, 0}, 1);
    expect_unit_and_orthogonal(model, tangents);
}

TEST(Tangents, FacesWithoutAreaCopyAndDoNotDisturb) {
    Model model;
    add_quad(model, 0, 1, 0, 1);
    const std::vector<float> before = model.tangents();
    model.indices.insert(model.indices.begin(), {0, 2, 0, 1, 1, 1});
    const uint32_t alone = model.add({7, 7, 7}, up_z, 0, 0);
    model.triangle(alone, alone, 0);
    const std::vector<float> tangents = model.tangents();
    expect_unit_and_orthogonal(model, tangents);
    for (const size_t corner : std::initializer_list<size_t>{0, 1, 2, 3, 4, 5, 14}) {
        expect_tangent(tangents, corner, {1, 0, 0}, 1);
    }
    EXPECT_TRUE(std::equal(before.begin(), before.end(), tangents.begin() + 24));
}

TEST(Tangents, OppositeDirectionsAroundAVertexDoNotAverage) {
    // A fan of four faces in which the image rotates by 180 degrees more than the surface.
    constexpr double degree = std::numbers::pi / 180;
    constexpr double surface[] = {0, 60, 90, 120, 180}, image[] = {0, 60, 180, 300, 360};
    Model model;
    const uint32_t o = model.add({0, 0, 0}, up_z, 0, 0);
    for (int i = 0; i < 5; ++i) {
        const double a = surface[i] * degree, b = image[i] * degree;
        model.add({std::cos(a), std::sin(a), 0}, up_z, std::cos(b), -std::sin(b));
    }
    Vec sum = {0, 0, 0};  // of the first three faces, each times its angle
    for (uint32_t i = 0; i < 4; ++i) {
        model.triangle(o, i + 1, i + 2);
        const float *p = model.positions.data() + 3 * (i + 1), *t = model.uvs.data() + 2 * (i + 1);
        const double ux = p[0] * t[3] - p[3] * t[1], uy = p[1] * t[3] - p[4] * t[1];
        const double signed_angle = (surface[i + 1] - surface[i]) / -std::hypot(ux, uy);
        if (i < 3) sum = {sum[0] + signed_angle * ux, sum[1] + signed_angle * uy, 0};
    }
    const double size = std::sqrt(dot_of(sum, sum));
    const std::vector<float> tangents = model.tangents();
    // The fourth face says -x, the opposite of the first, which therefore ignores it.
    expect_tangent(tangents, 0, {sum[0] / size, sum[1] / size, 0}, 1);
    expect_tangent(tangents, 9, {-sum[0] / size, sum[1] / size, 0}, 1);
    expect_tangent(tangents, 11, {-1, 0, 0}, 1);
}

TEST(Tangents, EdgesOfManyFacesAndVerticesOfManyFacesStayLinear) {
    Model model;
    const uint32_t a = model.add({0, 0, 0}, up_z, 0, 0);
    const uint32_t b = model.add({0, 1, 0}, up_z, 0, -1);
    for (int i = 0; i < 200000; ++i) {  // one edge, all the same way round
        model.triangle(a, b, model.add({-1.0 - i, 0, 0}, up_z, -1.0 - i, 0));
    }
    const uint32_t hub = model.add({0, 0, 5}, up_z, 0.5, 0.5);
    uint32_t last = model.add({1, 0, 5}, up_z, 1, 0.5);
    for (int i = 1; i <= 200000; ++i) {  // one vertex, u along every direction
        const double angle = i * 2 * std::numbers::pi / 200000;
        const double x = std::cos(angle), y = std::sin(angle);
        const uint32_t next = model.add({x, y, 5}, up_z, 1 + i, 0.5 + (i % 2));
        model.triangle(hub, last, next);
        last = next;
    }
    expect_unit_and_orthogonal(model, model.tangents());
}

TEST(Tangents, BrokenNumbersStayFinite) {
    const double bad[] = {std::numeric_limits<double>::quiet_NaN(),
                          std::numeric_limits<double>::infinity(),
                          3e38,
                          1e-44,
                          0.0};
    for (const double value : bad) {
        Model model;
        add_quad(model, 0, 1, 0, 1);
        model.positions[3] = static_cast<float>(value);
        model.normals[6] = static_cast<float>(value);
        model.normals[8] = 0.0f;
        model.uvs[5] = static_cast<float>(value);
        const std::vector<float> tangents = model.tangents();
        for (size_t corner = 0; corner < 6; ++corner) {
            const Vec t = tangent(tangents, corner);
            EXPECT_NEAR(dot_of(t, t), 1.0, 1e-5) << value << " corner " << corner;
        }
    }
}

TEST(Tangents, NothingInNothingOut) {
    EXPECT_TRUE(make_tangents({}).empty());
}

}  // namespace
}  // namespace obscura::gltf
