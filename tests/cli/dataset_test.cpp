// tests/cli/dataset_test.cpp - obscura dataset: images with labels, in the formats of others.
// SPDX-License-Identifier: Apache-2.0
#include "cli/cli.h"
#include "support/text_files.h"
#include <cmath>
#include <nlohmann/json.hpp>
#include <set>

namespace obscura {
namespace {

namespace fs = std::filesystem;
using nlohmann::json;
using testing::HasSubstr;
using testing::Not;
using Texts = std::vector<std::string>;
using Rows = std::vector<std::vector<double>>;

/// Two boxes of one mesh, the second one half as large and turned.
class DatasetCommand : public Cli {
protected:
    void SetUp() override {
        Cli::SetUp();
        SmallScene scene = box_scene();
        scene.nodes = R"({"name": "big", "mesh": 0}, {"name": "small", "mesh": 0,
"translation": [2.5, 0.5, 0.5], "rotation": [0, 0.38268343, 0, 0.92387953],
"scale": [0.5, 0.5, 0.5]})";
        scene.roots = "0, 1";
        scene.more.clear();
        folder_.write("pair.gltf", gltf_text(scene));
    }

    /// `obscura dataset` of few and small images, unless `more` says otherwise.
    ProgramRun dataset(const Texts& more, const Texts& scenes = {"pair.gltf"}) const {
        Texts arguments = {"dataset"};
        for (const auto& [option, value] :
             {std::pair{"--size", "48x32"}, std::pair{"--spp", "1"}, std::pair{"--count", "4"}}) {
            if (std::find(more.begin(), more.end(), option) != more.end()) continue;
            arguments.insert(arguments.end(), {option, value});
        }
        return run(joined(joined(arguments, more), scenes));
    }
    json read(const std::string& file) const { return json::parse(read_text(folder_ / file)); }

    /// The codes of a grey image of so many bits.
    std::vector<int> codes(const std::string& file, int bits) const {
        const auto image = read_image_file(folder_ / file);
        EXPECT_TRUE(image) << file;
        std::vector<int> out;
        const double largest = std::exp2(bits) - 1;
        for (const float value : image ? image->pixels : std::vector<float>())
            out.push_back(static_cast<int>(std::lround(static_cast<double>(value) * largest)));
        return out;
    }

    /// All files below a folder by their names, with their bytes.
    std::map<std::string, std::string> files(const std::string& below) const {
        std::map<std::string, std::string> out;
        for (const auto& entry : fs::recursive_directory_iterator(folder_ / below)) {
            if (entry.is_regular_file())
                out[fs::relative(entry.path(), folder_ / below)] = read_text(entry.path());
        }
        return out;
    }
};

/// Where a corner of a box of half a width of 1 is seen, in pixels, by BOP's numbers.
std::array<double, 2> project(const json& camera, const json& pose, std::array<double, 3> p) {
    const auto r = pose.at("cam_R_m2c").get<std::vector<double>>();
    const auto t = pose.at("cam_t_m2c").get<std::vector<double>>();
    const auto k = camera.at("cam_K").get<std::vector<double>>();
    std::array<double, 3> x{};
    for (size_t i = 0; i < 3; ++i)
        x[i] = 1000 * (r[3 * i] * p[0] + r[3 * i + 1] * p[1] + r[3 * i + 2] * p[2]) + t[i];
    return {k[0] * x[0] / x[2] + k[2], k[4] * x[1] / x[2] + k[5]};
}

