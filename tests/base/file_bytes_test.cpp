// tests/base/file_bytes_test.cpp - only plain files are read, and nothing blocks.
// SPDX-License-Identifier: Apache-2.0
#include "base/file_bytes.h"

#include <gtest/gtest.h>

#include "support/temp_folder.h"
#include <algorithm>
#include <string>
#include <sys/socket.h>
#include <sys/stat.h>
#include <sys/un.h>
#include <unistd.h>

namespace obscura {
namespace {

FileFault fault_of(const std::filesystem::path& path) {
    return read_file_bytes(path, {}).fault;
}

TEST(FileBytes, ReadsWholeFilesAndBeginnings) {
    const TempFolder folder;
    const auto file = folder.write("a.bin", "abcdef");
    const FileBytes whole = read_file_bytes(file, {});
    EXPECT_EQ(whole.fault, FileFault::none);
    EXPECT_EQ(whole.size, 6U);
    ASSERT_EQ(whole.bytes.size(), 6U);
    EXPECT_EQ(whole.bytes[5], std::byte{'f'});
    const FileBytes start = read_file_bytes(file, {UINT64_MAX, 2});
    EXPECT_EQ(start.size, 6U);
    EXPECT_EQ(start.bytes.size(), 2U);
    EXPECT_EQ(read_file_bytes(folder.write("empty", ""), {}).fault, FileFault::none);
}

TEST(FileBytes, AddressesOnTheWebAreToldFromNames) {
    for (const char* name : {"https://a.example/a.glb", "http:/a.example/a.hdr"}) {
        const FileBytes read = read_file_bytes(name, {});
        EXPECT_EQ(read.fault, FileFault::missing) << name;
        EXPECT_NE(read.reason.find("network"), std::string::npos) << name << ": " << read.reason;
    }
    const FileBytes read = read_file_bytes("https.glb", {});
    EXPECT_EQ(read.reason.find("network"), std::string::npos) << read.reason;
}

TEST(FileBytes, LargeFilesAreRefusedUnread) {
    const TempFolder folder;
    const FileBytes read = read_file_bytes(folder.write("a.bin", "abcdef"), {5, UINT64_MAX});
    EXPECT_EQ(read.fault, FileFault::too_large);
    EXPECT_TRUE(read.bytes.empty());
}

TEST(FileBytes, TellsWhatIsNotAFile) {  // A2, A3
    const TempFolder folder;
    EXPECT_EQ(fault_of(folder / "absent"), FileFault::missing);
    EXPECT_EQ(fault_of(folder.write("file", "") / "inside"), FileFault::missing);
    EXPECT_EQ(fault_of(folder.path()), FileFault::not_a_file);
    EXPECT_EQ(fault_of("/dev/zero"), FileFault::not_a_file);

    const std::filesystem::path fifo = folder / "fifo";
    ASSERT_EQ(::mkfifo(fifo.c_str(), 0600), 0);
    EXPECT_EQ(fault_of(fifo), FileFault::not_a_file);

    const int socket = ::socket(AF_UNIX, SOCK_STREAM, 0);
    sockaddr_un address = {};
    address.sun_family = AF_UNIX;
    const std::string path = (folder / "socket").string();
    ASSERT_LT(path.size(), sizeof(address.sun_path));
    std::copy(path.begin(), path.end(), address.sun_path);
    ASSERT_EQ(::bind(socket, reinterpret_cast<const sockaddr*>(&address), sizeof(address)), 0);
    EXPECT_EQ(fault_of(path), FileFault::not_a_file);
    ::close(socket);
}

TEST(FileBytes, TellsWhatMayNotBeRead) {
    if (::geteuid() == 0) GTEST_SKIP() << "root may read everything";
    const TempFolder folder;
    const auto file = folder.write("secret", "x");
    std::filesystem::permissions(file, std::filesystem::perms::none);
    EXPECT_EQ(fault_of(file), FileFault::denied);
}

}  // namespace
}  // namespace obscura
