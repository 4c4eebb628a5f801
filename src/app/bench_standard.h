// app/bench_standard.h - `obscura bench --standard`: measure, print, compare, write.
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "app/bench_request.h"
#include "bench/compare.h"

namespace obscura::app {

/// In      old: the report to compare with, already read
/// Errors  67 E-BENCH-OLD it is of another standard; 75 E-STOPPED; those of measure_standard
Result<void> run_standard(const BenchRequest& request, const bench::OldReport& old, Log& log);

}  // namespace obscura::app
