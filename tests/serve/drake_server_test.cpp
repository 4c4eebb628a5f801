// tests/serve/drake_server_test.cpp - Drake's protocol over HTTP, as its client speaks it.
// SPDX-License-Identifier: Apache-2.0
#include "app/serve_request.h"
#include "base/memory_budget.h"
#include "base/sha256.h"

#include <OpenImageIO/filesystem.h>
#include <OpenImageIO/imageio.h>
#include <gtest/gtest.h>

#include "serve/drake_scene.h"
#include "serve/server.h"
#include <cmath>
#include <gmock/gmock.h>
#include <httplib.h>
#include <limits>
#include <thread>

namespace obscura::serve {
namespace {

using drake_scene::Lens;
using testing::HasSubstr;
using testing::Not;

using Fields = std::map<std::string, std::string>;

/// An answer, as OpenImageIO reads it.
struct ReadImage {
    OIIO::ImageSpec spec;
    std::vector<float> values;
    std::vector<uint16_t> codes;
};

ReadImage read_image(const std::string& bytes, const char* format) {
    ReadImage out;
    std::string copy = bytes;
    OIIO::Filesystem::IOMemReader reader(copy.data(), copy.size());
    const auto input = OIIO::ImageInput::open(std::string("x.") + format, nullptr, &reader);
    EXPECT_TRUE(input) << OIIO::geterror();
    if (!input) return out;
    EXPECT_STREQ(input->format_name(), format);
    out.spec = input->spec();
    const size_t count = out.spec.image_pixels() * static_cast<size_t>(out.spec.nchannels);
    out.values.resize(count);
    out.codes.resize(count);
    if (out.spec.format == OIIO::TypeFloat) {
        EXPECT_TRUE(
            input->read_image(0, 0, 0, out.spec.nchannels, OIIO::TypeFloat, out.values.data()));
    } else {
        EXPECT_TRUE(
            input->read_image(0, 0, 0, out.spec.nchannels, OIIO::TypeUInt16, out.codes.data()));
    }
    return out;
}

class DrakeServer : public testing::Test {
protected:
    void SetUp() override {
        ServerOptions options;
        options.port = 0;
        options.token = "secret";
        options.service.options = app::image_options({});
        options.service.max_upload = max_upload;
        auto server = Server::listen(options);
        ASSERT_TRUE(server) << server.error().message;
        server_ = std::move(*server);
        thread_ = std::thread([this] { server_->run(stop_); });
    }
    static constexpr uint64_t max_upload = 8U << 20U;

    void TearDown() override {
        stop_ = true;
        if (thread_.joinable()) thread_.join();
    }

    static Fields form(const std::string& type, const std::string& scene = drake_scene::gltf()) {
        const Lens lens;
        Fields out = {{"scene", scene},
                      {"scene_sha256", sha256_of(std::as_bytes(std::span(scene)))},
                      {"image_type", type},
                      {"width", std::to_string(lens.width)},
                      {"height", std::to_string(lens.height)},
                      {"near", "0.010000"},
                      {"far", "10.000000"},
                      {"focal_x", std::to_string(lens.fx)},
                      {"focal_y", std::to_string(lens.fy)},
                      {"fov_x", "0.857000"},
                      {"fov_y", "0.761000"},
                      {"center_x", std::to_string(lens.cx)},
                      {"center_y", std::to_string(lens.cy)},
                      {"submit", "Render"}};
        if (type == "depth") {
            out["min_depth"] = "0.100000";
            out["max_depth"] = "10.000000";
        }
        return out;
    }

    /// In   more: fields behind the others
    httplib::Result post(const Fields& fields,
                         const std::string& query = "token=secret",
                         int patience_ms = 120000,
                         const httplib::MultipartFormDataItems& more = {}) const {
        httplib::Client client("127.0.0.1", server_->port());
        client.set_read_timeout(std::chrono::milliseconds(patience_ms));
        httplib::MultipartFormDataItems items;
        for (const auto& [name, value] : fields) {
            const bool is_file = name == "scene";
            items.push_back(
                {name, value, is_file ? "scene.gltf" : "", is_file ? "model/gltf+json" : ""});
        }
        items.insert(items.end(), more.begin(), more.end());
        return client.Post("/render?" + query, items);
    }
    std::string image(const Fields& fields, const std::string& more = "") const {
        const auto got = post(fields, "token=secret" + more);
        EXPECT_TRUE(got);
        if (!got) return "";
        EXPECT_EQ(got->status, 200) << got->body;
        return got->body;
    }
    void expect_refused(const Fields& fields,
                        const std::string& text,
                        const std::string& more = "") const {
        const auto got = post(fields, "token=secret" + more);
        ASSERT_TRUE(got);
        EXPECT_EQ(got->status, 400) << text;
        EXPECT_THAT(got->get_header_value("Content-Type"), HasSubstr("text/plain"));
        EXPECT_THAT(got->body, HasSubstr(text));
        EXPECT_THAT(got->body, Not(HasSubstr("{")));
        EXPECT_THAT(got->body, Not(HasSubstr("scene.gltf"))) << "the server's own copy";
    }

