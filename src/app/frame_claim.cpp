// app/frame_claim.cpp - --skip-existing: whether an image is still to be rendered, and its lock.
// SPDX-License-Identifier: Apache-2.0
#include "app/frame_claim.h"

#include "session/fingerprint.h"

#include <fmt/format.h>

namespace obscura::app {

namespace {

/// "frame 7", or the name of a single image.
std::string name_of(const ListedImage& image) {
    return image.label.empty() ? image.outputs.front().string() : image.label;
}

}  // namespace

FrameClaim::FrameClaim(Kind kind, Watch& watch, std::unique_ptr<WorkLock> lock)
    : kind_(kind), watch_(&watch), lock_(std::move(lock)) {}

FrameClaim::~FrameClaim() {
    if (!lock_) return;
    lock_->release();
    watch_->forget_last_task();
}

Result<FrameClaim> FrameClaim::make(Job& job, const ListedImage& image) {
    if (!job.request.long_run.skips_existing) return FrameClaim(Kind::to_render, job.watch);
    const std::string fingerprint = image_fingerprint(job.options, job.facts, image.facts);
    const auto skip = [&] {
        job.log.info(name_of(image) + " is there and is left as it is");
        return FrameClaim(Kind::is_there, job.watch);
    };
    const auto existing = [&] {
        ExistingImage found = find_existing(job.request, image, fingerprint);
        if (!found.is_finished || !job.hooks.has_label || job.hooks.has_label(image)) return found;
        return ExistingImage{false, "its labels are not there"};
    };
    if (existing().is_finished) return skip();
    Result<std::unique_ptr<WorkLock>> lock;
    job.watch.begin_undoable([&]() -> Watch::LastTask {
        lock = WorkLock::take(lock_file(image));
        if (!lock || !*lock) return {};
        return [held = lock->get()] { held->release(); };
    });
    if (!lock) return fail(lock.error());
    if (!*lock) {
        job.log.info(name_of(image) + " is being rendered by another");
        return FrameClaim(Kind::of_others, job.watch);
    }
    FrameClaim out(Kind::to_render, job.watch, std::move(*lock));
    if (!out.lock_->taken_from().empty())
        job.log.info(name_of(image) + ": its lock was left by " + out.lock_->taken_from());
    // Another may have finished it before the lock was ours.
    const ExistingImage found = existing();
    if (found.is_finished) return skip();
    if (!found.differs.empty())
        job.log.info(name_of(image) + " is rendered again: " + found.differs);
    return out;
}

Result<void> check_none_left(const std::vector<ListedImage>& left, const RenderRequest& request) {
    if (left.empty()) return {};
    std::vector<int> numbers;
    for (const ListedImage& image : left) {
        if (image.number && !request.lists.is_asked()) numbers.push_back(*image.number);
    }
    const std::string what = numbers.empty() ? fmt::format("{}{} {}",
                                                           left.front().outputs.front().string(),
                                                           left.size() > 1 ? " and others" : "",
                                                           left.size() > 1 ? "are" : "is")
                                             : fmt::format("frame{} {} {}",
                                                           numbers.size() == 1 ? "" : "s",
                                                           ranges_text(numbers),
                                                           numbers.size() == 1 ? "is" : "are");
    return fail(ExitCode::stopped_early,
                "E-LOCKED",
                request.scene.string(),
                what +
                    " left to others, who hold the locks; all else is finished. The same "
                    "command renders what they do not finish");
}

std::string ranges_text(const std::vector<int>& numbers) {
    std::string out;
    for (size_t i = 0; i < numbers.size();) {
        size_t last = i;
        while (last + 1 < numbers.size() && numbers[last + 1] == numbers[last] + 1)
            ++last;
        out += fmt::format("{}{}", out.empty() ? "" : ", ", numbers[i]);
        if (last > i) out += fmt::format("-{}", numbers[last]);
        i = last + 1;
    }
    return out;
}

}  // namespace obscura::app