TEST_F(DatasetCommand, BopPosesAndBoxesAreThoseOfTheCorners) {
    expect_result(dataset({"--write", "bop", "-o", "d", "--size", "200x160"}), 0, "OK");
    const json cameras = read("d/000000/scene_camera.json");
    const json poses = read("d/000000/scene_gt.json");
    const json infos = read("d/000000/scene_gt_info.json");
    const json models = read("d/objects.json").at("objects");
    ASSERT_EQ(models.size(), 2U);  // one mesh, in two sizes
    EXPECT_EQ(models[0].at("mesh_index"), models[1].at("mesh_index"));
    for (const char* image : {"0", "1", "2", "3"}) {
        ASSERT_EQ(poses.at(image).size(), 2U);
        for (size_t i = 0; i < 2; ++i) {
            const json& pose = poses.at(image)[i];
            EXPECT_EQ(pose.at("obj_id"), i + 1);
            const double half = i == 0 ? 1 : 0.5;
            double low[2] = {1e9, 1e9};
            double high[2] = {-1e9, -1e9};
            for (unsigned corner = 0; corner < 8; ++corner) {
                std::array<double, 3> p{};
                for (unsigned axis = 0; axis < 3; ++axis)
                    p[axis] = ((corner >> axis) & 1U) != 0 ? half : -half;
                const auto at = project(cameras.at(image), pose, p);
                for (size_t axis = 0; axis < 2; ++axis) {
                    low[axis] = std::min(low[axis], at[axis]);
                    high[axis] = std::max(high[axis], at[axis]);
                }
            }
            const auto box = infos.at(image)[i].at("bbox_obj").get<std::vector<int>>();
            for (size_t axis = 0; axis < 2; ++axis) {
                EXPECT_NEAR(box[axis], low[axis], 1.5);
                EXPECT_NEAR(box[axis] + box[axis + 2], high[axis], 1.5);
            }
        }
    }
}

TEST_F(DatasetCommand, MasksIdsAndCountsAreOfOnePiece) {
    expect_result(dataset({"--write", "bop", "-o", "d"}), 0, "OK");
    const json infos = read("d/000000/scene_gt_info.json");
    std::ptrdiff_t hidden = 0;  // pixels of an object behind the other one
    for (const int image : {0, 1, 2, 3}) {
        const std::string name = "00000" + std::to_string(image);
        const std::vector<int> ids = codes("d/000000/segmentation/" + name + ".png", 16);
        const std::vector<int> depths = codes("d/000000/depth/" + name + ".png", 16);
        for (int object = 0; object < 2; ++object) {
            const std::string mask = name + "_00000" + std::to_string(object) + ".png";
            const std::vector<int> all = codes("d/000000/mask/" + mask, 8);
            const std::vector<int> seen = codes("d/000000/mask_visib/" + mask, 8);
            const json& info = infos.at(std::to_string(image))[static_cast<size_t>(object)];
            const auto visible = std::count(seen.begin(), seen.end(), 255);
            const auto inside = std::count(all.begin(), all.end(), 255);
            EXPECT_EQ(visible, info.at("px_count_visib"));
            EXPECT_EQ(inside, info.at("px_count_valid"));
            if (visible > 0) hidden += inside - visible;
            for (size_t i = 0; i < ids.size(); ++i) {
                EXPECT_EQ(ids[i] == object + 1, seen[i] == 255);
                EXPECT_LE(seen[i], all[i]);
                EXPECT_EQ(ids[i] == 0, depths[i] == 0);
            }
        }
    }
    EXPECT_GT(hidden, 0);
}

TEST_F(DatasetCommand, ValidPixelsAreThoseWithADepth) {
    expect_result(dataset({"--write", "bop", "-o", "d", "--count", "1"}), 0, "OK");
    std::vector<int> known = codes("d/000000/depth/000000.png", 16);
    std::erase(known, 0);
    ASSERT_FALSE(known.empty());
    const auto [nearest, farthest] = std::minmax_element(known.begin(), known.end());
    const double unit_mm = read("d/000000/scene_camera.json").at("0").at("depth_scale");
    const double middle_mm = 0.5 * (*nearest + *farthest) * unit_mm;
    const std::string reaches_middle = std::to_string(middle_mm / 65535);
    const std::string rounds_to_0 = "1000000";
    for (const std::string& step : {reaches_middle, rounds_to_0}) {
        const Texts options = {"--write", "bop", "-o", step, "--count", "1", "--depth-unit", step};
        expect_result(dataset(options), 0, "OK");
        const std::vector<int> depths = codes(step + "/000000/depth/000000.png", 16);
        const json infos = read(step + "/000000/scene_gt_info.json").at("0");
        std::ptrdiff_t inside = 0;
        std::ptrdiff_t valid = 0;
        for (const int object : {0, 1}) {
            const std::vector<int> mask =
                codes(step + "/000000/mask/000000_00000" + std::to_string(object) + ".png", 8);
            std::ptrdiff_t with_depth = 0;
            for (size_t i = 0; i < mask.size(); ++i)
                with_depth += mask[i] != 0 && depths[i] != 0 ? 1 : 0;
            EXPECT_EQ(infos[static_cast<size_t>(object)].at("px_count_valid"), with_depth);
            inside += std::count(mask.begin(), mask.end(), 255);
            valid += with_depth;
        }
        EXPECT_LT(valid, inside) << step;
        EXPECT_EQ(valid > 0, step == reaches_middle);
    }
}

