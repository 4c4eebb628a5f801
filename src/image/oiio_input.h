// image/oiio_input.h - opens an encoded image in memory with exactly one OpenImageIO reader.
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <OpenImageIO/filesystem.h>
#include <OpenImageIO/imageio.h>

#include <cstddef>
#include <memory>
#include <span>
#include <string>

namespace obscura {

/// Must be called before OpenImageIO is used. In programs that own their process
/// (image/process_settings.h), OpenImageIO then starts no threads (we decode one image per task)
/// and searches no plug-ins.
void prepare_oiio();

/// An open image; `bytes` must outlive it.
class OiioInput {
public:
    /// format: OpenImageIO's name of the one reader to use, such as "png".
    OiioInput(std::span<const std::byte> bytes, const char* format);

    /// "", or the reason why the image could not be opened.
    const std::string& error() const { return error_; }
    const OIIO::ImageSpec& spec() const { return input_->spec(); }

    /// Reads all channels, converted to `type`, into pixels that lie `pixel_stride` bytes apart.
    /// False on failure. In both cases errors() returns the library's messages.
    bool read(const OIIO::TypeDesc& type, void* pixels, OIIO::stride_t pixel_stride);
    std::string errors();

private:
    OIIO::Filesystem::IOMemReader reader_;
    std::unique_ptr<OIIO::ImageInput> input_;
    std::string error_;
};

}  // namespace obscura
