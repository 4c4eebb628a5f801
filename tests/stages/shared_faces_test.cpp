// tests/stages/shared_faces_test.cpp - faces that a path crosses together, and the one that counts.
// SPDX-License-Identifier: Apache-2.0
#include "stages/shared_faces.h"

#include <gtest/gtest.h>

namespace obscura::test {
namespace {

constexpr int32_t liquid = 1, glass = 2;

/// A face at a depth along the probe, of a primitive with one triangle.
Crossing face(float t, int32_t primitive, int32_t medium, bool enters) {
    return {t, 0, 0, {-1, primitive}, 0, medium, enters};
}

constexpr Probe probe{1.0f, 50.0f, 0.1f};  // the hit at 1, the path's start 50 before it

uint32_t medium_stack(uint32_t shared) {
    return shared & ~faces_shared;
}

TEST(SharedFaces, AloneNothingChanges) {
    std::vector<Crossing> none;
    EXPECT_FALSE(find_coincident_faces(probe, face(1, 0, glass, true), none).found);
    // The hit itself, and the neighbour on whose edge it is.
    std::vector<Crossing> same{face(1, 0, glass, true), face(1, 1, glass, true)};
    EXPECT_FALSE(find_coincident_faces(probe, face(1, 0, glass, true), same).found);
    std::vector<Crossing> far{face(1.5f, 1, liquid, true)};
    EXPECT_FALSE(find_coincident_faces(probe, face(1, 0, glass, false), far).found);
}

TEST(SharedFaces, WhicheverIsHitTheGreaterNumberCounts) {
    const Crossing out = face(1, 0, glass, false);
    for (const float gap : {-0.05f, 0.0f, 0.05f}) {
        const Crossing in = face(1 + gap, 1, liquid, true);
        for (const bool glass_is_hit : {true, false}) {
            Crossing hit = glass_is_hit ? out : in;
            hit.t = 1;
            std::vector<Crossing> others{glass_is_hit ? in : out};
            const CoincidentFaces coincident = find_coincident_faces(probe, hit, others);
            ASSERT_TRUE(coincident.found);
            EXPECT_EQ(coincident.face.medium, glass);
            EXPECT_EQ(medium_stack(coincident.crossed.left), static_cast<uint32_t>(glass) << 16U);
            EXPECT_EQ(medium_stack(coincident.crossed.entered),
                      static_cast<uint32_t>(liquid) << 16U);
            EXPECT_GE(coincident.crossed.reflected_clearance, 0.1f);
            EXPECT_GE(coincident.crossed.transmitted_clearance, 0.1f);
        }
    }
}

/// Rays start off all faces, not only off the one that counts.
TEST(SharedFaces, RaysStartClearOfAllOnBothSides) {
    std::vector<Crossing> others{face(1.15f, 1, glass, true), face(1.3f, 2, 3, true)};
    const CoincidentFaces coincident =
        find_coincident_faces(probe, face(1, 0, liquid, true), others);
    ASSERT_TRUE(coincident.found);
    EXPECT_EQ(coincident.face.medium, 3);
    EXPECT_FLOAT_EQ(coincident.crossed.reflected_clearance, 0.4f);
    EXPECT_FLOAT_EQ(coincident.crossed.transmitted_clearance, 0.1f);
    EXPECT_EQ(medium_stack(coincident.crossed.entered), 3U << 16U | 2U << 8U | 1U);
}

/// Faces in front of the hit and behind the path's start have been crossed already.
TEST(SharedFaces, WhatThePathHasLeftBehindIsNotCrossedAgain) {
    std::vector<Crossing> others{face(0.95f, 1, liquid, true)};
    const Probe started_between{1.0f, 0.03f, 0.1f};
    EXPECT_FALSE(find_coincident_faces(started_between, face(1, 0, glass, false), others).found);
}

TEST(SharedFaces, OutOfAMediumAndIntoItAgainIsNoBoundary) {
    std::vector<Crossing> others{face(1, 1, glass, true)};
    const CoincidentFaces coincident =
        find_coincident_faces(probe, face(1, 0, glass, false), others);
    ASSERT_TRUE(coincident.found);
    EXPECT_EQ(medium_stack(coincident.crossed.left), 0U);
    EXPECT_EQ(coincident.crossed.entered, 0U);
}

}  // namespace
}  // namespace obscura::test
