// app/bench_standard.cpp - `obscura bench --standard`: measure, print, compare, write.
// SPDX-License-Identifier: Apache-2.0
#include "app/bench_standard.h"

#include "app/memory_option.h"
#include "app/outcome.h"
#include "app/signals.h"
#include "base/atomic_file.h"
#include "base/parallel.h"
#include "bench/machine.h"
#include "bench/measure_standard.h"
#include "bench/standard_report.h"

#include <fmt/format.h>
#include <span>

namespace obscura::app {

namespace {

Result<void> check_old(const BenchRequest& request, const bench::OldReport& old) {
    if (!request.compare || old.standard == bench::standard_version) return {};
    return fail(ExitCode::bad_resource,
                "E-BENCH-OLD",
                request.compare->string(),
                old.standard == 0
                    ? std::string("it is of no standard; expected a file that `obscura bench "
                                  "--standard --json` wrote")
                    : fmt::format("it is of standard {}, and this is {}: their scores are never "
                                  "compared",
                                  old.standard,
                                  bench::standard_version));
}

}  // namespace

Result<void> run_standard(const BenchRequest& request, const bench::OldReport& old, Log& log) {
    if (auto same = check_old(request, old); !same) return same;
    const ThreadLimit threads(request.threads.front());
    if (auto begun = start_threads_ahead(); !begun) return begun;
    for (const std::string& doubt :
         bench::doubts_about(bench::describe_machine(), {threads.threads()}))
        log.warn("bench", doubt);
    const StopOnSignal stop;
    bench::StandardTask task;
    task.isa = request.isas.front();
    task.threads = threads.threads();
    Result<bench::StandardReport> report = bench::measure_standard(task, stop.flag(), log);
    if (!report) return fail(report.error());
    report->warnings = log.warnings();
    std::string text = bench::standard_table(*report);
    std::vector<bench::Change> changes;
    if (request.compare) {
        const std::string now = bench::circumstances_of(*report);
        if (old.circumstances != now) {
            log.warn(request.compare->string(),
                     "measured under other circumstances: " + old.circumstances + "; now " + now);
        }
        changes = bench::compare(old.figures, bench::comparable_figures(*report));
        text += bench::compare_table(changes);
    }
    if (auto printed = print_output(text); !printed) return printed;
    if (!request.json) return {};
    const std::string json = bench::standard_json(*report, changes);
    return write_file_atomically(*request.json, std::as_bytes(std::span(json)));
}

}  // namespace obscura::app
