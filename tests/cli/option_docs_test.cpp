// tests/cli/option_docs_test.cpp - man page, completions and docs/cli.md agree with the program.
// SPDX-License-Identifier: Apache-2.0
#include "cli/cli.h"

namespace obscura {
namespace {

using testing::Contains;
using testing::HasSubstr;
using testing::Not;

class OptionDocs : public Cli {
protected:
    /// Prints a kind of text into a file here.
    std::filesystem::path print(const std::string& kind, const std::string& name) {
        EXPECT_EQ(run({"print-docs", kind, "-o", name}).code, 0) << kind;
        return folder_ / name;
    }
    ProgramRun shell(const std::string& program, const std::string& script) {
        ProgramSetup setup;
        setup.arguments = {"/usr/bin/env", program, "-c", script};
        setup.folder = folder_.path();
        setup.environment = {"LC_ALL=C.UTF-8"};
        return run_program_with(setup);
    }
    bool is_installed(const std::string& program) {
        return shell("sh", "command -v " + program).code == 0;
    }
    /// The completions that bash offers for the last word.
    std::vector<std::string> complete(const std::vector<std::string>& words) {
        std::string list;
        for (const std::string& word : words)
            list += " '" + word + "'";
        const ProgramRun got = shell("bash",
                                     ". ./completion.bash; COMP_WORDS=(obscura" + list +
                                         "); COMP_CWORD=" + std::to_string(words.size()) +
                                         "; _obscura; printf '%s\\n' \"${COMPREPLY[@]}\"");
        EXPECT_EQ(got.err, "");
        return lines_of(got.out);
    }
};

TEST_F(OptionDocs, TheTablesOfTheManualAreThoseOfTheProgram) {
    const std::filesystem::path manual = OBSCURA_SOURCE_DIR "/docs/cli.md";
    folder_.write("cli.md", read_whole_file(manual));
    EXPECT_EQ(run({"print-docs", "markdown", "-o", "cli.md"}).code, 0);
    EXPECT_TRUE(read_whole_file(folder_ / "cli.md") == read_whole_file(manual))
        << "the options have changed; make the tables anew with\n"
           "  " OBSCURA_BINARY_DIR "/bin/obscura print-docs markdown -o docs/cli.md";
    folder_.write("odd.md", "<!-- options of paint -->\n<!-- end of options -->\n");
    expect_result(run({"print-docs", "markdown", "-o", "odd.md"}), 65, "E-DOCS-MARK");
    expect_result(run({"print-docs", "pdf"}), 64, "E-USAGE-CHOICE");
}

TEST_F(OptionDocs, TheManPageIsOneForMan) {
    const std::string page = read_whole_file(print("man", "obscura.1"));
    for (const char* text : {".TH OBSCURA 1", ".SH NAME", "\\-\\-size", "\\-\\-rays", "1280x720"})
        EXPECT_THAT(page, HasSubstr(text));
    EXPECT_THAT(page, Not(HasSubstr("print\\-docs \\fI")));
    if (!is_installed("groff")) GTEST_SKIP() << "groff is not installed";
    const ProgramRun got = shell("sh", "groff -ww -man -Tutf8 obscura.1");
    EXPECT_EQ(got.code, 0);
    EXPECT_EQ(got.err, "") << "groff warns";
    EXPECT_THAT(got.out, HasSubstr("explain-pixel"));
}

TEST_F(OptionDocs, BashCompletesCommandsOptionsValuesAndFiles) {
    if (!is_installed("bash")) GTEST_SKIP() << "bash is not installed";
    print("bash", "completion.bash");
    folder_.write("sky.hdr", "");
    folder_.write("notes.txt", "");
    EXPECT_EQ(complete({"ren"}), std::vector<std::string>{"render"});
    EXPECT_THAT(complete({""}), Contains("explain-pixel"));
    EXPECT_THAT(complete({""}), Not(Contains("print-docs")));
    EXPECT_EQ(complete({"render", "box.gltf", "--spp-"}), std::vector<std::string>{"--spp-min"});
    EXPECT_THAT(complete({"crosscheck", "--r"}), testing::ElementsAre("--rays", "--ray"));
    EXPECT_EQ(complete({"render", "--filter", "g"}), std::vector<std::string>{"gaussian"});
    EXPECT_THAT(complete({"render", "--fisheye", ""}), Contains("equisolid"));
    EXPECT_THAT(complete({"bench", "--isa", ""}), Contains("avx2"));
    EXPECT_EQ(complete({"render", "--env", "s"}), std::vector<std::string>{"sky.hdr"});
    EXPECT_EQ(complete({"info", "b"}), std::vector<std::string>{"box.gltf"});
    folder_.write("box.exr", "");
    EXPECT_EQ(complete({"denoise", "b"}), std::vector<std::string>{"box.exr"});
    EXPECT_THAT(complete({"render", "--spp", ""}), testing::ElementsAre("")) << "any number";
}

TEST_F(OptionDocs, OtherShellsTakeTheirCompletions) {
    print("zsh", "_obscura");
    print("fish", "obscura.fish");
    EXPECT_THAT(read_whole_file(folder_ / "_obscura"), HasSubstr("#compdef obscura"));
    EXPECT_THAT(read_whole_file(folder_ / "obscura.fish"), HasSubstr("-l spp -x"));
    bool tried = false;
    for (const char* script : {"zsh -n _obscura", "fish -n obscura.fish"}) {
        if (!is_installed(std::string(script, std::string(script).find(' ')))) continue;
        const ProgramRun got = shell("sh", script);
        EXPECT_EQ(got.code, 0) << script << "\n" << got.err;
        tried = true;
    }
    if (!tried) GTEST_SKIP() << "neither zsh nor fish is installed";
}

}  // namespace
}  // namespace obscura