TEST_F(DatasetCommand, OptionsFixWhatTheyName) {
    const auto turns_of = [&](const std::string& below) {
        std::set<double> turns;
        for (const char* name : {"000000", "000001", "000002", "000003"}) {
            const json labels = read(below + "/pair/labels/" + name + ".json");
            turns.insert(labels.at("environment_rotation").get<double>());
        }
        return turns;
    };
    const Texts varied = {"--vary", "environment", "--env", "studio"};
    expect_result(dataset(joined(varied, {"-o", "turned"})), 0, "OK");
    EXPECT_EQ(turns_of("turned").size(), 4U);
    expect_result(dataset(joined(varied, {"-o", "fixed", "--env-rotation", "20"})), 0, "OK");
    EXPECT_EQ(turns_of("fixed"), std::set<double>{20});
}

TEST_F(DatasetCommand, WhatIsNoObjectIsNotListed) {
    for (const std::string option : {"--holdout", "--catcher", "--camera-invisible"}) {
        const std::string d = option.substr(2);
        expect_result(dataset({"--write", "bop", "-o", d, option, "big"}), 0, "OK");
        const json objects = read(d + "/000000/objects.json").at("objects");
        ASSERT_EQ(objects.size(), 1U) << option;
        EXPECT_EQ(objects[0].at("node"), "/small");
        const json models = read(d + "/objects.json").at("objects");
        ASSERT_EQ(models.size(), 1U) << option;
        EXPECT_EQ(models[0].at("nodes"), json::array({"/small"}));
        EXPECT_EQ(read(d + "/000000/labels/000000.json").at("objects").size(), 1U) << option;
        for (const json& poses : read(d + "/000000/scene_gt.json")) {
            for (const json& pose : poses)
                EXPECT_EQ(pose.at("obj_id"), 1) << option;
        }
    }
    expect_result(dataset({"-o", "d", "--no-shadow", "big"}), 0, "OK");
    EXPECT_EQ(read("d/objects.json").at("objects").size(), 2U);
}

/// A holdout by a material that nodes have in one of two variants.
TEST_F(DatasetCommand, WhatAnyVariantShowsIsListed) {
    json scene = json::parse(read_text(folder_ / "pair.gltf"));
    scene["extensionsUsed"].push_back("KHR_materials_variants");
    scene["extensions"]["KHR_materials_variants"]["variants"] = {{{"name", "A"}}, {{"name", "B"}}};
    scene["materials"].push_back({{"name", "Glass"}});
    scene["meshes"][0]["primitives"][0]["extensions"]["KHR_materials_variants"]["mappings"] =
        json::parse(R"([{"material": 1, "variants": [0]}])");
    folder_.write("pair.gltf", scene.dump());
    const Texts options = {"--write", "bop", "--count", "8", "--holdout", "Glass", "-o"};
    expect_result(dataset(joined(options, {"any"})), 0, "OK");
    std::set<size_t> counts;
    for (const json& poses : read("any/000000/scene_gt.json")) {
        counts.insert(poses.size());
        for (const json& pose : poses)
            EXPECT_GT(pose.at("obj_id"), 0);
    }
    EXPECT_EQ(counts, (std::set<size_t>{0, 2})) << "images of both variants";
    EXPECT_EQ(read("any/000000/objects.json").at("objects").size(), 2U);
    expect_result(dataset(joined(options, {"one", "--variant", "A"})), 0, "OK");
    EXPECT_TRUE(read("one/000000/objects.json").at("objects").empty());
    expect_result(dataset({"-o", "node", "--holdout", "big"}), 0, "OK");
    EXPECT_EQ(read("node/pair/objects.json").at("objects").size(), 1U);
}

