// tests/support/fake_viewer.h - listens as the viewer tev does, and keeps what it is shown.
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <arpa/inet.h>
#include <array>
#include <atomic>
#include <bit>
#include <cstdint>
#include <map>
#include <netinet/in.h>
#include <poll.h>
#include <stdexcept>
#include <string>
#include <sys/socket.h>
#include <thread>
#include <unistd.h>
#include <vector>

namespace obscura {

/// An image as the viewer has it.
struct ViewedImage {
    int width = 0, height = 0, updates = 0;
    std::vector<std::string> channels;
    std::vector<float> pixels;  ///< interleaved

    /// The values of a rectangle, rows from the top.
    std::vector<float> part(int x, int y, int w, int h) const {
        std::vector<float> out;
        for (int row = y; row < y + h; ++row) {
            const auto begin =
                static_cast<ptrdiff_t>(row * width + x) * static_cast<ptrdiff_t>(channels.size());
            const auto end = begin + w * static_cast<ptrdiff_t>(channels.size());
            out.insert(out.end(), pixels.begin() + begin, pixels.begin() + end);
        }
        return out;
    }
};

/// Reads packets one by one; throws where they do not say what the protocol wants.
class PacketReader {
public:
    explicit PacketReader(std::string bytes) : bytes_(std::move(bytes)) {}
    bool at_end() const { return at_ == bytes_.size(); }

    uint64_t number(size_t size) {
        need(size);
        uint64_t out = 0;
        for (size_t i = size; i-- > 0;)
            out = out << 8U | static_cast<uint8_t>(bytes_[at_ + i]);
        at_ += size;
        return out;
    }
    int integer() { return static_cast<int32_t>(number(4)); }
    std::string text() {
        const size_t end = bytes_.find('\0', at_);
        if (end == std::string::npos) throw std::runtime_error("a text has no end");
        const std::string out = bytes_.substr(at_, end - at_);
        at_ = end + 1;
        return out;
    }
    std::vector<std::string> texts(int count) {
        std::vector<std::string> out;
        for (int i = 0; i < count; ++i)
            out.push_back(text());
        return out;
    }
    /// What is left of a packet is `size` bytes.
    PacketReader packet() {
        const size_t size = number(4);
        if (size < 5) throw std::runtime_error("a packet is too short");
        need(size - 4);
        PacketReader out(bytes_.substr(at_, size - 4));
        at_ += size - 4;
        return out;
    }

private:
    void need(size_t size) const {
        if (bytes_.size() - at_ < size) throw std::runtime_error("bytes are missing");
    }
    std::string bytes_;
    size_t at_ = 0;
};

namespace fake_viewer_detail {

inline void create(PacketReader& in, std::map<std::string, ViewedImage>& images) {
    in.number(1);
    ViewedImage& image = images[in.text()];
    image = {};
    image.width = in.integer();
    image.height = in.integer();
    image.channels = in.texts(in.integer());
    image.pixels.resize(static_cast<size_t>(image.width * image.height) * image.channels.size());
}

inline void update(PacketReader& in, std::map<std::string, ViewedImage>& images) {
    in.number(1);
    ViewedImage& image = images.at(in.text());
    const int count = in.integer();
    if (in.texts(count) != image.channels) throw std::runtime_error("other channels");
    const int x = in.integer(), y = in.integer(), w = in.integer(), h = in.integer();
    if (x < 0 || y < 0 || w < 1 || h < 1 || x + w > image.width || y + h > image.height)
        throw std::runtime_error("beyond the image");
    std::vector<uint64_t> offsets, strides;
    for (int i = 0; i < count; ++i)
        offsets.push_back(in.number(8));
    for (int i = 0; i < count; ++i)
        strides.push_back(in.number(8));
    std::vector<float> values;
    while (!in.at_end())
        values.push_back(std::bit_cast<float>(static_cast<uint32_t>(in.number(4))));
    for (int i = 0; i < w * h; ++i) {
        const auto pixel = static_cast<size_t>((y + i / w) * image.width + x + i % w);
        for (size_t c = 0; c < image.channels.size(); ++c)
            image.pixels[pixel * image.channels.size() + c] =
                values.at(offsets[c] + static_cast<size_t>(i) * strides[c]);
    }
    ++image.updates;
}

}  // namespace fake_viewer_detail

/// What a viewer shows after these bytes.
inline std::map<std::string, ViewedImage> images_of(const std::string& bytes) {
    std::map<std::string, ViewedImage> out;
    PacketReader all(bytes);
    while (!all.at_end()) {
        PacketReader packet = all.packet();
        const uint64_t kind = packet.number(1);
        if (kind != 4 && kind != 6) throw std::runtime_error("another kind of packet");
        if (kind == 4) fake_viewer_detail::create(packet, out);
        if (kind == 6) fake_viewer_detail::update(packet, out);
        if (!packet.at_end()) throw std::runtime_error("a packet is too long");
    }
    return out;
}

/// A listening socket on this machine, with a thread that takes one connection.
class FakeViewer {
public:
    enum class Manner { reads, closes_early, never_reads };

