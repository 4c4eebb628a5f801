// bench/report_json.h - the figures of a bench for programs.
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "bench/compare.h"
#include "bench/report.h"

#include <string>
#include <vector>

namespace obscura {

/// One JSON object; docs/cli.md explains the keys. `changes` may be empty.
std::string bench_json(const BenchReport& report, const std::vector<Change>& changes);

}  // namespace obscura
