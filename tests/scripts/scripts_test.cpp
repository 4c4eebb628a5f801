// tests/scripts/scripts_test.cpp - runs the shell scripts against stand-ins for what they call.
// SPDX-License-Identifier: Apache-2.0
#include <gtest/gtest.h>

#include <array>
#include <cstdio>
#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <gmock/gmock.h>
#include <iterator>
#include <string>
#include <sys/wait.h>
#include <unistd.h>
#include <utility>

namespace obscura {
namespace {

namespace fs = std::filesystem;
using ::testing::HasSubstr;
using ::testing::Not;

const std::string source_dir = OBSCURA_SOURCE_DIR;

struct Outcome {
    int code = -1;
    std::string output;  ///< standard output and standard error
};

Outcome run_shell(const std::string& script) {
    FILE* pipe = popen(("exec 2>&1; " + script).c_str(), "r");
    if (pipe == nullptr) return {};
    Outcome outcome;
    std::array<char, 4096> block;
    while (const size_t size = fread(block.data(), 1, block.size(), pipe)) {
        outcome.output.append(block.data(), size);
    }
    const int status = pclose(pipe);
    outcome.code = WIFEXITED(status) ? WEXITSTATUS(status) : -1;
    return outcome;
}

std::string read_text(const fs::path& file) {
    std::ifstream in(file, std::ios::binary);
    return {std::istreambuf_iterator<char>(in), {}};
}

/// A folder with made-up models and programs, gone at the end.
class Scripts : public testing::Test {
protected:
    Scripts() {
        std::string name = (fs::temp_directory_path() / "obscura_scripts_XXXXXX").string();
        if (mkdtemp(name.data()) == nullptr) std::abort();
        folder_ = name;
    }
    ~Scripts() override {
        std::error_code ignored;
        fs::remove_all(folder_, ignored);
    }

    void write(const std::string& name, const std::string& text) const {
        fs::create_directories((folder_ / name).parent_path());
        std::ofstream(folder_ / name, std::ios::binary) << text;
    }
    void write_program(const std::string& name, const std::string& body) const {
        write(name, "#!/bin/bash\n" + body);
        fs::permissions(folder_ / name, fs::perms::owner_all);
    }
    /// Runs a command line in the folder.
    Outcome run(const std::string& command) const {
        return run_shell("cd '" + folder_.string() + "' && " + command);
    }
    /// Runs bash code after scripts/setup.sh, where PATH finds the folder's programs only.
    Outcome run_with_setup(const std::string& code) const {
        return run("bash -c 'set -euo pipefail; source \"" + source_dir +
                   "/scripts/setup.sh\"; PATH=\"$PWD/bin\"; OBSCURA_PACKAGES=\"$PWD/list.txt\"; " +
                   code + "'");
    }
    std::string page() const { return read_text(folder_ / "out/index.html"); }

    fs::path folder_;
};

/// Stands in for obscura: what it does depends on the model's text.
constexpr const char* fake_obscura = R"sh(
scene="$2"
while (($# > 1)); do shift; done
case "$(cat -- "$scene")" in
    good) echo picture >"$1"
          echo "WARN model: <odd> & \"strange\"" >&2
          echo "RESULT code=0 id=OK where= warnings=1" >&2 ;;
    bad) echo "ERROR x: no" >&2
         echo "RESULT code=65 id=E-JSON where=x warnings=0" >&2
         exit 65 ;;
    bug) exit 70 ;;
    signal) kill -SEGV $$ ;;
    hang) sleep 30 ;;
esac
)sh";

