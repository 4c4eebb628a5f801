// serve/job.h - a job of a client: its state, and what its manifest has told so far.
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "base/json/json.h"

#include "serve/job_check.h"
#include <chrono>
#include <condition_variable>
#include <cstdint>
#include <filesystem>
#include <memory>
#include <mutex>
#include <optional>
#include <string>
#include <vector>

namespace obscura::serve {

enum class JobState { queued, running, done, failed, cancelled };

/// "queued" and so on.
const char* name_of(JobState state);
bool is_ended(JobState state);

/// How a job's program ended.
struct JobEnd {
    JobState state = JobState::done;
    std::optional<int> code;     ///< none: it was never started
    std::optional<Error> error;  ///< why it failed
    int warnings = 0;            ///< that it counted
};

/// One job with its folder: job.json, log.txt, and the folder "files" of all that it writes. Lines
/// of the manifest stay in their file; where each lies is known here. Any thread may call.
class Job {
public:
    Job(std::string id, std::filesystem::path folder)
        : id_(std::move(id)), folder_(std::move(folder)) {}

    const std::string& id() const { return id_; }
    const std::filesystem::path& folder() const { return folder_; }
    std::filesystem::path files() const { return folder_ / "files"; }

    /// What it is to render. Before any other thread knows the job.
    void set_plan(CheckedJob checked, int pictures);
    const CheckedJob& checked() const { return checked_; }

    JobState state() const;
    /// {"job", "state", "pictures", "finished", ...}
    Json describe() const;

    void begin();
    void end(JobEnd how);
    /// The client wants it to end.
    void cancel();
    bool is_cancelled() const;
    /// Takes note of the manifest's new lines. One thread at a time.
    void read_manifest();

    /// The manifest's lines from one on, with the client's names for files: at most so many.
    ///
    /// In      first: 0 is the first
    std::vector<std::string> lines(size_t first, size_t count) const;

    /// What listeners have to know to go on.
    struct News {
        size_t lines = 0;  ///< of the manifest, so far
        JobState state = JobState::queued;
    };
    /// Waits for other news than those known, at most so long.
    News wait_for_news(const News& known, std::chrono::milliseconds longest) const;

    void add_listeners(int more);

private:
    using Clock = std::chrono::steady_clock;
    struct Line {
        uint64_t offset = 0, length = 0;
    };

    void take_line(const std::string& text, uint64_t offset);

    const std::string id_;
    const std::filesystem::path folder_;
    CheckedJob checked_;
    int pictures_ = 0;
    uint64_t read_ = 0;  ///< bytes of the manifest, up to a line's end

    mutable std::mutex mutex_;  ///< of what follows
    mutable std::condition_variable changed_;
    JobState state_ = JobState::queued;
    JobEnd end_;
    bool is_cancelled_ = false;
    Clock::time_point begun_, ended_;
    std::vector<Line> lines_;
    int finished_ = 0, failures_ = 0, warnings_ = 0, listeners_ = 0;
};

/// Counts as a listener of a job while it lives, and tells it what is new: server-sent events.
///
/// Source  WHATWG HTML, "Server-sent events"
class JobEvents {
public:
    /// In      after: pictures that the client knows already
    JobEvents(std::shared_ptr<Job> job, size_t after);
    ~JobEvents();
    JobEvents(const JobEvents&) = delete;
    JobEvents& operator=(const JobEvents&) = delete;

    /// Text of the next events, or of a heartbeat; "" after waiting for a moment.
    std::string next();
    /// All was told.
    bool is_over() const { return is_over_; }

private:
    std::string state_event(const Job::News& news) const;
    std::string image_events(size_t known);

    const std::shared_ptr<Job> job_;
    Job::News told_;
    bool has_begun_ = false;
    bool is_over_ = false;
    std::chrono::steady_clock::time_point last_;
};

}  // namespace obscura::serve