    explicit FakeViewer(Manner manner) : manner_(manner) {
        listener_ = socket(AF_INET, SOCK_STREAM | SOCK_CLOEXEC, 0);
        const int small = 4096;
        if (manner == Manner::never_reads)
            setsockopt(listener_, SOL_SOCKET, SO_RCVBUF, &small, sizeof(small));
        sockaddr_in place = {};
        place.sin_family = AF_INET;
        place.sin_addr.s_addr = htonl(INADDR_LOOPBACK);
        socklen_t size = sizeof(place);
        if (bind(listener_, reinterpret_cast<sockaddr*>(&place), size) != 0 ||
            listen(listener_, 1) != 0 ||
            getsockname(listener_, reinterpret_cast<sockaddr*>(&place), &size) != 0)
            throw std::runtime_error("no socket");
        port_ = ntohs(place.sin_port);
        thread_ = std::thread([this] { serve(); });
    }
    ~FakeViewer() { finish(); }
    FakeViewer(const FakeViewer&) = delete;
    FakeViewer& operator=(const FakeViewer&) = delete;

    std::string address() const { return "127.0.0.1:" + std::to_string(port_); }
    uint16_t port() const { return port_; }

    /// After the program has ended: all that came.
    std::string bytes() {
        finish();
        return bytes_;
    }
    std::map<std::string, ViewedImage> images() { return images_of(bytes()); }

    /// Nobody listens there any more.
    void finish() {
        ends_ = true;
        if (thread_.joinable()) thread_.join();
        if (listener_ >= 0) close(listener_);
        listener_ = -1;
    }

private:
    static bool is_readable(int file) {
        pollfd state{file, POLLIN, 0};
        return poll(&state, 1, 20) > 0;
    }
    /// What has been sent before the end is read to its end.
    void serve() {
        while (!is_readable(listener_)) {
            if (ends_) return;
        }
        const int from = accept4(listener_, nullptr, nullptr, SOCK_CLOEXEC);
        while (manner_ == Manner::never_reads && !ends_)
            std::this_thread::sleep_for(std::chrono::milliseconds(20));
        std::array<char, 65536> buffer;
        while (manner_ != Manner::never_reads) {
            if (!is_readable(from)) {
                if (ends_) break;
                continue;
            }
            const ssize_t count = read(from, buffer.data(), buffer.size());
            if (count <= 0) break;
            bytes_.append(buffer.data(), static_cast<size_t>(count));
            if (manner_ == Manner::closes_early) break;
        }
        close(from);
    }

    const Manner manner_;
    int listener_ = -1;
    uint16_t port_ = 0;
    std::atomic<bool> ends_ = false;
    std::string bytes_;
    std::thread thread_;
};

}  // namespace obscura
