// tests/cli/delivery_test.cpp - masks, overscan and an environment that turns with the camera.
// SPDX-License-Identifier: Apache-2.0
#include "cli/cli.h"
#include <cmath>
#include <cstdint>
#include <map>
#include <nlohmann/json.hpp>

namespace obscura {
namespace {

using nlohmann::json;

class Delivery : public Cli {
protected:
    /// Two squares, the smaller one before the other, and a third behind the camera.
    void SetUp() override {
        Cli::SetUp();
        json tree = json::parse(gltf_text(lit_quad_scene()));
        tree["nodes"] =
            json::array({{{"name", "wall"}, {"mesh", 0}, {"scale", {0.9, 0.6, 1}}},
                         {{"camera", 0}, {"translation", {0, 0, 3}}},
                         {{"name", "shelf"}, {"children", {3}}, {"translation", {0.3, 0.1, 0.5}}},
                         {{"name", "book"}, {"mesh", 0}, {"scale", {0.2, 0.3, 1}}},
                         {{"name", "unseen"}, {"mesh", 0}, {"translation", {0, 0, 9}}}});
        tree["scenes"][0]["nodes"] = {0, 1, 2, 4};
        folder_.write("two.gltf", tree.dump());
    }

    std::vector<uint16_t> codes(const std::string& name) const {
        const auto input = OIIO::ImageInput::open((folder_ / name).string());
        if (!input) return {};
        const OIIO::ImageSpec& spec = input->spec();
        EXPECT_EQ(spec.nchannels, 1);
        EXPECT_EQ(spec.format, OIIO::TypeUInt16);
        std::vector<uint16_t> out(spec.image_pixels());
        EXPECT_TRUE(input->read_image(0, 0, 0, 1, OIIO::TypeUInt16, out.data()));
        return out;
    }
};

struct MaskBox {
    int left = 1 << 20, top = 1 << 20, right = -1, bottom = -1;
    int pixels = 0;
};

/// What a mask shows, counted in another way than the program does: by id and row and column.
std::map<int, MaskBox> boxes_in(const std::vector<uint16_t>& ids, int width) {
    std::map<int, MaskBox> out;
    for (size_t i = 0; i < ids.size(); ++i) {
        if (ids[i] == 0) continue;
        MaskBox& box = out[ids[i]];
        const int x = static_cast<int>(i) % width;
        const int y = static_cast<int>(i) / width;
        box = {std::min(box.left, x),
               std::min(box.top, y),
               std::max(box.right, x),
               std::max(box.bottom, y),
               box.pixels + 1};
    }
    return out;
}

void expect_same(const json& list, const std::map<int, MaskBox>& boxes) {
    ASSERT_EQ(list["segments"].size(), boxes.size()) << list;
    for (const json& entry : list["segments"]) {
        const auto found = boxes.find(entry["id"].get<int>());
        ASSERT_NE(found, boxes.end()) << entry;
        const MaskBox& box = found->second;
        EXPECT_EQ(entry["pixels"], box.pixels);
        EXPECT_EQ(entry["box"]["x"], box.left);
        EXPECT_EQ(entry["box"]["y"], box.top);
        EXPECT_EQ(entry["box"]["width"], box.right - box.left + 1);
        EXPECT_EQ(entry["box"]["height"], box.bottom - box.top + 1);
    }
}

TEST_F(Delivery, AMaskHasTheIdsThatItsListExplains) {
    const std::vector<std::string> shot = {
        "--size", "61x40", "--spp", "9", "--segmentation", "m.png", "-o", "a.exr"};
    expect_result(render("two.gltf", shot), 0, "OK");
    const std::vector<uint16_t> ids = codes("m.png");
    const json list = json::parse(read_whole_file(folder_ / "m.json"));
    const auto boxes = boxes_in(ids, 61);
    expect_same(list, boxes);
    ASSERT_EQ(boxes.size(), 2U) << "wall and book; no ids between theirs at edges";
    EXPECT_EQ(list["width"], 61);
    const json& wall = list["segments"][0];
    const json& book = list["segments"][1];
    EXPECT_EQ(wall["id"], 1);
    EXPECT_EQ(wall["node"], "/wall");
    EXPECT_EQ(book["id"], 4);
    EXPECT_EQ(book["node"], "/shelf/book");
    EXPECT_EQ(book["mesh"], "Mesh");
    EXPECT_EQ(book["materials"], json({"Paint"}));
    // 0.4 m and 0.6 m seen from 2.5 m at 0.8 radians: as many pixels as a pinhole shows.
    const double per_metre = 20 / (2.5 * std::tan(0.4));
    EXPECT_NEAR(book["box"]["width"].get<double>(), 0.4 * per_metre, 1.0);
    EXPECT_NEAR(book["box"]["height"].get<double>(), 0.6 * per_metre, 1.0);

    // The beauty is that of a run without, and a crop has the ids of the whole image.
    expect_result(render("two.gltf", {"--size", "61x40", "--spp", "9", "-o", "b.exr"}), 0, "OK");
    EXPECT_EQ(without_fingerprints(read_whole_file(folder_ / "a.exr")),
              without_fingerprints(read_whole_file(folder_ / "b.exr")));
    expect_result(render("two.gltf", joined(shot, {"--crop", "30,8,20,20"})), 0, "OK");
    const std::vector<uint16_t> part = codes("m.png");
    ASSERT_EQ(part.size(), ids.size());
    for (size_t i = 0; i < ids.size(); ++i) {
        const size_t x = i % 61;
        const size_t y = i / 61;
        const bool inside = x >= 30 && x < 50 && y >= 8 && y < 28;
        ASSERT_EQ(part[i], inside ? ids[i] : 0) << x << " " << y;
    }
    expect_same(json::parse(read_whole_file(folder_ / "m.json")), boxes_in(part, 61));
}

/// Every pixel belongs to what covers most of it: a wide filter does not make masks grow.
TEST_F(Delivery, AMaskKnowsNoWiderEdgesThanTheImage) {
    const auto count = [&](const char* filter) {
        expect_result(render("two.gltf",
                             {"--size",
                              "61x40",
                              "--spp",
                              "64",
                              "--filter",
                              filter,
                              "--segmentation",
                              "m.png",
                              "-o",
                              "a.exr"}),
                      0,
                      "OK");
        return boxes_in(codes("m.png"), 61)[4].pixels;
    };
    const int plain = count("box");
    EXPECT_NEAR(count("blackman-harris"), plain, 0.04 * plain);
}

TEST_F(Delivery, MasksAreNamedAndRefusedAsOutputsAre) {
    expect_result(
        render("two.gltf", {"--frames", "3-4", "--segmentation", "m.##.png", "-o", "a.##.exr"}),
        0,
        "OK");
    for (const char* name : {"m.03.png", "m.04.png", "m.03.json", "m.04.json"})
        EXPECT_TRUE(std::filesystem::exists(folder_ / name)) << name;
    const auto refused = [&](const std::vector<std::string>& more, int code, const char* id) {
        expect_result(render("two.gltf", more), code, id);
    };
    refused(
        {"--frames", "3-4", "--segmentation", "m.png", "-o", "a.##.exr"}, 64, "E-USAGE-CONFLICT");
    refused({"--segmentation", "m.jpg", "-o", "a.exr"}, 64, "E-OUT-FORMAT");
    refused({"--segmentation", "m.png", "-o", "m.png"}, 64, "E-USAGE-SAMEFILE");
    refused(
        {"--segmentation", "m.png", "--stats", "m.json", "-o", "a.exr"}, 64, "E-USAGE-SAMEFILE");
    refused({"--segmentation", "no/m.png", "-o", "a.exr"}, 73, "E-OUT-CREATE");
    refused({"--segmentation", "m.png", "--integrator", "normal", "-o", "a.exr"},
            64,
            "E-USAGE-CONFLICT");
}

TEST_F(Delivery, OverscanLeavesTheFrameAsItIs) {
    for (const char* model : {"pinhole", "orthographic", "fisheye"}) {
        SCOPED_TRACE(model);
        const std::vector<std::string> shot = {
            "--eye", "0.5,0.4,3", "--camera-model", model, "--float", "--spp", "3"};
        expect_result(render("two.gltf", joined(shot, {"-o", "a.exr", "-o", "a.png"})), 0, "OK");
        expect_result(
            render("two.gltf", joined(shot, {"-o", "b.exr", "-o", "b.png", "--overscan", "5"})),
            0,
            "OK");
        const auto small = read_image_file(folder_ / "a.png");
        const auto cut = read_image_file(folder_ / "b.png");
        ASSERT_TRUE(small && cut);
        EXPECT_EQ(small->pixels, cut->pixels) << "other formats hold the frame alone";
        const auto plain = read_image_file(folder_ / "a.exr");
        const auto wide = read_image_file(folder_ / "b.exr");
        ASSERT_TRUE(plain && wide);
        EXPECT_EQ(wide->spec.full_width, 24);
        EXPECT_EQ(wide->spec.full_x, 0);
        EXPECT_EQ(wide->spec.x, -5);
        EXPECT_EQ(wide->spec.y, -5);
        ASSERT_EQ(wide->width, 34);
        ASSERT_EQ(wide->height, 26);
        for (size_t y = 0; y < 16; ++y) {
            for (size_t i = 0; i < 24 * 4; ++i)
                ASSERT_EQ(wide->pixels[((y + 5) * 34 + 5) * 4 + i], plain->pixels[y * 96 + i]);
        }
    }
}

/// What lies beyond the frame is what a camera of a wider film sees there.
TEST_F(Delivery, OverscanShowsWhatAWiderFilmDoes) {
    // A quarter more on every side: 1.5 times the tangent of the half angle.
    const double wider = 2 * std::atan(1.5 * std::tan(0.3)) * 180 / 3.14159265358979;
    const std::vector<std::string> shot = {
        "--eye", "0.5,0.4,3", "--target", "0,0,0", "--integrator", "raycast", "--float"};
    const auto fov = [](double degrees) { return std::to_string(degrees); };
    expect_result(render("two.gltf",
                         joined(shot,
                                {"--fov",
                                 fov(0.6 * 180 / 3.14159265358979),
                                 "--overscan",
                                 "25%",
                                 "-o",
                                 "a.exr",
                                 "--exr-tiles",
                                 "16"})),
                  0,
                  "OK");
    expect_result(
        render("two.gltf", joined(shot, {"--fov", fov(wider), "--size", "36x24", "-o", "b.exr"})),
        0,
        "OK");
    const auto wide = read_image_file(folder_ / "a.exr");
    const auto other = read_image_file(folder_ / "b.exr");
    ASSERT_TRUE(wide && other);
    ASSERT_EQ(wide->width, 36);
    ASSERT_EQ(wide->height, 24);
    size_t different = 0;
    for (size_t i = 0; i < wide->pixels.size(); ++i)
        different += std::abs(wide->pixels[i] - other->pixels[i]) > 1e-3f ? 1 : 0;
    EXPECT_LT(different, wide->pixels.size() / 100) << "edges may round differently";
}

TEST_F(Delivery, OverscanIsRefusedWhereItMakesNoSense) {
    const auto refused = [&](const std::vector<std::string>& more, const char* id) {
        expect_result(render("two.gltf", joined(more, {"-o", "a.exr"})), 64, id);
    };
    refused({"--overscan", "5", "--crop", "0,0,4,4"}, "E-USAGE-CONFLICT");
    refused({"--overscan", "101%"}, "E-USAGE-RANGE");
    refused({"--overscan", "2.5"}, "E-USAGE-NUMBER");
    refused({"--overscan", "5", "--camera-model", "environment"}, "E-CAM-OVERSCAN");
}

/// A turntable of a ball, without noise: every azimuth sees the same light.
TEST_F(Delivery, AnEnvironmentTurnsWithTheCamera) {
    json tree = json::parse(gltf_text(triangle_scene()));
    tree["extensionsUsed"] = {"OBSCURA_shape"};
    tree["extensions"]["OBSCURA_shape"]["shapes"][0] = {{"type", "sphere"}};
    tree["nodes"][0] = json::object();
    tree["nodes"][0]["extensions"]["OBSCURA_shape"]["shape"] = 0;
    folder_.write("ball.gltf", tree.dump());
    std::vector<float> sky(16 * 8 * 3, 0.1f);
    for (size_t i = 0; i < 16 * 8; ++i)
        sky[3 * i + (i % 16 < 8 ? 0 : 2)] = 1 + static_cast<float>(i % 16);
    const auto output = OIIO::ImageOutput::create((folder_ / "sky.exr").string());
    ASSERT_TRUE(output->open((folder_ / "sky.exr").string(), OIIO::ImageSpec(16, 8, 3)) &&
                output->write_image(OIIO::TypeFloat, sky.data()) && output->close());
    const auto shot = [&](const char* azimuth, const char* rotation) {
        expect_result(render("ball.gltf",
                             {"--env",
                              "sky.exr",
                              "--azimuth",
                              azimuth,
                              "--env-rotation",
                              rotation,
                              "--integrator",
                              "raycast",
                              "--float",
                              "-o",
                              "a.exr"}),
                      0,
                      "OK");
        const auto image = read_image_file(folder_ / "a.exr");
        return image ? image->pixels : std::vector<float>();
    };
    const auto difference = [](const std::vector<float>& a, const std::vector<float>& b) {
        double sum = 0, all = 0;
        for (size_t i = 0; i < a.size(); ++i) {
            sum += std::abs(static_cast<double>(a[i]) - static_cast<double>(b[i]));
            all += std::abs(static_cast<double>(a[i]));
        }
        return sum / all;
    };
    const std::vector<float> front = shot("0", "camera");
    EXPECT_LT(difference(front, shot("130", "camera")), 0.01);
    EXPECT_LT(difference(front, shot("-75", "camera")), 0.01);
    EXPECT_LT(difference(front, shot("0", "0")), 1e-6) << "from the front it is not turned";
    EXPECT_LT(difference(shot("130", "camera+30"), shot("0", "30")), 0.01);
    EXPECT_LT(difference(shot("130", "camera-30"), shot("0", "-30")), 0.01);
    EXPECT_GT(difference(front, shot("130", "0")), 0.2);
    expect_result(render("ball.gltf", {"--env-rotation", "cameras"}), 64, "E-USAGE-NUMBER");
}

}  // namespace
}  // namespace obscura
