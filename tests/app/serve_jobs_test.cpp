// tests/app/serve_jobs_test.cpp - what jobs of `obscura serve` may say, and what they are given.
// SPDX-License-Identifier: Apache-2.0
#include "app/serve_jobs.h"

#include "app/render_options.h"

#include <gtest/gtest.h>

#include "serve/option_names.h"
#include <filesystem>

namespace obscura::app {
namespace {

using Texts = std::vector<std::string>;

/// All names of options, without dashes.
std::vector<OptionInfo> all_options(RenderArguments& arguments) {
    std::vector<OptionInfo> out;
    for (const BoundOption& option : bind_all(std::span(render_option_groups()), arguments))
        out.push_back(option.info);
    return out;
}

TEST(ServeJobs, NoOptionOfAClientNamesAFile) {
    RenderArguments arguments;
    int allowed = 0;
    for (const OptionInfo& info : all_options(arguments)) {
        const std::string name = long_name(info), argument = info.argument;
        if (!name.starts_with("--") || !serve::is_job_option(name.substr(2))) continue;
        ++allowed;
        EXPECT_EQ(argument.find("DIR"), std::string::npos) << name;
        if (name == "--env") continue;  // which the server looks up
        EXPECT_EQ(argument.find("FILE"), std::string::npos) << name;
        EXPECT_STREQ(info.files, "") << name;
    }
    EXPECT_GT(allowed, 90);
    EXPECT_TRUE(serve::is_view_option("spp"));
    EXPECT_FALSE(serve::is_view_option("turntable"));
    EXPECT_FALSE(serve::is_job_option("--spp"));
}

TEST(ServeJobs, JobsGetTheServersOwnOptions) {
    serve::JobsOptions jobs;
    complete_jobs_options({}, jobs);
    EXPECT_EQ(jobs.words, (Texts{"--priority", "low"}));
    EXPECT_TRUE(jobs.options.empty());
    RenderArguments common;
    common.threads = "3";
    common.priority = "normal";
    common.texture_cache = "cache";
    common.ocio = "a.ocio";
    jobs = {};
    complete_jobs_options(common, jobs);
    const std::string folder = std::filesystem::current_path().string();
    EXPECT_EQ(
        jobs.words,
        (Texts{"--threads", "3", "--priority", "normal", "--texture-cache", folder + "/cache"}));
    EXPECT_EQ(jobs.options["ocio"], folder + "/a.ocio");
}

}  // namespace
}  // namespace obscura::app