TEST_F(DatasetCommand, CocoAndNerfNameTheImages) {
    expect_result(
        dataset({"--write", "coco,nerf", "-o", "d", "--exr"}, {"pair.gltf", "box.gltf"}), 0, "OK");
    const json coco = read("d/coco_annotations.json");
    ASSERT_EQ(coco.at("images").size(), 8U);
    EXPECT_EQ(coco.at("categories").size(), 3U);
    for (const json& image : coco.at("images")) {
        const std::string file = "d/" + image.at("file_name").get<std::string>();
        EXPECT_TRUE(fs::exists(folder_ / file)) << file;
    }
    EXPECT_GE(coco.at("annotations").size(), 8U);
    EXPECT_EQ(coco.at("annotations")[0].at("segmentation").at("size"), json({32, 48}));
    const json nerf = read("d/box/transforms.json");
    ASSERT_EQ(nerf.at("frames").size(), 4U);
    EXPECT_TRUE(fs::exists(folder_ / "d/box/exr/000003.exr"));
    // The eye is behind the camera's +Z, as far as the box is away.
    const auto m = nerf.at("frames")[0].at("transform_matrix").get<Rows>();
    const double distance = std::hypot(m[0][3], m[1][3], m[2][3]);
    for (size_t axis = 0; axis < 3; ++axis)
        EXPECT_NEAR(m[axis][3], distance * m[axis][2], 1e-4 * distance);
}

TEST_F(DatasetCommand, PartsMakeTheSameFiles) {
    const Texts options = {"--write", "bop,coco", "--seed", "5"};
    expect_result(dataset(joined(options, {"-o", "whole"})), 0, "OK");
    expect_result(dataset(joined(options, {"-o", "parts", "--part", "2/2"})), 0, "OK");
    EXPECT_EQ(read("parts/coco_annotations.json").at("images").size(), 2U);
    expect_result(dataset(joined(options, {"-o", "parts", "--part", "1/2"})), 0, "OK");
    EXPECT_TRUE(files("whole") == files("parts"));
    const ProgramRun again = dataset(joined(options, {"-o", "whole", "--skip-existing"}));
    EXPECT_THAT(again.err, HasSubstr("skipped=4"));
    EXPECT_TRUE(files("whole") == files("parts"));
}

TEST_F(DatasetCommand, ViewsFromInsideShowSomething) {
    // A room: the box from inside, and a small one in it. Another one is far away, so that most of
    // the places in the bounding box are outside the room, where views show the sky.
    SmallScene scene = box_scene();
    scene.nodes = R"({"mesh": 0, "scale": [-2, 2, 2]},
{"mesh": 0, "translation": [0, -1.7, 0], "scale": [0.3, 0.3, 0.3]},
{"mesh": 0, "translation": [20, 0, 0], "scale": [0.3, 0.3, 0.3]})";
    scene.roots = "0, 1, 2";
    scene.more.clear();
    folder_.write("room.gltf", gltf_text(scene));
    expect_result(dataset({"--sample", "box", "-o", "d", "--fov", "60"}, {"room.gltf"}), 0, "OK");
    for (const char* name : {"000000", "000001", "000002", "000003"}) {
        const std::vector<int> ids = codes("d/room/segmentation/" + std::string(name) + ".png", 16);
        EXPECT_EQ(std::count(ids.begin(), ids.end(), 0), 0) << name;
        const json labels = read("d/room/labels/" + std::string(name) + ".json");
        for (const json& coordinate : labels.at("camera").at("world_from_camera"))
            EXPECT_LE(std::abs(coordinate[3].get<double>()), 2) << name;
    }
}

