// serve/job_check.h - a client's job becomes one that may run: it names no file but the server's.
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "base/error.h"

#include "serve/view_settings.h"
#include <filesystem>
#include <functional>
#include <map>
#include <string>
#include <vector>

namespace obscura::serve {

/// The job's file, as its program is told it: beside the folder where that runs.
inline constexpr const char* job_file_name = "../job.json";

/// What a job may name.
struct JobFiles {
    /// The file of a name; as KnownFiles::find.
    std::function<Result<std::filesystem::path>(const std::string& name)> find;
    /// The names that fit a pattern; as KnownFiles::match.
    std::function<std::vector<std::string>(const std::string& pattern)> match;
    /// Options whose files were found; as Service::with_files_found.
    std::function<Result<Options>(const Options& options)> options;
};

struct CheckedJob {
    nlohmann::json job;            ///< for `obscura batch`, in the folder of the job's files
    std::vector<size_t> asset_of;  ///< for each asset there, the index of the client's
    std::map<std::string, std::string> names;  ///< of files, as the client may say them
    std::string manifest;                      ///< its name in the folder of the job's files
};

/// Checks a job of `obscura batch` and rewrites it: assets and environments become files that were
/// found; all that is written has a relative name; options are those that clients may give. What
/// else may be wrong, such as values of options, is left to `obscura batch`.
///
/// In      common: options of all pictures, which the client's go before
/// Errors  with a pointer into the job as the place: 65 E-JOB-KEY, E-JOB-VALUE, E-DOC-MISSING;
///         66 E-JOB-ASSETS a pattern fits no file; 77 E-JOB-PATH a file to be written is not
///         below the job's folder; E-JOB-LIMIT too many assets; those of JobFiles
Result<CheckedJob> check_job(const nlohmann::json& job,
                             const JobFiles& files,
                             const Options& common);

/// A text of the program, with the client's names for files and pointers into the client's job.
std::string client_text(const CheckedJob& job, std::string text);

/// The same for an error, and for what was found with it.
Error client_error(const CheckedJob& job, Error error);

}  // namespace obscura::serve
