// tests/serve/jobs_test.cpp - the queue of jobs, with a shell script in place of the program.
// SPDX-License-Identifier: Apache-2.0
#include "serve/jobs.h"

#include <gtest/gtest.h>

#include "support/temp_folder.h"
#include <chrono>
#include <csignal>
#include <functional>
#include <optional>
#include <thread>

namespace obscura::serve {
namespace {

using nlohmann::json;
using namespace std::chrono_literals;
namespace fs = std::filesystem;

/// What it does is named by the job's look.
constexpr const char* program_text = R"(#!/bin/sh
case "$*" in *--dry-run*)
    if grep -q '"hang"' ../job.json; then sleep 1000; fi
    if grep -q '"refused"' ../job.json; then
        echo 'ERROR ../job.json#/looks/0: not so [E-X]' >&2
        echo 'RESULT code=65 id=E-X where=../job.json#/looks/0 warnings=0' >&2
        exit 65
    fi
    echo "INFO 2 images" >&2
    echo "RESULT code=0 id=OK where=x warnings=0" >&2
    exit 0
esac
echo "$@" > words.txt
picture='{"files":[],"asset":"'$(readlink -f "$PWD/../../..")'/root/a.glb",'
picture=$picture'"warnings":["w"],"exit_code":0,"id":"OK"}'
echo "$picture" >> manifest.jsonl
if grep -q '"waits"' ../job.json; then
    while [ ! -e ../../../go ]; do sleep 0.02; done
fi
if grep -q '"stops"' ../job.json; then
    trap 'echo "RESULT code=143 id=E-STOPPED where=x warnings=0" >&2; exit 143' TERM
    while :; do sleep 0.02; done
fi
if grep -q '"stubborn"' ../job.json; then
    trap '' TERM
    sleep 1000 & echo $! > child.txt
    wait
    sleep 1000
fi
if grep -q '"fails"' ../job.json; then
    echo 'ERROR a.glb: broken [E-Y]' >&2
    echo 'RESULT code=66 id=E-Y where=a.glb warnings=3' >&2
    exit 66
fi
if grep -q '"crashes"' ../job.json; then kill -SEGV $$; fi
echo '{"files":[],"warnings":[],"exit_code":65,"id":"E-Z"}' >> manifest.jsonl
echo "RESULT code=0 id=OK where=x warnings=1" >&2
)";

bool wait_until(const std::function<bool()>& is_so) {
    for (int i = 0; i < 1000; ++i) {
        if (is_so()) return true;
        std::this_thread::sleep_for(10ms);
    }
    return false;
}

class JobsTest : public testing::Test {
protected:
    void SetUp() override {
        fs::create_directories(folder_ / "root");
        fs::create_directories(folder_ / "jobs");
        folder_.write("root/a.glb", "a");
        options_.program = folder_.write("program", program_text);
        fs::permissions(options_.program, fs::perms::owner_all);
        options_.folder = folder_ / "jobs";
        options_.words = {"--threads", "1"};
        service_.emplace(ServiceOptions{{folder_ / "root"}, 1000, {}});
    }
    void TearDown() override { jobs_.reset(); }
    void begin() { jobs_.emplace(options_, *service_); }

    static json job(const std::string& look) {
        return {{"assets", {"a.glb"}}, {"looks", json::array({look})}};
    }
    std::string submit(const std::string& look) {
        const auto taken = jobs_->submit(job(look));
        EXPECT_TRUE(taken) << taken.error().message;
        return taken ? (*taken)["job"].get<std::string>() : "";
    }
    std::string fault_of(const std::string& look) {
        const auto taken = jobs_->submit(job(look));
        return taken ? "OK" : taken.error().id + " " + taken.error().where;
    }
    Json told(const std::string& id) const {
        const auto all = jobs_->describe(id);
        return all ? *all : Json{{"state", "gone"}};
    }
    std::string state(const std::string& id) const { return told(id)["state"]; }
    bool gets(const std::string& id, const std::string& wanted) const {
        return wait_until([&] { return state(id) == wanted; });
    }

