// serve/jobs.cpp - the queue of clients' jobs.
// SPDX-License-Identifier: Apache-2.0
#include "serve/jobs.h"

#include "base/atomic_file.h"
#include "base/log.h"

#include <algorithm>
#include <csignal>
#include <cstdlib>
#include <system_error>

namespace obscura::serve {

namespace {

namespace fs = std::filesystem;

constexpr const char* names_name = "names.txt";
constexpr const char* check_name = "check.txt";
constexpr const char* log_name = "log.txt";

tl::unexpected<Error> is_busy(const std::string& message) {
    return fail(ExitCode::stopped_early, "E-SERVE-BUSY", "job", message);
}

tl::unexpected<Error> cannot_make(const fs::path& folder, const std::error_code& error) {
    return fail(ExitCode::cannot_create, "E-OUT-CREATE", folder.string(), error.message());
}

/// The highest N of entries jN.
int highest_number(const fs::path& folder) {
    int highest = 0;
    std::error_code error;
    for (fs::directory_iterator at(folder, error); !error && at != fs::directory_iterator();
         at.increment(error)) {
        const std::string name = at->path().filename().string();
        if (name.starts_with('j')) highest = std::max(highest, std::atoi(name.c_str() + 1));
    }
    return highest;
}

/// An upload goes when others need its room: a job has a link of its own.
Result<fs::path> linked(const fs::path& file, const fs::path& folder) {
    const fs::path own = folder / file.parent_path().filename();
    std::error_code error;
    fs::create_directories(own, error);
    const fs::path link = own / file.filename();
    if (fs::exists(link, error)) return link;
    fs::create_hard_link(file, link, error);
    if (error) fs::copy_file(file, link, error);
    if (error) return cannot_make(link, error);
    return link;
}

}  // namespace

Jobs::Jobs(JobsOptions options, Service& service)
    : options_(std::move(options)), service_(service) {
    for (int i = 0; i < options_.at_once; ++i)
        workers_.emplace_back([this] { work(); });
}

Jobs::~Jobs() {
    stop();
    for (std::thread& worker : workers_)
        worker.join();
}

void Jobs::stop() {
    ends_ = true;
    const std::lock_guard lock(mutex_);
    changed_.notify_all();
}

/// With mutex_ locked.
Result<fs::path> Jobs::root() {
    if (!root_.empty()) return root_;
    std::error_code error;
    fs::path folder = options_.folder;
    if (folder.empty()) {
        Result<std::unique_ptr<const OwnFolder>> own = OwnFolder::make("jobs");
        if (!own) return fail(own.error());
        own_folder_ = std::move(*own);
        folder = own_folder_->path();
    }
    fs::create_directories(folder, error);
    if (error) return cannot_make(folder, error);
    folder = fs::canonical(folder, error);
    if (error) return cannot_make(folder, error);
    last_number_ = highest_number(folder);
    root_ = folder;
    return root_;
}

Result<std::shared_ptr<Job>> Jobs::new_job() {
    const std::lock_guard lock(mutex_);
    const Result<fs::path> folder = root();
    if (!folder) return fail(folder.error());
    const std::string id = "j" + std::to_string(++last_number_);
    auto job = std::make_shared<Job>(id, *folder / id);
    std::error_code error;
    fs::create_directories(job->files(), error);
    if (error) return cannot_make(job->files(), error);
    return job;
}

JobFiles Jobs::files_for(const Job& job) const {
    const fs::path inputs = job.folder() / "inputs";
    const auto find = [this, inputs](const std::string& name) -> Result<fs::path> {
        Result<fs::path> file = service_.files().find(name);
        if (!file || !is_upload(name)) return file;
        return linked(*file, inputs);
    };
    const auto options = [this, inputs](const Options& given) -> Result<Options> {
        Result<Options> found = service_.with_files_found(given);
        if (!found || !given.contains("env")) return found;
        if (!is_upload(given.at("env").get<std::string>())) return found;
        const Result<fs::path> own = linked(found->at("env").get<std::string>(), inputs);
        if (!own) return fail(own.error());
        (*found)["env"] = own->string();
        return found;
    };
    return {find,
            [this](const std::string& pattern) { return service_.files().match(pattern); },
            options};
}

std::vector<std::string> Jobs::words(bool only_checks) const {
    std::vector<std::string> out = {options_.program, "batch", job_file_name};
    if (only_checks) out.emplace_back("--dry-run");
    out.insert(out.end(), options_.words.begin(), options_.words.end());
    return out;
}

Result<void> Jobs::wait_for_check(ChildProcess& child, const fs::path& printed) const {
    constexpr uintmax_t max_printed = 16U << 20U;
    constexpr std::chrono::milliseconds slice(5);
    const auto end = std::chrono::steady_clock::now() + options_.check_limit;
    while (!child.code()) {
        if (ends_) return is_busy("the server is ending");
        std::error_code error;
        const uintmax_t bytes = fs::file_size(printed, error);
        const bool is_late = std::chrono::steady_clock::now() > end;
        if (is_late || (!error && bytes > max_printed)) {
            return fail(ExitCode::refused,
                        "E-JOB-LIMIT",
                        "job",
                        is_late ? "it takes too long to find out which pictures the job has"
                                : "the job has too many pictures");
        }
        std::this_thread::sleep_for(slice);
    }
    return {};
}

/// The number of pictures.
Result<int> Jobs::check_by_program(const Job& job, const CheckedJob& checked) {
    constexpr int max_checks = 2;
    struct Turn {  // checks read assets: few at once
        explicit Turn(Jobs& all) : jobs(all) {
            std::unique_lock lock(jobs.mutex_);
            jobs.changed_.wait(lock, [&] { return jobs.ends_ || jobs.checks_ < max_checks; });
            ++jobs.checks_;
        }
        ~Turn() {
            const std::lock_guard lock(jobs.mutex_);
            --jobs.checks_;
            jobs.changed_.notify_all();
        }
        Jobs& jobs;
    } const turn(*this);
    const fs::path names = job.folder() / names_name, messages = job.folder() / check_name;
    Result<ChildProcess> child = ChildProcess::start({words(true), job.files(), names, messages});
    if (!child) return fail(child.error());
    if (auto ended = wait_for_check(*child, names); !ended) return fail(ended.error());
    constexpr size_t max_text = 1U << 20U;
    ProgramOutput output = parse_program_output(end_of_file(messages, max_text));
    const int code = child->code().value_or(0);
    if (code != 0 && !output.error) output.error = error_of_code(code);
    if (output.error) return fail(client_error(checked, std::move(*output.error)));
    return output.images;
}

Result<void> Jobs::prepare(const std::shared_ptr<Job>& job, const nlohmann::json& given) {
    Result<CheckedJob> checked = check_job(given, files_for(*job), options_.options);
    if (!checked) return fail(checked.error());
    const std::string text = checked->job.dump();
    const auto written =
        write_file_atomically(job->folder() / "job.json", std::as_bytes(std::span(text)));
    if (!written) return written;
    const Result<int> pictures = check_by_program(*job, *checked);
    if (!pictures) return fail(pictures.error());
    job->set_plan(std::move(*checked), *pictures);
    return enqueue(job);
}

/// Where too many are kept, the oldest that has ended goes. Its files stay where folders do.
Result<void> Jobs::enqueue(const std::shared_ptr<Job>& job) {
    std::shared_ptr<Job> forgotten;
    {
        const std::lock_guard lock(mutex_);
        if (ends_) return is_busy("the server is ending");
        if (jobs_.size() >= options_.max_kept) {
            const auto oldest = std::find_if(
                jobs_.begin(), jobs_.end(), [](const auto& one) { return is_ended(one->state()); });
            if (oldest == jobs_.end())
                return is_busy("too many jobs wait; try again when some have ended");
            forgotten = *oldest;
            jobs_.erase(oldest);
        }
        jobs_.push_back(job);
        queue_.push_back(job);
        changed_.notify_all();
    }
    if (forgotten && options_.folder.empty()) forget_files(*forgotten);
    return {};
}

void Jobs::forget_files(const Job& job) const {
    std::error_code ignored;
    fs::remove_all(job.folder(), ignored);
}

Result<Json> Jobs::submit(const nlohmann::json& given) {
    const Result<std::shared_ptr<Job>> job = new_job();
    if (!job) return fail(job.error());
    if (auto ready = prepare(*job, given); !ready) {
        forget_files(**job);
        return fail(ready.error());
    }
    return (*job)->describe();
}

Json Jobs::list() const {
    std::deque<std::shared_ptr<Job>> jobs;
    {
        const std::lock_guard lock(mutex_);
        jobs = jobs_;
    }
    Json out = {{"jobs", Json::array()}};
    for (const auto& job : jobs)
        out["jobs"].push_back(job->describe());
    return out;
}

Result<std::shared_ptr<Job>> Jobs::find(const std::string& id) const {
    const std::lock_guard lock(mutex_);
    const auto found =
        std::find_if(jobs_.begin(), jobs_.end(), [&](const auto& job) { return job->id() == id; });
    if (found != jobs_.end()) return *found;
    return fail(ExitCode::usage,
                "E-SERVE-UNKNOWN",
                escape_control(id),
                "there is no such job, or it went to make room for others");
}

Result<Json> Jobs::describe(const std::string& id) const {
    const auto job = find(id);
    if (!job) return fail(job.error());
    Json out = (*job)->describe();
    out["lines"] = Json::array();
    for (const std::string& line : (*job)->lines(0, SIZE_MAX))
        out["lines"].push_back(Json::parse(line, nullptr, false));
    return out;
}

Result<Json> Jobs::remove(const std::string& id) {
    const auto job = find(id);
    if (!job) return fail(job.error());
    bool has_ended = false;
    {
        const std::lock_guard lock(mutex_);
        (*job)->cancel();
        const auto waiting = std::find(queue_.begin(), queue_.end(), *job);
        has_ended = is_ended((*job)->state());
        if (waiting != queue_.end()) {
            queue_.erase(waiting);
            (*job)->end({JobState::cancelled, {}, {}, 0});
        } else if (has_ended) {
            std::erase(jobs_, *job);
        }
        changed_.notify_all();
    }
    if (has_ended) forget_files(**job);
    Json out = (*job)->describe();
    out["removed"] = has_ended;
    return out;
}

Result<Json> Jobs::list_files(const std::string& id) const {
    const auto job = find(id);
    if (!job) return fail(job.error());
    std::vector<std::pair<std::string, uintmax_t>> files;
    std::error_code error, ignored;
    const fs::path folder = (*job)->files();
    for (fs::recursive_directory_iterator at(folder, error);
         !error && at != fs::recursive_directory_iterator();
         at.increment(error)) {
        if (at->is_regular_file(ignored) && at->path().extension() != ".part")
            files.emplace_back(at->path().lexically_relative(folder).string(),
                               at->file_size(ignored));
    }
    std::sort(files.begin(), files.end());
    Json out = {{"files", Json::array()}};
    for (const auto& [name, bytes] : files)
        out["files"].push_back({{"file", name}, {"bytes", bytes}});
    return out;
}

Result<fs::path> Jobs::file(const std::string& id, const std::string& name) const {
    const auto job = find(id);
    if (!job) return fail(job.error());
    return KnownFiles({(*job)->files()}, 0).find(name);
}

Result<std::shared_ptr<JobEvents>> Jobs::listen(const std::string& id, size_t after) {
    const auto job = find(id);
    if (!job) return fail(job.error());
    if (++listeners_ > options_.max_listeners) {
        --listeners_;
        return is_busy("too many clients follow jobs");
    }
    struct Counted {
        Counted(std::shared_ptr<Job> job, size_t after, std::atomic<size_t>& count)
            : events(std::move(job), after), listeners(count) {}
        ~Counted() { --listeners; }
        Counted(const Counted&) = delete;
        Counted& operator=(const Counted&) = delete;
        JobEvents events;
        std::atomic<size_t>& listeners;
    };
    auto counted = std::make_shared<Counted>(*job, after, listeners_);
    return std::shared_ptr<JobEvents>(counted, &counted->events);
}

void Jobs::work() {
    while (true) {
        std::shared_ptr<Job> job;
        {
            std::unique_lock lock(mutex_);
            changed_.wait(lock, [&] { return ends_ || !queue_.empty(); });
            if (ends_) return;
            job = queue_.front();
            queue_.pop_front();
            job->begin();
        }
        run(*job);
    }
}

/// Its exit code.
int Jobs::wait_for_end(Job& job, ChildProcess& child) {
    constexpr std::chrono::milliseconds slice(50);
    using Clock = std::chrono::steady_clock;
    std::optional<Clock::time_point> last_moment;
    while (true) {
        const std::optional<int> code = child.code();
        job.read_manifest();
        if (code) return *code;
        const bool is_to_end = job.is_cancelled() || ends_;
        if (is_to_end && !last_moment) {
            child.send(SIGTERM);
            last_moment = Clock::now() + options_.grace;
        } else if (last_moment && Clock::now() > *last_moment) {
            child.send(SIGKILL);
        }
        std::unique_lock lock(mutex_);
        changed_.wait_for(lock, slice, [&] { return !last_moment && job.is_cancelled(); });
    }
}

void Jobs::run(Job& job) {
    const fs::path log = job.folder() / log_name;
    Result<ChildProcess> child = ChildProcess::start({words(false), job.files(), log, log});
    if (!child) {
        job.end({JobState::failed, {}, child.error(), 0});
        return;
    }
    JobEnd end;
    end.code = wait_for_end(job, *child);
    constexpr size_t max_text = 1U << 16U;
    ProgramOutput output = parse_program_output(end_of_file(log, max_text));
    end.warnings = output.warnings;
    if (*end.code != 0) {
        const bool was_asked = job.is_cancelled() || ends_;
        end.state = was_asked ? JobState::cancelled : JobState::failed;
        if (!output.error && was_asked)  // before it could say so
            output.error = Error{ExitCode::stopped_early, "E-STOPPED", "job", "it was cancelled"};
        if (!output.error) output.error = error_of_code(*end.code);
        end.error = client_error(job.checked(), std::move(*output.error));
    }
    job.end(std::move(end));
}

}  // namespace obscura::serve
