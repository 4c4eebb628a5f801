// crosscheck/place_check.h - checks u, v and Ng against the triangle.
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "crosscheck/compare.h"

namespace obscura::crosscheck {

/// In   answer: to a ray close to its item; answers without a triangle or a position are right
///
/// The weights u and v are two of the three sides on which the ray passes the edges (SideTest),
/// divided by their sum: their error may be that of the sides by rounding. Ng is the cross product
/// of two edges, whose corners may be moved as far.
bool is_right_place(const TrueScene& scene, const TrueRay& ray, const Answer& answer);

}  // namespace obscura::crosscheck