TEST_F(Scripts, GalleryShowsEveryModelInOrder) {
    write_program("obscura", fake_obscura);
    write("models/b dir/Box With Spaces.gltf", "good");
    write("models/a/Unicode❤♻Test.glb", "good");
    write("models/c/-o.glb", "good");
    write("models/c/<i>&.gltf", "bad");
    write("models/c/readme.txt", "hang");
    const Outcome outcome = run(source_dir + "/tests/gallery.sh --obscura ./obscura models out");
    EXPECT_EQ(outcome.code, 0) << outcome.output;
    EXPECT_THAT(outcome.output,
                HasSubstr("4 files: 3 rendered, 1 refused (1 with code 65), "
                          "0 crashed, 0 hung"));
    const std::string html = page();
    const size_t unicode = html.find("a/Unicode❤♻Test.glb");
    const size_t spaces = html.find("b dir/Box With Spaces.gltf");
    const size_t dash = html.find("c/-o.glb");
    const size_t markup = html.find("c/&lt;i&gt;&amp;.gltf");
    EXPECT_LT(unicode, spaces);
    EXPECT_LT(spaces, dash);
    EXPECT_LT(dash, markup);
    ASSERT_NE(markup, std::string::npos);
    EXPECT_THAT(html, HasSubstr("WARN model: &lt;odd&gt; &amp; &quot;strange&quot;"));
    EXPECT_THAT(html, HasSubstr("RESULT code=65 id=E-JSON where=x warnings=0"));
    EXPECT_THAT(html, HasSubstr("data:image/png;base64,cGljdHVyZQo="));
    EXPECT_THAT(html, HasSubstr("refused, exit code 65, "));
    EXPECT_THAT(html, Not(HasSubstr("readme")));
}

TEST_F(Scripts, GalleryFailsWhenAModelCrashesOrHangs) {
    write_program("obscura", fake_obscura);
    write("models/1.glb", "good");
    write("models/2.glb", "bug");
    write("models/3.glb", "signal");
    write("models/4.glb", "hang");
    const Outcome outcome =
        run(source_dir + "/tests/gallery.sh --limit 1 --obscura ./obscura models out");
    EXPECT_EQ(outcome.code, 1);
    EXPECT_THAT(outcome.output, HasSubstr("4 files: 1 rendered, 0 refused, 2 crashed, 1 hung"));
    EXPECT_THAT(outcome.output, HasSubstr("crashed with 70: 2.glb"));
    EXPECT_THAT(outcome.output, HasSubstr("crashed with 139: 3.glb"));
    EXPECT_THAT(outcome.output, HasSubstr("hung with 124: 4.glb"));
    EXPECT_THAT(page(), HasSubstr("class=\"model hung\""));
}

TEST_F(Scripts, GalleryDropsImagesOfAnEarlierRun) {
    write_program("obscura", fake_obscura);
    write("models/1.glb", "bad");
    write("out/0001.png", "old");
    EXPECT_EQ(run(source_dir + "/tests/gallery.sh --obscura ./obscura models out").code, 0);
    EXPECT_THAT(page(), Not(HasSubstr("base64")));
}

TEST_F(Scripts, GalleryExplainsItsUse) {
    write_program("obscura", fake_obscura);
    fs::create_directories(folder_ / "empty");
    const std::string gallery = source_dir + "/tests/gallery.sh ";
    for (const std::string arguments : {"",
                                        "--what empty",
                                        "missing --obscura ./obscura",
                                        "empty --obscura ./obscura",
                                        "empty --obscura ./none",
                                        "empty out more",
                                        "empty --env"}) {
        const Outcome outcome = run(gallery + arguments);
        EXPECT_EQ(outcome.code, 64) << arguments;
        EXPECT_THAT(outcome.output, HasSubstr("usage: tests/gallery.sh")) << arguments;
    }
    EXPECT_EQ(run(gallery + "--help").code, 0);
}

constexpr const char* fake_dpkg_query = R"sh(
for name; do :; done
[[ " here too " == *" $name "* ]] && printf installed
[[ "$name" == removed ]] && printf config-files
exit 0
)sh";

TEST_F(Scripts, SetupListsThePackagesOfGroups) {
    write("list.txt", "# title\n[build]\nhere\n\n# why\ntoo\n[ci]\nlint");
    EXPECT_EQ(run_with_setup("listed_packages build").output, "here\ntoo\n");
    EXPECT_EQ(run_with_setup("listed_packages ci build").output, "here\ntoo\nlint\n");
    EXPECT_EQ(run_with_setup("listed_packages other").output, "");
}

TEST_F(Scripts, SetupDoesNothingWhenAllIsThere) {
    write("list.txt", "[build]\nhere\ntoo\n[ci]\nmissing\n");
    write_program("bin/dpkg-query", fake_dpkg_query);
    write_program("bin/apt-get", "echo CALLED; exit 1");
    const Outcome outcome = run_with_setup("install_packages build");
    EXPECT_EQ(outcome.code, 0);
    EXPECT_EQ(outcome.output, "");
}

