// tests/cli/denoise_command_test.cpp - obscura denoise: bits, what stays, errors.
// SPDX-License-Identifier: Apache-2.0
#include "cli/cli.h"
#include <fstream>
#include <map>

namespace obscura {
namespace {

using testing::Contains;
using testing::HasSubstr;
using testing::Not;

class DenoiseCommand : public Cli {
protected:
    /// Renders the box in 40x30 pixels with 8 samples, unless `more` says else.
    ProgramRun shot(const std::vector<std::string>& more, const std::string& file) const {
        std::vector<std::string> all = more;
        for (const auto& [option, value] :
             {std::pair{"--size", "40x30"}, std::pair{"--spp", "8"}}) {
            if (std::find(more.begin(), more.end(), option) == more.end())
                all.insert(all.end(), {option, value});
        }
        all.insert(all.end(), {"-o", file});
        return render("box.gltf", all);
    }
    ProgramRun denoise(std::vector<std::string> arguments) const {
        arguments.insert(arguments.begin(), "denoise");
        return run(std::move(arguments));
    }
    void write(const std::string& file, const std::string& bytes) const {
        std::ofstream stream(folder_ / file, std::ios::binary);
        stream << bytes;
    }
    std::string bytes_of(const std::string& file) const {
        std::ifstream stream(folder_ / file, std::ios::binary);
        return {std::istreambuf_iterator<char>(stream), std::istreambuf_iterator<char>()};
    }

    /// All channels of all parts, by view and name.
    std::map<std::string, std::vector<float>> channels_of(const std::string& file) const {
        std::map<std::string, std::vector<float>> out;
        const auto input = OIIO::ImageInput::open((folder_ / file).string());
        for (int part = 0; input && input->seek_subimage(part, 0); ++part) {
            const OIIO::ImageSpec spec = input->spec();
            std::vector<float> pixels(spec.image_pixels() * static_cast<size_t>(spec.nchannels));
            EXPECT_TRUE(
                input->read_image(part, 0, 0, spec.nchannels, OIIO::TypeFloat, pixels.data()));
            const std::string view = spec.get_string_attribute("view");
            for (size_t i = 0; i < pixels.size(); ++i) {
                const size_t c = i % static_cast<size_t>(spec.nchannels);
                out[view + ":" + spec.channelnames[c]].push_back(pixels[i]);
            }
        }
        return out;
    }
    std::string attribute(const std::string& file, const std::string& name) const {
        return read_image_file(folder_ / file).value().spec.get_string_attribute(name);
    }

