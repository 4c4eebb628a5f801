// tests/stages/shared_faces_test.cpp - which faces a path crosses together, and which one counts.
// SPDX-License-Identifier: Apache-2.0
#include "stages/shared_faces.h"

#include <gtest/gtest.h>

namespace obscura::test {
namespace {

constexpr int32_t liquid = 1, glass = 2;

/// A face at a depth along the probe, of a primitive with one triangle.
Crossing face(float t, int32_t primitive, int32_t body, bool enters) {
    return {t, 0, 0, {-1, primitive}, 0, body, enters};
}

constexpr Probe probe{1.0f, 50.0f, 0.1f};  // the hit at 1, the path from 50 before it

uint32_t bodies(uint32_t shared) {
    return shared & ~faces_shared;
}

TEST(SharedFaces, AloneNothingChanges) {
    std::vector<Crossing> none;
    EXPECT_FALSE(find_company(probe, face(1, 0, glass, true), none).found);
    // The hit itself, and the neighbour on whose edge it lies.
    std::vector<Crossing> same{face(1, 0, glass, true), face(1, 1, glass, true)};
    EXPECT_FALSE(find_company(probe, face(1, 0, glass, true), same).found);
    std::vector<Crossing> far{face(1.5f, 1, liquid, true)};
    EXPECT_FALSE(find_company(probe, face(1, 0, glass, false), far).found);
}

TEST(SharedFaces, WhicheverIsHitTheGreaterNumberCounts) {
    const Crossing out = face(1, 0, glass, false);
    for (const float gap : {-0.05f, 0.0f, 0.05f}) {
        const Crossing in = face(1 + gap, 1, liquid, true);
        for (const bool glass_is_hit : {true, false}) {
            Crossing hit = glass_is_hit ? out : in;
            hit.t = 1;
            std::vector<Crossing> others{glass_is_hit ? in : out};
            const Company company = find_company(probe, hit, others);
            ASSERT_TRUE(company.found);
            EXPECT_EQ(company.face.body, glass);
            EXPECT_EQ(bodies(company.crossed.left), static_cast<uint32_t>(glass) << 16U);
            EXPECT_EQ(bodies(company.crossed.entered), static_cast<uint32_t>(liquid) << 16U);
            EXPECT_GE(company.crossed.before, 0.1f);
            EXPECT_GE(company.crossed.beyond, 0.1f);
        }
    }
}

/// Rays start clear of all faces, not only of the one that counts.
TEST(SharedFaces, RaysStartBeforeAndBehindAll) {
    std::vector<Crossing> others{face(1.15f, 1, glass, true), face(1.3f, 2, 3, true)};
    const Company company = find_company(probe, face(1, 0, liquid, true), others);
    ASSERT_TRUE(company.found);
    EXPECT_EQ(company.face.body, 3);
    EXPECT_FLOAT_EQ(company.crossed.before, 0.4f);
    EXPECT_FLOAT_EQ(company.crossed.beyond, 0.1f);
    EXPECT_EQ(bodies(company.crossed.entered), 3U << 16U | 2U << 8U | 1U);
}

/// What lies before the hit and behind the path's start has been crossed already.
TEST(SharedFaces, WhatThePathHasLeftBehindIsNotCrossedAgain) {
    std::vector<Crossing> others{face(0.95f, 1, liquid, true)};
    const Probe started_between{1.0f, 0.03f, 0.1f};
    EXPECT_FALSE(find_company(started_between, face(1, 0, glass, false), others).found);
}

TEST(SharedFaces, OutOfABodyAndIntoItAgainIsNoBoundary) {
    std::vector<Crossing> others{face(1, 1, glass, true)};
    const Company company = find_company(probe, face(1, 0, glass, false), others);
    ASSERT_TRUE(company.found);
    EXPECT_EQ(bodies(company.crossed.left), 0U);
    EXPECT_EQ(company.crossed.entered, 0U);
}

}  // namespace
}  // namespace obscura::test
