// crosscheck/budget.h - how much may differ before a cross-check fails.
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "base/error.h"
#include "crosscheck/check_scene.h"

#include <string>
#include <vector>

namespace obscura {

/// Share of the rays aimed at nothing that may differ from the truth, edges within 4 ulp included.
inline constexpr double mismatch_share = 1e-6;

/// Mismatches that so few rays allow: as many as 10^-6 of them explains in 999 of 1000 runs.
uint64_t mismatches_allowed(uint64_t rays);

/// One sentence for everything that is outside the budget.
std::vector<std::string> faults_of(const CheckedScene& scene);

/// The first fault of the first scene that has some.
///
/// Errors  1 E-CROSSCHECK
Result<void> check_budget(const std::vector<CheckedScene>& scenes);

}  // namespace obscura
