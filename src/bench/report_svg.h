// bench/report_svg.h - a chart of scaling by threads and instruction sets.
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "bench/report.h"

#include <string>

namespace obscura::bench {

/// An SVG chart with one panel for the entries by threads (speed-up, with the ideal line) and one
/// for those by instruction set (speed-up over the slowest); an empty panel is left out.
std::string bench_svg(const BenchReport& report);

}  // namespace obscura::bench
