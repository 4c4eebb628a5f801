// base/sha256.cpp - SHA-256 of files, by OpenSSL.
// SPDX-License-Identifier: Apache-2.0
#include "base/sha256.h"

#include <array>
#include <fstream>
#include <memory>
#include <openssl/evp.h>
#include <vector>

namespace obscura {

std::optional<FileDigest> digest_file(const std::filesystem::path& file) {
    constexpr size_t block = size_t{1} << 20;
    std::ifstream in(file, std::ios::binary);
    const std::unique_ptr<EVP_MD_CTX, void (*)(EVP_MD_CTX*)> context(EVP_MD_CTX_new(),
                                                                     EVP_MD_CTX_free);
    if (!in || !context || EVP_DigestInit_ex(context.get(), EVP_sha256(), nullptr) != 1) return {};
    FileDigest out;
    std::vector<char> bytes(block);
    while (in) {
        in.read(bytes.data(), static_cast<std::streamsize>(block));
        const auto count = static_cast<size_t>(in.gcount());
        if (EVP_DigestUpdate(context.get(), bytes.data(), count) != 1) return {};
        out.bytes += count;
    }
    if (in.bad()) return {};
    std::array<unsigned char, EVP_MAX_MD_SIZE> digest = {};
    unsigned int size = 0;
    if (EVP_DigestFinal_ex(context.get(), digest.data(), &size) != 1) return {};
    constexpr std::string_view digits = "0123456789abcdef";
    for (unsigned int i = 0; i < size; ++i) {
        out.sha256 += digits[digest[i] >> 4];
        out.sha256 += digits[digest[i] & 15];
    }
    return out;
}

}  // namespace obscura
