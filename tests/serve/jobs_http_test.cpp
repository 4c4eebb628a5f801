// tests/serve/jobs_http_test.cpp - jobs of the real program, over HTTP.
// SPDX-License-Identifier: Apache-2.0
#include <gtest/gtest.h>

#include "serve/child_process.h"
#include "support/small_scenes.h"
#include "support/temp_folder.h"
#include <chrono>
#include <csignal>
#include <functional>
#include <httplib.h>
#include <map>
#include <nlohmann/json.hpp>
#include <optional>
#include <regex>
#include <thread>

namespace obscura::serve {
namespace {

using nlohmann::json;
using namespace std::chrono_literals;
namespace fs = std::filesystem;

constexpr const char* json_type = "application/json";
constexpr const char* program = OBSCURA_BINARY_DIR "/bin/obscura";

template <typename Is>
bool becomes_so(const Is& is_so) {
    for (int i = 0; i < 6000; ++i) {
        if (is_so()) return true;
        std::this_thread::sleep_for(10ms);
    }
    return false;
}

/// A server with two small scenes below its root.
class JobsHttp : public testing::Test {
protected:
    void SetUp() override {
        fs::create_directories(folder_ / "root");
        folder_.write("root/quad.gltf", gltf_text(lit_quad_scene()));
        folder_.write("root/box.gltf", gltf_text(box_scene()));
        begin({"--token", "secret"});
    }
    void TearDown() override { end(); }

    void begin(const std::vector<std::string>& more) {
        std::vector<std::string> words = {program, "serve", "--port", "0", "--root", "root"};
        words.insert(words.end(), more.begin(), more.end());
        const fs::path out = folder_ / "out.txt";
        auto child = ChildProcess::start({words, folder_.path(), out, folder_ / "err.txt"});
        ASSERT_TRUE(child) << child.error().message;
        server_.emplace(std::move(*child));
        ASSERT_TRUE(becomes_so([&] { return read_whole_file(out).ends_with('\n'); }))
            << read_whole_file(folder_ / "err.txt");
        std::smatch match;
        const std::string url = read_whole_file(out);
        ASSERT_TRUE(std::regex_search(url, match, std::regex(R"(:(\d+)/#token=secret)"))) << url;
        port_ = std::stoi(match[1]);
        http_.emplace("127.0.0.1", port_);
        http_->set_bearer_token_auth("secret");
        http_->set_read_timeout(60);
    }
    int end() {
        if (!server_) return 0;
        server_->send(SIGTERM);
        becomes_so([&] { return server_->code().has_value(); });
        const int code = server_->code().value_or(-1);
        server_.reset();
        return code;
    }

    /// The answer's JSON; errors have "error".
    json read(const httplib::Result& answer, int status) const {
        EXPECT_TRUE(answer);
        if (!answer) return json::object();
        EXPECT_EQ(answer->status, status) << answer->body;
        EXPECT_EQ(answer->get_header_value("Content-Type"), json_type);
        return json::parse(answer->body, nullptr, false);
    }
    json get(const std::string& path, int status = 200) { return read(http_->Get(path), status); }
    json submit(const json& job, int status = 201) {
        return read(http_->Post("/api/jobs", job.dump(), json_type), status);
    }
    /// "ID place" of a job that is refused.
    std::string fault_of(const json& job, int status) {
        const json error = submit(job, status).value("error", json::object());
        return error.value("id", "") + " " + error.value("place", "");
    }
    std::string state(const std::string& id) { return get("/api/jobs/" + id).at("state"); }

    /// What `obscura batch` makes of the job, in the folder "own".
    void render_directly(json job) {
        job["assets"] = {(folder_ / "root").string() + "/*.gltf"};
        const fs::path own = folder_ / "own";
        fs::create_directories(own);
        folder_.write("own/job.json", job.dump());
        auto batch =
            ChildProcess::start({{program, "batch", "job.json"}, own, own / "log", own / "log"});
        ASSERT_TRUE(batch);
        ASSERT_TRUE(becomes_so([&] { return batch->code().has_value(); }));
        ASSERT_EQ(*batch->code(), 0) << read_whole_file(own / "log");
    }

    static json long_job() {
        return {{"assets", {"box.gltf"}}, {"options", {{"size", "640x480"}, {"spp", 100000}}}};
    }

