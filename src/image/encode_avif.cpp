// image/encode_avif.cpp - encodes finished images as AVIF where OpenImageIO can.
// SPDX-License-Identifier: Apache-2.0
#include "base/file_bytes.h"
#include "image/encode.h"
#include "image/oiio.h"

#include <cstring>
#include <stdlib.h>
#include <string_view>
#include <unistd.h>
#include <utility>

namespace obscura {

namespace {

/// A new empty file; removed in the end.
class ScratchFile {
public:
    ScratchFile() {
        std::error_code error;
        const std::filesystem::path folder = std::filesystem::temp_directory_path(error);
        if (error) return;
        std::string name = (folder / "obscura-XXXXXX.avif").string();
        const int descriptor = ::mkstemps(name.data(), 5);
        if (descriptor < 0) return;
        ::close(descriptor);
        path_ = name;
    }
    ScratchFile(const ScratchFile&) = delete;
    ScratchFile& operator=(const ScratchFile&) = delete;
    ~ScratchFile() {
        std::error_code error;
        if (!path_.empty()) std::filesystem::remove(path_, error);
    }

    const std::string& path() const { return path_; }  ///< "": it could not be made

private:
    std::string path_;
};

bool is_avif(std::span<const std::byte> bytes) {
    constexpr std::string_view brand = "ftypavif";
    return bytes.size() > 12 && std::memcmp(bytes.data() + 4, brand.data(), brand.size()) == 0;
}

}  // namespace

Result<std::vector<std::byte>> encode_avif(const CodedImage& image,
                                           int quality,
                                           const std::string& where) {
    const Result<const OiioModule*>& oiio = oiio_module();
    if (!oiio) return fail(oiio.error());
    const ScratchFile file;
    if (file.path().empty()) {
        return fail(ExitCode::io_error,
                    "E-OUT-WRITE",
                    where,
                    "no temporary file can be made, which AVIF needs; set $TMPDIR");
    }
    const OiioImage whole{.width = image.width,
                          .height = image.height,
                          .channels = image.channels,
                          .codes = image.codes,
                          .attributes = {{"compression", "avif:" + std::to_string(quality)}}};
    const std::string failure = (*oiio)->encode_to_file("heif", whole, file.path());
    FileBytes encoded = failure.empty() ? read_file_bytes(file.path(), {}) : FileBytes();
    if (!is_avif(encoded.bytes)) {
        return fail(ExitCode::internal, "E-OUT-ENCODE", where, "encoding failed: " + failure);
    }
    return std::move(encoded.bytes);
}

bool can_write_avif() {
    static const bool can = [] {
        constexpr int side = 16;
        const std::vector<uint8_t> grey(size_t{3} * side * side, 128);
        return encode_avif({side, side, 3, grey.data()}, 50, "").has_value();
    }();
    return can;
}

}  // namespace obscura
