// image/exr_stream.h - OpenEXR streams over memory.
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <OpenEXR/Iex.h>
#include <OpenEXR/ImfIO.h>

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <cstring>
#include <span>
#include <utility>
#include <vector>

namespace obscura {

/// Reads from bytes, which must outlive it.
class ExrMemoryReader final : public Imf::IStream {
public:
    ExrMemoryReader(std::span<const std::byte> bytes, const char* name)
        : Imf::IStream(name), bytes_(bytes) {}

    bool read(char out[], int count) override {
        const auto wanted = static_cast<uint64_t>(std::max(count, 0));
        if (position_ > bytes_.size() || wanted > bytes_.size() - position_) {
            throw Iex::InputExc("the file is cut off");
        }
        std::memcpy(out, bytes_.data() + position_, wanted);
        position_ += wanted;
        return position_ < bytes_.size();
    }
    uint64_t tellg() override { return position_; }
    void seekg(uint64_t position) override { position_ = position; }

private:
    std::span<const std::byte> bytes_;
    uint64_t position_ = 0;
};

/// Collects written bytes; OpenEXR seeks back once, to fill in its table of offsets.
class ExrMemoryWriter final : public Imf::OStream {
public:
    explicit ExrMemoryWriter(const char* name) : Imf::OStream(name) {}

    void write(const char in[], int count) override {
        const std::span from{reinterpret_cast<const std::byte*>(in),
                             static_cast<size_t>(std::max(count, 0))};
        if (position_ > bytes_.size()) bytes_.resize(position_);
        const size_t over = std::min<size_t>(from.size(), bytes_.size() - position_);
        std::copy_n(from.begin(), over, bytes_.data() + position_);
        bytes_.insert(bytes_.end(), from.begin() + static_cast<ptrdiff_t>(over), from.end());
        position_ += from.size();
    }
    uint64_t tellp() override { return position_; }
    void seekp(uint64_t position) override { position_ = position; }

    /// Before so many more bytes are written: they need no other memory then.
    void expect(uint64_t more) { bytes_.reserve(position_ + more); }

    std::vector<std::byte> take() { return std::move(bytes_); }

private:
    std::vector<std::byte> bytes_;
    uint64_t position_ = 0;
};

}  // namespace obscura
