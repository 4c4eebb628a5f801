// serve/route_jobs.cpp - the HTTP routes of jobs.
// SPDX-License-Identifier: Apache-2.0
#include "serve/route_jobs.h"

#include "base/descriptor.h"

#include <algorithm>
#include <array>
#include <charconv>
#include <fcntl.h>
#include <sys/stat.h>
#include <unistd.h>

namespace obscura::serve {

namespace {

struct FileType {
    std::string_view ending;
    const char* type;
};
constexpr std::array<FileType, 11> file_types = {{{".png", "image/png"},
                                                  {".jpg", "image/jpeg"},
                                                  {".jpeg", "image/jpeg"},
                                                  {".webp", "image/webp"},
                                                  {".avif", "image/avif"},
                                                  {".tif", "image/tiff"},
                                                  {".tiff", "image/tiff"},
                                                  {".exr", "image/x-exr"},
                                                  {".json", "application/json"},
                                                  {".jsonl", "application/x-ndjson"},
                                                  {".html", "text/html; charset=utf-8"}}};

const char* type_of_file(const std::filesystem::path& file) {
    const std::string ending = file.extension().string();
    const auto found = std::find_if(file_types.begin(), file_types.end(), [&](const auto& one) {
        return one.ending == ending;
    });
    return found == file_types.end() ? "application/octet-stream" : found->type;
}

/// An open file that answers read from; it may be removed meanwhile.
class ServedFile {
public:
    explicit ServedFile(const std::filesystem::path& file)
        : file_(::open(file.c_str(), O_RDONLY | O_CLOEXEC)) {
        struct stat status = {};
        if (is_open() && ::fstat(file_.number(), &status) == 0)
            size_ = static_cast<size_t>(status.st_size);
    }

    bool is_open() const { return file_.is_open(); }
    size_t size() const { return size_; }
    bool hand_over(size_t offset, size_t length, httplib::DataSink& sink) const {
        std::array<char, 1U << 16U> bytes;
        const ssize_t count = ::pread(file_.number(),
                                      bytes.data(),
                                      std::min(length, bytes.size()),
                                      static_cast<off_t>(offset));
        return count > 0 && sink.write(bytes.data(), static_cast<size_t>(count));
    }

private:
    const Descriptor file_;
    size_t size_ = 0;
};

Result<Answer> file_answer(const std::filesystem::path& path) {
    const auto file = std::make_shared<const ServedFile>(path);
    if (!file->is_open())
        return fail(ExitCode::missing_scene, "E-SCENE-MISSING", path.filename(), "not found");
    Answer out;
    out.type = type_of_file(path);
    out.size = file->size();
    out.part = [file](size_t offset, size_t length, httplib::DataSink& sink) {
        return file->hand_over(offset, length, sink);
    };
    out.headers = {{"Cache-Control", "no-store"}};
    // Pages that a job wrote are none of the server's own.
    if (!std::string_view(out.type).starts_with("image/"))
        out.headers.emplace_back("Content-Disposition", "attachment");
    return out;
}

/// The pictures that a client knows: the number in front of the last event's id.
size_t told_before(const httplib::Request& request) {
    const std::string text = request.get_header_value("Last-Event-ID");
    size_t value = 0;
    std::from_chars(text.data(), text.data() + text.size(), value);
    return value;
}

Answer events_answer(std::shared_ptr<JobEvents> events) {
    Answer out;
    out.type = "text/event-stream";
    out.headers = {{"Cache-Control", "no-store"}};
    out.stream = [events = std::move(events)](httplib::DataSink& sink) {
        if (!sink.is_writable()) return false;
        const std::string text = events->next();
        if (!text.empty() && !sink.write(text.data(), text.size())) return false;
        if (events->is_over()) sink.done();
        return true;
    };
    return out;
}

/// An answer of what the jobs say.
Result<Answer> answer_of(const Result<Json>& json, int status = 200) {
    if (!json) return fail(json.error());
    return json_result(*json, status);
}

}  // namespace

void route_jobs(Routes& routes, Jobs& jobs) {
    routes.post("/api/jobs", [&jobs](const auto& /*request*/, Body& body) -> Result<Answer> {
        const Result<nlohmann::json> job = body.json();
        if (!job) return fail(job.error());
        return answer_of(jobs.submit(*job), 201);
    });
    routes.get("/api/jobs", [&jobs](const auto& /*request*/) -> Result<Answer> {
        return json_result(jobs.list());
    });
    routes.get("/api/jobs/([^/]+)", [&jobs](const auto& request) {
        return answer_of(jobs.describe(request.matches[1]));
    });
    routes.remove("/api/jobs/([^/]+)", [&jobs](const auto& request, Body& /*body*/) {
        return answer_of(jobs.remove(request.matches[1]));
    });
    routes.get("/api/jobs/([^/]+)/events", [&jobs](const auto& request) -> Result<Answer> {
        auto events = jobs.listen(request.matches[1], told_before(request));
        if (!events) return fail(events.error());
        return events_answer(std::move(*events));
    });
    routes.get("/api/jobs/([^/]+)/files", [&jobs](const auto& request) {
        return answer_of(jobs.list_files(request.matches[1]));
    });
    routes.get("/api/jobs/([^/]+)/files/(.+)", [&jobs](const auto& request) -> Result<Answer> {
        const auto file = jobs.file(request.matches[1], request.matches[2]);
        if (!file) return fail(file.error());
        return file_answer(*file);
    });
}

}  // namespace obscura::serve
