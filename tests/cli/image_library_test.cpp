// tests/cli/image_library_test.cpp - OpenImageIO is opened late: without it the rest works.
// SPDX-License-Identifier: Apache-2.0
#include "cli/cli.h"
#include "support/text_files.h"

namespace obscura {
namespace {

namespace fs = std::filesystem;
using testing::HasSubstr;
using testing::Not;
using Texts = std::vector<std::string>;

/// A program beside which there is no module, unless a test puts one there.
class ImageLibrary : public Cli {
protected:
    void SetUp() override {
        Cli::SetUp();
        fs::create_directories(folder_ / "bin");
        fs::copy_file(OBSCURA_BINARY_DIR "/bin/obscura", folder_ / "bin/obscura");
    }
    ProgramRun run_copy(const Texts& arguments) const {
        ProgramSetup alone = setup(arguments, folder_);
        alone.arguments.front() = (folder_ / "bin/obscura").string();
        return run_program_with(alone);
    }
    static std::string showcase() { return OBSCURA_SOURCE_DIR "/assets/showcase/showcase.gltf"; }
    static fs::path module() { return OBSCURA_BINARY_DIR "/lib/obscura/libobscura_oiio.so"; }
    fs::path module_place() const {
        fs::create_directories(folder_ / "lib/obscura");
        return folder_ / "lib/obscura" / module().filename();
    }
};

TEST_F(ImageLibrary, WhatNeedsNoneRunsWithoutIt) {
    EXPECT_EQ(run_copy({"--version"}).code, 0);
    expect_result(run_copy({"info", showcase(), "--json"}), 0, "OK");
    const Texts outputs = {"--env",
                           "studio",
                           "-o",
                           "a.exr",
                           "-o",
                           "a.webp",
                           "-o",
                           "a.png",
                           "--segmentation",
                           "ids.png"};
    expect_result(run_copy(small_render("box.gltf", outputs)), 0, "OK");
    for (const char* output : {"b.exr", "b.png"}) {
        const Texts again = {"--env", "studio", "-o", output, "--skip-existing"};
        for (int i = 0; i < 2; ++i)
            expect_result(run_copy(small_render("box.gltf", again)), 0, "OK");
    }
}

TEST_F(ImageLibrary, WhatNeedsItSaysSoBeforeTheWork) {
    for (const Texts& more : {Texts{"-o", "a.jpg"}, Texts{"-o", "a.exr", "-o", "a.tif"}}) {
        const ProgramRun got = run_copy(small_render("box.gltf", more));
        expect_result(got, 69, "E-OIIO");
        EXPECT_THAT(got.err, HasSubstr("libobscura_oiio.so"));
        EXPECT_FALSE(fs::exists(folder_ / "a.exr"));
    }
    expect_result(run_copy(small_render(showcase(), {"-o", "a.exr"})), 69, "E-OIIO");
}

TEST_F(ImageLibrary, AModuleThatDoesNotFitIsNotUsed) {
    std::ofstream(module_place()) << "no library";
    expect_result(run_copy(small_render("box.gltf", {"-o", "a.jpg"})), 69, "E-OIIO");
    fs::copy_file(OBSCURA_BINARY_DIR "/foreign_plugins/foreign.imageio.so",
                  module_place(),
                  fs::copy_options::overwrite_existing);
    const ProgramRun got = run_copy(small_render("box.gltf", {"-o", "a.jpg"}));
    expect_result(got, 69, "E-OIIO");
    EXPECT_THAT(got.err, HasSubstr("is not of version"));
}

TEST_F(ImageLibrary, BesideTheProgramItIsFound) {
    fs::copy_file(module(), module_place());
    expect_result(run_copy(small_render(showcase(), {"-o", "a.png"})), 0, "OK");
    expect_result(run(small_render(showcase(), {"-o", "b.png"})), 0, "OK");
    EXPECT_TRUE(read_text(folder_ / "a.png") == read_text(folder_ / "b.png"));
}

}  // namespace
}  // namespace obscura
