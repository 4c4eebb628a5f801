// tests/cli/cli.h - runs the built program on small scenes in a folder of its own.
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <OpenImageIO/imageio.h>
#include <gtest/gtest.h>

#include "support/run_program.h"
#include "support/small_scenes.h"
#include "support/temp_folder.h"
#include <algorithm>
#include <csignal>
#include <gmock/gmock.h>
#include <memory>
#include <optional>
#include <regex>
#include <string>
#include <vector>

namespace obscura {

/// The fields of the closing line "RESULT code=65 id=E-X where=a#/b warnings=3".
struct ResultLine {
    int code = -1;
    std::string id;
    std::string where;
    int warnings = -1;
    int skipped = -1;  ///< with --skip-existing
};

/// The last line of standard error, if it is a result line.
inline std::optional<ResultLine> result_of(const ProgramRun& run) {
    static const std::regex form(
        R"(RESULT code=(\d+) id=(\S+) where=(\S+) warnings=(\d+)(?: skipped=(\d+))?)");
    const std::vector<std::string> lines = lines_of(run.err);
    std::smatch match;
    if (lines.empty() || !std::regex_match(lines.back(), match, form)) return std::nullopt;
    const int skipped = match[5].matched ? std::stoi(match[5]) : -1;
    return ResultLine{std::stoi(match[1]), match[2], match[3], std::stoi(match[4]), skipped};
}

inline std::vector<std::string> joined(std::vector<std::string> a,
                                       const std::vector<std::string>& b) {
    a.insert(a.end(), b.begin(), b.end());
    return a;
}

/// Lets a program get a signal, once, when its output holds a line that satisfies the pattern.
inline void send_at(ProgramSetup& program, int signal, const char* pattern) {
    program.on_output = [signal, form = std::regex(pattern), sent = false](const std::string& out,
                                                                           pid_t process) mutable {
        if (sent || !std::regex_search(out, form)) return;
        sent = true;
        kill(process, signal);
    };
}

/// An image as OpenImageIO reads it.
struct ReadImage {
    int width = 0;
    int height = 0;
    std::vector<std::string> channels;
    std::vector<float> pixels;
    OIIO::ImageSpec spec;
};

inline std::optional<ReadImage> read_image_file(const std::filesystem::path& file) {
    const auto input = OIIO::ImageInput::open(file.string());
    if (!input) return std::nullopt;
    ReadImage image;
    image.spec = input->spec();
    image.width = image.spec.width;
    image.height = image.spec.height;
    image.channels = image.spec.channelnames;
    image.pixels.resize(image.spec.image_pixels() * static_cast<size_t>(image.spec.nchannels));
    if (!input->read_image(0, 0, 0, image.spec.nchannels, OIIO::TypeFloat, image.pixels.data())) {
        return std::nullopt;
    }
    return image;
}

/// The bytes of an EXR but those of its fingerprints, which depend on all options.
inline std::string without_fingerprints(std::string exr) {
    const std::string name("obscura:fingerprint\0string\0", 27);
    constexpr size_t size_field = 4;
    constexpr size_t digits = 16;
    for (size_t at = 0; (at = exr.find(name, at)) != std::string::npos; at += name.size())
        exr.erase(at + name.size() + size_field, digits);
    return exr;
}

/// Every test gets a folder with three scenes: triangle.gltf, quad.gltf, box.gltf.
class Cli : public testing::Test {
protected:
    void SetUp() override {
        folder_.write("triangle.gltf", gltf_text(triangle_scene()));
        folder_.write("quad.gltf", gltf_text(lit_quad_scene()));
        folder_.write("box.gltf", gltf_text(box_scene()));
    }

    static ProgramSetup setup(std::vector<std::string> arguments, const TempFolder& folder) {
        ProgramSetup out;
        out.arguments = std::move(arguments);
        out.arguments.insert(out.arguments.begin(), OBSCURA_BINARY_DIR "/bin/obscura");
        out.folder = folder.path();
        out.environment = {"OCIO=", "LC_ALL=C"};
        return out;
    }
    ProgramRun run(std::vector<std::string> arguments) const {
        return run_program_with(setup(std::move(arguments), folder_));
    }
    /// `obscura render` of few pixels and samples, unless `more` says how many.
    static std::vector<std::string> small_render(const std::string& scene,
                                                 const std::vector<std::string>& more) {
        std::vector<std::string> arguments = {"render"};
        for (const auto& [option, value] :
             {std::pair{"--size", "24x16"}, std::pair{"--spp", "2"}}) {
            if (std::find(more.begin(), more.end(), option) != more.end()) continue;
            arguments.insert(arguments.end(), {option, value});
        }
        arguments.insert(arguments.end(), more.begin(), more.end());
        arguments.insert(arguments.end(), {"--", scene});
        return arguments;
    }
    ProgramRun render(const std::string& scene, const std::vector<std::string>& more = {}) const {
        return run(small_render(scene, more));
    }

    static void expect_result(const ProgramRun& got, int code, const std::string& id) {
        EXPECT_EQ(got.code, code) << got.err;
        const std::optional<ResultLine> result = result_of(got);
        ASSERT_TRUE(result) << got.err;
        EXPECT_EQ(result->code, code);
        EXPECT_EQ(result->id, id) << got.err;
        if (code != 0) {
            EXPECT_THAT(got.err, testing::HasSubstr("ERROR "));
        }
    }

    TempFolder folder_;
};

}  // namespace obscura
