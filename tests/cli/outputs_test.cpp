// tests/cli/outputs_test.cpp - images that are written, and files that survive a failed run.
// SPDX-License-Identifier: Apache-2.0
#include "cli/cli.h"
#include <sys/resource.h>
#include <sys/stat.h>
#include <tuple>

namespace obscura {
namespace {

using testing::HasSubstr;

class Outputs : public Cli {
protected:
    /// The pixel in the centre of the image.
    static std::vector<float> centre(const ReadImage& image) {
        const size_t channels = image.channels.size();
        const size_t pixel = static_cast<size_t>(image.height / 2 * image.width + image.width / 2);
        return {image.pixels.begin() + static_cast<long>(pixel * channels),
                image.pixels.begin() + static_cast<long>((pixel + 1) * channels)};
    }
};

TEST_F(Outputs, OneRenderingSeveralFiles) {
    expect_result(render("quad.gltf", {"-o", "a.exr", "-o", "b.png", "-o", "c.jpg"}), 0, "OK");
    const auto exr = read_image_file(folder_ / "a.exr");
    const auto png = read_image_file(folder_ / "b.png");
    const auto jpg = read_image_file(folder_ / "c.jpg");
    ASSERT_TRUE(exr && png && jpg);
    for (const auto& image : {*exr, *png, *jpg}) {
        EXPECT_EQ(image.width, 24);
        EXPECT_EQ(image.height, 16);
    }
    EXPECT_EQ(exr->spec.format, OIIO::TypeHalf);
    EXPECT_EQ(exr->channels, (std::vector<std::string>{"R", "G", "B", "A"}));
    const std::vector<float> lit = centre(*exr);
    EXPECT_GT(lit[0], 0.8f);
    EXPECT_LT(lit[0], 1.1f);
    EXPECT_FLOAT_EQ(lit[3], 1);
    EXPECT_GT(centre(*png)[0], 0.3f);
    EXPECT_NEAR(centre(*png)[1], centre(*jpg)[1], 0.03f);
}

TEST_F(Outputs, TheDefaultNameIsTheScenesStemHere) {
    std::filesystem::create_directory(folder_ / "elsewhere");
    std::filesystem::rename(folder_ / "box.gltf", folder_ / "elsewhere/my.box.gltf");
    expect_result(render("elsewhere/my.box.gltf"), 0, "OK");
    EXPECT_TRUE(std::filesystem::exists(folder_ / "my.box.exr"));
}

TEST_F(Outputs, StrangeNamesKeepTheirBytes) {
    for (const std::string& name : std::vector<std::string>{
             "two words", "new\nline", "-dash", "%s%n", "\xC3\xA9\xFF", "[x]"}) {
        SCOPED_TRACE(name);
        folder_.write(name + ".gltf", gltf_text(triangle_scene()));
        expect_result(render(name + ".gltf", {"-o", name + ".exr", "-o", name + ".png"}), 0, "OK");
        EXPECT_TRUE(std::filesystem::exists(folder_ / (name + ".exr")));
        EXPECT_TRUE(std::filesystem::exists(folder_ / (name + ".png")));
    }
}

TEST_F(Outputs, TheExrSpeaksAboutItself) {
    expect_result(
        render("box.gltf", {"-o", "a.exr", "--float", "--seed", "7", "--camera", "Top"}), 0, "OK");
    const auto exr = read_image_file(folder_ / "a.exr");
    ASSERT_TRUE(exr);
    const OIIO::ImageSpec& spec = exr->spec;
    EXPECT_EQ(spec.format, OIIO::TypeFloat);
    EXPECT_THAT(std::string(spec.get_string_attribute("Software")), HasSubstr("Obscura"));
    EXPECT_EQ(spec.get_string_attribute("colorInteropID"), "lin_rec709_scene");
    EXPECT_EQ(spec.get_string_attribute("obscura:asset"), "box.gltf");
    EXPECT_EQ(spec.get_string_attribute("obscura:integrator"), "path");
    EXPECT_THAT(std::string(spec.get_string_attribute("obscura:camera")), HasSubstr("'Top'"));
    EXPECT_EQ(spec.get_int_attribute("obscura:samplesPerPixel"), 2);
    EXPECT_EQ(spec.get_int_attribute("obscura:seed"), 7);
    EXPECT_NE(spec.find_attribute("worldToCamera", OIIO::TypeMatrix44), nullptr);
    EXPECT_NE(spec.find_attribute("worldToNDC", OIIO::TypeMatrix44), nullptr);
}

TEST_F(Outputs, TheExrNamesWhatMakesItBiased) {
    expect_result(render("box.gltf", {"-o", "a.exr"}), 0, "OK");
    const std::vector<std::string> options = {"--clamp-direct",
                                              "20",
                                              "--clamp-indirect",
                                              "2.5",
                                              "--caustics",
                                              "off",
                                              "--regularize",
                                              "-o",
                                              "b.exr"};
    expect_result(render("box.gltf", options), 0, "OK");
    const auto plain = read_image_file(folder_ / "a.exr");
    const auto biased = read_image_file(folder_ / "b.exr");
    ASSERT_TRUE(plain && biased);
    for (const char* name : {"clampDirect", "clampIndirect", "caustics", "regularize"})
        EXPECT_EQ(plain->spec.find_attribute("obscura:" + std::string(name)), nullptr) << name;
    const OIIO::ImageSpec& spec = biased->spec;
    const auto number = [&](const char* name) {
        const OIIO::ParamValue* value = spec.find_attribute(name);
        return value == nullptr ? 0.0F : value->get_float();
    };
    EXPECT_EQ(number("obscura:clampDirect"), 20);
    EXPECT_EQ(number("obscura:clampIndirect"), 2.5F);
    EXPECT_EQ(spec.get_string_attribute("obscura:caustics"), "off");
    EXPECT_EQ(spec.get_string_attribute("obscura:regularize"), "on");
}

TEST_F(Outputs, AovsAreFloatsInExrAndReadableInPng) {
    const std::vector<std::pair<std::string, size_t>> aovs = {
        {"normal", 3}, {"depth", 1}, {"id", 3}, {"facing", 1}, {"distance", 1}, {"heat", 1}};
    for (const auto& [name, channels] : aovs) {
        SCOPED_TRACE(name);
        const std::string exr_name = name + ".exr";
        const std::string png_name = name + ".png";
        expect_result(
            render("quad.gltf", {"--integrator", name, "-o", exr_name, "-o", png_name}), 0, "OK");
        const auto exr = read_image_file(folder_ / exr_name);
        const auto png = read_image_file(folder_ / png_name);
        ASSERT_TRUE(exr && png);
        EXPECT_EQ(exr->channels.size(), channels);
        EXPECT_EQ(exr->spec.format, OIIO::TypeFloat);
        EXPECT_EQ(exr->spec.get_string_attribute("colorInteropID"), "data");
        EXPECT_EQ(exr->spec.get_int_attribute("obscura:samplesPerPixel"), 1);
        EXPECT_GT(centre(*png)[0] + centre(*png)[1] + centre(*png)[2], 0.3f);
    }
    EXPECT_NEAR(centre(*read_image_file(folder_ / "depth.exr"))[0], 3, 1e-5);
    EXPECT_NEAR(centre(*read_image_file(folder_ / "normal.exr"))[2], 1, 1e-5);
    EXPECT_NEAR(centre(*read_image_file(folder_ / "normal.png"))[2], 1, 1e-5);
    EXPECT_NEAR(centre(*read_image_file(folder_ / "normal.png"))[0], 0.5, 0.01);
}

TEST_F(Outputs, EveryIntegratorRuns) {
    for (const char* name : {"path", "direct", "ao", "albedo", "raycast"}) {
        SCOPED_TRACE(name);
        expect_result(
            render("quad.gltf", {"--integrator", name, "-o", "a.exr", "-o", "a.jpg"}), 0, "OK");
        const auto exr = read_image_file(folder_ / "a.exr");
        ASSERT_TRUE(exr);
        EXPECT_GT(centre(*exr)[0], 0.5f);
    }
    const std::vector<std::string> wires = {
        "--integrator", "wireframe", "--wire-width", "4", "-o", "a.exr", "-o", "a.png"};
    expect_result(render("quad.gltf", wires), 0, "OK");
    EXPECT_EQ(centre(*read_image_file(folder_ / "a.exr"))[0], 1) << "the quad's diagonal";
    EXPECT_EQ(read_image_file(folder_ / "a.exr")->spec.get_int_attribute("obscura:samplesPerPixel"),
              16);
}

TEST_F(Outputs, BackgroundsAndExposure) {
    const std::vector<std::string> far_away = {
        "--eye", "0,0,90", "--target", "0,90,90", "--up", "0,0,1"};
    const auto shot = [&](std::vector<std::string> more) {
        more.insert(more.end(), far_away.begin(), far_away.end());
        expect_result(render("quad.gltf", more), 0, "OK");
    };
    shot({"-o", "clear.exr", "--background", "transparent"});
    EXPECT_EQ(centre(*read_image_file(folder_ / "clear.exr")), (std::vector<float>{0, 0, 0, 0}));
    shot({"-o", "color.exr", "-o", "plain.png", "--background", "0.5,0.25,2", "--view", "Raw"});
    EXPECT_EQ(centre(*read_image_file(folder_ / "color.exr")),
              (std::vector<float>{0.5f, 0.25f, 2, 1}));
    shot({"-o", "bright.png", "--background", "0.125,0.25,0", "--view", "Raw", "--exposure", "+1"});
    EXPECT_NEAR(centre(*read_image_file(folder_ / "plain.png"))[0], 0.5f, 0.003f);
    EXPECT_NEAR(centre(*read_image_file(folder_ / "bright.png"))[0], 0.25f, 0.003f);
}

TEST_F(Outputs, ACropHasTheSamePixels) {
    expect_result(render("box.gltf", {"-o", "whole.exr", "--float"}), 0, "OK");
    expect_result(render("box.gltf", {"-o", "part.exr", "--float", "--crop", "5,3,9,7"}), 0, "OK");
    const auto whole = read_image_file(folder_ / "whole.exr");
    const auto part = read_image_file(folder_ / "part.exr");
    ASSERT_TRUE(whole && part);
    EXPECT_EQ(part->spec.full_width, 24);
    EXPECT_EQ(part->spec.full_height, 16);
    ASSERT_EQ(std::tie(part->spec.x, part->spec.y, part->width, part->height),
              std::tuple(5, 3, 9, 7))
        << "the data window";
    for (int y = 0; y < 7; ++y) {
        for (int x = 0; x < 9; ++x) {
            const size_t at = static_cast<size_t>(y * 9 + x) * 4;
            const size_t there = static_cast<size_t>((y + 3) * 24 + x + 5) * 4;
            for (size_t c = 0; c < 4; ++c)
                EXPECT_EQ(part->pixels[at + c], whole->pixels[there + c]) << x << ',' << y;
        }
    }
}

/// PNG has no windows: the image is whole, and black where nothing was rendered.
TEST_F(Outputs, ACropInAPngLiesInTheWholeImage) {
    for (const std::string integrator : {"path", "heat"}) {
        const std::vector<std::string> how = {"--integrator", integrator, "--view", "Raw"};
        const auto shot = [&](std::vector<std::string> more) {
            more.insert(more.end(), how.begin(), how.end());
            expect_result(render("box.gltf", more), 0, "OK");
        };
        shot({"-o", "whole.png"});
        shot({"-o", "part.png", "--crop", "5,3,9,7"});
        const auto whole = read_image_file(folder_ / "whole.png");
        const auto part = read_image_file(folder_ / "part.png");
        ASSERT_TRUE(whole && part);
        ASSERT_EQ(part->pixels.size(), whole->pixels.size());
        const size_t channels = part->channels.size();
        EXPECT_EQ(part->pixels[0], 0);
        EXPECT_EQ(part->pixels[(10 * 24 + 14) * channels], 0);
        if (integrator == "heat") continue;  // whose hottest pixel is another
        for (size_t c = 0; c < channels; ++c) {
            const size_t at = (6 * 24 + 9) * channels + c;
            EXPECT_EQ(part->pixels[at], whole->pixels[at]);
        }
    }
}

TEST_F(Outputs, FormatsForTheWebAndForPrint) {
    const std::vector<std::string> files = {"a.webp", "a.tif", "a.png"};
    std::vector<std::string> how = {"--no-dither"};
    for (const std::string& file : files)
        how.insert(how.end(), {"-o", file});
    expect_result(render("quad.gltf", how), 0, "OK");
    const auto reference = read_image_file(folder_ / "a.png");
    ASSERT_TRUE(reference);
    for (const std::string& file : files) {
        const auto image = read_image_file(folder_ / file);
        ASSERT_TRUE(image) << file;
        EXPECT_NEAR(centre(*image)[1], centre(*reference)[1], 0.03f) << file;
    }
    expect_result(render("quad.gltf", {"--bits", "16", "-o", "b.png", "-o", "b.tiff"}), 0, "OK");
    EXPECT_EQ(read_image_file(folder_ / "b.png")->spec.format, OIIO::TypeDesc::UINT16);
    EXPECT_EQ(read_image_file(folder_ / "b.tiff")->spec.format, OIIO::TypeDesc::UINT16);
}

/// Nothing but the image goes to standard output, in any format.
TEST_F(Outputs, StandardOutputTakesTheImageAlone) {
    expect_result(render("quad.gltf", {"-o", "file.png"}), 0, "OK");
    const ProgramRun png = render("quad.gltf", {"-o", "-"});
    expect_result(png, 0, "OK");
    EXPECT_EQ(png.out, read_whole_file(folder_ / "file.png"));
    EXPECT_THAT(png.err, HasSubstr("Progress: 100%"));
    EXPECT_THAT(png.err, HasSubstr("wrote standard output"));
    const ProgramRun exr = render("quad.gltf", {"-o", "-", "--format", "exr", "-o", "also.webp"});
    expect_result(exr, 0, "OK");
    EXPECT_EQ(exr.out.substr(0, 4), "\x76\x2F\x31\x01");
    EXPECT_TRUE(std::filesystem::exists(folder_ / "also.webp"));
    EXPECT_EQ(render("missing.gltf", {"-o", "-"}).out, "");
    EXPECT_EQ(render("quad.gltf", {"-o", "-", "--check"}).out, "");
}

TEST_F(Outputs, APageLiesBehindTheFinishedImage) {
    const std::vector<std::string> away = {
        "--eye", "0,0,90", "--target", "0,90,90", "--up", "0,0,1", "-o", "a.png"};
    const auto shot = [&](std::vector<std::string> more) {
        more.insert(more.end(), away.begin(), away.end());
        expect_result(render("quad.gltf", more), 0, "OK");
        return read_image_file(folder_ / "a.png");
    };
    const auto white = shot({"--page", "white"});
    ASSERT_TRUE(white);
    EXPECT_EQ(white->channels.size(), 3U) << "alpha leaves the file";
    EXPECT_THAT(white->pixels, testing::Each(1.0f)) << "whatever the view does to white";
    const auto color = shot({"--page", "#336699", "--exposure", "3"});
    for (size_t c = 0; c < 3; ++c)
        EXPECT_NEAR(centre(*color)[c] * 255, 51 * static_cast<float>(c + 1), 1e-3f);
    const auto scene = shot({"--background", "#336699", "--view", "Un-tone-mapped"});
    EXPECT_NEAR(centre(*scene)[0], 51 / 255.0f, 0.005f)
        << "a colour of the scene, through the view";
}

class Surviving : public Outputs {
protected:
    void SetUp() override {
        Outputs::SetUp();
        folder_.write("old.exr", old_content);
    }
    void TearDown() override {
        EXPECT_EQ(read_whole_file(folder_ / "old.exr"), old_content);
        for (const auto& entry : std::filesystem::directory_iterator(folder_.path())) {
            EXPECT_NE(entry.path().extension(), ".part") << entry.path();
        }
    }
    static constexpr const char* old_content = "last week's picture";
};

TEST_F(Surviving, ABadScene) {
    folder_.write("bad.gltf", "{\"asset\": ");
    EXPECT_EQ(render("bad.gltf", {"-o", "old.exr"}).code, 65);
}

TEST_F(Surviving, AMissingScene) {
    EXPECT_EQ(render("missing.gltf", {"-o", "old.exr"}).code, 66);
}

TEST_F(Surviving, ASecondOutputThatCannotBe) {
    expect_result(
        render("box.gltf", {"-o", "old.exr", "-o", "no/folder/b.png"}), 73, "E-OUT-CREATE");
}

TEST_F(Surviving, AFileSizeLimit) {
    ProgramSetup limited =
        setup({"render", "box.gltf", "--size", "200x200", "--spp", "1", "--float", "-o", "old.exr"},
              folder_);
    limited.before_start = [] {
        const rlimit limit = {8192, 8192};
        setrlimit(RLIMIT_FSIZE, &limit);
    };
    expect_result(run_program_with(limited), 74, "E-OUT-WRITE");
}

TEST_F(Outputs, AnImageWhoseFolderGoesAwayIsCopiedElsewhere) {
    std::filesystem::create_directory(folder_ / "gone");
    std::filesystem::create_directory(folder_ / "tmp");
    ProgramSetup program = setup(
        {"render", "box.gltf", "--size", "160x120", "--spp", "256", "-o", "gone/shot.0007.exr"},
        folder_);
    program.before_start = [this] { setenv("TMPDIR", (folder_ / "tmp").c_str(), 1); };
    program.on_output = [this](const std::string& out, pid_t) {
        if (out.find("Progress: ") != std::string::npos)
            std::filesystem::remove_all(folder_ / "gone");
    };
    const ProgramRun got = run_program_with(program);
    expect_result(got, 74, "E-OUT-WRITE");
    const auto copies = std::filesystem::directory_iterator(folder_ / "tmp");
    ASSERT_NE(copies, std::filesystem::directory_iterator());
    EXPECT_THAT(got.err, HasSubstr("a copy is " + copies->path().string()));
    EXPECT_EQ(copies->path().extension(), ".exr");
    EXPECT_GT(std::filesystem::file_size(copies->path()), 10000U);
}

TEST_F(Outputs, OutputsThatCannotBeAreRefusedBeforeTheSceneIsRead) {
    std::filesystem::create_directory(folder_ / "folder.exr");
    ASSERT_EQ(mkfifo((folder_ / "pipe.exr").c_str(), 0600), 0);
    const std::string long_name(300, 'x');
    for (const std::string& output : {std::string("no/such/a.exr"),
                                      std::string("folder.exr"),
                                      std::string("pipe.exr"),
                                      std::string("/proc/a.exr"),
                                      long_name + ".exr"}) {
        SCOPED_TRACE(output);
        expect_result(render("missing.gltf", {"-o", output}), 73, "E-OUT-CREATE");
    }
    expect_result(render("missing.gltf", {"--stats", "no/such/s.json"}), 73, "E-OUT-CREATE");
}

}  // namespace
}  // namespace obscura
