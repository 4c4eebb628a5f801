// base/sha256.cpp - SHA-256 of files and of bytes in memory, by OpenSSL.
// SPDX-License-Identifier: Apache-2.0
#include "base/sha256.h"

#include <array>
#include <fstream>
#include <memory>
#include <openssl/evp.h>
#include <string_view>
#include <vector>

namespace obscura {

namespace {

using Digest = std::array<unsigned char, EVP_MAX_MD_SIZE>;

std::string hexadecimal(const Digest& digest, unsigned int size) {
    constexpr std::string_view digits = "0123456789abcdef";
    std::string out;
    for (unsigned int i = 0; i < size; ++i) {
        out += digits[digest[i] >> 4];
        out += digits[digest[i] & 15];
    }
    return out;
}

}  // namespace

std::string sha256_of(std::span<const std::byte> bytes) {
    Digest digest = {};
    unsigned int size = 0;
    const int done =
        EVP_Digest(bytes.data(), bytes.size(), digest.data(), &size, EVP_sha256(), nullptr);
    return done == 1 ? hexadecimal(digest, size) : std::string();
}

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
    Digest digest = {};
    unsigned int size = 0;
    if (EVP_DigestFinal_ex(context.get(), digest.data(), &size) != 1) return {};
    out.sha256 = hexadecimal(digest, size);
    return out;
}

}  // namespace obscura
