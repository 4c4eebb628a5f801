// serve/job.cpp - a job of a client: its state, and what its manifest has told so far.
// SPDX-License-Identifier: Apache-2.0
#include "serve/job.h"

#include "base/json/json.h"

#include "serve/answers.h"
#include <algorithm>
#include <fstream>

namespace obscura::serve {

namespace {

/// A line of the manifest as its client may read it; one that is damaged as it is.
std::string client_line(const CheckedJob& job, const std::string& line) {
    Json tree = Json::parse(line, nullptr, false);
    if (!tree.is_object()) return line;
    const auto replace = [&](Json& text) {
        if (text.is_string()) text = client_text(job, text.get<std::string>());
    };
    for (const char* const key : {"asset", "message"}) {
        if (tree.contains(key)) replace(tree[key]);
    }
    if (tree.contains("warnings") && tree["warnings"].is_array()) {
        for (Json& warning : tree["warnings"])
            replace(warning);
    }
    return json_line(tree);
}

/// A part of a file; "": it is not there any more.
std::string bytes_of(std::ifstream& in, uint64_t offset, uint64_t length) {
    std::string out(length, '\0');
    in.seekg(static_cast<std::streamoff>(offset));
    in.read(out.data(), static_cast<std::streamsize>(length));
    return in.gcount() == static_cast<std::streamsize>(length) ? out : "";
}

}  // namespace

const char* name_of(JobState state) {
    switch (state) {
        case JobState::queued:
            return "queued";
        case JobState::running:
            return "running";
        case JobState::done:
            return "done";
        case JobState::failed:
            return "failed";
        case JobState::cancelled:
            break;
    }
    return "cancelled";
}

bool is_ended(JobState state) {
    return state != JobState::queued && state != JobState::running;
}

void Job::set_plan(CheckedJob checked, int pictures) {
    checked_ = std::move(checked);
    pictures_ = pictures;
}

JobState Job::state() const {
    const std::lock_guard lock(mutex_);
    return state_;
}

Json Job::describe() const {
    const std::lock_guard lock(mutex_);
    const bool has_begun = begun_ != Clock::time_point();
    const Clock::time_point until = is_ended(state_) ? ended_ : Clock::now();
    const double seconds = has_begun ? std::chrono::duration<double>(until - begun_).count() : 0.0;
    Json out = {{"job", id_},
                {"state", name_of(state_)},
                {"pictures", pictures_},
                {"finished", finished_},
                {"failures", failures_},
                {"warnings", std::max(warnings_, end_.warnings)},
                {"cancelling", is_cancelled_ && !is_ended(state_)},
                {"exit_code", end_.code ? Json(*end_.code) : Json()},
                {"seconds", seconds},
                {"listeners", listeners_},
                {"manifest", checked_.manifest}};
    if (end_.error) out["error"] = error_answer(*end_.error)["error"];
    return out;
}

void Job::begin() {
    const std::lock_guard lock(mutex_);
    state_ = JobState::running;
    begun_ = Clock::now();
    changed_.notify_all();
}

void Job::end(JobEnd how) {
    const std::lock_guard lock(mutex_);
    state_ = how.state;
    end_ = std::move(how);
    ended_ = Clock::now();
    changed_.notify_all();
}

void Job::cancel() {
    const std::lock_guard lock(mutex_);
    is_cancelled_ = true;
}

bool Job::is_cancelled() const {
    const std::lock_guard lock(mutex_);
    return is_cancelled_;
}

void Job::take_line(const std::string& text, uint64_t offset) {
    const auto tree = nlohmann::json::parse(text, nullptr, false);
    const bool is_object = tree.is_object();
    const bool is_finished = is_object && tree.value("exit_code", nlohmann::json()) == 0;
    const bool is_stopped = is_object && tree.value("id", nlohmann::json()) == "E-STOPPED";
    const auto warnings =
        is_object ? tree.value("warnings", nlohmann::json::array()) : nlohmann::json::array();
    const std::lock_guard lock(mutex_);
    lines_.push_back({offset, text.size()});
    finished_ += is_finished ? 1 : 0;
    failures_ += is_finished || is_stopped ? 0 : 1;
    warnings_ += static_cast<int>(warnings.size());
}

void Job::read_manifest() {
    std::ifstream in(files() / checked_.manifest, std::ios::binary);
    if (!in) return;
    in.seekg(static_cast<std::streamoff>(read_));
    bool is_new = false;
    for (std::string line; std::getline(in, line) && !in.eof();) {  // a line's end has come, too
        take_line(line, read_);
        read_ += line.size() + 1;
        is_new = true;
    }
    if (is_new) changed_.notify_all();
}

std::vector<std::string> Job::lines(size_t first, size_t count) const {
    std::vector<Line> places;
    {
        const std::lock_guard lock(mutex_);
        const size_t end = std::min(lines_.size(), first + std::min(count, lines_.size()));
        for (size_t i = first; i < end; ++i)
            places.push_back(lines_[i]);
    }
    std::vector<std::string> out;
    std::ifstream in(files() / checked_.manifest, std::ios::binary);
    for (const Line& place : places) {
        const std::string line = bytes_of(in, place.offset, place.length);
        out.push_back(line.empty() ? "null" : client_line(checked_, line));
    }
    return out;
}

Job::News Job::wait_for_news(const News& known, std::chrono::milliseconds longest) const {
    std::unique_lock lock(mutex_);
    changed_.wait_for(
        lock, longest, [&] { return lines_.size() != known.lines || state_ != known.state; });
    return {lines_.size(), state_};
}

void Job::add_listeners(int more) {
    const std::lock_guard lock(mutex_);
    listeners_ += more;
}

JobEvents::JobEvents(std::shared_ptr<Job> job, size_t after)
    : job_(std::move(job)),
      told_{after, JobState::queued},
      last_(std::chrono::steady_clock::now()) {
    job_->add_listeners(1);
}

JobEvents::~JobEvents() {
    job_->add_listeners(-1);
}

/// The number in front of its id is that of the pictures told.
std::string JobEvents::state_event(const Job::News& news) const {
    const std::string state = name_of(news.state);
    return "id: " + std::to_string(told_.lines) + "-" + state +
           "\nevent: state\ndata: " + json_line(job_->describe()) + "\n\n";
}

std::string JobEvents::image_events(size_t known) {
    constexpr size_t max_at_once = 64;
    std::string out;
    if (known <= told_.lines) return out;
    for (const std::string& line : job_->lines(told_.lines, max_at_once)) {
        ++told_.lines;
        out += "id: " + std::to_string(told_.lines) + "\nevent: picture\ndata: " + line + "\n\n";
    }
    return out;
}

std::string JobEvents::next() {
    constexpr std::chrono::milliseconds slice(250);
    constexpr std::chrono::seconds heartbeat(3);
    const auto now = std::chrono::steady_clock::now();
    std::string out;
    if (!has_begun_) {
        has_begun_ = true;
        const Job::News news = job_->wait_for_news(told_, std::chrono::milliseconds(0));
        told_ = {std::min(told_.lines, news.lines), news.state};
        // The state of a job that has ended comes last: then clients leave.
        out = "retry: 2000\n" + (is_ended(news.state) ? "" : state_event(news));
    } else {
        const Job::News news = job_->wait_for_news(told_, slice);
        out = image_events(news.lines);
        const bool is_all = told_.lines >= news.lines;
        is_over_ = is_all && is_ended(news.state);
        if (is_all && (news.state != told_.state || is_over_)) {
            out += state_event(news);
            told_.state = news.state;
        }
        if (out.empty() && now - last_ >= heartbeat) out = ":\n\n";
    }
    if (!out.empty()) last_ = now;
    return out;
}

}  // namespace obscura::serve
