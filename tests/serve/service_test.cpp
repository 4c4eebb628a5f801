// tests/serve/service_test.cpp - how many views are open, and what clients are told of files.
// SPDX-License-Identifier: Apache-2.0
#include "serve/service.h"

#include "app/serve_request.h"

#include <gtest/gtest.h>

#include "support/small_scenes.h"
#include "support/temp_folder.h"
#include <fstream>
#include <gmock/gmock.h>

namespace obscura::serve {
namespace {

using std::chrono::milliseconds;
using testing::HasSubstr;
using testing::Not;

class ServiceTest : public testing::Test {
protected:
    void SetUp() override { folder_.write("quad.gltf", gltf_text(lit_quad_scene())); }

    ServiceOptions options() const {
        ServiceOptions out;
        out.roots = {folder_.path()};
        out.options = app::image_options({});
        return out;
    }

    static std::string opened(Service& service, const std::string& file) {
        const Result<Json> view = service.open_view(file);
        EXPECT_TRUE(view) << view.error().message;
        return view ? view->at("view").get<std::string>() : "";
    }

    static Result<std::string> send(Service& service, const std::string& bytes) {
        return service.files().keep("sent.gltf", [&](const ByteSink& sink) {
            return sink(std::as_bytes(std::span(bytes)));
        });
    }

    TempFolder folder_;
};

TEST_F(ServiceTest, EightViewsAreOpenAndTheOneNotAskedForLongestMakesRoom) {
    Service service(options());
    std::vector<std::string> views;
    for (int i = 0; i < 8; ++i)
        views.push_back(opened(service, "quad.gltf"));
    ASSERT_TRUE(service.viewer(views[0]));
    (*service.viewer(views[0]))->wait_for(0, milliseconds(0));
    views.push_back(opened(service, "quad.gltf"));
    const Result<std::shared_ptr<Viewer>> closed = service.viewer(views[1]);
    ASSERT_FALSE(closed);
    EXPECT_EQ(closed.error().id, "E-SERVE-UNKNOWN");
    views.erase(views.begin() + 1);
    for (const std::string& open : views)
        EXPECT_TRUE(service.viewer(open)) << open;
    Service other(options());
    EXPECT_NE(opened(other, "quad.gltf"), views[0]) << "as of a server that was started anew";
}

TEST_F(ServiceTest, ChoicesAreThoseOfTheOcioConfig) {
    ServiceOptions with_config = options();
    std::ofstream(folder_ / "own.ocio") << R"(ocio_profile_version: 2
roles: {default: lin_rec709_scene, scene_linear: lin_rec709_scene}
file_rules:
  - !<Rule> {name: Default, colorspace: default}
displays:
  wall:
    - !<View> {name: dim, colorspace: lin_rec709_scene}
colorspaces:
  - !<ColorSpace> {name: lin_rec709_scene}
)";
    with_config.ocio_file = folder_ / "own.ocio";
    const Result<Json> choices = Service(with_config).choices();
    ASSERT_TRUE(choices) << choices.error().message;
    EXPECT_EQ(choices->at("displays"), Json::parse(R"([{"name": "wall", "views": ["dim"]}])"));
    with_config.ocio_file = folder_ / "none.ocio";
    const Result<Json> none = Service(with_config).choices();
    ASSERT_FALSE(none);
    EXPECT_EQ(none.error().id, "E-OCIO-FILE");
}

TEST_F(ServiceTest, WarningsNameFilesAsTheClientDoes) {
    folder_.write("marked.gltf", "\xEF\xBB\xBF" + gltf_text(lit_quad_scene()));
    Service service(options());
    const Result<Json> view = service.open_view("marked.gltf");
    ASSERT_TRUE(view) << view.error().message;
    const auto warnings = view->at("asset").at("warnings").get<std::vector<std::string>>();
    ASSERT_FALSE(warnings.empty());
    EXPECT_THAT(warnings[0], testing::StartsWith("marked.gltf: "));
    EXPECT_THAT(view->dump(), Not(HasSubstr(folder_.path().string())));
}

/// The error of a view's next image, as its client is told it.
Error error_of(Service& service, const std::string& view) {
    const auto viewer = service.viewer(view);
    for (int i = 0, after = 0; viewer && i < 600; ++i) {
        const auto image = (*viewer)->wait_for(after, milliseconds(100));
        if (image && image->error) return service.told(view, *image->error);
        if (image) after = image->serial;
    }
    ADD_FAILURE() << "there is no error";
    return {};
}

TEST_F(ServiceTest, ErrorsOfImagesHaveTheClientsNames) {
    folder_.write("sky.hdr", "no picture at all");
    Service service(options());
    const std::string view = opened(service, "quad.gltf");
    ASSERT_TRUE(service.wish(view, {{"size", "8x8"}, {"env", "sky.hdr"}}));
    const Error error = error_of(service, view);
    EXPECT_THAT(error.where, HasSubstr("sky.hdr"));
    EXPECT_THAT(error.where + error.message, Not(HasSubstr(folder_.path().string())));
}

TEST_F(ServiceTest, AnUploadThatMadeRoomIsToldAsThat) {
    const std::string scene = gltf_text(lit_quad_scene());
    ServiceOptions small = options();
    small.max_upload = scene.size() + 1;
    Service service(small);
    const Result<std::string> first = send(service, scene);
    ASSERT_TRUE(first) << first.error().message;
    const std::string view = opened(service, *first);
    ASSERT_TRUE(send(service, scene + "\n"));
    // Lenient or not is decided when a file is read.
    ASSERT_TRUE(service.wish(view, {{"size", "8x8"}, {"lenient", true}}));
    const Error error = error_of(service, view);
    EXPECT_EQ(error.id, "E-SCENE-MISSING");
    EXPECT_EQ(error.where, *first);
    EXPECT_THAT(error.message, HasSubstr("send it again"));
}

}  // namespace
}  // namespace obscura::serve