TEST_F(Scripts, SetupInstallsWhatIsMissing) {
    write("list.txt", "[build]\nhere\nabsent\nremoved\n");
    write_program("bin/dpkg-query", fake_dpkg_query);
    write_program("bin/apt-get", "echo \"APT $DEBIAN_FRONTEND $*\"");
    write_program("bin/id", "echo 0");
    write_program("bin/env", "exec /usr/bin/env \"$@\"");
    const Outcome outcome = run_with_setup("install_packages build");
    EXPECT_EQ(outcome.code, 0) << outcome.output;
    EXPECT_THAT(outcome.output, HasSubstr("installing absent removed"));
    EXPECT_THAT(outcome.output, HasSubstr("APT noninteractive -q update"));
    EXPECT_THAT(
        outcome.output,
        HasSubstr("APT noninteractive -q -y --no-install-recommends install absent removed"));
}

TEST_F(Scripts, SetupUsesSudoWhenNotRoot) {
    write("list.txt", "[build]\nabsent\n");
    write_program("bin/dpkg-query", fake_dpkg_query);
    write_program("bin/apt-get", "exit 0");
    write_program("bin/id", "echo 1000");
    write_program("bin/sudo", "echo \"SUDO $*\"");
    const Outcome outcome = run_with_setup("install_packages build");
    EXPECT_EQ(outcome.code, 0) << outcome.output;
    EXPECT_THAT(outcome.output, HasSubstr("SUDO env DEBIAN_FRONTEND=noninteractive apt-get -q -y"));
}

TEST_F(Scripts, SetupSaysWhatToDoWithoutRights) {
    write("list.txt", "[build]\nabsent\n");
    write_program("bin/dpkg-query", fake_dpkg_query);
    write_program("bin/apt-get", "echo CALLED");
    write_program("bin/id", "echo 1000");
    const Outcome outcome = run_with_setup("install_packages build");
    EXPECT_EQ(outcome.code, 1);
    EXPECT_THAT(outcome.output, HasSubstr("needs root or sudo"));
    EXPECT_THAT(outcome.output, HasSubstr("apt-get install --no-install-recommends absent"));
    EXPECT_THAT(outcome.output, Not(HasSubstr("CALLED")));
}

TEST_F(Scripts, SetupFailsWhenInstallingFails) {
    write("list.txt", "[build]\nabsent\n");
    write_program("bin/dpkg-query", fake_dpkg_query);
    write_program("bin/apt-get", "exit 100");
    write_program("bin/id", "echo 0");
    write_program("bin/env", "exec /usr/bin/env \"$@\"");
    const Outcome outcome = run_with_setup("install_packages build");
    EXPECT_EQ(outcome.code, 1);
    EXPECT_THAT(outcome.output, HasSubstr("apt-get could not install absent"));
}

TEST_F(Scripts, SetupNamesThePackageListOnOtherSystems) {
    write("list.txt", "[build]\nabsent\n");
    for (const std::string program : {"mkdir", "touch"}) {
        write_program("bin/" + program, "exec /bin/" + program + " \"$@\"");
    }
    const std::string code = "OBSCURA_ROOT=\"$PWD\"; install_packages build";
    const Outcome first = run_with_setup(code);
    EXPECT_EQ(first.code, 0) << first.output;
    EXPECT_THAT(first.output, HasSubstr("this is not a Debian system"));
    EXPECT_THAT(first.output, HasSubstr("list.txt"));
    EXPECT_EQ(run_with_setup(code).output, "") << "said once only";
}

TEST_F(Scripts, SetupChangesAnOptionOfABuildOnce) {
    write("build/release/CMakeCache.txt", "OBSCURA_ISAS:STRING=native\n");
    write_program("bin/cmake", "printf '%s|' \"$@\"");
    write_program("bin/grep", "exec /bin/grep \"$@\"");
    const std::string code = "OBSCURA_ROOT=\"$PWD\"; reconfigure release OBSCURA_ISAS ";
    EXPECT_EQ(run_with_setup(code + "native").output, "");
    const Outcome changed = run_with_setup(code + "all && /bin/cat build/release/configure.log");
    EXPECT_EQ(changed.code, 0) << changed.output;
    EXPECT_THAT(changed.output, HasSubstr("configuring build/release with OBSCURA_ISAS=all"));
    EXPECT_THAT(changed.output, HasSubstr("-D|OBSCURA_ISAS=all|"));
}

