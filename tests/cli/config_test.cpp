// tests/cli/config_test.cpp - options from the file of --config, under those of the command line.
// SPDX-License-Identifier: Apache-2.0
#include "cli/cli.h"

namespace obscura {
namespace {

using testing::HasSubstr;

class Config : public Cli {
protected:
    /// Checks a scene with a file of options; --check reads everything and renders nothing.
    ProgramRun check(const std::string& text, std::vector<std::string> more = {}) {
        folder_.write("look.toml", text);
        std::vector<std::string> arguments = {
            "render", "box.gltf", "--check", "--config", "look.toml"};
        arguments.insert(arguments.end(), more.begin(), more.end());
        return run(arguments);
    }
};

TEST_F(Config, OptionsOfAFileMakeTheImage) {
    folder_.write("look.toml",
                  "# for every command\n"
                  "quiet = true  # no notes\n"
                  "size = \"9x9\"\n"
                  "\n"
                  "[render]\n"
                  "size = 8x6\n"
                  "spp = 2\n"
                  "eye = [2, 1, 3]\n"
                  "output = [\"shot #1.exr\", b.png]\n"
                  "\n"
                  "[bench]\n"
                  "repeat = 3\n");
    const ProgramRun got = run({"render", "box.gltf", "--config", "look.toml"});
    EXPECT_EQ(got.code, 0) << got.err;
    EXPECT_EQ(got.err, "") << "quiet was asked for";
    const auto image = read_image_file(folder_ / "shot #1.exr");
    ASSERT_TRUE(image);
    EXPECT_EQ(image->width, 8);
    EXPECT_EQ(image->height, 6);
    EXPECT_TRUE(std::filesystem::exists(folder_ / "b.png"));
}

TEST_F(Config, TheCommandLineGoesBefore) {
    folder_.write("look.toml", "size = 8x6\nspp = 1\nlens-radius = 0.1\nverbose = true\n");
    const ProgramRun got = run({"render",
                                "box.gltf",
                                "--config",
                                "look.toml",
                                "--size",
                                "4x3",
                                "--fstop",
                                "2",
                                "--quiet",
                                "-o",
                                "a.exr"});
    EXPECT_EQ(got.code, 0) << got.err;
    const auto image = read_image_file(folder_ / "a.exr");
    ASSERT_TRUE(image);
    EXPECT_EQ(image->width, 4);
}

TEST_F(Config, MistakesSayWhereTheyAre) {
    expect_result(run({"info", "box.gltf", "--config", "none.toml"}), 66, "E-CONFIG-MISSING");
    expect_result(run({"info", "box.gltf", "--config", "."}), 66, "E-CONFIG-MISSING");
    const ProgramRun unknown = check("[render]\nsp = 3\n");
    expect_result(unknown, 64, "E-CONFIG-KEY");
    EXPECT_THAT(unknown.err, HasSubstr("look.toml#render.sp"));
    EXPECT_THAT(unknown.err, HasSubstr("did you mean spp?"));
    expect_result(check("[paint]\nspp = 3\n"), 64, "E-CONFIG-KEY");
    expect_result(check("SCENE = 3\n"), 64, "E-CONFIG-KEY");
    expect_result(check("config = other.toml\n"), 64, "E-CONFIG-KEY");
    expect_result(check("spp = 3\nseed = 4\nspp = 5\n"), 64, "E-CONFIG-KEY");
    expect_result(check("spp = [1, 2]\n"), 64, "E-CONFIG-VALUE");
    expect_result(check("lenient = 2\n"), 64, "E-CONFIG-VALUE");
    expect_result(check("this is no key\n"), 64, "E-CONFIG-KEY");
}

TEST_F(Config, ValuesAreCheckedAsThoseOfOptionsAre) {
    const ProgramRun range = check("spp = 0\n");
    expect_result(range, 64, "E-USAGE-RANGE");
    EXPECT_THAT(range.err, HasSubstr("1 to 1048576"));
    expect_result(check("spp = many\n"), 64, "E-USAGE-NUMBER");
    expect_result(check("filter = sinc\n"), 64, "E-USAGE-CHOICE");
    expect_result(check("lenient = true\nstrict = true\n"), 64, "E-USAGE-CONFLICT");
    expect_result(check("eye = \"1,2,3\"\ncamera = 0\n"), 64, "E-USAGE-CONFLICT");
    EXPECT_EQ(check("lenient = false\nstrict = true\nbackground = [0, 0.5, 1]\n").code, 0);
}

}  // namespace
}  // namespace obscura
