// image/environment_exr.cpp - reads OpenEXR files in memory as linear RGB.
// SPDX-License-Identifier: Apache-2.0
#include "image/environment_exr.h"

#include "image/corrupt.h"
#include "image/exr_sizes.h"
#include "image/exr_stream.h"

#include <OpenEXR/ImfChannelList.h>
#include <OpenEXR/ImfChromaticities.h>
#include <OpenEXR/ImfFrameBuffer.h>
#include <OpenEXR/ImfHeader.h>
#include <OpenEXR/ImfInputFile.h>
#include <OpenEXR/ImfStandardAttributes.h>

#include <algorithm>
#include <array>
#include <cmath>

namespace obscura {

namespace {

using ByteSpan = std::span<const std::byte>;
using Names = std::array<std::string, 3>;

/// Checks the sizes of all parts and tiles before OpenEXR sees them.
Result<void> check_sizes(ByteSpan bytes, const std::string& where) {
    constexpr int64_t longest_side = 65536;
    const ExrSizes sizes = read_exr_sizes(bytes);
    if (!sizes.window) {
        return corrupt_environment(where, "the OpenEXR header is cut off or has no data window");
    }
    auto fits = check_environment_size((*sizes.window)[0], (*sizes.window)[1], where);
    if (!fits) return fits;
    if (sizes.longest_side <= longest_side) return {};
    return corrupt_environment(where, "a part or a tile is wider or higher than 65536 pixels");
}

/// The channels of red, green and blue; all the same for a luminance image; empty if none.
Names color_channels(const Imf::ChannelList& channels) {
    const auto has = [&](const std::string& name) { return channels.findChannel(name) != nullptr; };
    if (has("R") && has("G") && has("B")) return {"R", "G", "B"};
    for (auto channel = channels.begin(); channel != channels.end(); ++channel) {
        const std::string name = channel.name();
        const size_t dot = name.rfind('.');
        if (dot == std::string::npos || name.substr(dot) != ".R") continue;
        const std::string layer = name.substr(0, dot);
        if (has(layer + ".G") && has(layer + ".B")) return {name, layer + ".G", layer + ".B"};
    }
    if (has("Y") && !has("RY") && !has("BY")) return {"Y", "Y", "Y"};
    return {};
}

std::string channel_list(const Imf::ChannelList& channels) {
    std::string list;
    for (auto channel = channels.begin(); channel != channels.end() && list.size() < 200;
         ++channel) {
        if (!list.empty()) list += ", ";
        list += channel.name();
    }
    return list.empty() ? "none" : list;
}

void warn_about_primaries(const Imf::Header& header, const std::string& where, Log& log) {
    if (!Imf::hasChromaticities(header)) return;
    const Imf::Chromaticities rec709;
    const Imf::Chromaticities& found = Imf::chromaticities(header);
    const auto differ = [](const Imath::V2f& a, const Imath::V2f& b) {
        return !((a - b).length() < 0.005f);
    };
    if (differ(found.red, rec709.red) || differ(found.green, rec709.green) ||
        differ(found.blue, rec709.blue) || differ(found.white, rec709.white)) {
        log.warn(where, "its primaries are not Rec.709; its values are taken as if they were");
    }
}

Result<ImageRgb32f> read_pixels(Imf::InputFile& file, const std::string& where) {
    const Imf::ChannelList& channels = file.header().channels();
    const Names names = color_channels(channels);
    if (names[0].empty()) {
        return corrupt_environment(where,
                                   "needs channels R, G, B or Y; it has " + channel_list(channels));
    }
    for (const std::string& name : names) {
        const Imf::Channel& channel = *channels.findChannel(name);
        if (channel.xSampling != 1 || channel.ySampling != 1) {
            return corrupt_environment(
                where, "channel " + name + " is subsampled; save it at full resolution");
        }
    }
    const Imath::Box2i window = file.header().dataWindow();
    ImageRgb32f image{window.max.x - window.min.x + 1, window.max.y - window.min.y + 1, {}};
    const auto width = static_cast<size_t>(image.width);
    image.pixels.resize(3 * width * static_cast<size_t>(image.height));
    Imf::FrameBuffer buffer;
    const bool is_grey = names[0] == names[1];
    for (size_t i = 0; i < (is_grey ? 1 : 3); ++i) {
        buffer.insert(names[i],
                      Imf::Slice::Make(Imf::FLOAT,
                                       image.pixels.data() + i,
                                       window.min,
                                       image.width,
                                       image.height,
                                       3 * sizeof(float),
                                       3 * sizeof(float) * width));
    }
    file.setFrameBuffer(buffer);
    file.readPixels(window.min.y, window.max.y);
    for (size_t i = 0; is_grey && i < image.pixels.size(); i += 3) {
        image.pixels[i + 1] = image.pixels[i + 2] = image.pixels[i];
    }
    return image;
}

}  // namespace

Result<ImageRgb32f> read_exr(ByteSpan bytes, const std::string& where, Log& log) {
    if (auto fits = check_sizes(bytes, where); !fits) return fail(std::move(fits.error()));
    try {
        ExrMemoryReader stream(bytes, where.c_str());
        Imf::InputFile file(stream);
        warn_about_primaries(file.header(), where, log);
        return read_pixels(file, where);
    } catch (const std::bad_alloc&) {
        throw;
    } catch (const std::exception& error) {
        return corrupt_environment(where, error.what());
    }
}

}  // namespace obscura
