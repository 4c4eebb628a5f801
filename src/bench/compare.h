// bench/compare.h - compares two benches and tells changes from chance.
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "base/error.h"
#include "bench/report.h"

#include <filesystem>
#include <string>
#include <string_view>
#include <vector>

namespace obscura::bench {

/// One measured number under a name that is the same in every run. Its suffix is its unit: "_s"
/// seconds, "_bytes" bytes, "of_bare" a fraction of bare Embree's speed,
/// "per_s" a number a second.
struct Figure {
    std::string name;
    Spread value;
};

/// All figures of a report that are worth comparing.
std::vector<Figure> comparable_figures(const BenchReport& report);

/// An earlier report as --json wrote it: its figures, and the settings and machine in one text.
struct OldReport {
    std::vector<Figure> figures;
    std::string circumstances;
    int standard = 0;  ///< of `bench --standard`: its number; 0: another bench
};

/// Settings and machine as text: equal for reports measured alike.
std::string circumstances_of(const BenchReport& report);

/// Errors  67 E-BENCH-OLD the file is missing or is no such report
Result<OldReport> read_old_report(const std::filesystem::path& file);

struct Change {
    std::string name;
    Spread before;
    Spread after;
};

/// The figures that both have, in the order of `after`.
std::vector<Change> compare(const std::vector<Figure>& before, const std::vector<Figure>& after);

/// "faster", "slower" or "within noise"; for bytes "larger", "smaller" or "the same".
///
/// A change counts when the two ranges of measurements have nothing in common and the medians
/// differ by more than 2 %: of 5 + 5 measurements of the same thing, one pair of ranges in 126
/// comes apart by chance alone, and machines drift a little between two runs. Of 3 + 3 it is one in
/// ten, of fewer one in three or all: those are "too few measurements".
std::string_view verdict(const Change& change);

/// The comparison as a table for people.
std::string compare_table(const std::vector<Change>& changes);

}  // namespace obscura::bench
