// image/oiio_input.cpp - opens an encoded image in memory with exactly one OpenImageIO reader.
// SPDX-License-Identifier: Apache-2.0
#include "image/oiio_input.h"

#include "image/process_settings.h"

#include <mutex>

namespace obscura {

void prepare_oiio() {
    if (!owns_process_settings()) return;
    static std::once_flag once;
    std::call_once(once, [] {
        OIIO::attribute("threads", 1);
        OIIO::attribute("exr_threads", 1);
        OIIO::attribute("plugin_searchpath", "");
    });
}

OiioInput::OiioInput(std::span<const std::byte> bytes, const char* format)
    : reader_(const_cast<std::byte*>(bytes.data()), bytes.size()) {
    prepare_oiio();
    input_ = OIIO::ImageInput::create(format);
    if (!input_) {
        error_ = OIIO::geterror();
        return;
    }
    input_->threads(1);
    if (!input_->set_ioproxy(&reader_)) {
        error_ = std::string("this OpenImageIO cannot read ") + format + " from memory";
        return;
    }
    OIIO::ImageSpec wishes;
    wishes.attribute("oiio:UnassociatedAlpha", 1);
    OIIO::ImageSpec found;
    if (!input_->open(format, found, wishes)) error_ = input_->geterror();
}

bool OiioInput::read(const OIIO::TypeDesc& type, void* pixels, OIIO::stride_t pixel_stride) {
    return input_->read_image(0, 0, 0, input_->spec().nchannels, type, pixels, pixel_stride);
}

std::string OiioInput::errors() {
    return input_->has_error() ? input_->geterror() : std::string();
}

}  // namespace obscura
