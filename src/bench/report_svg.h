// bench/report_svg.h - scaling and instruction sets as a chart.
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "bench/report.h"

#include <string>

namespace obscura {

/// An SVG picture with one panel for the rows by threads (speed-up, with the ideal line) and one
/// for those by instruction set (speed-up over the slowest); a panel without rows is left out.
std::string bench_svg(const BenchReport& report);

}  // namespace obscura
