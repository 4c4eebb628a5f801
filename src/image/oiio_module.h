// image/oiio_module.h - what OpenImageIO does for us, in a module of its own that is opened late.
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <memory>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

namespace obscura {

enum class OiioType { uint8, uint16, float32 };

/// An open image in memory.
class OiioInput {
public:
    OiioInput() = default;
    OiioInput(const OiioInput&) = delete;
    OiioInput& operator=(const OiioInput&) = delete;
    virtual ~OiioInput() = default;

    /// "", or the reason why the image could not be opened; then nothing else may be asked.
    virtual const std::string& error() const = 0;
    virtual int width() const = 0;
    virtual int height() const = 0;
    virtual int channels() const = 0;

    /// Reads all channels, converted to `type`, into pixels that lie `pixel_stride` bytes apart.
    /// False on failure. In both cases errors() returns the library's messages.
    virtual bool read(OiioType type, void* pixels, std::ptrdiff_t pixel_stride) = 0;
    virtual std::string errors() = 0;
};

/// An image to encode, with what is said about it.
struct OiioImage {
    int width = 0, height = 0, channels = 0;
    OiioType type = OiioType::uint8;
    const void* codes = nullptr;  ///< interleaved; alpha is straight
    std::vector<std::pair<std::string, std::string>> attributes = {};
    std::span<const std::byte> icc_profile = {};  ///< empty: none
};

/// The functions of the module. They may throw std::exception; formats have OpenImageIO's names,
/// such as "png". Thread-safe.
struct OiioModule {
    const char* version;  ///< of Obscura: module and program are of one build

    /// OpenImageIO starts no threads from now on (we decode one image per task) and searches no
    /// plug-ins: for programs that own their process (image/process_settings.h).
    void (*own_process)();

    /// Opens an image by exactly one reader; `bytes` must outlive it.
    std::unique_ptr<OiioInput> (*open)(std::span<const std::byte> bytes, const char* format);

    /// Encodes in memory. Returns the library's message; "": it is done.
    std::string (*encode)(const char* format, const OiioImage& image, std::vector<std::byte>& out);

    /// Encodes 8 bits to a file, for writers that know only files. As encode.
    std::string (*encode_to_file)(const char* format,
                                  const OiioImage& image,
                                  const std::string& file);

    /// The texts of a file's header by their names, "" for those that it lacks; nothing: there is
    /// no such file, or its header cannot be read.
    std::optional<std::vector<std::string>> (*read_texts)(const char* format,
                                                          const std::string& file,
                                                          std::span<const std::string> names);
};

/// The module's one symbol, a function that returns its OiioModule.
inline constexpr const char* oiio_module_symbol = "obscura_oiio_module";

}  // namespace obscura
