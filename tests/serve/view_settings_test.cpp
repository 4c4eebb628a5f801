// tests/serve/view_settings_test.cpp - which options leave the samples of a picture as they are.
// SPDX-License-Identifier: Apache-2.0
#include "serve/view_settings.h"

#include <gtest/gtest.h>

namespace obscura::serve {
namespace {

TEST(ViewSettings, TheDisplayDoesNotChangeSamples) {
    const Options plain = {{"size", "64x36"}, {"spp", 4}};
    Options shown = plain;
    shown["exposure"] = 2;
    shown["view"] = "Raw";
    shown["display"] = "sRGB";
    EXPECT_EQ(rendering_of(shown), rendering_of(plain));
    for (const char* name : {"spp", "page", "denoise", "eye", "fstop"}) {
        Options other = plain;
        other[name] = "7";
        EXPECT_NE(rendering_of(other), rendering_of(plain)) << name;
    }
}

TEST(ViewSettings, AdaptiveSamplingLooksAtTheExposure) {
    const Options plain = {{"noise-target", 0.05}};
    Options exposed = plain;
    exposed["exposure"] = 2;
    EXPECT_NE(rendering_of(exposed), rendering_of(plain));
    Options viewed = plain;
    viewed["view"] = "Raw";
    EXPECT_EQ(rendering_of(viewed), rendering_of(plain));
}

}  // namespace
}  // namespace obscura::serve
