// session/tev_packets.cpp - the bytes of packets that make the viewer tev show an image.
// SPDX-License-Identifier: Apache-2.0
#include "session/tev_packets.h"

#include <bit>
#include <string_view>

namespace obscura {

namespace {

enum class Kind : uint8_t { create_image = 4, update_channels = 6 };

class PacketWriter {
public:
    explicit PacketWriter(Kind kind) {
        put(uint32_t{0});  // the length, when it is known
        put(static_cast<uint8_t>(kind));
    }

    template <typename Unsigned>
    void put(Unsigned value) {
        for (size_t i = 0; i < sizeof(value); ++i)
            bytes_.push_back(static_cast<std::byte>(value >> (8 * i)));
    }

    void put_int(int value) { put(static_cast<uint32_t>(value)); }

    void put_text(std::string_view text) {
        for (const char letter : text)
            bytes_.push_back(static_cast<std::byte>(letter));
        bytes_.push_back(std::byte{0});
    }

    void put_floats(std::span<const float> values) {
        static_assert(std::endian::native == std::endian::little);
        const auto bytes = std::as_bytes(values);
        bytes_.insert(bytes_.end(), bytes.begin(), bytes.end());
    }

    Bytes finish() {
        const size_t length = bytes_.size();
        for (size_t i = 0; i < sizeof(uint32_t); ++i)
            bytes_[i] = static_cast<std::byte>(length >> (8 * i));
        return std::move(bytes_);
    }

private:
    Bytes bytes_;
};

void put_channels(const TevImage& image, PacketWriter& out) {
    for (const std::string& channel : image.channels)
        out.put_text(channel);
}

}  // namespace

Bytes tev_create_image(const TevImage& image) {
    PacketWriter out(Kind::create_image);
    out.put(uint8_t{1});  // comes to the front
    out.put_text(image.name);
    out.put_int(image.width);
    out.put_int(image.height);
    out.put(static_cast<uint32_t>(image.channels.size()));
    put_channels(image, out);
    return out.finish();
}

Bytes tev_update_image(const TevImage& image,
                       const PixelRect& area,
                       std::span<const float> pixels) {
    PacketWriter out(Kind::update_channels);
    out.put(uint8_t{0});  // what is being looked at stays in front
    out.put_text(image.name);
    const size_t channels = image.channels.size();
    out.put(static_cast<uint32_t>(channels));
    put_channels(image, out);
    for (const int number : {area.x, area.y, area.width, area.height})
        out.put_int(number);
    // Where each channel's first value is, then how far its values are apart.
    for (size_t i = 0; i < channels; ++i)
        out.put(static_cast<uint64_t>(i));
    for (size_t i = 0; i < channels; ++i)
        out.put(static_cast<uint64_t>(channels));
    out.put_floats(pixels);
    return out.finish();
}

}  // namespace obscura
