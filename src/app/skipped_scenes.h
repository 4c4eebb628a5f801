// app/skipped_scenes.h - commands over many scenes go on after one that cannot be used.
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "base/error.h"
#include "base/log.h"

#include <optional>

namespace obscura {

/// Remembers why scenes were left out: one bad file does not cost the figures of the others, but
/// the command still ends with its exit code.
class SkippedScenes {
public:
    /// In   scenes: of the whole command
    SkippedScenes(size_t scenes, Log& log) : scenes_(scenes), log_(log) {}

    /// False where the command must end now: a single scene, or a fault that is not the scene's
    /// own.
    bool skip(const Error& error) {
        const bool of_scene =
            error.code >= ExitCode::bad_data && error.code <= ExitCode::unsupported;
        if (scenes_ < 2 || !(of_scene || error.code == ExitCode::refused)) return false;
        log_.warn(error.where, "left out: " + error.message);
        if (!first_) first_ = error;
        return true;
    }

    /// Success, or the first of the reasons.
    Result<void> result() const {
        if (first_) return fail(*first_);
        return {};
    }

private:
    size_t scenes_;
    Log& log_;
    std::optional<Error> first_;
};

}  // namespace obscura
