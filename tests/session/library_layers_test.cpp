// tests/session/library_layers_test.cpp - layers through the library: asked for, held and written.
// SPDX-License-Identifier: Apache-2.0
#include <OpenEXR/ImfChannelList.h>
#include <OpenEXR/ImfFrameBuffer.h>
#include <OpenEXR/ImfHeader.h>
#include <OpenEXR/ImfInputPart.h>
#include <OpenEXR/ImfMultiPartInputFile.h>
#include <OpenEXR/ImfStringAttribute.h>
#include <gtest/gtest.h>

#include "support/small_scenes.h"
#include "support/temp_folder.h"
#include <Imath/ImathBox.h>
#include <algorithm>
#include <gmock/gmock.h>
#include <map>
#include <obscura/obscura.h>

namespace obscura {
namespace {

using testing::AllOf;
using testing::Contains;
using testing::ElementsAre;
using testing::HasSubstr;
using testing::Not;

const std::string cornell = OBSCURA_SOURCE_DIR "/assets/cornell/cornell.gltf";

/// The Cornell box, small, with layers.
class LibraryLayers : public testing::Test {
protected:
    void SetUp() override {
        const Result<Asset> asset = session_.open(cornell);
        ASSERT_TRUE(asset) << asset.error().text;
        asset_.push_back(*asset);
        view_.width = 40;
        view_.height = 24;
        sampling_.samples_per_pixel = 3;
    }

    Result<Image> render() { return session_.render(asset_.front(), view_, {}, sampling_); }

    Image image_of(const std::vector<std::string>& names) {
        sampling_.aov = names;
        const Result<Image> image = render();
        EXPECT_TRUE(image) << image.error().text;
        return image ? *image : Image{};
    }

    Error error_of(const std::vector<std::string>& names) {
        sampling_.aov = names;
        const Result<Image> image = render();
        EXPECT_FALSE(image);
        return image ? Error{} : image.error();
    }