    std::unique_ptr<Server> server_;
    std::atomic<bool> stop_ = false;
    std::thread thread_;
};

TEST_F(DrakeServer, DepthIsThatOfTheFormulaInEveryPixel) {
    const Lens lens;
    const ReadImage got = read_image(image(form("depth")), "tiff");
    ASSERT_EQ(got.spec.width, lens.width);
    ASSERT_EQ(got.spec.height, lens.height);
    ASSERT_EQ(got.spec.nchannels, 1);
    ASSERT_EQ(got.spec.format, OIIO::TypeFloat);
    int hits = 0;
    for (int y = 0; y < lens.height; ++y) {
        for (int x = 0; x < lens.width; ++x) {
            const drake_scene::Seen seen = drake_scene::seen_at(lens, x, y);
            const float depth = got.values[static_cast<size_t>(y * lens.width + x)];
            if (seen.wall < 0) {
                EXPECT_EQ(depth, std::numeric_limits<float>::infinity()) << x << " " << y;
                continue;
            }
            ++hits;
            EXPECT_NEAR(depth, seen.depth_m, 4e-6) << x << " " << y;
        }
    }
    EXPECT_GT(hits, 600);
}

TEST_F(DrakeServer, DepthBeyondTheSensorIsTooNearOrTooFar) {
    Fields fields = form("depth");
    fields["min_depth"] = "4.000000";  // the walls are at 3.5 to 4.5 and at 5
    fields["max_depth"] = "4.500000";
    const Lens lens;
    const ReadImage got = read_image(image(fields), "tiff");
    int nearer = 0, further = 0;
    for (int y = 0; y < lens.height; ++y) {
        for (int x = 0; x < lens.width; ++x) {
            const drake_scene::Seen seen = drake_scene::seen_at(lens, x, y);
            const float depth = got.values[static_cast<size_t>(y * lens.width + x)];
            if (seen.wall < 0) continue;
            if (seen.depth_m < 4) {
                ++nearer;
                EXPECT_EQ(depth, 0);
            } else if (seen.depth_m > 4.5) {
                ++further;
                EXPECT_EQ(depth, std::numeric_limits<float>::infinity());
            }
        }
    }
    EXPECT_GT(nearer, 50);
    EXPECT_GT(further, 50);
}

TEST_F(DrakeServer, NothingIsSeenBeyondTheClippingPlanes) {
    Fields fields = form("depth");
    fields["near"] = "4.600000";  // through the first wall, to the second one
    const ReadImage behind = read_image(image(fields), "tiff");
    fields["near"] = "0.010000";
    fields["far"] = "4.900000";
    const ReadImage before = read_image(image(fields), "tiff");
    const Lens lens;
    const auto [column, row] = drake_scene::projected(lens, 0.1, 2, 0.3);  // both walls are there
    const auto pixel =
        static_cast<size_t>(row) * static_cast<size_t>(lens.width) + static_cast<size_t>(column);
    EXPECT_NEAR(behind.values[pixel], 5, 1e-5);
    EXPECT_LT(before.values[pixel], 4.6f);
    for (const float depth : before.values)
        EXPECT_TRUE(depth < 4.9f || std::isinf(depth));
}

TEST_F(DrakeServer, LabelsAreExactInEveryPixel) {
    const Lens lens;
    const ReadImage colors = read_image(image(form("label")), "png");
    const ReadImage numbers = read_image(image(form("label"), "&labels=number"), "png");
    ASSERT_EQ(colors.spec.format, OIIO::TypeUInt8);
    ASSERT_EQ(colors.spec.nchannels, 3);
    ASSERT_EQ(numbers.spec.format, OIIO::TypeUInt16);
    ASSERT_EQ(numbers.spec.nchannels, 1);
    for (int y = 0; y < lens.height; ++y) {
        for (int x = 0; x < lens.width; ++x) {
            const int wall = drake_scene::seen_at(lens, x, y).wall;
            const auto pixel = static_cast<size_t>(y * lens.width + x);
            std::array<int, 3> color = {};
            for (size_t c = 0; c < 3; ++c)
                color[c] = colors.codes[3 * pixel + c] / 257;  // 8 bits as 16
            if (wall < 0) {
                EXPECT_EQ(color, (std::array<int, 3>{255, 255, 255})) << x << " " << y;
                EXPECT_EQ(numbers.codes[pixel], 32766);
                continue;
            }
            const int label = drake_scene::walls[static_cast<size_t>(wall)].label;
            EXPECT_EQ(color, (std::array<int, 3>{label & 255, label >> 8, 0})) << x << " " << y;
            EXPECT_EQ(numbers.codes[pixel], label);
        }
    }
}

TEST_F(DrakeServer, ThePrincipalPointIsWhereItIsSaidToBe) {
    const Lens lens;
    const ReadImage got = read_image(image(form("label"), "&labels=number"), "png");
    const drake_scene::Wall& wall = drake_scene::walls[0];
    const auto low = drake_scene::projected(lens, wall.left, wall.near_y, wall.low);
    const auto high = drake_scene::projected(lens, wall.right, wall.near_y, wall.low);
    int lowest = 0, least = lens.width, most = 0;
    for (int y = 0; y < lens.height; ++y) {
        for (int x = 0; x < lens.width; ++x) {
            if (got.codes[static_cast<size_t>(y * lens.width + x)] != wall.label) continue;
            lowest = std::max(lowest, y);
            least = std::min(least, x);
            most = std::max(most, x);
        }
    }
    EXPECT_EQ(lowest, static_cast<int>(std::round(low[1])) - 1);
    EXPECT_EQ(least, std::max(static_cast<int>(std::round(low[0])), 0));
    EXPECT_EQ(most, static_cast<int>(std::round(high[0])) - 1);
}

TEST_F(DrakeServer, ColorsShowTheSameWallsAndTheSameRequestTheSameBits) {
    const Lens lens;
    const std::string options = "&spp=4&env=white&view=Raw&no-dither";
    const std::string bytes = image(form("color"), options);
    EXPECT_TRUE(image(form("color"), options) == bytes);
    const ReadImage got = read_image(bytes, "png");
    ASSERT_EQ(got.spec.format, OIIO::TypeUInt8);
    ASSERT_EQ(got.spec.nchannels, 4);
    for (int y = 1; y + 1 < lens.height; ++y) {
        for (int x = 1; x + 1 < lens.width; ++x) {
            const int wall = drake_scene::seen_at(lens, x, y).wall;
            bool is_inside = true;  // else a pixel is a mixture
            for (int i = 0; i < 9; ++i)
                is_inside = is_inside &&
                            drake_scene::seen_at(lens, x + i % 3 - 1, y + i / 3 - 1).wall == wall;
            const size_t at = 4 * static_cast<size_t>(y * lens.width + x);
            const int blue = got.codes[at + 2] / 257;
            EXPECT_EQ(got.codes[at + 3], 65535);
            if (!is_inside) continue;
            if (wall < 0) {
                EXPECT_EQ(blue, 255) << x << " " << y;
            } else {
                EXPECT_LT(blue, 60) << x << " " << y;  // what a dielectric reflects
            }
        }
    }
}

/// Beside the walls the light itself is seen: a little brighter above than below.
TEST_F(DrakeServer, UpIsZUnlessItIsSaidToBeY) {
    const Lens lens;
    const auto top_to_bottom = [&](const std::string& more) {
        const std::string light = "&spp=1&env=neutral&exposure=-1&view=Raw&no-dither";
        const ReadImage got = read_image(image(form("color"), light + more), "png");
        const auto columns = static_cast<size_t>(lens.width);
        const auto code = [&](int row) {
            return double{1} * got.codes[4 * (static_cast<size_t>(row) * columns + columns - 2)];
        };
        return code(0) / code(lens.height - 1);
    };
    EXPECT_GT(top_to_bottom(""), 1.05);
    EXPECT_LT(top_to_bottom("&up=y"), 1);  // the camera looks up there
    EXPECT_TRUE(image(form("label"), "&up=y") == image(form("label")));
}

TEST_F(DrakeServer, RequestsAtTheSameTimeGetWhatTheyWouldGetAlone) {
    const std::array<const char*, 3> types = {"color", "depth", "label"};
    const std::string other = drake_scene::gltf() + "\n";  // another content, the same scene
    std::array<std::string, 3> alone;
    for (size_t i = 0; i < types.size(); ++i)
        alone[i] = image(form(types[i]), "&spp=2");
    std::vector<std::string> together(12);
    std::vector<std::thread> clients;
    for (size_t i = 0; i < together.size(); ++i) {
        clients.emplace_back([&, i] {
            const std::string scene = i % 2 == 0 ? drake_scene::gltf() : other;
            together[i] = image(form(types[i % 3], scene), "&spp=2");
        });
    }
    for (std::thread& client : clients)
        client.join();
    for (size_t i = 0; i < together.size(); ++i)
        EXPECT_TRUE(together[i] == alone[i % 3]) << i;
}

TEST_F(DrakeServer, FaultsOfRequestsAreToldAsText) {
    Fields fields = form("color");
    fields["scene_sha256"] = std::string(64, '0');
    expect_refused(fields, "E-DRAKE-HASH");
    fields = form("color");
    fields.erase("focal_y");
    expect_refused(fields, "E-DRAKE-FIELD focal_y");
    fields = form("depth");
    fields.erase("min_depth");
    expect_refused(fields, "E-DRAKE-FIELD min_depth");
    expect_refused(form("colour"), "E-DRAKE-FIELD image_type");
    fields = form("color");
    fields["width"] = "4000000000";
    expect_refused(fields, "E-DRAKE-FIELD width");
    expect_refused(form("color"), "E-DRAKE-OPTION size", "&size=3x3");
    expect_refused(form("color"), "spp", "&spp=many");
    expect_refused(form("color", "no scene"), "E-");
    expect_refused(form("color", drake_scene::gltf(false)), "E-DRAKE-CAMERA");
}

TEST_F(DrakeServer, WhatIsNoFormIsToldAsText) {
    httplib::Client client("127.0.0.1", server_->port());
    const auto got = client.Post("/render?token=secret", "scene=1", "text/plain");
    ASSERT_TRUE(got);
    EXPECT_EQ(got->status, 400);
    EXPECT_THAT(got->body, HasSubstr("E-SERVE-BODY"));
    EXPECT_THAT(got->get_header_value("Content-Type"), HasSubstr("text/plain"));
}

TEST_F(DrakeServer, AFieldThatIsThereTwiceIsRefused) {
    const auto got =
        post(form("color"), "token=secret", 120000, {{"width", std::to_string(96), "", ""}});
    ASSERT_TRUE(got);
    EXPECT_EQ(got->status, 400);
    EXPECT_THAT(got->body, HasSubstr("width: the form has this field twice"));
}

TEST_F(DrakeServer, LabelsBeyondTheMemoryAreRefused) {
    Fields fields = form("label");
    EXPECT_FALSE(image(fields).empty());  // the scene is open now
    fields["width"] = fields["height"] = "4000";
    set_memory_limit(program_memory_bytes + (64U << 20), "a test");
    const auto got = post(fields);
    remove_memory_limit();
    ASSERT_TRUE(got);
    EXPECT_NE(got->status, 200);
    EXPECT_THAT(got->body, HasSubstr("E-MEM 4000x4000: the film would take"));
}

TEST_F(DrakeServer, LargeFormsAreRefused) {
    const std::string scene(max_upload + (1U << 17U), ' ');
    const auto got = post(form("color", scene));
    ASSERT_TRUE(got);
    EXPECT_EQ(got->status, 413);
    EXPECT_THAT(got->body, HasSubstr("E-SERVE-SIZE"));
}

TEST_F(DrakeServer, FormsOfManyFieldsAreRefused) {
    Fields fields = form("color");
    for (int i = 0; i < 300; ++i)
        fields["field" + std::to_string(i)] = "1";
    const auto got = post(fields);
    ASSERT_TRUE(got);
    EXPECT_EQ(got->status, 413);
    EXPECT_THAT(got->body, HasSubstr("form: more than 256 fields"));
    EXPECT_EQ(got->get_header_value("Connection"), "close");
    EXPECT_FALSE(image(form("color")).empty());
}

TEST_F(DrakeServer, AClientThatGoesLeavesTheSceneToOthers) {
    const std::string unlimited = "token=secret&spp=1000000";
    EXPECT_FALSE(post(form("color"), unlimited, 300));
    const auto next = post(form("color"), "token=secret&spp=1", 60000);
    ASSERT_TRUE(next);
    EXPECT_EQ(next->status, 200);
}

TEST_F(DrakeServer, TheTokenIsAskedFor) {
    for (const char* query : {"", "token=other", "spp=1"}) {
        const auto got = post(form("color"), query);
        ASSERT_TRUE(got);
        EXPECT_EQ(got->status, 401) << query;
        EXPECT_THAT(got->body, HasSubstr("E-SERVE-TOKEN"));
        EXPECT_THAT(got->get_header_value("Content-Type"), HasSubstr("text/plain"));
    }
}

}  // namespace
}  // namespace obscura::serve
