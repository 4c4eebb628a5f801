// base/work_lock.h - a file that says who is at work on another, for machines that share a folder.
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "base/error.h"

#include <cstdint>
#include <filesystem>
#include <memory>
#include <string>

namespace obscura {

/// Who holds a lock, as its file says.
struct LockHolder {
    std::string host;
    std::string process_space;  ///< the namespace that numbers processes; "": unknown
    int64_t process = 0;
    std::string since;  ///< "2026-11-26T03:43:22Z"
};

/// A lock whose holder shows no sign for so long is stale.
inline constexpr double lock_stale_after_s = 60;

/// Holds a file "shot.exr.lock" while it lives. A thread touches the file every few seconds, so
/// that it does not become stale. A lock is advice: nothing but other WorkLocks heeds it.
///
/// Stale locks are taken over: those that nobody has touched for lock_stale_after_s by the clock of
/// the file system, so that clocks of machines may differ; and at once those of this machine whose
/// process is no more. Of several that take over one lock, one gets it, as long as none of them is
/// held up for a fifth of a second between two calls; else two may do the same work.
class WorkLock {
public:
    /// Makes the file, or takes it over; null: another holds it.
    ///
    /// Errors  73 E-OUT-CREATE the file can be neither made nor read
    static Result<std::unique_ptr<WorkLock>> take(const std::filesystem::path& file);

    ~WorkLock();
    WorkLock(const WorkLock&) = delete;
    WorkLock& operator=(const WorkLock&) = delete;

    /// Removes the file, unless another has taken it over. Further calls do nothing. May be called
    /// from any thread.
    void release();

    /// "HOST, process 17, since 2026-11-26T03:43:22Z": who held it before; "": it was free.
    const std::string& taken_from() const;

private:
    struct State;
    explicit WorkLock(std::unique_ptr<State> state);
    std::unique_ptr<State> state_;
};

/// What a lock's file says of its holder; empty members where it does not. The form is one
/// "name=value" a line.
LockHolder parse_lock(const std::string& text);

/// Its text, and this process's.
std::string lock_text(const LockHolder& holder);
LockHolder this_process();

}  // namespace obscura