    TempFolder folder_;
    JobsOptions options_;
    std::optional<Service> service_;
    std::optional<Jobs> jobs_;
};

TEST_F(JobsTest, AJobTellsWhatBecameOfIt) {
    begin();
    const std::string id = submit("plain");
    ASSERT_TRUE(gets(id, "done"));
    const Json all = told(id);
    EXPECT_EQ(all["pictures"], 2);
    EXPECT_EQ(all["finished"], 1);
    EXPECT_EQ(all["failures"], 1);
    EXPECT_EQ(all["warnings"], 1);
    EXPECT_EQ(all["exit_code"], 0);
    EXPECT_GT(all["seconds"], 0.0);
    ASSERT_EQ(all["lines"].size(), 2U);
    EXPECT_EQ(all["lines"][0]["asset"], "a.glb");  // as the client named it
    EXPECT_EQ(all["lines"][1]["id"], "E-Z");
    EXPECT_EQ(read_whole_file(*jobs_->file(id, "words.txt")), "batch ../job.json --threads 1\n");
    const Json files = *jobs_->list_files(id);
    EXPECT_EQ(files["files"][0]["file"], "manifest.jsonl");
    EXPECT_EQ(files["files"][1]["file"], "words.txt");
}

TEST_F(JobsTest, PatternsTakeModelsBelowTheRoots) {
    fs::create_directories(folder_ / "root/[in]");
    folder_.write("root/[in]/b.gltf", "b");
    folder_.write("root/notes.txt", "notes");
    fs::create_directories(folder_ / "root/folder.glb");
    fs::create_symlink(folder_ / "program", folder_ / "root/out.glb");
    fs::create_symlink(folder_ / "root/a.glb", folder_ / "root/in.glb");
    fs::create_directory_symlink(folder_.path(), folder_ / "root/up");
    folder_.write("secret.glb", "secret");
    using Names = std::vector<std::string>;
    const KnownFiles& files = service_->files();
    EXPECT_EQ(files.match("*"), (Names{"a.glb", "in.glb"}));
    EXPECT_EQ(files.match("*/*"), Names{"[in]/b.gltf"});
    EXPECT_EQ(files.match("[!a]*.gl?"), Names{"in.glb"});
    EXPECT_EQ(files.match(".*/*.glb"), Names());  // none of ../
    EXPECT_EQ(files.match("none*"), Names());
}

TEST_F(JobsTest, FilesOutsideOfTheJobStayThere) {
    begin();
    const std::string id = submit("plain");
    ASSERT_TRUE(gets(id, "done"));
    fs::create_symlink(folder_ / "program", folder_ / "jobs" / id / "files/link");
    for (const char* const name : {"../job.json", "../../../program", "link", "/etc/hostname"})
        EXPECT_EQ(jobs_->file(id, name).error().id, "E-URI-REFUSED") << name;
    EXPECT_EQ(jobs_->file(id, "none").error().id, "E-SCENE-MISSING");
    EXPECT_EQ(jobs_->file("j99", "none").error().id, "E-SERVE-UNKNOWN");
    EXPECT_EQ(jobs_->remove("j99").error().id, "E-SERVE-UNKNOWN");
}

TEST_F(JobsTest, OneRunsAndTheOthersWait) {
    begin();
    const std::string first = submit("waits"), second = submit("plain"), third = submit("plain");
    ASSERT_TRUE(gets(first, "running"));
    EXPECT_EQ(state(second), "queued");
    const auto cancelled = jobs_->remove(third);
    ASSERT_TRUE(cancelled);
    EXPECT_EQ((*cancelled)["state"], "cancelled");
    EXPECT_EQ((*cancelled)["exit_code"], Json());
    folder_.write("go", "");
    EXPECT_TRUE(gets(second, "done"));
    EXPECT_EQ(state(first), "done");
    EXPECT_EQ(state(third), "cancelled");
    EXPECT_EQ(jobs_->list()["jobs"].size(), 3U);
}

