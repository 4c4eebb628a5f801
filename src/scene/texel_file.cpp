// scene/texel_file.cpp - the texels of an image with its mip chain in a file, to be mapped.
// SPDX-License-Identifier: Apache-2.0
#include "scene/texel_file.h"

#include "base/atomic_file.h"
#include "base/checksum.h"
#include "base/file_bytes.h"

#include <array>
#include <cstring>
#include <system_error>

namespace obscura {

namespace {

/// The first words of a file; zeros fill its page.
struct Head {
    std::array<char, 8> magic = {'O', 'B', 'S', 'T', 'E', 'X', '0', '1'};
    TexelKey key;
    uint64_t texels = 0;
    bool operator==(const Head&) const = default;
};

}  // namespace

std::filesystem::path texel_file(const std::filesystem::path& folder, const TexelKey& key) {
    return folder / (checksum_text(key.image) + "-" + checksum_text(key.settings) + ".texels");
}

bool has_texels(const std::filesystem::path& file, const TexelKey& key, size_t texels) {
    std::error_code error;
    const uint64_t size = std::filesystem::file_size(file, error);
    if (error || size != texel_file_head + texels * sizeof(uint32_t)) return false;
    const FileBytes read = read_file_bytes(file, {UINT64_MAX, sizeof(Head)});
    if (read.fault != FileFault::none || read.bytes.size() != sizeof(Head)) return false;
    Head head;
    std::memcpy(&head, read.bytes.data(), sizeof(head));
    return head == Head{.key = key, .texels = texels};
}

Result<void> write_texel_file(const std::filesystem::path& file,
                              const TexelKey& key,
                              std::span<const uint32_t> texels) {
    const Head head{.key = key, .texels = texels.size()};
    Bytes page(texel_file_head);
    std::memcpy(page.data(), &head, sizeof(head));
    std::error_code ignored;  // writing says what is wrong with the folder
    std::filesystem::create_directories(file.parent_path(), ignored);
    return write_pieces_atomically(file, [&](const ByteSink& sink) -> Result<void> {
        if (auto done = sink(page); !done) return done;
        return sink(std::as_bytes(texels));
    });
}

}  // namespace obscura
