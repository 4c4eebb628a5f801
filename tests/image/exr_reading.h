// tests/image/exr_reading.h - reads parts and levels of OpenEXR files by the library's own reader.
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "image/write.h"

#include <OpenEXR/ImfChannelList.h>
#include <OpenEXR/ImfFrameBuffer.h>
#include <OpenEXR/ImfHeader.h>
#include <OpenEXR/ImfInputPart.h>
#include <OpenEXR/ImfMultiPartInputFile.h>
#include <OpenEXR/ImfStringAttribute.h>
#include <OpenEXR/ImfTiledInputPart.h>
#include <gtest/gtest.h>

#include <map>
#include <string>
#include <vector>

namespace obscura::testing_images {

using Channels = std::map<std::string, std::vector<float>>;

/// Room for all channels of a window, and where OpenEXR puts them.
struct ChannelBuffer {
    ChannelBuffer(const Imf::Header& header, const Imath::Box2i& window) {
        const int width = window.max.x - window.min.x + 1;
        const int height = window.max.y - window.min.y + 1;
        for (auto c = header.channels().begin(); c != header.channels().end(); ++c) {
            std::vector<float>& values = channels[c.name()];
            values.resize(static_cast<size_t>(width) * static_cast<size_t>(height));
            frame.insert(c.name(),
                         Imf::Slice::Make(Imf::FLOAT, values.data(), window.min, width, height));
        }
    }

    Channels channels;
    Imf::FrameBuffer frame;
};

/// The channels of a part; tiles are read as scan lines.
inline Channels channels_of(Imf::MultiPartInputFile& file, int part = 0) {
    Imf::InputPart in(file, part);
    const Imath::Box2i window = in.header().dataWindow();
    ChannelBuffer buffer(in.header(), window);
    in.setFrameBuffer(buffer.frame);
    in.readPixels(window.min.y, window.max.y);
    return buffer.channels;
}

/// The channels of one level of a mipmap.
inline Channels level_of(Imf::MultiPartInputFile& file, int part, int level) {
    Imf::TiledInputPart in(file, part);
    ChannelBuffer buffer(in.header(), in.dataWindowForLevel(level));
    in.setFrameBuffer(buffer.frame);
    in.readTiles(0, in.numXTiles(level) - 1, 0, in.numYTiles(level) - 1, level);
    return buffer.channels;
}

inline std::string text_of(const Imf::Header& header, const std::string& name) {
    const auto* attribute = header.findTypedAttribute<Imf::StringAttribute>(name);
    return attribute ? attribute->value() : "(no " + name + ")";
}

/// Expects that a file has interleaved values in all their bits.
inline void expect_exact(const Channels& found,
                         const std::vector<std::string>& names,
                         const UnsetArray<float>& values) {
    for (size_t c = 0; c < names.size(); ++c) {
        const auto channel = found.find(names[c]);
        ASSERT_NE(channel, found.end()) << names[c];
        ASSERT_EQ(channel->second.size() * names.size(), values.size());
        for (size_t i = 0; i < channel->second.size(); ++i)
            ASSERT_EQ(channel->second[i], values[i * names.size() + c]) << names[c] << " " << i;
    }
}

}  // namespace obscura::testing_images
