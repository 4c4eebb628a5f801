// image/exr_document.cpp - an OpenEXR file of parts and layers: what it holds, and its values.
// SPDX-License-Identifier: Apache-2.0
#include "image/exr_document.h"

#include "image/exr_guard.h"
#include "image/exr_pixels.h"
#include "image/exr_sizes.h"
#include "image/exr_stream.h"

#include <OpenEXR/ImfChannelList.h>
#include <OpenEXR/ImfDoubleAttribute.h>
#include <OpenEXR/ImfFloatAttribute.h>
#include <OpenEXR/ImfFrameBuffer.h>
#include <OpenEXR/ImfHeader.h>
#include <OpenEXR/ImfInputPart.h>
#include <OpenEXR/ImfIntAttribute.h>
#include <OpenEXR/ImfMultiPartInputFile.h>
#include <OpenEXR/ImfPartType.h>
#include <OpenEXR/ImfStandardAttributes.h>
#include <OpenEXR/ImfStringAttribute.h>

#include <utility>

namespace obscura {

namespace {

tl::unexpected<Error> no_such_file(const std::string& where, const std::string& message) {
    return fail(ExitCode::bad_data, "E-EXR-FORMAT", where, message);
}

template <typename Value>
void add_if(const Imf::Attribute& from, const char* name, ExrPartInfo& out) {
    const auto* typed = dynamic_cast<const Imf::TypedAttribute<Value>*>(&from);
    if (typed != nullptr) out.attributes[name] = typed->value();
}

ExrPartInfo info_of(const Imf::Header& header) {
    ExrPartInfo out;
    if (header.hasName()) out.name = header.name();
    if (header.hasView()) out.view = header.view();
    const Imath::Box2i& data = header.dataWindow();
    const Imath::Box2i& display = header.displayWindow();
    out.width = data.max.x - data.min.x + 1;
    out.height = data.max.y - data.min.y + 1;
    out.place = {display.max.x - display.min.x + 1,
                 display.max.y - display.min.y + 1,
                 data.min.x - display.min.x,
                 data.min.y - display.min.y};
    const Imf::ChannelList& channels = header.channels();
    for (auto channel = channels.begin(); channel != channels.end(); ++channel) {
        const Imf::PixelType type = channel.channel().type;
        if (type != Imf::UINT) out.channels.push_back({channel.name(), type == Imf::HALF});
    }
    for (auto one = header.begin(); one != header.end(); ++one) {
        add_if<std::string>(one.attribute(), one.name(), out);
        add_if<int>(one.attribute(), one.name(), out);
        add_if<float>(one.attribute(), one.name(), out);
        add_if<double>(one.attribute(), one.name(), out);
    }
    if (Imf::hasWorldToCamera(header)) {
        const Imath::M44f& matrix = Imf::worldToCamera(header);
        out.world_to_camera.assign(&matrix[0][0], &matrix[0][0] + 16);
    }
    return out;
}

Result<void> check_part(const Imf::MultiPartInputFile& file, int part, const std::string& where) {
    const Imf::Header& header = file.header(part);
    if (header.hasType() && !Imf::isSupportedType(header.type()))
        return no_such_file(where, "a part is of the unknown type '" + header.type() + "'");
    if (header.hasType() && Imf::isDeepData(header.type()))
        return no_such_file(where, "a part has deep pixels; expected flat ones");
    const Imf::ChannelList& channels = header.channels();
    for (auto channel = channels.begin(); channel != channels.end(); ++channel) {
        if (channel.channel().xSampling == 1 && channel.channel().ySampling == 1) continue;
        return no_such_file(
            where,
            std::string("channel ") + channel.name() + " is subsampled; expected full resolution");
    }
    if (file.partComplete(part)) return {};
    return damaged_exr(where, "the file is cut off");
}

}  // namespace

Result<ExrDocument> ExrDocument::read(std::vector<std::byte> bytes, const std::string& where) {
    constexpr int64_t longest_side = 1 << 20;
    if (!is_exr(bytes)) return no_such_file(where, "it is no OpenEXR file");
    const ExrSizes sizes = read_exr_sizes(bytes);
    if (!sizes.window) return damaged_exr(where, "the header is cut off or has no data window");
    if (sizes.longest_side > longest_side) {
        return fail(ExitCode::refused,
                    "E-EXR-LIMIT",
                    where,
                    "a part or a tile is wider or higher than 1048576 pixels");
    }
    return guarded_exr(where, [&]() -> Result<ExrDocument> {
        ExrDocument out;
        out.where_ = where;
        out.bytes_ = std::make_shared<const std::vector<std::byte>>(std::move(bytes));
        ExrMemoryReader stream(*out.bytes_, where.c_str());
        const Imf::MultiPartInputFile file(stream, 0);
        for (int part = 0; part < file.parts(); ++part) {
            if (auto sound = check_part(file, part, where); !sound) return fail(sound.error());
            out.parts_.push_back(info_of(file.header(part)));
        }
        return out;
    });
}

Result<UnsetArray<float>> ExrDocument::values(size_t part,
                                              std::span<const std::string> channels) const {
    return guarded_exr(where_, [&]() -> Result<UnsetArray<float>> {
        const ExrPartInfo& info = parts_[part];
        const auto width = static_cast<size_t>(info.width);
        UnsetArray<float> out(width * static_cast<size_t>(info.height) * channels.size());
        ExrMemoryReader stream(*bytes_, where_.c_str());
        Imf::MultiPartInputFile file(stream, compression_threads(out.size()));
        Imf::InputPart in(file, static_cast<int>(part));
        const Imath::Box2i window = in.header().dataWindow();
        const size_t pixel_bytes = sizeof(float) * channels.size();
        Imf::FrameBuffer buffer;
        for (size_t c = 0; c < channels.size(); ++c) {
            buffer.insert(
                channels[c],
                Imf::Slice::Make(
                    Imf::FLOAT, out.data() + c, window, pixel_bytes, pixel_bytes * width));
        }
        in.setFrameBuffer(buffer);
        in.readPixels(window.min.y, window.max.y);
        return out;
    });
}

}  // namespace obscura
