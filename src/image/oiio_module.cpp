// image/oiio_module.cpp - what OpenImageIO does for us: the only file that includes it.
// SPDX-License-Identifier: Apache-2.0
#include "image/oiio_module.h"

#include <OpenImageIO/filesystem.h>
#include <OpenImageIO/imageio.h>

#include <cstdint>
#include <cstring>

namespace obscura {

namespace {

OIIO::TypeDesc type_of(OiioType type) {
    switch (type) {
        case OiioType::uint8:
            return OIIO::TypeDesc::UINT8;
        case OiioType::uint16:
            return OIIO::TypeDesc::UINT16;
        case OiioType::float32:
            break;
    }
    return OIIO::TypeDesc::FLOAT;
}

void own_process() {
    OIIO::attribute("threads", 1);
    OIIO::attribute("exr_threads", 1);
    OIIO::attribute("plugin_searchpath", "");
}

class Input final : public OiioInput {
public:
    Input(std::span<const std::byte> bytes, const char* format)
        : reader_(const_cast<std::byte*>(bytes.data()), bytes.size()),
          input_(OIIO::ImageInput::create(format)) {
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

    const std::string& error() const override { return error_; }
    int width() const override { return input_->spec().width; }
    int height() const override { return input_->spec().height; }
    int channels() const override { return input_->spec().nchannels; }

    bool read(OiioType type, void* pixels, std::ptrdiff_t pixel_stride) override {
        return input_->read_image(0, 0, 0, channels(), type_of(type), pixels, pixel_stride);
    }

    std::string errors() override {
        return input_->has_error() ? input_->geterror() : std::string();
    }

private:
    OIIO::Filesystem::IOMemReader reader_;
    std::unique_ptr<OIIO::ImageInput> input_;
    std::string error_;
};

std::unique_ptr<OiioInput> open_input(std::span<const std::byte> bytes, const char* format) {
    return std::make_unique<Input>(bytes, format);
}

OIIO::ImageSpec spec_of(const OiioImage& image) {
    OIIO::ImageSpec spec(image.width, image.height, image.channels, type_of(image.type));
    spec.attribute("oiio:UnassociatedAlpha", 1);
    for (const auto& [name, text] : image.attributes)
        spec.attribute(name, text);
    if (!image.icc_profile.empty()) {
        const auto count = static_cast<int>(image.icc_profile.size());
        const OIIO::TypeDesc bytes(OIIO::TypeDesc::UINT8, count);
        spec.attribute("ICCProfile", bytes, image.icc_profile.data());
    }
    return spec;
}

/// The library's message, never empty.
std::string failure_of(OIIO::ImageOutput* output) {
    const std::string cause = output != nullptr ? output->geterror() : OIIO::geterror();
    return cause.empty() ? "OpenImageIO does not say why" : cause;
}

std::string encode(const char* format, const OiioImage& image, std::vector<std::byte>& out) {
    const OIIO::ImageSpec spec = spec_of(image);
    std::vector<unsigned char> encoded;
    OIIO::Filesystem::IOVecOutput stream(encoded);
    const auto output = OIIO::ImageOutput::create(format);
    if (output) output->threads(1);
    const bool done = output && output->set_ioproxy(&stream) && output->open(format, spec) &&
                      output->write_image(spec.format, image.codes) && output->close();
    if (!done) return failure_of(output.get());
    const auto bytes = std::as_bytes(std::span(encoded));
    out.assign(bytes.begin(), bytes.end());
    return "";
}

/// Copies rows to the encoder from a buffer with room behind: up to version 2.5 OpenImageIO reads
/// as many bytes a row as libheif's rows have, which are padded.
bool write_rows(OIIO::ImageOutput& output, const OiioImage& image) {
    constexpr size_t max_padding = 4096;
    const size_t row = static_cast<size_t>(image.width) * static_cast<size_t>(image.channels);
    const auto* const codes = static_cast<const uint8_t*>(image.codes);
    std::vector<uint8_t> padded(row + max_padding);
    for (int y = 0; y < image.height; ++y) {
        std::memcpy(padded.data(), codes + static_cast<size_t>(y) * row, row);
        if (!output.write_scanline(y, 0, OIIO::TypeDesc::UINT8, padded.data())) return false;
    }
    return true;
}

std::string encode_to_file(const char* format, const OiioImage& image, const std::string& file) {
    const auto output = OIIO::ImageOutput::create(format);
    const bool done = output && output->open(file, spec_of(image)) && write_rows(*output, image) &&
                      output->close();
    return done ? "" : failure_of(output.get());
}

std::optional<std::vector<std::string>> read_texts(const char* format,
                                                   const std::string& file,
                                                   std::span<const std::string> names) {
    const auto input = OIIO::ImageInput::create(format);
    OIIO::ImageSpec spec;
    if (!input || !input->open(file, spec)) {
        if (input) input->geterror();  // OpenImageIO prints what nobody takes
        return {};
    }
    std::vector<std::string> texts;
    for (const std::string& name : names)
        texts.emplace_back(spec.get_string_attribute(name));
    return texts;
}

constexpr OiioModule module = {
    OBSCURA_VERSION, own_process, open_input, encode, encode_to_file, read_texts};

}  // namespace

}  // namespace obscura

extern "C" __attribute__((visibility("default"))) const obscura::OiioModule* obscura_oiio_module() {
    return &obscura::module;
}
