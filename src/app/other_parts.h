// app/other_parts.h - what other parts of a command render, for names that are theirs.
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "app/render_command.h"
#include "app/render_job.h"

#include <vector>

namespace obscura::app {

/// The renderings of other parts, as far as their files may be those of this part's. Each is noted
/// where it stands in the whole command, so that a part makes and refuses what that does.
class OtherParts {
public:
    /// Takes them out of a command's renderings, of which those of this part stay.
    explicit OtherParts(std::vector<SceneRun>& runs);

    /// Notes the files of those that come before a rendering of this part and after the one before
    /// it. Assets are opened where only they tell the names; of those that fail, their own part
    /// tells.
    ///
    /// In       next: index of the rendering of this part
    /// In, out  kept: written, run
    void note_files_before(size_t next, KeptForLater& kept) const;

private:
    struct Other {
        SceneRun run;
        size_t next = 0;  ///< index of this part's rendering that follows
    };
    std::vector<Other> others_;
};

}  // namespace obscura::app
