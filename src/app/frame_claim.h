// app/frame_claim.h - --skip-existing: whether an image is still to be rendered, and its lock.
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "app/render_job.h"
#include "base/work_lock.h"

#include <memory>
#include <string>
#include <vector>

namespace obscura::app {

/// What is to be done with an image. While it lives, others that heed locks leave the image alone.
class FrameClaim {
public:
    enum class Kind {
        to_render,  ///< and its lock, if there are locks, is held
        is_there,   ///< finished, to be left as it is
        of_others   ///< another holds the lock
    };

    /// Without --skip-existing every image is to be rendered. Says in the log what is left, and why
    /// an image that is there is rendered again.
    ///
    /// In      job: with its facts; must outlive this
    /// Errors  those of WorkLock::take
    static Result<FrameClaim> make(Job& job, const ListedImage& image);

    FrameClaim(FrameClaim&&) = default;
    FrameClaim& operator=(FrameClaim&&) = delete;
    ~FrameClaim();

    Kind kind() const { return kind_; }

private:
    FrameClaim(Kind kind, Watch& watch, std::unique_ptr<WorkLock> lock = {});
    Kind kind_;
    Watch* watch_;
    std::unique_ptr<WorkLock> lock_;
};

/// 75 E-LOCKED when images are left to others: "frames 3, 7-9 are being rendered by others ...".
///
/// In      left: those images
Result<void> check_none_left(const std::vector<ListedImage>& left, const RenderRequest& request);

/// "3, 7-9" of 3, 7, 8, 9.
std::string ranges_text(const std::vector<int>& numbers);

}  // namespace obscura::app
