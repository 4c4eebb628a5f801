// image/oiio_input.h - opens an encoded picture in memory with exactly one OpenImageIO reader.
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <OpenImageIO/filesystem.h>
#include <OpenImageIO/imageio.h>

#include <cstddef>
#include <memory>
#include <span>
#include <string>

namespace obscura {

/// Must be called before OpenImageIO is used: in a process of our own (image/process_settings.h) it
/// makes no threads (decoding runs in ours, one picture a task) and looks for no plug-ins.
void prepare_oiio();

/// An open picture; `bytes` must outlive it.
class OiioInput {
public:
    /// format: OpenImageIO's name of the one reader to use, such as "png".
    OiioInput(std::span<const std::byte> bytes, const char* format);

    /// "" or why the picture could not be opened.
    const std::string& error() const { return error_; }
    const OIIO::ImageSpec& spec() const { return input_->spec(); }

    /// Reads all channels, converted to `type`, into pixels that lie `pixel_stride` bytes apart.
    /// False on failure. Either way, errors() tells what the library said.
    bool read(const OIIO::TypeDesc& type, void* pixels, OIIO::stride_t pixel_stride);
    std::string errors();

private:
    OIIO::Filesystem::IOMemReader reader_;
    std::unique_ptr<OIIO::ImageInput> input_;
    std::string error_;
};

}  // namespace obscura
