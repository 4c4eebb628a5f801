// bench/report_json.h - the figures of a bench as JSON.
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "bench/compare.h"
#include "bench/report.h"

#include <string>
#include <vector>

namespace obscura::bench {

/// One JSON object; docs/cli.md explains the keys. `changes` may be empty.
std::string bench_json(const BenchReport& report, const std::vector<Change>& changes);

}  // namespace obscura::bench