TEST_F(Scripts, SetupShowsWhatCMakeSaysWhenItFails) {
    write("build/release/CMakeCache.txt", "OBSCURA_ISAS:STRING=native\n");
    write_program("bin/cmake", "echo REASON; exit 1");
    for (const std::string program : {"grep", "cat"}) {
        write_program("bin/" + program, "exec /bin/" + program + " \"$@\"");
    }
    const Outcome outcome =
        run_with_setup("OBSCURA_ROOT=\"$PWD\"; reconfigure release OBSCURA_ISAS all");
    EXPECT_EQ(outcome.code, 1);
    EXPECT_THAT(outcome.output, HasSubstr("REASON"));
}

/// Stands in for Blender: repeats its arguments where people see them.
constexpr const char* fake_blender = R"sh(
echo "log line"
printf '<%s>' "$@" >&3
exit "${BLENDER_CODE:-0}"
)sh";

TEST_F(Scripts, VersusCyclesHandsItsSettingsToBlender) {
    write_program("obscura", "");
    write_program("blender", fake_blender);
    write("a b.glb", "");
    const std::string versus = source_dir + "/benchmarks/versus_cycles.sh";
    const std::string tools = " --obscura ./obscura --blender ./blender ";
    const Outcome outcome =
        run(versus + tools + "--spp 32 --eye -1,2,3 --view close --keep kept 'a b.glb'");
    EXPECT_EQ(outcome.code, 0) << outcome.output;
    EXPECT_THAT(outcome.output, HasSubstr("/benchmarks/versus_cycles.py><-->"));
    EXPECT_THAT(outcome.output, HasSubstr("<--spp=32>"));
    EXPECT_THAT(outcome.output, HasSubstr("<--view=close>"));
    EXPECT_THAT(outcome.output, HasSubstr("<--size=1280x720>"));
    EXPECT_THAT(outcome.output, HasSubstr("<--camera=--eye=-1,2,3><--><a b.glb>"));
    EXPECT_THAT(outcome.output, Not(HasSubstr("log line")));
    EXPECT_EQ(read_text(folder_ / "kept/blender.log"), "log line\n");
    for (const auto& [ends, code] : {std::pair{1, 70}, {11, 70}, {69, 69}}) {
        const Outcome failed =
            run("BLENDER_CODE=" + std::to_string(ends) + " " + versus + tools + "'a b.glb'");
        EXPECT_EQ(failed.code, code);
        EXPECT_THAT(failed.output, HasSubstr("log line"));
    }
}

TEST_F(Scripts, VersusCyclesSaysWhatItNeeds) {
    write_program("obscura", "");
    write_program("blender", fake_blender);
    write("a.glb", "");
    const std::string versus = source_dir + "/benchmarks/versus_cycles.sh ";
    const std::string tools = "--obscura ./obscura --blender ./blender ";
    for (const std::string arguments : {"",
                                        "missing.glb",
                                        "a.glb --what",
                                        "a.glb --what 1",
                                        "a.glb --spp",
                                        "a.glb --spp 0",
                                        "a.glb --size 12",
                                        "a.glb --view left",
                                        "a.glb --env missing.hdr",
                                        "a.glb --obscura ./none"}) {
        const Outcome outcome = run(versus + tools + arguments);
        EXPECT_EQ(outcome.code, 64) << arguments;
        EXPECT_THAT(outcome.output, HasSubstr("usage: benchmarks/versus_cycles.sh")) << arguments;
    }
    const Outcome outcome = run(versus + "--obscura ./obscura --blender ./none a.glb");
    EXPECT_EQ(outcome.code, 69);
    EXPECT_THAT(outcome.output, HasSubstr("apt-get install"));
    EXPECT_EQ(run(versus + "--help").code, 0);
}

TEST_F(Scripts, EveryPackageIsListedOnce) {
    const Outcome outcome = run_shell("sed -n '/^[a-z]/p' '" + source_dir +
                                      "/third_party/packages.txt' | sort | uniq -d");
    EXPECT_EQ(outcome.output, "");
    EXPECT_THAT(read_text(fs::path(source_dir) / "third_party/packages.txt"), HasSubstr("[build]"));
}

}  // namespace
}  // namespace obscura