    TempFolder folder_;
    std::optional<ChildProcess> server_;
    int port_ = 0;
    std::optional<httplib::Client> http_;
};

/// The events of a stream: their names and data.
std::vector<std::pair<std::string, json>> events_of(const std::string& text) {
    static const std::regex form("id: (\\S+)\nevent: (\\w+)\ndata: ([^\n]*)\n\n");
    std::vector<std::pair<std::string, json>> out;
    for (auto i = std::sregex_iterator(text.begin(), text.end(), form); i != std::sregex_iterator();
         ++i)
        out.emplace_back((*i)[2], json::parse((*i)[3].str()));
    return out;
}

TEST_F(JobsHttp, ImagesAreThoseOfBatch) {
    const json options = {{"size", "24x16"}, {"spp", 2}};
    const json job = {{"assets", {"*.gltf"}},
                      {"options", options},
                      {"looks", {"day", {{"name", "night"}, {"options", {{"exposure", -1}}}}}},
                      {"outputs", {"{asset}/{look}.png", "{asset}/{look}.exr"}},
                      {"contact_sheet", "index.html"}};
    const json taken = submit(job);
    const std::string id = taken.at("job");
    EXPECT_EQ(taken.at("pictures"), 4);
    std::string text;
    const auto streamed =
        http_->Get("/api/jobs/" + id + "/events", [&](const char* bytes, size_t count) {
            text.append(bytes, count);
            return true;
        });
    ASSERT_TRUE(streamed);
    EXPECT_EQ(streamed->get_header_value("Content-Type"), "text/event-stream");
    const auto events = events_of(text);
    ASSERT_GE(events.size(), 6U) << text;
    EXPECT_EQ(events.front().first, "state");
    EXPECT_EQ(events.back().second.at("state"), "done");
    EXPECT_EQ(std::count_if(events.begin(),
                            events.end(),
                            [](const auto& event) { return event.first == "picture"; }),
              4);
    render_directly(job);
    const std::string files = "/api/jobs/" + id + "/files";
    std::map<std::string, std::string> types;
    const json listed = get(files);
    for (const json& one : listed.at("files")) {
        const std::string name = one.at("file");
        const auto answer = http_->Get(files + "/" + name);
        ASSERT_TRUE(answer) << name;
        EXPECT_EQ(answer->body.size(), one.at("bytes"));
        const std::string type = answer->get_header_value("Content-Type");
        types[fs::path(name).extension()] = type;
        if (!type.starts_with("image/")) continue;
        EXPECT_EQ(answer->body, read_whole_file(folder_ / "own" / name)) << name;
    }
    EXPECT_EQ(types[".png"], "image/png");
    EXPECT_EQ(types[".exr"], "image/x-exr");
    EXPECT_EQ(types[".jsonl"], "application/x-ndjson");
    EXPECT_EQ(types[".html"], "text/html; charset=utf-8");
    const auto again = http_->Get("/api/jobs/" + id + "/events", {{"Last-Event-ID", "3"}});
    ASSERT_TRUE(again);
    const auto rest = events_of(again->body);
    ASSERT_EQ(rest.size(), 2U) << again->body;
    EXPECT_EQ(rest[0].first, "picture");
    EXPECT_EQ(rest[1].second.at("state"), "done");
    EXPECT_EQ(get("/api/jobs").at("jobs").size(), 1U);
    EXPECT_EQ(read(http_->Delete("/api/jobs/" + id), 200).at("removed"), true);
    get("/api/jobs/" + id, 404);
    EXPECT_EQ(end(), 0);
}

TEST_F(JobsHttp, AKilledServerTakesItsJobsAlong) {
    end();
    begin({"--token", "secret", "--jobs", "jobs"});
    const std::string id = submit(long_job()).at("job");
    ASSERT_TRUE(becomes_so([&] { return state(id) == "running"; }));
    const fs::path log = folder_ / "jobs" / id / "log.txt";
    ASSERT_TRUE(becomes_so([&] { return !read_whole_file(log).empty(); }));
    server_->send(SIGKILL);
    ASSERT_TRUE(becomes_so([&] { return server_->code().has_value(); }));
    EXPECT_EQ(*server_->code(), 128 + SIGKILL);
    server_.reset();
    EXPECT_TRUE(becomes_so([&] {
        return read_whole_file(log).find("RESULT code=143") != std::string::npos;
    })) << read_whole_file(log);
}

TEST_F(JobsHttp, WhatMayNotBeIsRefusedWithItsPlace) {
    const json plain = {{"assets", {"box.gltf"}}};
    const auto with = [&](const char* key, const json& value) {
        json job = plain;
        job[key] = value;
        return job;
    };
    EXPECT_EQ(fault_of(with("options", {{"spp", "many"}}), 400), "E-USAGE-NUMBER /options/spp");
    EXPECT_EQ(fault_of(with("looks", {{{"name", "x"}, {"options", {{"ocio", "a"}}}}}), 422),
              "E-JOB-KEY /looks/0/options/ocio");
    EXPECT_EQ(fault_of(with("options", {{"variants", "x"}}), 400),
              "E-VARIANT-UNKNOWN /options/variants");
    EXPECT_EQ(fault_of({{"assets", {"../root/box.gltf"}}}, 403), "E-URI-REFUSED /assets/0/files");
    EXPECT_EQ(fault_of({{"assets", {"box.gltf", "c*"}}}, 404), "E-JOB-ASSETS /assets/1/files");
    EXPECT_EQ(fault_of(with("outputs", {"/tmp/a.png"}), 403), "E-JOB-PATH /outputs/0");
    EXPECT_EQ(fault_of(with("comment", std::string(5U << 20U, 'x')), 413), "E-SERVE-SIZE body");
    EXPECT_EQ(fault_of(json::array(), 422), "E-JSON-ROOT body");
    read(http_->Post("/api/jobs", "{", json_type), 422);
    for (const char* type : {"text/plain", "application/jsonx"})
        read(http_->Post("/api/jobs", plain.dump(), type), 403);
    httplib::Client stranger("127.0.0.1", port_);
    read(stranger.Post("/api/jobs", plain.dump(), json_type), 401);
    EXPECT_EQ(get("/api/jobs").at("jobs").size(), 0U);
}

TEST_F(JobsHttp, WhoAsksForARangeIsGivenAll) {
    const auto all = http_->Get("/page.js");
    ASSERT_TRUE(all);
    for (const char* range : {"bytes=0-10", "bytes=99999999-", "bytes=-5"}) {
        const auto asked = http_->Get("/page.js", {{"Range", range}});
        ASSERT_TRUE(asked) << range;
        EXPECT_EQ(asked->status, 200);
        EXPECT_EQ(asked->body, all->body);
        const auto nothing = http_->Get("/nothing", {{"Range", range}});
        ASSERT_TRUE(nothing) << range;
        EXPECT_FALSE(json::parse(nothing->body, nullptr, false).is_discarded()) << nothing->body;
    }
}

TEST_F(JobsHttp, ACancelledJobEndsAndTheServerGoesOn) {
    json job = long_job();
    const std::string id = submit(job).at("job");
    ASSERT_TRUE(becomes_so([&] { return state(id) == "running"; }));
    read(http_->Delete("/api/jobs/" + id), 200);
    ASSERT_TRUE(becomes_so([&] { return state(id) != "running"; }));
    const json told = get("/api/jobs/" + id);
    EXPECT_EQ(told.at("state"), "cancelled");
    EXPECT_EQ(told.at("exit_code"), 128 + SIGTERM);
    EXPECT_EQ(told.at("error").at("id"), "E-STOPPED");
    job["options"] = {{"size", "8x8"}, {"spp", 1}};
    const std::string next = submit(job).at("job");
    EXPECT_TRUE(becomes_so([&] { return state(next) == "done"; }));
}

TEST_F(JobsHttp, WhoVanishesWhileListeningIsNoticed) {
    const std::string id = submit(long_job()).at("job");
    for (int i = 0; i < 3; ++i) {
        httplib::Client other("127.0.0.1", port_);
        other.set_bearer_token_auth("secret");
        other.Get("/api/jobs/" + id + "/events",
                  [](const char* /*bytes*/, size_t /*count*/) { return false; });
    }
    EXPECT_TRUE(becomes_so([&] { return get("/api/jobs/" + id).at("listeners") == 0; }));
    EXPECT_EQ(state(id), "running");
    EXPECT_EQ(end(), 0);  // with a job under way
}

}  // namespace
}  // namespace obscura::serve
