// tests/cli/embed_test.cpp - the installed library, its symbols, a program that embeds it.
// SPDX-License-Identifier: Apache-2.0
#include "cli/cli.h"

namespace obscura {
namespace {

using testing::HasSubstr;

/// Installs the build into a folder and runs commands of a shell there.
class Installed : public Cli {
protected:
    void SetUp() override {
        Cli::SetUp();
#ifndef OBSCURA_INSTALLS
        GTEST_SKIP() << "this build has no library";
#endif
        const ProgramRun installed = shell("'" OBSCURA_CMAKE "' --install '" OBSCURA_BINARY_DIR
                                           "' --prefix \"$PWD/prefix\"");
        ASSERT_EQ(installed.code, 0) << installed.err;
    }

    ProgramRun shell(const std::string& command) const {
        ProgramSetup setup;
        setup.arguments = {"/bin/sh", "-ec", command};
        setup.folder = folder_.path();
        setup.environment = {"OCIO=", "LC_ALL=C"};
        return run_program_with(setup);
    }
};

/// The folder of the library, and the variables that find it.
const std::string find_library =
    "lib=$(dirname \"$(find prefix -name libobscura.so)\")\n"
    "export PKG_CONFIG_PATH=$lib/pkgconfig LD_LIBRARY_PATH=$lib\n";

TEST_F(Installed, OnlyTheLibrarysOwnNamesAreSeen) {
    const ProgramRun got =
        shell(find_library + "'" OBSCURA_NM "' -D -C --defined-only $lib/libobscura.so");
    ASSERT_EQ(got.code, 0) << got.err;
    const std::vector<std::string> lines = lines_of(got.out);
    EXPECT_GT(lines.size(), 5U);
    for (const std::string& line : lines)
        EXPECT_THAT(line, HasSubstr(" obscura::v0::"));
}

TEST_F(Installed, AProgramOfAnyStandardAndMachineGetsTheBitsOfTheCommand) {
    std::vector<std::string> own_render = {"render", "box.gltf", "--size", "96x64", "--spp", "4"};
    for (const char* more : {"--aov", "depth,crypto_object", "--float", "-o", "own.exr"})
        own_render.emplace_back(more);
    expect_result(run(own_render), 0, "OK");
    const auto own = read_image_file(folder_ / "own.exr");
    ASSERT_TRUE(own);
    ASSERT_EQ(own->channels.size(), size_t{4 + 1 + 12});
    const std::string source = "'" OBSCURA_SOURCE_DIR "/examples/embed/embed.cpp'";
    const std::string by_hand = "'" OBSCURA_CXX "' " + source +
                                " -o embed $(pkg-config --cflags --libs obscura) -Wall -Wextra "
                                "-Werror ";
    const std::string by_cmake =
        "'" OBSCURA_CMAKE "' -S '" OBSCURA_SOURCE_DIR
        "/examples/embed' -B build -G Ninja -DCMAKE_PREFIX_PATH=\"$PWD/prefix\" "
        "-DCMAKE_CXX_COMPILER='" OBSCURA_CXX
        "' -DCMAKE_CXX_STANDARD=17 -DCMAKE_CXX_FLAGS=-O2 > log\n"
        "'" OBSCURA_CMAKE "' --build build > log; mv build/embed embed; unset LD_LIBRARY_PATH\n";
    for (const std::string& build : {by_hand + "-std=c++17 -O2 -march=native",
                                     by_hand + "-std=c++20 -O2",
                                     by_hand + "-std=c++20 -O2 -march=native",
                                     by_cmake}) {
        const ProgramRun got =
            shell(find_library + build + "\nrm -f embed.exr; ./embed box.gltf embed.exr");
        ASSERT_EQ(got.code, 0) << build << '\n' << got.err;
        EXPECT_THAT(got.out, HasSubstr("tiles")) << build;
        const auto embedded = read_image_file(folder_ / "embed.exr");
        ASSERT_TRUE(embedded) << build;
        EXPECT_EQ(embedded->channels, own->channels);
        EXPECT_EQ(embedded->pixels, own->pixels) << build;
    }
}

TEST_F(Installed, ThePackageIsWhole) {
    const ProgramRun got = shell(
        "prefix/bin/obscura --version\n"
        "grep -q Apache prefix/share/doc/*/LICENSE\n"
        "test -f prefix/share/obscura/assets/cornell/cornell.gltf\n"
        "cd prefix/share; grep -q spp man/man1/obscura.1\n"
        "grep -q spp bash-completion/completions/obscura\n"
        "grep -q spp zsh/site-functions/_obscura\n"
        "grep -q spp fish/vendor_completions.d/obscura.fish\n"
        "cd ../..\n" +
        find_library + "pkg-config --modversion obscura; readlink $lib/libobscura.so");
    EXPECT_EQ(got.code, 0) << got.err;
    EXPECT_THAT(got.out, HasSubstr("obscura " OBSCURA_VERSION));
    EXPECT_THAT(got.out, HasSubstr("libobscura.so."));
}

}  // namespace
}  // namespace obscura
