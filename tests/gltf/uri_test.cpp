// tests/gltf/uri_test.cpp - URIs: data, files inside the asset's folder, and nothing else.
// SPDX-License-Identifier: Apache-2.0
#include "gltf/parse/uri.h"

#include "gltf/gltf_files.h"

#include <gtest/gtest.h>

#include <random>
#include <string>
#include <sys/stat.h>

namespace obscura::gltf {
namespace {

using namespace std::string_view_literals;
using test::base64;

std::string as_text(const Bytes& bytes) {
    return {reinterpret_cast<const char*>(bytes.data()), bytes.size()};
}

std::string decoded(std::string_view text) {
    Bytes out;
    const std::string fault = decode_base64(text, out);
    return fault.empty() ? as_text(out) : "FAULT " + fault;
}

/// The result of reading a URI inside a folder: the content, or "id code".
std::string read(const std::filesystem::path& folder, std::string_view uri) {
    const Result<UriBytes> bytes = read_uri(uri, {folder, "w"}, {});
    if (bytes) return as_text(bytes->bytes);
    EXPECT_EQ(bytes.error().where, "w");
    return bytes.error().id + " " + std::to_string(static_cast<int>(bytes.error().code));
}

TEST(Uri, Base64RoundTrips) {
    std::mt19937 random(7);
    for (size_t length = 0; length < 70; ++length) {
        std::string bytes(length, '\0');
        for (char& c : bytes)
            c = static_cast<char>(random());
        std::string text = base64(bytes);
        EXPECT_EQ(decoded(text), bytes);
        while (!text.empty() && text.back() == '=')
            text.pop_back();
        EXPECT_EQ(decoded(text), bytes) << "without padding";
    }
}

TEST(Uri, BadBase64IsAFault) {  // C19
    for (const char* text : {"A", "AAAAA", "AA=", "A===", "AA==AA==", "AA A", "AA-_", "A\nAA"}) {
        EXPECT_EQ(decoded(text).substr(0, 5), "FAULT") << text;
    }
}

TEST(Uri, PercentsAreDecodedOnce) {
    EXPECT_EQ(percent_decode("a%20b%2Fc%2fd"), "a b/c/d");
    EXPECT_EQ(percent_decode("%2541"), "%41");
    EXPECT_EQ(percent_decode("100%"), "100%");
    EXPECT_EQ(percent_decode("5%-6%zz%4"), "5%-6%zz%4");
    EXPECT_EQ(percent_decode("%E2%9D%A4"), "\xE2\x9D\xA4");
}

TEST(Uri, RefusesEverythingOutsideTheFolder) {
    for (const std::string_view uri : {"../a.bin"sv,
                                       "..%2Fa.bin"sv,
                                       "%2e%2e/a.bin"sv,
                                       "b/../../a.bin"sv,
                                       "b/c/../../../a.bin"sv,
                                       ".."sv,
                                       "/etc/passwd"sv,
                                       "%2Fetc/passwd"sv,
                                       "//server/share"sv,
                                       "\\\\server\\share"sv,
                                       "b\\..\\..\\a"sv,
                                       "b%5C..%5Ca"sv,
                                       "C:/a.bin"sv,
                                       "C:a.bin"sv,
                                       "c%3A/a.bin"sv,
                                       "http://example.org/a.bin"sv,
                                       "https://example.org/a.bin"sv,
                                       "HTTPS://example.org/a.bin"sv,
                                       "file:///etc/passwd"sv,
                                       "ftp:a"sv,
                                       "a%00.bin"sv,
                                       "a\0.bin"sv,
                                       "a%0A.bin"sv,
                                       ""sv}) {
        const auto path = relative_path_from_uri(uri, "w");
        ASSERT_FALSE(path) << uri;
        EXPECT_EQ(path.error().code, ExitCode::refused);
        EXPECT_EQ(path.error().id, "E-URI-REFUSED");
    }
}

TEST(Uri, ReadsFilesInTheFolder) {
    const TempFolder folder;
    std::filesystem::create_directories(folder / "b/c");
    folder.write("a b.bin", "one");
    folder.write("b/c/d.bin", "two");
    folder.write("100%.bin", "three");
    folder.write("x%41.bin", "four");
    EXPECT_EQ(read(folder.path(), "a b.bin"), "one");
    EXPECT_EQ(read(folder.path(), "a%20b.bin"), "one");
    EXPECT_EQ(read(folder.path(), "./b//c/../c/d.bin"), "two");
    EXPECT_EQ(read(folder.path(), "100%.bin"), "three");
    EXPECT_EQ(read(folder.path(), "x%2541.bin"), "four");
    EXPECT_EQ(read(folder.path(), "absent.bin"), "E-RES-MISSING 67");
}

TEST(Uri, SymbolicLinksMayNotLeave) {
    const TempFolder outside;
    const TempFolder folder;
    outside.write("secret", "s");
    folder.write("inside", "i");
    std::filesystem::create_symlink(outside / "secret", folder / "leaves");
    std::filesystem::create_directory_symlink(outside.path(), folder / "door");
    std::filesystem::create_symlink("inside", folder / "stays");
    std::filesystem::create_symlink("nowhere", folder / "dangling");
    EXPECT_EQ(read(folder.path(), "leaves"), "E-URI-REFUSED 77");
    EXPECT_EQ(read(folder.path(), "door/secret"), "E-URI-REFUSED 77");
    EXPECT_EQ(read(folder.path(), "stays"), "i");
    EXPECT_EQ(read(folder.path(), "dangling"), "E-RES-MISSING 67");
}

TEST(Uri, FolderNameThatIsAPrefixIsAnotherFolder) {
    const TempFolder parent;
    std::filesystem::create_directories(parent / "asset");
    std::filesystem::create_directories(parent / "asset2");
    parent.write("asset2/secret", "s");
    std::filesystem::create_symlink("../asset2/secret", parent / "asset/link");
    EXPECT_EQ(read(parent / "asset", "link"), "E-URI-REFUSED 77");
}

TEST(Uri, OnlyPlainFilesAreOpened) {  // D14
    const TempFolder folder;
    ASSERT_EQ(::mkfifo((folder / "fifo").c_str(), 0600), 0);
    std::filesystem::create_directory(folder / "sub");
    EXPECT_EQ(read(folder.path(), "fifo"), "E-URI-REFUSED 77");
    EXPECT_EQ(read(folder.path(), "sub"), "E-URI-REFUSED 77");
}

TEST(Uri, LargeFilesAreRefused) {
    const TempFolder folder;
    folder.write("a.bin", "abcdef");
    const Result<UriBytes> bytes = read_uri("a.bin", {folder.path(), "w"}, {3, UINT64_MAX});
    ASSERT_FALSE(bytes);
    EXPECT_EQ(bytes.error().id, "E-LIMIT-FILE");
    EXPECT_EQ(bytes.error().code, ExitCode::refused);
}

TEST(Uri, DataUrisAreDecoded) {
    const Result<UriBytes> bytes = read_uri("data:image/png;base64,YWJj", {"", "w"}, {});
    ASSERT_TRUE(bytes);
    EXPECT_EQ(as_text(bytes->bytes), "abc");
    EXPECT_EQ(bytes->mime, "image/png");
    for (const char* uri :
         {"DATA:image/png;Base64,YWJj", "data:image/png,abc", "data:image/png;x=y,%61b%63"}) {
        const Result<UriBytes> same = read_uri(uri, {"", "w"}, {});
        ASSERT_TRUE(same) << uri;
        EXPECT_EQ(as_text(same->bytes), "abc") << uri;
        EXPECT_EQ(same->mime, "image/png") << uri;
    }
    for (const char* uri : {"data:", "data:text/plain", "data:;base64", "data:;base64,A"}) {
        EXPECT_EQ(read("", uri), "E-URI-DATA 65") << uri;
    }
}

TEST(Uri, LongUrisAreShortenedInMessages) {
    const Result<UriBytes> bytes =
        read_uri("data:;base64," + std::string(100000, '!'), {"", "w"}, {});
    ASSERT_FALSE(bytes);
    EXPECT_LT(bytes.error().message.size(), 400U);
}

}  // namespace
}  // namespace obscura::gltf
