// crosscheck/place_check.h - whether u, v and Ng are those of the triangle where a ray meets it.
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "crosscheck/compare.h"

namespace obscura {

/// In   answer: of a ray near its item; what has no triangle, or says nothing of its place, is
/// right
///
/// The weights u and v are two of the three sides on which the ray passes the edges (SideTest), as
/// shares of their sum: they may miss it by as much as the sides may by rounding. Ng is the cross
/// product of two edges, of corners moved as far.
bool is_right_place(const TrueScene& scene, const TrueRay& ray, const Answer& answer);

}  // namespace obscura
