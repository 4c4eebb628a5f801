// tests/cli/batch_parts_test.cpp - parts of a job know the files of each other's images.
// SPDX-License-Identifier: Apache-2.0
#include "cli/cli.h"
#include <nlohmann/json.hpp>
#include <set>

namespace obscura {
namespace batch_parts {

namespace fs = std::filesystem;
using nlohmann::json;
using Texts = std::vector<std::string>;

class BatchParts : public Cli {
protected:
    /// A job of copies of one scene, seen from one place as `a_b` and as `b`.
    json job_of(const Texts& assets, const std::string& output) const {
        json job = {{"looks", {"a"}}, {"outputs", {output}}};
        folder_.write("views.json", R"({"views": [{"name": "a_b"}, {"name": "b"}]})");
        job["options"] = {{"size", "8x8"}, {"spp", 1}, {"views", "views.json"}};
        for (const std::string& asset : assets) {
            fs::copy_file(folder_ / "box.gltf", folder_ / (asset + ".gltf"));
            job["assets"].push_back(asset + ".gltf");
        }
        return job;
    }
    ProgramRun batch(const json& job, const Texts& more) const {
        folder_.write("job.json", job.dump());
        return run(joined({"batch", "job.json"}, more));
    }
    void expect_refused(const ProgramRun& got, const std::string& file) const {
        expect_result(got, 64, "E-USAGE-SAMEFILE");
        EXPECT_THAT(got.err, testing::HasSubstr(file));
    }
};

TEST_F(BatchParts, NoImageTakesTheFileOfAnotherPart) {
    json job = job_of({"x", "x_a"}, "{asset}_{view}.png");
    expect_result(batch(job, {"--part", "1/2"}), 0, "OK");
    expect_refused(batch(job, {"--part", "2/2"}), "x_a_b.png");
    expect_refused(batch(job, {"--part", "2/2", "--dry-run"}), "x_a_b.png");
    job["outputs"] = {"{asset}/{view}.png"};
    for (const char* part : {"1/2", "2/2"})
        expect_result(batch(job, {"--part", part}), 0, "OK");
}

TEST_F(BatchParts, NorThatOfALayerOrByAnotherPath) {
    json layers = job_of({"x", "x.normal"}, "{asset}.exr");
    layers["options"] = {
        {"size", "8x8"}, {"spp", 1}, {"aov", "normal"}, {"exr-layout", "separate"}};
    expect_result(batch(layers, {"--part", "1/2"}), 0, "OK");
    expect_refused(batch(layers, {"--part", "2/2"}), "x.normal.exr");
    const std::string folder = (folder_ / "job.json").parent_path().string();
    json paths = job_of({"y", "zy"}, "{asset}_{view}.png");
    paths["outputs"].push_back(folder + "/z{asset}_{view}.png");
    expect_result(batch(paths, {"--part", "1/2"}), 0, "OK");
    expect_refused(batch(paths, {"--part", "2/2"}), "zy_a_b.png");
}

/// Each part makes and refuses what the whole job does.
TEST_F(BatchParts, RefuseWhatTheWholeJobDoes) {
    const json job = job_of({"x", "x_a", "x_a_b"}, "{asset}_{view}.png");
    const auto files = [&] {
        std::set<std::string> out;
        for (const fs::directory_entry& entry :
             fs::directory_iterator((folder_ / "job.json").parent_path())) {
            if (entry.path().extension() == ".png") out.insert(entry.path().filename().string());
        }
        return out;
    };
    expect_result(batch(job, {}), 64, "E-USAGE-SAMEFILE");
    const std::set<std::string> whole = files();
    EXPECT_EQ(whole.size(), 4U);
    for (const std::string& file : whole)
        fs::remove(folder_ / file);
    expect_result(batch(job, {"--part", "1/2"}), 0, "OK");
    expect_refused(batch(job, {"--part", "2/2"}), "x_a_b.png");
    EXPECT_EQ(files(), whole);
}

}  // namespace batch_parts
}  // namespace obscura
