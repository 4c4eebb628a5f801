// bench/standard_report.h - the score of the standard as a table and as JSON to publish.
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "bench/compare.h"
#include "bench/standard_score.h"

#include <string>
#include <vector>

namespace obscura::bench {

std::string standard_table(const StandardReport& report);

/// One JSON object; docs/scores.md explains the keys. `changes` may be empty.
std::string standard_json(const StandardReport& report, const std::vector<Change>& changes);

/// Score and samples a second of each scene, for compare(). Their names have the standard's number
/// in them: those of different standards have none in common.
std::vector<Figure> comparable_figures(const StandardReport& report);

/// Machine and settings as text: equal for reports measured alike.
std::string circumstances_of(const StandardReport& report);

}  // namespace obscura::bench
