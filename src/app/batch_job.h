// app/batch_job.h - reads the job of `obscura batch`: assets, looks and outputs become renderings.
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "app/option_places.h"
#include "app/render_request.h"

#include <optional>
#include <string>
#include <vector>

namespace obscura::app {

/// One rendering of a job: an asset in a look, to outputs that have their options in common.
struct JobRun {
    RenderArguments arguments;
    size_t asset = 0;  ///< number in the job
    OptionPlaces places = {};
};

struct BatchJob {
    std::vector<JobRun> runs;  ///< those of an asset follow each other
    size_t assets = 0;
    std::optional<std::string> manifest, contact_sheet;
};

/// Reads a job; docs/batch.md and docs/batch.schema.json say what it may hold.
///
/// In      common: options of the command line, which all runs get
/// Errors  67 E-JOB-MISSING the file cannot be read; 65 E-JSON-*, E-DOC-MISSING; E-JOB-KEY a member
///         or an option that there is not; E-JOB-VALUE; 66 E-JOB-ASSETS a pattern fits no file
Result<BatchJob> read_batch_job(const std::string& file, const RenderArguments& common, Log& log);

/// Warns of options that no rendering of the job uses, by their places in it.
///
/// In      requests: of the runs
void warn_of_unused_options(const BatchJob& job,
                            const std::vector<const RenderRequest*>& requests,
                            Log& log);

/// The request of a run; an error has the place in the job of the option that it names.
///
/// Errors  those of make_render_request
Result<RenderRequest> request_of_run(const JobRun& run);

}  // namespace obscura::app