TEST_F(JobsTest, FailuresAndCrashesHaveAnError) {
    begin();
    const std::string fails = submit("fails"), crashes = submit("crashes");
    ASSERT_TRUE(gets(fails, "failed"));
    EXPECT_EQ(told(fails)["exit_code"], 66);
    EXPECT_EQ(told(fails)["error"]["id"], "E-Y");
    EXPECT_EQ(told(fails)["error"]["text"], "broken");
    EXPECT_EQ(told(fails)["warnings"], 3);
    ASSERT_TRUE(gets(crashes, "failed"));
    EXPECT_EQ(told(crashes)["exit_code"], 128 + SIGSEGV);
    EXPECT_EQ(told(crashes)["error"]["id"], "E-INTERNAL");
}

TEST_F(JobsTest, ACancelledJobKeepsWhatIsFinished) {
    begin();
    const std::string id = submit("stops");
    ASSERT_TRUE(wait_until([&] { return told(id)["finished"] == 1; }));
    EXPECT_EQ((*jobs_->remove(id))["removed"], false);
    ASSERT_TRUE(gets(id, "cancelled"));
    EXPECT_EQ(told(id)["exit_code"], 143);
    EXPECT_EQ(told(id)["finished"], 1);
    EXPECT_EQ((*jobs_->remove(id))["removed"], true);
    EXPECT_EQ(state(id), "gone");
    EXPECT_FALSE(fs::exists(folder_ / "jobs" / id));
}

TEST_F(JobsTest, WhoDoesNotEndIsKilledWithAllItStarted) {
    options_.grace = 200ms;
    begin();
    const std::string id = submit("stubborn");
    ASSERT_TRUE(wait_until([&] { return told(id)["finished"] == 1; }));
    const fs::path child = folder_ / "jobs" / id / "files/child.txt";
    ASSERT_TRUE(wait_until([&] { return !read_whole_file(child).empty(); }));
    const pid_t process = std::stoi(read_whole_file(child));
    jobs_->remove(id);
    ASSERT_TRUE(gets(id, "cancelled"));
    EXPECT_EQ(told(id)["exit_code"], 128 + SIGKILL);
    // Where nobody waits for it, it stays as a name without a program.
    const std::string status = "/proc/" + std::to_string(process) + "/stat";
    EXPECT_TRUE(wait_until([&] {
        const std::string text = read_whole_file(status);
        return text.empty() || text.find(") Z ") != std::string::npos;
    }));
}

TEST_F(JobsTest, WhatTheProgramRefusesIsNoJob) {
    begin();
    EXPECT_EQ(fault_of("refused"), "E-X /looks/0");
    EXPECT_EQ(jobs_->list()["jobs"].size(), 0U);
    EXPECT_TRUE(fs::is_empty(folder_ / "jobs"));
}

TEST_F(JobsTest, ACheckHasALimit) {
    options_.check_limit = 200ms;
    begin();
    EXPECT_EQ(fault_of("hang"), "E-JOB-LIMIT job");
    options_.program = folder_ / "none";
    begin();
    EXPECT_EQ(fault_of("plain"), "E-JOB-START " + options_.program);
}

TEST_F(JobsTest, TheOldestThatHasEndedMakesRoom) {
    options_.max_kept = 2;
    begin();
    const std::string first = submit("plain");
    ASSERT_TRUE(gets(first, "done"));
    const std::string second = submit("waits"), third = submit("plain");
    EXPECT_EQ(state(first), "gone");
    EXPECT_TRUE(fs::exists(folder_ / "jobs" / first));  // that folder is to be kept
    EXPECT_EQ(fault_of("plain"), "E-SERVE-BUSY job");
    folder_.write("go", "");
    EXPECT_TRUE(gets(third, "done"));
    EXPECT_EQ(fault_of("plain"), "OK");
    EXPECT_EQ(state(second), "gone");
}

