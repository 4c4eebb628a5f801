// tests/serve/known_files_test.cpp - names of clients become files, never outside the roots.
// SPDX-License-Identifier: Apache-2.0
#include "serve/known_files.h"

#include <gtest/gtest.h>

#include "support/temp_folder.h"
#include <algorithm>
#include <filesystem>
#include <fstream>

namespace obscura::serve {
namespace {

namespace fs = std::filesystem;

class KnownFilesTest : public testing::Test {
protected:
    void SetUp() override {
        fs::create_directories(folder_ / "root/shoes/.hidden");
        folder_.write("secret.glb", "secret");
        fs::create_directories(folder_ / "root2");
        folder_.write("root2/secret.glb", "secret");
        folder_.write("root/a.glb", "a");
        folder_.write("root/sky.hdr", "sky");
        folder_.write("root/notes.txt", "notes");
        folder_.write("root/shoes/left.gltf", "left");
        folder_.write("root/shoes/.hidden/b.glb", "b");
        fs::create_symlink(folder_ / "secret.glb", folder_ / "root/out.glb");
        fs::create_symlink(folder_ / "root/a.glb", folder_ / "root/in.glb");
        files_.emplace(std::vector<fs::path>{folder_ / "root"}, 100);
    }

    std::string id_of(const std::string& name) const {
        const auto found = files_->find(name);
        return found ? "OK" : found.error().id;
    }

    Result<std::string> keep(const std::string& name, const std::string& bytes) {
        return files_->keep(name, [&](const ByteSink& sink) -> Result<void> {
            for (size_t at = 0; at < bytes.size(); at += 7) {
                const std::string piece = bytes.substr(at, 7);
                if (auto taken = sink(std::as_bytes(std::span(piece))); !taken) return taken;
            }
            return {};
        });
    }

    static std::string text_of(const fs::path& file) {
        std::ifstream in(file, std::ios::binary);
        return {std::istreambuf_iterator<char>(in), {}};
    }

