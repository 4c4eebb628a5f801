// tests/session/dark_image_test.cpp - the warning of nearly black images.
// SPDX-License-Identifier: Apache-2.0
#include "session/dark_image.h"

#include <gtest/gtest.h>

#include <gmock/gmock.h>

namespace obscura {
namespace {

using testing::ElementsAre;
using testing::HasSubstr;
using testing::IsEmpty;
using testing::Not;

/// Two pixels of one grey; the second is covered as far as its alpha says.
OutputImage grey(float value, float alpha = 1) {
    OutputImage image;
    image.width = 2;
    image.height = 1;
    image.channels = {"R", "G", "B", "A"};
    image.pixels.resize(8);
    const float values[] = {
        value, value, value, 1, value * alpha, value * alpha, value * alpha, alpha};
    std::copy(std::begin(values), std::end(values), image.pixels.begin());
    return image;
}

Scene lit_scene() {
    Scene scene;
    scene.primitives.resize(1);
    scene.lights.resize(1);
    scene.info.light_names = {"Lamp"};
    return scene;
}

std::vector<std::string> warnings(const OutputImage& image,
                                  const RenderRequest& request = {},
                                  const Scene& scene = lit_scene(),
                                  double exposure_ev = 0) {
    Log log(Verbosity::quiet, {}, SettingNames::options);
    warn_of_dark_image(image, request, scene, exposure_ev, log);
    return log.warnings();
}

TEST(DarkImage, TheMeanIsOverWhatIsCovered) {
    EXPECT_NEAR(mean_luminance(grey(0.5F)).value(), 0.5, 1e-6);
    EXPECT_NEAR(mean_luminance(grey(0.5F, 0)).value(), 0.5, 1e-6);
    EXPECT_NEAR(mean_luminance(grey(0.5F, 0.25F)).value(), 0.5, 1e-6);
    OutputImage green = grey(0);
    green.pixels[1] = 1;
    EXPECT_NEAR(mean_luminance(green).value(), 0.5 * 0.7152, 1e-6);
    OutputImage depth = grey(1);
    depth.channels = {"Z", "Y", "X", "W"};
    EXPECT_FALSE(mean_luminance(depth));
}

TEST(DarkImage, OnlyNearlyBlackOnesAreWarnedOf) {
    EXPECT_THAT(warnings(grey(0.0101F)), IsEmpty());
    EXPECT_THAT(warnings(grey(0.0099F)), ElementsAre(HasSubstr("nearly black")));
    EXPECT_THAT(warnings(grey(0.0101F), {}, lit_scene(), -1), Not(IsEmpty()));
    EXPECT_THAT(warnings(grey(0.0099F), {}, lit_scene(), 1), IsEmpty());
}

TEST(DarkImage, SmallThingsInTheLightAreNot) {
    OutputImage small = grey(0.5F, 0);
    small.width = 100;
    small.pixels.resize(400, 0.0F);
    EXPECT_THAT(warnings(small), IsEmpty()) << "one pixel of a hundred is grey";
    EXPECT_THAT(warnings(grey(0.018F, 0)), ElementsAre(HasSubstr("its mean is 0.9 % of white")));
}

TEST(DarkImage, ItSaysWhatWouldHelp) {
    const auto text = warnings(grey(0.18F / 64));
    EXPECT_THAT(text,
                ElementsAre(HasSubstr("0.281 % of white, lit by the file's one light 'Lamp'")));
    EXPECT_THAT(text, ElementsAre(HasSubstr("--lights off lights it by the studio")));
    EXPECT_THAT(text, ElementsAre(HasSubstr("--exposure 6 makes")));
    RenderRequest request;
    request.environment = "maps/sky.hdr";
    EXPECT_THAT(warnings(grey(0.001F), request),
                ElementsAre(testing::AllOf(HasSubstr("the environment sky.hdr and the file's one"),
                                           Not(HasSubstr("--lights off")))));
    EXPECT_THAT(warnings(grey(0)), ElementsAre(HasSubstr("no light reaches")));
}

TEST(DarkImage, WhatGlowsKeepsTheStudioAway) {
    Scene scene = lit_scene();
    scene.materials.resize(2);
    EXPECT_THAT(warnings(grey(0.001F), {}, scene), ElementsAre(HasSubstr("--lights off")));
    scene.materials[1].emission[2] = 0.5F;
    EXPECT_THAT(warnings(grey(0.001F), {}, scene),
                ElementsAre(testing::AllOf(HasSubstr("light 'Lamp' and what glows in it; --env "
                                                     "studio lights it by the studio, too; --exp"),
                                           Not(HasSubstr("--lights off")))));
    scene.lights.clear();
    EXPECT_THAT(warnings(grey(0.001F), {}, scene),
                ElementsAre(HasSubstr("lit by what glows in it; --env studio lights")));
    scene.materials.assign(1, {});
    EXPECT_THAT(warnings(grey(0.001F), {}, scene),
                ElementsAre(HasSubstr("lit by the studio; --exposure")));
    scene.materials[0].flags |= material_unlit;
    EXPECT_THAT(warnings(grey(0.001F), {}, scene),
                ElementsAre(HasSubstr("lit by nothing, as its materials are unlit; --exposure")));
}

TEST(DarkImage, DataAndColouredBackgroundsAreNotJudged) {
    RenderRequest request;
    request.options.integrator = Integrator::depth;
    EXPECT_THAT(warnings(grey(0), request), IsEmpty());
    request.options.integrator = Integrator::path;
    request.options.background = BackgroundKind::color;
    EXPECT_THAT(warnings(grey(0), request), IsEmpty());
    EXPECT_THAT(warnings(grey(0), {}, Scene{}), IsEmpty());
}

}  // namespace
}  // namespace obscura