    TempFolder folder_;
    Session session_;
    std::vector<Asset> asset_;
    View view_;
    Sampling sampling_;
};

/// The channels of all parts of an EXR, and the text attributes of its first header.
struct ReadExr {
    std::map<std::string, std::vector<float>> channels;
    std::map<std::string, std::string> texts;
    std::vector<std::string> views;  ///< of the parts that have one
    int parts = 0;
};

ReadExr read_exr(const std::filesystem::path& file) {
    ReadExr out;
    Imf::MultiPartInputFile in(file.string().c_str());
    out.parts = in.parts();
    for (int number = 0; number < out.parts; ++number) {
        Imf::InputPart part(in, number);
        if (part.header().hasView()) out.views.push_back(part.header().view());
        const Imath::Box2i window = part.header().dataWindow();
        const int width = window.max.x - window.min.x + 1;
        const int height = window.max.y - window.min.y + 1;
        Imf::FrameBuffer buffer;
        for (auto c = part.header().channels().begin(); c != part.header().channels().end(); ++c) {
            std::vector<float>& values = out.channels[c.name()];
            values.resize(static_cast<size_t>(width) * static_cast<size_t>(height));
            buffer.insert(c.name(),
                          Imf::Slice::Make(Imf::FLOAT, values.data(), window.min, width, height));
        }
        part.setFrameBuffer(buffer);
        part.readPixels(window.min.y, window.max.y);
    }
    const Imf::Header& header = in.header(0);
    for (auto attribute = header.begin(); attribute != header.end(); ++attribute) {
        const auto* text = dynamic_cast<const Imf::StringAttribute*>(&attribute.attribute());
        if (text != nullptr) out.texts[attribute.name()] = text->value();
    }
    return out;
}

/// One channel of interleaved pixels.
std::vector<float> channel_of(const Layer& layer, size_t channel) {
    std::vector<float> out;
    for (size_t i = channel; i < layer.pixels.size(); i += layer.channels.size())
        out.push_back(layer.pixels[i]);
    return out;
}

TEST_F(LibraryLayers, AnImageHasThoseThatWereAskedFor) {
    const Image plain = image_of({});
    EXPECT_TRUE(plain.layers.empty());
    const Image image = image_of({"normal", "depth", "crypto_object", "depth"});
    EXPECT_EQ(image.pixels, plain.pixels) << "the beauty keeps its bits";
    ASSERT_EQ(image.layers.size(), 3U);
    const Layer& normal = image.layers[0];
    EXPECT_EQ(normal.name, "normal");
    EXPECT_THAT(normal.channels, ElementsAre("normal.X", "normal.Y", "normal.Z"));
    EXPECT_EQ(normal.kind, LayerKind::data);
    EXPECT_EQ(normal.reduction, "mean");
    EXPECT_EQ(normal.pixels.size(), size_t{40 * 24 * 3});
    EXPECT_TRUE(normal.names.empty());
    EXPECT_EQ(image.layers[1].reduction, "nearest");
    EXPECT_EQ(image.layers[2].kind, LayerKind::id);
    EXPECT_EQ(image.layers[2].channels.size(), 12U);
    sampling_.crypto_levels = 2;
    EXPECT_EQ(image_of({"crypto_object"}).layers[0].channels.size(), 4U);
}

/// What the pixels say by ids and coverages can be looked up in the list of names.
TEST_F(LibraryLayers, CryptomatteIdsHaveNames) {
    const Image image = image_of({"crypto_material", "opacity"});
    const Layer& layer = image.layers.at(0);
    ASSERT_GT(layer.names.size(), 3U);
    std::map<std::string, double> covered;
    for (size_t i = 0; i < layer.pixels.size(); i += 2) {
        if (layer.pixels[i + 1] == 0) continue;
        const auto named = std::find_if(layer.names.begin(), layer.names.end(), [&](const auto& n) {
            return n.id == layer.pixels[i];
        });
        ASSERT_NE(named, layer.names.end()) << i;
        covered[named->name] += static_cast<double>(layer.pixels[i + 1]);
    }
    EXPECT_GT(covered.size(), 3U);
    double sum = 0;
    for (const auto& [name, coverage] : covered)
        sum += coverage;
    double opacity = 0;
    for (const float value : image.layers.at(1).pixels)
        opacity += static_cast<double>(value);
    EXPECT_NEAR(sum, opacity, 1e-3 * opacity);
}

TEST_F(LibraryLayers, FilesHoldThemWhereTheyAreWanted) {
    const Image image = image_of({"base_color", "depth", "crypto_object"});
    const std::string file = (folder_ / "a.exr").string();
    for (const ExrLayout layout : {ExrLayout::single, ExrLayout::multipart, ExrLayout::separate}) {
        SCOPED_TRACE(static_cast<int>(layout));
        WriteOptions options;
        options.float32 = true;
        options.exr_layout = layout;
        const Result<void> written = session_.write(image, file, options);
        ASSERT_TRUE(written) << written.error().text;
        const ReadExr first = read_exr(file);
        EXPECT_EQ(first.parts, layout == ExrLayout::multipart ? 4 : 1);
        for (const Layer& layer : image.layers) {
            const ReadExr own = layout == ExrLayout::separate
                                    ? read_exr(folder_ / ("a." + layer.name + ".exr"))
                                    : first;
            for (size_t c = 0; c < layer.channels.size(); ++c)
                EXPECT_EQ(own.channels.at(layer.channels[c]), channel_of(layer, c));
            for (const auto& [name, text] : layer.attributes)
                EXPECT_EQ(own.texts.at(name), text);
        }
    }
    EXPECT_EQ(image.layers[2].attributes.size(), 4U) << "those of Cryptomatte";
    EXPECT_TRUE(session_.write(image, (folder_ / "a.png").string())) << "the beauty alone";
}

TEST_F(LibraryLayers, ACropHasItsPart) {
    const Image whole = image_of({"depth"});
    view_.crop = Rect{3, 2, 33, 21};
    const Image part = image_of({"depth"});
    ASSERT_EQ(part.layers.at(0).pixels.size(), size_t{33 * 21});
    EXPECT_EQ(part.layers[0].pixels[34], whole.layers.at(0).pixels[3 * 40 + 4]);
}

TEST_F(LibraryLayers, TwoEyesAreTheViewsOfAMultipartFile) {
    view_.width = view_.height = 8;
    view_.stereo_m = 0.06;
    const Image image = image_of({"depth"});
    EXPECT_EQ(image.layers.at(0).pixels.size(), 64U) << "one eye above the other";
    WriteOptions options;
    options.exr_layout = ExrLayout::multipart;
    const std::string file = (folder_ / "a.exr").string();
    ASSERT_TRUE(session_.write(image, file, options));
    const ReadExr eyes = read_exr(file);
    EXPECT_THAT(eyes.views, ElementsAre("left", "left", "right", "right"));
    const std::vector<float>& depth = image.layers[0].pixels;
    EXPECT_EQ(eyes.channels.at("depth.Z"), std::vector<float>(depth.begin() + 32, depth.end()))
        << "the last part is of the right eye";
}

/// A triangle with texture coordinates that no texture reads.
std::string triangle_with_uv() {
    std::string text = gltf_text(triangle_scene());
    const auto replace = [&](const std::string& what, const std::string& by) {
        const size_t at = text.find(what);
        ASSERT_NE(at, std::string::npos) << what;
        text.replace(at, what.size(), by);
    };
    replace(R"({"POSITION": 0})", R"({"POSITION": 0, "TEXCOORD_0": 2})");
    replace(R"("type": "SCALAR", "count": 3})",
            R"("type": "SCALAR", "count": 3},
{"bufferView": 2, "componentType": 5126, "type": "VEC2", "count": 3})");
    replace("}],\n\"buffers\"", "}, {\"buffer\": 0, \"byteLength\": 24}],\n\"buffers\"");
    return text;
}

/// The asset is read again for a layer that needs more of it.
TEST_F(LibraryLayers, TextureCoordinatesAreKeptForTheirLayer) {
    const Result<Asset> asset =
        session_.open(folder_.write("uv.gltf", triangle_with_uv()).string());
    ASSERT_TRUE(asset) << asset.error().text;
    asset_.front() = *asset;
    image_of({});
    const Image image = image_of({"uv", "opacity"});
    const Layer& uv = image.layers.at(0);
    EXPECT_THAT(uv.channels, ElementsAre("uv.U", "uv.V", "uv.A"));
    const std::vector<float> u = channel_of(uv, 0);
    EXPECT_LT(*std::min_element(u.begin(), u.end()), -0.5F);
    const std::vector<float> mask = channel_of(uv, 2);
    const std::vector<float>& opacity = image.layers.at(1).pixels;
    EXPECT_THAT(mask, AllOf(Contains(0), Contains(1)));
    for (size_t i = 0; i < mask.size(); ++i)
        EXPECT_EQ(mask[i], opacity[i] > 0 ? 1 : 0) << i;
}

TEST_F(LibraryLayers, ErrorsAreThoseOfTheCommand) {
    const Error unknown = error_of({"depth", "none"});
    EXPECT_EQ(unknown.id, "E-AOV-NAME");
    EXPECT_EQ(unknown.place, "aov");
    EXPECT_EQ(unknown.code, 64);
    EXPECT_THAT(unknown.text, HasSubstr("'none' is no layer; there are "));
    sampling_.integrator = Integrator::normal;
    const Error lightless = error_of({"depth"});
    EXPECT_EQ(lightless.id, "E-USAGE-CONFLICT");
    EXPECT_EQ(lightless.place, "aov");
    EXPECT_THAT(lightless.text, Not(HasSubstr("--")));
    sampling_ = {};
    sampling_.crypto_levels = 65;
    EXPECT_EQ(error_of({"crypto_object"}).place, "crypto_levels");
    Image changed = [&] {
        sampling_ = {};
        sampling_.samples_per_pixel = 1;
        return image_of({"depth"});
    }();
    changed.layers[0].pixels.pop_back();
    const Result<void> written = session_.write(changed, (folder_ / "b.exr").string());
    ASSERT_FALSE(written);
    EXPECT_EQ(written.error().id, "E-OUT-ENCODE");
}

}  // namespace
}  // namespace obscura
