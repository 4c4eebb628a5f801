// serve/jobs.h - the queue of clients' jobs: each runs as a program of its own.
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "serve/child_process.h"
#include "serve/job.h"
#include "serve/own_folder.h"
#include "serve/program_output.h"
#include "serve/service.h"
#include <atomic>
#include <condition_variable>
#include <deque>
#include <memory>
#include <mutex>
#include <string>
#include <thread>
#include <vector>

namespace obscura::serve {

struct JobsOptions {
    /// Of the jobs' folders, which then stay; empty: a temporary one.
    std::filesystem::path folder = {};
    int at_once = 1;                               ///< jobs that run; the others wait
    size_t max_kept = 100;                         ///< jobs; then the oldest that has ended goes
    size_t max_listeners = 128;                    ///< clients that follow events
    std::string program = "/proc/self/exe";        ///< this program itself
    std::vector<std::string> words = {};           ///< options of `obscura batch`
    Options options = Options::object();           ///< of all pictures; those of a job go before
    std::chrono::milliseconds grace{10000};        ///< from SIGTERM to SIGKILL
    std::chrono::milliseconds check_limit{60000};  ///< for the check of a job
};

/// Any thread may call.
class Jobs {
public:
    /// Begins to run what will be submitted.
    ///
    /// In      service: outlives the jobs
    Jobs(JobsOptions options, Service& service);
    /// Ends all jobs, waits for them, and removes a temporary folder.
    ~Jobs();
    Jobs(const Jobs&) = delete;
    Jobs& operator=(const Jobs&) = delete;

    /// Checks a job, by `obscura batch --dry-run` too, and puts it into the queue.
    ///
    /// Out     as Job::describe
    /// Errors  those of check_job and of `obscura batch`; 75 E-SERVE-BUSY too many jobs wait;
    ///         73 E-OUT-CREATE; 74 E-JOB-START; 77 E-JOB-LIMIT the check takes too long
    Result<Json> submit(const nlohmann::json& job);
    /// {"jobs": [...]}: all that are kept, the oldest first.
    Json list() const;
    /// Errors  64 E-SERVE-UNKNOWN
    Result<std::shared_ptr<Job>> find(const std::string& id) const;
    /// Job::describe with "lines", those of the manifest so far.
    Result<Json> describe(const std::string& id) const;
    /// Cancels a job, or removes one that has ended, with its files.
    Result<Json> remove(const std::string& id);

    /// {"files": [{"file", "bytes"}]}, by their names.
    Result<Json> list_files(const std::string& id) const;
    /// Errors  64 E-SERVE-UNKNOWN; 66 E-SCENE-MISSING; 77 E-URI-REFUSED
    Result<std::filesystem::path> file(const std::string& id, const std::string& name) const;

    /// Errors  64 E-SERVE-UNKNOWN; 75 E-SERVE-BUSY too many listen
    Result<std::shared_ptr<JobEvents>> listen(const std::string& id, size_t after);

    /// All jobs are to end, and none begins. Returns at once.
    void stop();

private:
    Result<std::shared_ptr<Job>> new_job();
    Result<std::filesystem::path> root();
    JobFiles files_for(const Job& job) const;
    Result<int> check_by_program(const Job& job, const CheckedJob& checked);
    Result<void> wait_for_check(ChildProcess& child, const std::filesystem::path& printed) const;
    Result<void> prepare(const std::shared_ptr<Job>& job, const nlohmann::json& given);
    Result<void> enqueue(const std::shared_ptr<Job>& job);
    void forget_files(const Job& job) const;
    void work();
    void run(Job& job);
    int wait_for_end(Job& job, ChildProcess& child);
    std::vector<std::string> words(bool only_checks) const;

    const JobsOptions options_;
    Service& service_;
    std::atomic<bool> ends_ = false;
    mutable std::mutex mutex_;  ///< of what follows
    std::condition_variable changed_;
    std::unique_ptr<const OwnFolder> own_folder_;  ///< where none was asked for
    std::filesystem::path root_;              ///< of the jobs' folders; empty: there was none yet
    std::deque<std::shared_ptr<Job>> jobs_;   ///< the oldest first
    std::deque<std::shared_ptr<Job>> queue_;  ///< those that wait
    int last_number_ = 0;
    int checks_ = 0;  ///< under way
    std::atomic<size_t> listeners_ = 0;
    std::vector<std::thread> workers_;
};

}  // namespace obscura::serve
