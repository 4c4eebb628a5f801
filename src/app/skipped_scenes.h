// app/skipped_scenes.h - lets commands over many scenes skip those that cannot be used.
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "base/error.h"
#include "base/log.h"

#include <optional>

namespace obscura::app {

/// Remembers why scenes were skipped: one bad file does not cost the figures of the others, but its
/// exit code still ends the command.
class SkippedScenes {
public:
    /// In   scenes: number of scenes of the whole command
    SkippedScenes(size_t scenes, Log& log) : scenes_(scenes), log_(log) {}

    /// False where the command must end now: there is a single scene, or the fault is not the
    /// scene's.
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

}  // namespace obscura::app
