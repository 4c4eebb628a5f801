// crosscheck/budget.h - how many differences a cross-check accepts.
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "base/error.h"
#include "crosscheck/check_scene.h"

#include <string>
#include <vector>

namespace obscura::crosscheck {

/// Fraction of the unaimed rays that may differ from the truth, edges within 4 ulp included.
inline constexpr double mismatch_fraction = 1e-6;

/// Mismatches allowed for so many rays: what a rate of 10^-6 explains in 999 of 1000 runs.
uint64_t mismatches_allowed(uint64_t rays);

/// One sentence for each figure outside the budget.
std::vector<std::string> faults_of(const CheckedScene& scene);

/// The first fault of the first faulty scene.
///
/// Errors  1 E-CROSSCHECK
Result<void> check_budget(const std::vector<CheckedScene>& scenes);

}  // namespace obscura::crosscheck