TEST_F(DatasetCommand, DepthsBeyondTheStepsAreUnknown) {
    const ProgramRun got = dataset({"-o", "d", "--depth-unit", "0.001", "--count", "1"});
    expect_result(got, 0, "OK");
    EXPECT_THAT(got.err, HasSubstr("they are 0, unknown. --depth-unit takes"));
    const std::vector<int> depths = codes("d/pair/depth/000000.png", 16);
    EXPECT_EQ(std::count(depths.begin(), depths.end(), 0), 48 * 32);
}

TEST_F(DatasetCommand, MistakesAreRefused) {
    expect_result(dataset({}), 64, "E-USAGE-CONFLICT");
    expect_result(dataset({"-o", "d", "--write", "voc"}), 64, "E-USAGE-CHOICE");
    expect_result(dataset({"-o", "d", "--vary", "light"}), 64, "E-USAGE-CHOICE");
    expect_result(dataset({"-o", "d", "--fill", "0.9,0.5"}), 64, "E-USAGE-CONFLICT");
    expect_result(
        dataset({"-o", "d", "--fill", "0.5,0.9", "--sample", "box"}), 64, "E-USAGE-CONFLICT");
    expect_result(dataset({"-o", "d/{view}"}), 64, "E-USAGE-CONFLICT");
    expect_result(
        dataset({"-o", "d", "--write", "bop", "--distortion", "0.1,0"}), 64, "E-USAGE-CONFLICT");
    EXPECT_THAT(dataset({"-o", "d", "--aov", "depth"}).err, HasSubstr("add --exr"));
    EXPECT_FALSE(fs::exists(folder_ / "d"));
    folder_.write("file", "");
    expect_result(dataset({"-o", "file"}), 73, "E-OUT-CREATE");
    const ProgramRun no_scene = dataset({"-o", "d"}, {"none.gltf"});
    expect_result(no_scene, 66, "E-SCENE-MISSING");
    EXPECT_THAT(no_scene.err, Not(HasSubstr("E-OUT-CREATE"))) << "of no folder that was asked for";
    const ProgramRun dry = dataset({"-o", "dry", "--dry-run"});
    EXPECT_EQ(split_lines(dry.out).size(), 4U);
    EXPECT_FALSE(fs::exists(folder_ / "dry"));
}

TEST_F(DatasetCommand, WhatIsMissingIsMadeAgain) {
    const Texts options = {"-o", "d", "--write", "bop"};
    expect_result(dataset(options), 0, "OK");
    const auto whole = files("d");
    for (const char* file : {"labels/000001.json",
                             "depth/000002.png",
                             "segmentation/000003.png",
                             "mask/000001_000000.png",
                             "mask_visib/000000_000000.png"}) {
        for (const bool cut : {false, true}) {
            const fs::path path = folder_ / "d/000000" / file;
            if (cut) {
                fs::resize_file(path, fs::file_size(path) / 2);
            } else {
                fs::remove(path);
            }
            const ProgramRun again = dataset(joined(options, {"--skip-existing"}));
            EXPECT_THAT(again.err, HasSubstr("its labels are not there"));
            EXPECT_THAT(again.err, HasSubstr("skipped=3"));
            EXPECT_TRUE(files("d") == whole) << file;
        }
    }
    // What an earlier image of more objects has left goes.
    const fs::path folder = folder_ / "d/000000";
    const size_t objects = read("d/000000/labels/000001.json").at("objects").size();
    const std::string left = "/000001_00000" + std::to_string(objects) + ".png";
    for (const char* masks : {"mask", "mask_visib"})
        fs::copy_file(folder / "mask/000001_000000.png", folder / (masks + left));
    expect_result(dataset(options), 0, "OK");
    EXPECT_TRUE(files("d") == whole);
    // Another step of the depths is another image.
    const ProgramRun other = dataset(joined(options, {"--skip-existing", "--depth-unit", "1"}));
    EXPECT_THAT(other.err, HasSubstr("skipped=0"));
    // An image that is not there is in no format.
    fs::remove(folder_ / "d/000000/rgb/000001.png");
    expect_result(
        dataset(joined(options, {"--skip-existing", "--depth-unit", "1", "--part", "1/4"})),
        0,
        "OK");
    EXPECT_FALSE(read("d/000000/scene_gt.json").contains("1"));
    EXPECT_TRUE(read("d/000000/scene_gt.json").contains("2"));
}

