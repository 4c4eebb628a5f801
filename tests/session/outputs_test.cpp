// tests/session/outputs_test.cpp - what is said of files before they are written.
// SPDX-License-Identifier: Apache-2.0
#include "session/outputs.h"

#include <gtest/gtest.h>

#include <array>
#include <gmock/gmock.h>

namespace obscura {
namespace {

using testing::AllOf;
using testing::ElementsAre;
using testing::HasSubstr;
using testing::IsEmpty;

std::vector<std::string> warnings(const RenderRequest& request) {
    Log log(Verbosity::quiet, {}, SettingNames::options);
    warn_of_lost_alpha(request, log);
    return log.warnings();
}

TEST(Outputs, AJpegOfATransparentImageNeedsAPage) {
    RenderRequest request;
    request.outputs = {"shoe.png", "shoe.jpg", "shoe.exr"};
    EXPECT_THAT(warnings(request), IsEmpty());
    request.options.background = BackgroundKind::transparent;
    EXPECT_THAT(
        warnings(request),
        ElementsAre(AllOf(HasSubstr("shoe.jpg: jpeg has no alpha"), HasSubstr("--page white"))));
    request.standard_output = OutputFormat::jpeg;
    request.outputs.clear();
    EXPECT_THAT(warnings(request), ElementsAre(HasSubstr("standard output: jpeg has")));
    request.encoding.page = std::array<float, 3>{1, 1, 1};
    EXPECT_THAT(warnings(request), IsEmpty());
}

}  // namespace
}  // namespace obscura
