// base/error.h - errors with id, location and exit code, and Result.
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>
#include <tl/expected.hpp>
#include <utility>
#include <vector>

namespace obscura {

/// Process exit codes: those of sysexits.h, and some that render farms retry.
///
/// To add one: append it here, give it a line in docs/cli.md, and a test in tests/cli that raises
/// it. An id of an error needs a line in docs/errors.md and a test that raises it.
enum class ExitCode : int {
    ok = 0,
    outside_budget = 1,  ///< a cross-check found more differences than it allows
    out_of_memory = 33,
    usage = 64,
    bad_data = 65,       ///< the scene file breaks its format
    missing_scene = 66,  ///< the scene file cannot be opened
    bad_resource = 67,   ///< a referenced buffer, image or environment is missing or corrupt
    unsupported = 69,    ///< a required extension or version that we do not have
    internal = 70,       ///< a bug in this program
    cannot_create = 73,  ///< the output cannot be created
    io_error = 74,       ///< reading or writing failed half-way
    stopped_early = 75,  ///< stopped on request, or at the time limit
    too_many_nonfinite = 76,
    refused = 77,        ///< a limit or a policy forbids it
    configuration = 78,  ///< OCIO config, display or view
};

/// One failure. `id` is a stable name for scripts ("E-ACC-RANGE"), `where` is a file with a JSON
/// pointer or an option, `message` says what is wrong and what would be accepted.
struct Error {
    ExitCode code = ExitCode::internal;
    std::string id;
    std::string where;
    std::string message;
    std::vector<Error> also = {};  ///< further failures that were found together with this one
};

template <typename T>
using Result = tl::expected<T, Error>;

/// Builds the failed side of a Result.
inline tl::unexpected<Error> fail(ExitCode code,
                                  std::string id,
                                  std::string where,
                                  std::string message) {
    return tl::make_unexpected(Error{code, std::move(id), std::move(where), std::move(message)});
}

/// Converts an error to the caller's own Result type.
inline tl::unexpected<Error> fail(Error error) {
    return tl::make_unexpected(std::move(error));
}

/// Several failures as one: the first, with the others in `also`. There is at least one.
inline Error joined(std::vector<Error> errors) {
    Error first = std::move(errors.front());
    for (size_t i = 1; i < errors.size(); ++i)
        first.also.push_back(std::move(errors[i]));
    return first;
}

}  // namespace obscura