    void expect_bits_of_render(const std::vector<std::string>& options) const {
        std::vector<std::string> all = options;
        all.emplace_back("--denoising-data");
        expect_result(shot(all, "noisy.exr"), 0, "OK");
        expect_result(denoise({"noisy.exr", "-o", "later.exr"}), 0, "OK");
        all.back() = "--denoise";
        all.emplace_back("--float");
        expect_result(shot(all, "at_once.exr"), 0, "OK");
        const auto at_once = channels_of("at_once.exr");
        const auto later = channels_of("later.exr");
        const auto noisy = channels_of("noisy.exr");
        ASSERT_THAT(at_once, testing::SizeIs(testing::Ge(4U)));
        for (const auto& [name, values] : at_once)
            EXPECT_EQ(later.at(name), values) << name;
        ASSERT_EQ(later.size(), noisy.size());
        for (const auto& [name, values] : noisy) {
            if (at_once.contains(name)) continue;
            EXPECT_EQ(later.at(name), values) << name;
        }
        EXPECT_EQ(attribute("later.exr", "obscura:denoise"),
                  attribute("at_once.exr", "obscura:denoise"));
    }
};

TEST_F(DenoiseCommand, GivesTheBitsOfRenderDenoise) {
    expect_bits_of_render({});
    expect_bits_of_render({"--spp", "5", "--background", "transparent"});
    expect_bits_of_render({"--crop", "5,6,30,20", "--exr-layout", "multipart"});
}

/// Ids, data and light that adds up.
TEST_F(DenoiseCommand, FiltersLayersOfTheLightAndNoOthers) {
    for (const char* layout : {"single", "multipart"}) {
        expect_bits_of_render({"--exr-layout",
                               layout,
                               "--aov",
                               "crypto_object,albedo,diffuse_direct,sample_count",
                               "--light-groups",
                               "each",
                               "--lpe",
                               "gloss=C<R[GS]>.*[LOB]"});
        EXPECT_NE(channels_of("later.exr").at(":gloss.R"), channels_of("noisy.exr").at(":gloss.R"));
    }
}

TEST_F(DenoiseCommand, TakesAdaptiveSamplesCatchersTilesAndTwoEyes) {
    expect_bits_of_render({"--noise-target", "0.02", "--spp-min", "4", "--spp", "20"});
    expect_bits_of_render({"--catcher", "ground", "--light-groups", "each"});
    expect_bits_of_render({"--exr-tiles", "16", "--exr-mipmap"});
    expect_bits_of_render({"--camera-model",
                           "environment",
                           "--size",
                           "40x40",
                           "--stereo",
                           "0.065",
                           "--exr-layout",
                           "multipart"});
}

TEST_F(DenoiseCommand, MayReplaceItsInput) {
    expect_result(shot({"--denoising-data"}, "a.exr"), 0, "OK");
    expect_result(denoise({"a.exr", "-o", "b.exr"}), 0, "OK");
    expect_result(denoise({"a.exr", "-o", "a.exr"}), 0, "OK");
    EXPECT_EQ(bytes_of("a.exr"), bytes_of("b.exr"));
    expect_result(denoise({"a.exr", "-o", "a.exr"}), 65, "E-DENOISE-DONE");
    EXPECT_EQ(bytes_of("a.exr"), bytes_of("b.exr"));
}

TEST_F(DenoiseCommand, KeepsTheNoisyBeautyOnRequest) {
    for (const char* layout : {"single", "multipart"}) {
        expect_result(shot({"--denoising-data", "--exr-layout", layout}, "a.exr"), 0, "OK");
        expect_result(denoise({"a.exr", "-o", "b.exr", "--keep-noisy"}), 0, "OK");
        const auto before = channels_of("a.exr");
        const auto after = channels_of("b.exr");
        EXPECT_EQ(after.at(":noisy.R"), before.at(":R"));
        EXPECT_EQ(after.at(":noisy.B"), before.at(":B"));
        EXPECT_EQ(after.size(), before.size() + 3);
    }
    expect_result(shot({"--denoising-data", "--lpe", "noisy=CD[LOB]"}, "a.exr"), 0, "OK");
    expect_result(denoise({"a.exr", "-o", "b.exr", "--keep-noisy"}), 64, "E-USAGE-CONFLICT");
}

TEST_F(DenoiseCommand, WritesImagesForDisplaysAsRenderDoes) {
    const std::vector<std::string> look = {"--exposure", "1", "--view", "Un-tone-mapped"};
    const std::vector<std::string> light = {"--color-space", "acescg"};
    std::vector<std::string> all = look;
    all.insert(all.end(), light.begin(), light.end());
    all.emplace_back("--denoise");
    expect_result(shot(all, "at_once.png"), 0, "OK");
    std::vector<std::string> data = light;
    data.emplace_back("--denoising-data");
    expect_result(shot(data, "a.exr"), 0, "OK");
    std::vector<std::string> arguments = {"a.exr", "-o", "later.png", "-o", "later.exr"};
    arguments.insert(arguments.end(), look.begin(), look.end());
    expect_result(denoise(arguments), 0, "OK");
    EXPECT_EQ(read_image_file(folder_ / "later.png").value().pixels,
              read_image_file(folder_ / "at_once.png").value().pixels);
    EXPECT_TRUE(std::filesystem::exists(folder_ / "later.exr"));
}

/// Colours in 16 bits are less than render --denoise has, and still free of most noise.
TEST_F(DenoiseCommand, TakesRoundedColours) {
    const std::vector<std::string> halves = {
        "--aov",
        "half_1,half_2,albedo_half_1,albedo_half_2,normal_half_1,normal_half_2,depth,opacity"};
    expect_result(shot(halves, "a.exr"), 0, "OK");
    const ProgramRun got = denoise({"a.exr", "-o", "b.exr"});
    expect_result(got, 0, "OK");
    EXPECT_THAT(got.err, Not(HasSubstr("WARN")));
    expect_result(shot({"--denoise"}, "c.exr"), 0, "OK");
    const std::vector<float> later = channels_of("b.exr").at(":G");
    const std::vector<float> at_once = channels_of("c.exr").at(":G");
    double difference = 0;
    double sum = 0;
    for (size_t i = 0; i < later.size(); ++i) {
        difference += std::abs(later[i] - at_once[i]);
        sum += at_once[i];
    }
    EXPECT_LT(difference, 0.01 * sum);
}

TEST_F(DenoiseCommand, SaysWhatIsMissing) {
    expect_result(shot({"--aov", "half_1,normal"}, "a.exr"), 0, "OK");
    const ProgramRun without = denoise({"a.exr", "-o", "b.exr"});
    expect_result(without, 65, "E-DENOISE-LAYER");
    EXPECT_THAT(without.err, HasSubstr("half_2"));
    EXPECT_THAT(without.err, HasSubstr("--denoising-data"));
    EXPECT_FALSE(std::filesystem::exists(folder_ / "b.exr"));
    expect_result(
        shot({"--aov", "half_1,half_2,depth", "--exr-layout", "separate"}, "c.exr"), 0, "OK");
    EXPECT_THAT(denoise({"c.exr", "-o", "b.exr"}).err, HasSubstr("files of their own"));
}

/// Guides are no must: what was there is in the header.
TEST_F(DenoiseCommand, DoesWithoutGuides) {
    expect_result(shot({"--aov", "half_1,half_2,depth", "--float"}, "a.exr"), 0, "OK");
    const ProgramRun got = denoise({"a.exr", "-o", "b.exr"});
    expect_result(got, 0, "OK");
    EXPECT_THAT(got.err, HasSubstr("albedo_half_1, albedo_half_2, normal_half_1"));
    EXPECT_THAT(attribute("b.exr", "obscura:denoise"), HasSubstr("halves depth;"));
    EXPECT_NE(channels_of("b.exr").at(":R"), channels_of("a.exr").at(":R"));
}

TEST_F(DenoiseCommand, RefusesWhatItCannotDenoise) {
    const auto refused = [&](const std::string& file, int code, const std::string& id) {
        expect_result(denoise({file, "-o", "out.exr"}), code, id);
        EXPECT_FALSE(std::filesystem::exists(folder_ / "out.exr"));
    };
    refused("missing.exr", 66, "E-EXR-MISSING");
    expect_result(shot({}, "a.png"), 0, "OK");
    refused("a.png", 65, "E-EXR-FORMAT");
    expect_result(shot({"--integrator", "ao", "--aov", "half_1,half_2"}, "ao.exr"), 0, "OK");
    refused("ao.exr", 65, "E-DENOISE-SOURCE");
    expect_result(
        shot({"--aov", "half_1,half_2", "--noise-target", "1", "--spp-min", "3", "--spp", "3"},
             "odd.exr"),
        0,
        "OK");
    refused("odd.exr", 65, "E-DENOISE-HALVES");
    // No multiple of 16: when the limit comes, the halves have not as many samples.
    expect_result(shot({"--denoising-data", "--spp", "1000001", "--time-limit", "1"}, "some.exr"),
                  75,
                  "E-TIME-LIMIT");
    refused("some.exr", 65, "E-DENOISE-HALVES");
    expect_result(shot({"--denoising-data"}, "a.exr"), 0, "OK");
    const std::string whole = bytes_of("a.exr");
    write("short.exr", whole.substr(0, whole.size() / 2));
    refused("short.exr", 65, "E-EXR-CORRUPT");
}

/// A file of another program, and one whose pixels are not numbers.
TEST_F(DenoiseCommand, RefusesFilesOfOthersAndPixelsThatAreNoNumbers) {
    OIIO::ImageSpec spec(4, 3, 9, OIIO::TypeFloat);
    spec.channelnames = {
        "R", "G", "B", "half_1.R", "half_1.G", "half_1.B", "half_2.R", "half_2.G", "half_2.B"};
    std::vector<float> pixels(4 * 3 * 9, 0.5f);
    const auto save = [&](const std::string& file) {
        const auto output = OIIO::ImageOutput::create("exr");
        ASSERT_TRUE(output->open((folder_ / file).string(), spec));
        ASSERT_TRUE(output->write_image(OIIO::TypeFloat, pixels.data()));
    };
    save("other.exr");
    expect_result(denoise({"other.exr", "-o", "out.exr"}), 65, "E-DENOISE-SOURCE");
    spec.attribute("obscura:samplesPerPixel", 4);
    spec.attribute("obscura:integrator", "path");
    save("same.exr");
    expect_result(denoise({"same.exr", "-o", "out.exr"}), 0, "OK");
    pixels[9 * 5 + 3] = std::numeric_limits<float>::quiet_NaN();
    save("nan.exr");
    const ProgramRun got = denoise({"nan.exr", "-o", "out.exr"});
    expect_result(got, 65, "E-EXR-CORRUPT");
    EXPECT_THAT(got.err, HasSubstr("half_1.R has the value nan at column 1, row 1"));
}

TEST_F(DenoiseCommand, NeedsAnOutputAndOptionsThatFit) {
    expect_result(shot({"--denoising-data"}, "a.exr"), 0, "OK");
    expect_result(denoise({"a.exr"}), 64, "E-USAGE-CONFLICT");
    expect_result(denoise({"a.exr", "-o", "b.png", "--exposure", "auto"}), 64, "E-USAGE-CHOICE");
    expect_result(denoise({"a.exr", "-o", "b.exr", "-o", "b.exr"}), 64, "E-USAGE-SAMEFILE");
    expect_result(denoise({"a.exr", "-o", "b.txt"}), 64, "E-OUT-FORMAT");
    expect_result(denoise({"a.exr", "-o", "nowhere/b.exr"}), 73, "E-OUT-CREATE");
    for (const std::vector<std::string>& more : {std::vector<std::string>{"--spp", "1"},
                                                 {"--denoise"},
                                                 {"--compression", "dwaa"},
                                                 {"--exr-layout", "separate"},
                                                 {"--integrator", "ao"}}) {
        std::vector<std::string> all = more;
        all.emplace_back("--denoising-data");
        expect_result(shot(all, "b.exr"), 64, "E-USAGE-CONFLICT");
    }
}

}  // namespace
}  // namespace obscura