TEST_F(JobsTest, TheEndOfAllEndsThem) {
    begin();
    const std::string first = submit("stops"), second = submit("plain");
    ASSERT_TRUE(gets(first, "running"));
    jobs_.reset();
    EXPECT_TRUE(fs::exists(folder_ / "jobs" / first / "log.txt"));
    EXPECT_FALSE(fs::exists(folder_ / "jobs" / second / "log.txt"));
    begin();  // numbers go on, as the folders are there
    EXPECT_EQ(submit("plain"), "j3");
}

TEST_F(JobsTest, ATemporaryFolderGoesInTheEnd) {
    options_.folder.clear();
    begin();
    const std::string id = submit("plain");
    ASSERT_TRUE(gets(id, "done"));
    const fs::path folder = (*jobs_->find(id))->folder();
    EXPECT_TRUE(fs::exists(folder));
    jobs_.reset();
    EXPECT_FALSE(fs::exists(folder.parent_path()));
}

TEST_F(JobsTest, AnUploadStaysWhileItsJobWaits) {
    begin();
    const auto keep = [&](const std::string& bytes) {
        return service_->files().keep(
            "up.glb", [&](const ByteSink& sink) { return sink(std::as_bytes(std::span(bytes))); });
    };
    const auto name = keep(std::string(600, 'x'));
    ASSERT_TRUE(name);
    const auto taken = jobs_->submit({{"assets", {*name}}});
    ASSERT_TRUE(taken) << taken.error().message;
    ASSERT_TRUE(keep(std::string(900, 'y')));
    EXPECT_FALSE(service_->files().find(*name));
    const auto job = *jobs_->find((*taken)["job"]);
    const fs::path own = job->checked().job["assets"][0]["files"].get<std::string>();
    EXPECT_EQ(fs::file_size(own), 600U);
    EXPECT_EQ(own.filename(), "up.glb");
}

std::string all_events(JobEvents& events) {
    std::string out;
    for (int i = 0; i < 1000 && !events.is_over(); ++i)
        out += events.next();
    return out;
}

TEST_F(JobsTest, EventsTellStatesAndImages) {
    begin();
    const std::string id = submit("waits");
    ASSERT_TRUE(wait_until([&] { return told(id)["finished"] == 1; }));
    const auto events = jobs_->listen(id, 0);
    ASSERT_TRUE(events);
    EXPECT_EQ(told(id)["listeners"], 1);
    const std::string first = (*events)->next();
    EXPECT_NE(first.find("id: 0-running\nevent: state\ndata: {\"job\":\"" + id), std::string::npos);
    EXPECT_NE((*events)->next().find("id: 1\nevent: picture\ndata: {"), std::string::npos);
    folder_.write("go", "");
    const std::string rest = all_events(**events);
    EXPECT_NE(rest.find("id: 2\nevent: picture\n"), std::string::npos);
    EXPECT_NE(rest.find("id: 2-done\nevent: state\n"), std::string::npos);
    EXPECT_TRUE(rest.ends_with("\n\n"));
    const std::string later = all_events(**jobs_->listen(id, 1));
    EXPECT_EQ(later.find("id: 1\n"), std::string::npos);
    EXPECT_NE(later.find("id: 2\nevent: picture\n"), std::string::npos);
    EXPECT_NE(later.find("id: 2-done\n"), std::string::npos);
}

TEST_F(JobsTest, ListenersAreCounted) {
    options_.max_listeners = 2;
    begin();
    const std::string id = submit("plain");
    {
        const auto one = jobs_->listen(id, 0), two = jobs_->listen(id, 0);
        EXPECT_TRUE(one && two);
        EXPECT_EQ(jobs_->listen(id, 0).error().id, "E-SERVE-BUSY");
    }
    EXPECT_TRUE(jobs_->listen(id, 0));
    EXPECT_EQ(told(id)["listeners"], 0);
}

}  // namespace
}  // namespace obscura::serve