TEST_F(DatasetCommand, MatricesOfSinglePrecisionAreOneModel) {
    SmallScene scene = box_scene();
    scene.nodes.clear();
    scene.roots.clear();
    for (int i = 0; i < 6; ++i) {
        const double c = std::cos(0.7 * i);
        const double s = std::sin(0.7 * i);
        const auto text = [](double x) { return std::to_string(x); };  // six decimals
        scene.nodes += (i == 0 ? "" : ", ") + std::string(R"({"mesh": 0, "matrix": [)") +
                       text(2 * c) + ", 0, " + text(-2 * s) + ", 0, 0, 2, 0, 0, " + text(2 * s) +
                       ", 0, " + text(2 * c) + ", 0, " + text(5.0 * i) + ", 0, 0, 1]}";
        scene.roots += (i == 0 ? "" : ", ") + std::to_string(i);
    }
    scene.more.clear();
    folder_.write("six.gltf", gltf_text(scene));
    expect_result(dataset({"-o", "d", "--count", "1"}, {"six.gltf"}), 0, "OK");
    const json models = read("d/objects.json").at("objects");
    ASSERT_EQ(models.size(), 1U);
    EXPECT_EQ(models[0].at("nodes").size(), 6U);
}

TEST_F(DatasetCommand, ASceneThatFailsLeavesNoFolder) {
    const Texts scenes = {"pair.gltf", "broken.gltf"};
    folder_.write("broken.gltf", "{");
    // Where variants vary, the scene fails before its folder is made; else after.
    for (const char* varied : {"variant", "none"}) {
        const Texts options = {"-o", varied, "--write", "bop", "--vary", varied};
        EXPECT_NE(dataset(options, scenes).code, 0);
        EXPECT_FALSE(fs::exists(folder_ / varied / "000001")) << varied;
        EXPECT_TRUE(fs::exists(folder_ / varied / "000000/scene_gt.json")) << varied;
    }
}

/// Other parts may be about to write there.
TEST_F(DatasetCommand, APartWithoutImagesLeavesFoldersAlone) {
    for (const Texts& shared :
         {Texts{"--part", "9/9"}, Texts{"--part", "9/9", "--skip-existing"}}) {
        fs::create_directories(folder_ / "d/pair/rgb");
        expect_result(dataset(joined({"-o", "d"}, shared)), 0, "OK");
        EXPECT_TRUE(fs::exists(folder_ / "d/pair/rgb"));
    }
}

TEST_F(DatasetCommand, DamagedLabelsAreNamed) {
    expect_result(dataset({"-o", "d", "--write", "coco"}), 0, "OK");
    folder_.write("d/pair/labels/000001.json", R"({"image": "rgb/000001.png", "objects": []})");
    const ProgramRun got = dataset({"-o", "d", "--write", "coco", "--skip-existing"});
    expect_result(got, 65, "E-DATASET-LABELS");
}

/// A view from a random place between two far things shows neither, unless it is aimed.
TEST_F(DatasetCommand, IsMeteredWhereItsViewsAim) {
    SmallScene scene = box_scene();
    scene.nodes = R"({"mesh": 0}, {"mesh": 0, "translation": [40, 40, 40]})";
    scene.roots = "0, 1";
    scene.more.clear();
    folder_.write("far.gltf", gltf_text(scene));
    const ProgramRun got = dataset(
        {"--sample", "box", "--exposure", "auto", "--env", "white", "-o", "far"}, {"far.gltf"});
    expect_result(got, 0, "OK");
    EXPECT_THAT(got.err, HasSubstr("metered in 4 small images"));
}

}  // namespace
}  // namespace obscura