    TempFolder folder_;
    std::optional<KnownFiles> files_;
};

TEST_F(KnownFilesTest, ModelsAndEnvironmentsBelowTheRootsAreListed) {
    std::vector<std::string> names;
    for (const KnownFile& file : files_->list())
        names.push_back(file.name + (file.kind == FileKind::environment ? " light" : ""));
    EXPECT_EQ(names,
              (std::vector<std::string>{"a.glb", "in.glb", "shoes/left.gltf", "sky.hdr light"}));
}

TEST_F(KnownFilesTest, NamesNeverLeadOut) {
    EXPECT_EQ(id_of("a.glb"), "OK");
    EXPECT_EQ(id_of("in.glb"), "OK");
    EXPECT_EQ(id_of("shoes/left.gltf"), "OK");
    EXPECT_EQ(id_of("shoes/../a.glb"), "OK");
    const std::string absolute = (folder_ / "root/a.glb").string();
    for (const std::string& name : {std::string("../secret.glb"),
                                    std::string("shoes/../../secret.glb"),
                                    std::string("../root2/secret.glb"),
                                    std::string("out.glb"),
                                    absolute,
                                    std::string("/etc/passwd"),
                                    std::string("a.glb\0.hdr", 10),
                                    std::string("../no/such/file"),
                                    std::string()})
        EXPECT_EQ(id_of(name), "E-URI-REFUSED") << name;
    EXPECT_EQ(id_of("b.glb"), "E-SCENE-MISSING");
    EXPECT_EQ(id_of("shoes"), "E-SCENE-MISSING");
    EXPECT_EQ(id_of("%2e%2e/secret.glb"), "E-SCENE-MISSING");
    EXPECT_EQ(id_of("upload:a.glb"), "E-SCENE-MISSING");
}

TEST_F(KnownFilesTest, PatternsFitModelsAndNeverLeadOut) {
    using Names = std::vector<std::string>;
    EXPECT_EQ(files_->match("*.glb"), (Names{"a.glb", "in.glb"}));
    EXPECT_EQ(files_->match("shoes/*"), (Names{"shoes/left.gltf"}));
    EXPECT_EQ(files_->match("*/*"), (Names{"shoes/left.gltf"}));
    EXPECT_EQ(files_->match("[a-b].glb"), (Names{"a.glb"}));
    for (const char* none :
         {"*.hdr", ".?/*", "shoes/.?/*.glb", "shoes/.*/*", "*/.?/.?/*.glb", "/*"})
        EXPECT_EQ(files_->match(none), Names()) << none;
}

TEST_F(KnownFilesTest, UploadsAreKeptByTheirBytes) {
    const Result<std::string> first = keep("C:\\Users\\me\\shoe.glb", "twenty bytes of shoe");
    ASSERT_TRUE(first) << first.error().message;
    EXPECT_TRUE(first->starts_with("upload:")) << *first;
    EXPECT_TRUE(first->ends_with("/shoe.glb")) << *first;
    const auto file = files_->find(*first);
    ASSERT_TRUE(file);
    EXPECT_EQ(text_of(*file), "twenty bytes of shoe");
    const Result<std::string> again = keep("folder/shoe.glb", "twenty bytes of shoe");
    ASSERT_TRUE(again);
    EXPECT_EQ(*again, *first);
    const Result<std::string> other = keep("boot.glb", "twenty bytes of shoe");
    ASSERT_TRUE(other);
    EXPECT_EQ(text_of(*files_->find(*other)), "twenty bytes of shoe");
    EXPECT_TRUE(fs::equivalent(*files_->find(*other), *file));
    EXPECT_EQ(id_of(*first + "/../../../secret.glb"), "E-URI-REFUSED");
    EXPECT_EQ(id_of("upload:../secret.glb"), "E-URI-REFUSED");
    const fs::path kept = file->parent_path().parent_path();
    files_.reset();
    EXPECT_FALSE(fs::exists(kept));
}

TEST_F(KnownFilesTest, TheOldestUploadsMakeRoom) {
    const Result<std::string> a = keep("a.glb", std::string(40, 'a'));
    const Result<std::string> b = keep("b.glb", std::string(40, 'b'));
    ASSERT_TRUE(keep("a.glb", std::string(40, 'a')));  // now b is the oldest
    const Result<std::string> c = keep("c.glb", std::string(60, 'c'));
    ASSERT_TRUE(a && b && c);
    EXPECT_EQ(id_of(*a), "OK");
    EXPECT_EQ(id_of(*b), "E-SCENE-MISSING");
    EXPECT_EQ(id_of(*c), "OK");
    const Result<std::string> d = keep("d.glb", std::string(101, 'd'));
    ASSERT_FALSE(d);
    EXPECT_EQ(d.error().id, "E-SERVE-SIZE");
    EXPECT_EQ(id_of(*c), "OK");
}

TEST_F(KnownFilesTest, UploadsNeedANameOfAKnownKind) {
    for (const char* name : {"", "shoe", "shoe.exe", ".glb", "a\nb.glb", "folder/", "..", "x.pic/"})
        EXPECT_EQ(keep(name, "bytes").error().id, "E-SERVE-NAME") << name;
    EXPECT_TRUE(keep("SHOE.GLB", "bytes"));
    EXPECT_TRUE(keep("sky.exr", "bytes"));
}

TEST_F(KnownFilesTest, WhatIsBrokenOffLeavesNothing) {
    const Result<std::string> kept = files_->keep("a.glb", [](const ByteSink& sink) {
        const std::string half = "half";
        EXPECT_TRUE(sink(std::as_bytes(std::span(half))));
        return Result<void>(fail(ExitCode::bad_data, "E-SERVE-BODY", "body", "gone"));
    });
    EXPECT_EQ(kept.error().id, "E-SERVE-BODY");
    const Result<std::string> whole = keep("b.glb", "whole");
    ASSERT_TRUE(whole);
    const fs::path folder = files_->find(*whole)->parent_path().parent_path();
    EXPECT_EQ(std::distance(fs::directory_iterator(folder), fs::directory_iterator()), 1);
}

}  // namespace
}  // namespace obscura::serve
