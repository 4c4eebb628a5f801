// tests/app/render_request_test.cpp - option texts become a request; mistakes are in tests/cli.
// SPDX-License-Identifier: Apache-2.0
#include "app/render_request.h"

#include "app/distinct_files.h"
#include "base/setting_names.h"

#include <gtest/gtest.h>

#include "support/temp_folder.h"
#include <cmath>

namespace obscura::app {
namespace {

Result<RenderRequest> request_of(const RenderArguments& arguments) {
    RenderArguments named = arguments;
    named.scene_file = "s.glb";
    return make_render_request(named);
}

void expect_conflict(const RenderArguments& arguments, const std::string& where) {
    const Result<RenderRequest> request = request_of(arguments);
    ASSERT_FALSE(request) << where;
    EXPECT_EQ(request.error().code, ExitCode::usage);
    EXPECT_EQ(request.error().id, "E-USAGE-CONFLICT");
    EXPECT_EQ(spell_settings(request.error().where, SettingNames::options), where);
}

TEST(RenderRequest, ImagesForDisplaysAreAskedForByFourOptions) {
    RenderArguments arguments;
    arguments.outputs = {"a.png"};
    arguments.bits = "16";
    arguments.quality = "70";
    arguments.no_dither = true;
    arguments.page = "#FF0000";
    const Result<RenderRequest> request = request_of(arguments);
    ASSERT_TRUE(request);
    EXPECT_EQ(request->encoding.bits, 16);
    EXPECT_EQ(request->encoding.quality, 70);
    EXPECT_FALSE(request->encoding.dither);
    EXPECT_EQ(request->encoding.page, (std::array<float, 3>{1, 0, 0}));
    EXPECT_EQ(request->options.background, BackgroundKind::transparent) << "a page shows behind";
    arguments.background = "env";
    EXPECT_EQ(request_of(arguments)->options.background, BackgroundKind::environment);
    arguments.background = "white";
    expect_conflict(arguments, "--page");
}

TEST(RenderRequest, ADashIsStandardOutput) {
    RenderArguments arguments;
    arguments.outputs = {"-"};
    Result<RenderRequest> request = request_of(arguments);
    ASSERT_TRUE(request);
    EXPECT_TRUE(request->outputs.empty()) << "no default file";
    EXPECT_EQ(request->standard_output, OutputFormat::png);
    arguments.format = "webp";
    arguments.outputs = {"a.exr", "-"};
    request = request_of(arguments);
    ASSERT_TRUE(request);
    EXPECT_EQ(request->outputs, std::vector<std::filesystem::path>{"a.exr"});
    EXPECT_EQ(request->standard_output, OutputFormat::webp);
    arguments.outputs = {"a.exr"};
    expect_conflict(arguments, "--format");
    arguments.outputs = {"-", "-"};
    EXPECT_EQ(request_of(arguments).error().id, "E-USAGE-SAMEFILE");
    arguments.outputs = {"-"};
    arguments.frames = "1-2";
    expect_conflict(arguments, "--output");
}

TEST(RenderRequest, ExrsAreStoredAsTheOptionsSay) {
    RenderArguments arguments;
    const ExrOptions untouched = request_of(arguments)->exr;
    EXPECT_EQ(untouched.layout, ExrLayout::single);
    EXPECT_EQ(untouched.compression, ExrCompression::zip);
    EXPECT_EQ(untouched.tile_size, 0);
    EXPECT_FALSE(untouched.mipmap);
    arguments.exr_layout = "multipart";
    arguments.compression = "dwab:12";
    arguments.exr_tiles = "128";
    arguments.exr_mipmap = true;
    const Result<RenderRequest> request = request_of(arguments);
    ASSERT_TRUE(request);
    EXPECT_EQ(request->exr.layout, ExrLayout::multipart);
    EXPECT_EQ(request->exr.compression, ExrCompression::dwab);
    EXPECT_EQ(request->exr.dwa_level, 12);
    EXPECT_EQ(request->exr.tile_size, 128);
    EXPECT_TRUE(request->exr.mipmap);
    arguments.exr_tiles = "0";
    EXPECT_EQ(request_of(arguments).error().id, "E-USAGE-RANGE");
}

TEST(RenderRequest, ANoiseTargetAsksForAsManySamplesAsItNeeds) {
    RenderArguments arguments;
    EXPECT_FALSE(request_of(arguments)->options.adaptive);
    arguments.spp = "auto";
    Result<RenderRequest> request = request_of(arguments);
    ASSERT_TRUE(request && request->options.adaptive);
    EXPECT_EQ(request->options.samples_per_pixel, default_max_samples);
    EXPECT_EQ(request->options.adaptive->noise_target, 0.01);
    EXPECT_EQ(request->options.adaptive->min_samples, 16);
    arguments.spp.reset();
    arguments.noise_target = "0.05";
    arguments.spp_min = "5000";
    request = request_of(arguments);
    ASSERT_TRUE(request && request->options.adaptive);
    EXPECT_EQ(request->options.samples_per_pixel, 5000) << "at least the least";
    EXPECT_EQ(request->options.adaptive->noise_target, 0.05);
    arguments.spp = "300";
    expect_conflict(arguments, "--spp-min");
    arguments.spp_min.reset();
    arguments.spp = "8";
    EXPECT_EQ(request_of(arguments)->options.adaptive->min_samples, 8);
    arguments.spp = "1";
    expect_conflict(arguments, "--noise-target");
    arguments.spp = "300";
    arguments.spp_min = "300";
    EXPECT_EQ(request_of(arguments)->options.samples_per_pixel, 300);
    arguments.integrator = "raycast";
    expect_conflict(arguments, "--noise-target");
    arguments.integrator = "ao";
    EXPECT_TRUE(request_of(arguments));
    arguments.spp_min = "1";
    EXPECT_EQ(request_of(arguments).error().id, "E-USAGE-RANGE");
    arguments.spp_min = "32";
    arguments.noise_target = "0";
    EXPECT_EQ(request_of(arguments).error().id, "E-USAGE-RANGE");
    arguments.noise_target.reset();
    expect_conflict(arguments, "--spp-min");
    arguments.spp = "automatic";
    EXPECT_EQ(request_of(arguments).error().id, "E-USAGE-NUMBER");
}

TEST(RenderRequest, LayersNeedAnExrAndFilesOfTheirOwnANamedOne) {
    RenderArguments arguments;
    arguments.aovs = {"depth,normal"};
    arguments.outputs = {"a.png"};
    expect_conflict(arguments, "--aov");
    arguments.outputs = {"-"};
    expect_conflict(arguments, "--aov");
    arguments.format = "exr";
    EXPECT_TRUE(request_of(arguments));
    arguments.exr_layout = "separate";
    expect_conflict(arguments, "--exr-layout");
    arguments.format = "png";
    arguments.outputs = {"-", "a.exr"};
    const Result<RenderRequest> request = request_of(arguments);
    ASSERT_TRUE(request);
    const std::vector<std::filesystem::path> files = {"a.exr", "a.depth.exr", "a.normal.exr"};
    EXPECT_EQ(image_files(*request, list_images(*request, {})->images.front()), files);
    arguments.outputs = {"a.exr", "a.depth.exr"};
    arguments.format.reset();
    EXPECT_EQ(request_of(arguments).error().id, "E-USAGE-SAMEFILE");
}

TEST(RenderRequest, NamesTheOptionThatAsksForLayers) {
    RenderArguments arguments;
    arguments.outputs = {"a.png"};
    EXPECT_TRUE(request_of(arguments));
    arguments.layer.denoising_data = true;
    expect_conflict(arguments, "--denoising-data");
    arguments.layer.lpe = {"gloss=C<R[GS]>.*[LOB]"};
    expect_conflict(arguments, "--lpe");
}

TEST(RenderRequest, SharesOfTheLightComeFromPaths) {
    RenderArguments arguments;
    arguments.outputs = {"a.exr"};
    arguments.aovs = {"diffuse_direct,shadow"};
    arguments.layer.lpe = {"gloss=C<R[GS]>.*[LOB]"};
    arguments.layer.light_group = {"key=Key*,Sun"};
    const Result<RenderRequest> request = request_of(arguments);
    ASSERT_TRUE(request) << request.error().message;
    std::vector<std::string> names;
    for (const Layer& layer : request->options.layers)
        names.push_back(layer.name);
    const std::vector<std::string> expected = {
        "diffuse_direct", "shadow", "gloss", "light_key", "light_rest"};
    EXPECT_EQ(names, expected);
    arguments.integrator = "ao";
    expect_conflict(arguments, "--aov");
    arguments.aovs.clear();
    expect_conflict(arguments, "--lpe");
    arguments.layer.lpe.clear();
    expect_conflict(arguments, "--light-group");
    arguments.integrator = "direct";
    EXPECT_TRUE(request_of(arguments));
    arguments.product.catcher = {"ground"};
    EXPECT_TRUE(request_of(arguments));
    arguments.product.catcher.clear();
    arguments.layer.lpe = {"light_key=CO"};
    expect_conflict(arguments, "--lpe");
    arguments.layer = {};
    arguments.layer.light_groups = "each";
    EXPECT_TRUE(request_of(arguments));
    arguments.exr_layout = "separate";
    expect_conflict(arguments, "--exr-layout");
    arguments.layer = {};
    arguments.layer.lpe = {"a=C("};
    EXPECT_EQ(request_of(arguments).error().id, "E-LPE");
}

TEST(RenderRequest, AManifestIsForCryptomatteAndLiesBesideTheImage) {
    RenderArguments arguments;
    arguments.outputs = {"out/a.exr", "b.png"};
    arguments.crypto_manifest = "out/names.json";
    expect_conflict(arguments, "--crypto-manifest");
    arguments.aovs = {"depth"};
    expect_conflict(arguments, "--crypto-manifest");
    arguments.aovs = {"crypto_object"};
    EXPECT_EQ(request_of(arguments)->crypto_manifest, std::filesystem::path("out/names.json"));
    arguments.crypto_manifest = "names.json";
    expect_conflict(arguments, "--crypto-manifest");
    arguments.outputs = {"a.exr"};
    EXPECT_TRUE(request_of(arguments));
    arguments.crypto_manifest = "names\\.json";
    expect_conflict(arguments, "--crypto-manifest");
    arguments.crypto_manifest = "a.exr";
    EXPECT_EQ(request_of(arguments).error().id, "E-USAGE-SAMEFILE");
    arguments.crypto_manifest = "names.json";
    arguments.outputs = {"-"};
    arguments.format = "exr";
    expect_conflict(arguments, "--crypto-manifest");
}

TEST(RenderRequest, TheDefaultsAreTheDocumentedOnes) {
    RenderArguments arguments;
    arguments.scene_file = "folder/My.Scene.glb";
    const Result<RenderRequest> request = make_render_request(arguments);
    ASSERT_TRUE(request);
    EXPECT_EQ(request->outputs, std::vector<std::filesystem::path>{"My.Scene.exr"});
    EXPECT_EQ(request->options.width, 1280);
    EXPECT_EQ(request->options.height, 720);
    EXPECT_EQ(request->options.samples_per_pixel, 64);
    EXPECT_EQ(request->options.max_bounces, 8);
    EXPECT_EQ(request->options.seed, 0U);
    EXPECT_EQ(request->options.integrator, Integrator::path);
    EXPECT_EQ(request->options.filter, PixelFilter::box);
    EXPECT_EQ(request->options.background, BackgroundKind::environment);
    EXPECT_EQ(request->options.tile_size, 16);
    EXPECT_EQ(request->options.clamp_direct, 0);
    EXPECT_EQ(request->options.clamp_indirect, 0);
    EXPECT_TRUE(request->options.caustics);
    EXPECT_FALSE(request->options.regularize);
    EXPECT_FALSE(request->options.crop);
    EXPECT_EQ(request->threads, 0);
    EXPECT_EQ(request->isa, Isa::automatic);
    EXPECT_EQ(request->exr.depth, ExrDepth::half);
    EXPECT_EQ(request->encoding.bits, 8);
    EXPECT_FALSE(request->encoding.quality || request->encoding.page);
    EXPECT_TRUE(request->encoding.dither);
    EXPECT_FALSE(request->standard_output);
    EXPECT_EQ(request->load.scene, -1);
    EXPECT_FALSE(request->load.occlusion);
    EXPECT_EQ(request->verbosity, Verbosity::normal);
    EXPECT_EQ(request->points_lines.points.diameter, 3);
    EXPECT_EQ(request->points_lines.lines.diameter, 2);
    EXPECT_EQ(request->points_lines.lines.unit, LengthUnit::pixels);
    EXPECT_FALSE(request->camera.yfov_rad || request->camera.eye_m || request->camera.model);
}

RenderArguments every_option() {
    RenderArguments a;
    a.scene_file = "s.glb";
    a.outputs = {"b.png", "c.exr"};
    a.size = "64x32";
    a.crop = "1,2,3,4";
    a.spp = "5";
    a.depth = "6";
    a.seed = "7";
    a.threads = "8";
    a.isa = "avx2";
    a.tile_size = "9";
    a.scene = "3";
    a.camera_model = "orthographic";
    a.eye = "1,2,3";
    a.target = "4,5,6";
    a.up = "0,0,1";
    a.fov = "90";
    a.env = "sky.hdr";
    a.env_intensity = "2";
    a.env_rotation = "-45";
    a.occlusion = "ambient";
    a.product.lights = "Key=Light=0.5,Rim*=off";
    a.product.hide = {"Floor", "Wall*"};
    a.product.holdout = {"Actor"};
    a.product.camera_invisible = {"Wall"};
    a.product.no_shadow = {"Lid", "Net"};
    a.background = "0.5,0.25,1";
    a.point_size = "0.25";
    a.line_width = "5px";
    a.integrator = "ao";
    a.ao_distance = "0.5";
    a.clamp_direct = "20";
    a.clamp_indirect = "2.5";
    a.caustics = "off";
    a.regularize = true;
    a.filter = "gaussian";
    a.view = "V";
    a.display = "D";
    a.ocio = "o.ocio";
    a.exposure = "-1.5";
    a.stats = "s.json";
    a.float32 = true;
    a.verbose = true;
    return a;
}

TEST(RenderRequest, CatchersAreTheGroundOrParts) {
    RenderArguments a;
    a.scene_file = "s.glb";
    EXPECT_FALSE(make_render_request(a)->catcher_ground);
    a.product.catcher = {"ground", "Table*"};
    a.product.catcher_reflections = true;
    const Result<RenderRequest> request = make_render_request(a);
    ASSERT_TRUE(request) << request.error().message;
    EXPECT_TRUE(request->catcher_ground);
    EXPECT_TRUE(request->options.catcher_reflections);
    ASSERT_EQ(request->load.visibility.size(), 1U);
    EXPECT_EQ(request->load.visibility[0].pattern, "Table*");
    EXPECT_EQ(request->load.visibility[0].flag, visibility_catcher);
    a.integrator = "direct";
    EXPECT_TRUE(make_render_request(a));
    for (const char* other : {"raycast", "ao", "depth"}) {
        a.integrator = other;
        const Result<RenderRequest> refused = make_render_request(a);
        ASSERT_FALSE(refused);
        EXPECT_EQ(refused.error().id, "E-USAGE-CONFLICT");
    }
    a.product.catcher.clear();  // its reflections need one
    a.integrator.reset();
    EXPECT_EQ(make_render_request(a).error().id, "E-USAGE-CONFLICT");
}

TEST(RenderRequest, GlassIsTransparentWhereThereAreCatchersUnlessItIsSaid) {
    RenderArguments a;
    a.scene_file = "s.glb";
    EXPECT_EQ(make_render_request(a)->options.transparent_glass, TransparentGlass::automatic);
    EXPECT_EQ(make_render_request(a)->options.clear_roughness, 0.1);
    a.product.transparent_glass = "on";
    a.product.transparent_glass_roughness = "0.25";
    EXPECT_EQ(make_render_request(a)->options.transparent_glass, TransparentGlass::on);
    EXPECT_EQ(make_render_request(a)->options.clear_roughness, 0.25);
    a.product.transparent_glass = "off";
    EXPECT_EQ(make_render_request(a)->options.transparent_glass, TransparentGlass::off);
    a.product.transparent_glass = "clear";
    EXPECT_EQ(make_render_request(a).error().id, "E-USAGE-CHOICE");
    a.product.transparent_glass = "auto";
    a.product.transparent_glass_roughness = "1.5";
    EXPECT_EQ(make_render_request(a).error().id, "E-USAGE-RANGE");
}

TEST(RenderRequest, ImageAndSamplingOptionsArrive) {
    const Result<RenderRequest> request = make_render_request(every_option());
    ASSERT_TRUE(request) << request.error().message;
    const RenderOptions& options = request->options;
    EXPECT_EQ(request->outputs.size(), 2U);
    EXPECT_EQ(options.width, 64);
    EXPECT_EQ(options.height, 32);
    ASSERT_TRUE(options.crop);
    EXPECT_EQ(options.crop->y, 2);
    EXPECT_EQ(options.crop->height, 4);
    EXPECT_EQ(options.samples_per_pixel, 5);
    EXPECT_EQ(options.max_bounces, 6);
    EXPECT_EQ(options.seed, 7U);
    EXPECT_EQ(request->threads, 8);
    EXPECT_EQ(request->isa, Isa::avx2);
    EXPECT_EQ(options.tile_size, 9);
    EXPECT_EQ(request->load.scene, 3);
    EXPECT_EQ(options.integrator, Integrator::ao);
    EXPECT_EQ(options.ao_distance_m, 0.5);
    EXPECT_EQ(options.clamp_direct, 20);
    EXPECT_EQ(options.clamp_indirect, 2.5);
    EXPECT_FALSE(options.caustics);
    EXPECT_TRUE(options.regularize);
    EXPECT_EQ(request->points_lines.points.diameter, 0.25);
    EXPECT_EQ(request->points_lines.points.unit, LengthUnit::metres);
    EXPECT_EQ(request->points_lines.lines.diameter, 5);
    EXPECT_EQ(request->points_lines.lines.unit, LengthUnit::pixels);
    EXPECT_EQ(options.filter, PixelFilter::gaussian);
}

TEST(RenderRequest, CameraLightAndDisplayOptionsArrive) {
    const Result<RenderRequest> request = make_render_request(every_option());
    ASSERT_TRUE(request) << request.error().message;
    const RenderOptions& options = request->options;
    EXPECT_EQ(request->camera.model, CameraModel::orthographic);
    EXPECT_EQ(request->camera.eye_m->z, 3);
    EXPECT_EQ(request->camera.target_m->x, 4);
    EXPECT_EQ(request->camera.up->z, 1);
    EXPECT_NEAR(*request->camera.yfov_rad, M_PI / 2, 1e-12);
    EXPECT_EQ(request->environment, std::filesystem::path("sky.hdr"));
    EXPECT_EQ(request->environment_intensity, 2);
    EXPECT_EQ(request->environment_rotation_deg, -45);
    EXPECT_TRUE(request->load.occlusion);
    ASSERT_EQ(request->load.lights.factors.size(), 2U);
    EXPECT_FALSE(request->load.lights.off);
    EXPECT_EQ(request->load.lights.factors[0].pattern, "Key=Light");
    EXPECT_EQ(request->load.lights.factors[0].factor, 0.5);
    EXPECT_EQ(request->load.lights.factors[1].pattern, "Rim*");
    EXPECT_EQ(request->load.lights.factors[1].factor, 0);
    EXPECT_EQ(request->load.hidden, (std::vector<std::string>{"Floor", "Wall*"}));
    std::vector<std::string> flagged;
    for (const gltf::VisibilityRule& rule : request->load.visibility)
        flagged.push_back(rule.pattern + " " + std::to_string(rule.flag));
    EXPECT_EQ(flagged, (std::vector<std::string>{"Actor 1", "Wall 2", "Lid 4", "Net 4"}));
    EXPECT_EQ(options.background, BackgroundKind::color);
    EXPECT_EQ(options.background_color[1], 0.25f);
    EXPECT_EQ(request->display.view, "V");
    EXPECT_EQ(request->display.display, "D");
    EXPECT_EQ(request->display.ocio_file, "o.ocio");
    EXPECT_EQ(request->display.exposure_ev, -1.5);
    EXPECT_EQ(request->statistics, std::filesystem::path("s.json"));
    EXPECT_EQ(request->exr.depth, ExrDepth::float32);
    EXPECT_EQ(request->verbosity, Verbosity::verbose);
}

TEST(RenderRequest, ASceneIsAnIndexOrAName) {
    RenderArguments arguments;
    arguments.scene_file = "s.glb";
    arguments.scene = "Night 2";
    EXPECT_EQ(make_render_request(arguments)->load.scene_name, "Night 2");
    arguments.scene = "99999999999";
    EXPECT_EQ(make_render_request(arguments).error().id, "E-USAGE-RANGE");
}

TEST(RenderRequest, TheFramingsOptionsArriveAndGoBeforeTheFilesCameras) {
    RenderArguments a;
    a.scene_file = "s.glb";
    EXPECT_FALSE(make_render_request(a)->camera.frames);
    a.camera = "auto";
    EXPECT_TRUE(make_render_request(a)->camera.frames);
    a.product.azimuth = "-90";
    a.product.elevation = "45";
    a.product.roll = "180";
    a.product.zoom = "2.5";
    a.product.margin = "10";
    a.product.frame = "sphere";
    a.product.focus_node = "Lid*";
    const Result<RenderRequest> request = make_render_request(a);
    ASSERT_TRUE(request) << request.error().message;
    const FramingOptions& framing = request->camera.framing;
    EXPECT_NEAR(framing.azimuth_rad, -M_PI / 2, 1e-12);
    EXPECT_NEAR(framing.elevation_rad, M_PI / 4, 1e-12);
    EXPECT_NEAR(framing.roll_rad, M_PI, 1e-12);
    EXPECT_EQ(framing.zoom, 2.5);
    EXPECT_NEAR(framing.margin, 0.1, 1e-12);
    EXPECT_EQ(framing.fit, FrameFit::sphere);
    EXPECT_EQ(request->camera.framed_node, "Lid*");
    a.camera.reset();
    EXPECT_TRUE(make_render_request(a)->camera.frames);
    a.camera = "Door";
    EXPECT_EQ(make_render_request(a).error().id, "E-USAGE-CONFLICT");
    a.camera.reset();
    a.eye = "1,2,3";
    EXPECT_EQ(make_render_request(a).error().id, "E-USAGE-CONFLICT");
}

TEST(RenderRequest, TheDefaultsOfTheFramingAreWrittenAsTheyAre) {
    RenderArguments a;
    a.scene_file = "s.glb";
    const FramingOptions framing = make_render_request(a)->camera.framing;
    a.product.azimuth = "30";  // as in the table of options
    a.product.elevation = "20";
    a.product.margin = "5";
    const FramingOptions written = make_render_request(a)->camera.framing;
    EXPECT_NEAR(written.azimuth_rad, framing.azimuth_rad, 1e-12);
    EXPECT_NEAR(written.elevation_rad, framing.elevation_rad, 1e-12);
    EXPECT_NEAR(written.margin, framing.margin, 1e-12);
}

TEST(ParseLights, TakesTwoWordsAndPairs) {
    EXPECT_TRUE(parse_lights("off", "--lights")->off);
    EXPECT_FALSE(parse_lights("keep", "--lights")->off);
    EXPECT_TRUE(parse_lights("keep", "--lights")->factors.empty());
    for (const char* text : {"", "Lamp", "=2", "Lamp=1,", ","})
        EXPECT_EQ(parse_lights(text, "--lights").error().id, "E-USAGE-CHOICE") << text;
    EXPECT_EQ(parse_lights("Lamp=bright", "--lights").error().id, "E-USAGE-NUMBER");
    EXPECT_EQ(parse_lights("Lamp=1e7", "--lights").error().id, "E-USAGE-RANGE");
}

TEST(SameFile, SeesThroughLinksAndMissingFiles) {
    const TempFolder folder;
    folder.write("a", "a");
    std::filesystem::create_symlink("a", folder / "link");
    EXPECT_TRUE(same_file(folder / "a", folder.path() / "." / "a"));
    EXPECT_TRUE(same_file(folder / "a", folder / "link"));
    EXPECT_TRUE(same_file(folder / "new", folder.path() / ".." / folder.path().filename() / "new"));
    EXPECT_TRUE(same_file("obscura_no_such_file", "./obscura_no_such_file"));
    EXPECT_FALSE(same_file(folder / "new", folder / "other"));
    EXPECT_FALSE(same_file(folder / "a", folder / "new"));
}

}  // namespace
}  // namespace obscura::app
