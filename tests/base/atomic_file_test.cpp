// tests/base/atomic_file_test.cpp - files appear whole or not at all, whatever fails.
// SPDX-License-Identifier: Apache-2.0
#include "base/atomic_file.h"

#include <gtest/gtest.h>

#include <atomic>
#include <chrono>
#include <csignal>
#include <cstring>
#include <fcntl.h>
#include <fstream>
#include <sstream>
#include <string>
#include <sys/resource.h>
#include <sys/stat.h>
#include <sys/time.h>
#include <sys/wait.h>
#include <thread>
#include <unistd.h>

namespace obscura {
namespace {

namespace fs = std::filesystem;

std::span<const std::byte> bytes_of(std::string_view text) {
    return std::as_bytes(std::span(text.data(), text.size()));
}

std::string content(const fs::path& file) {
    std::ifstream stream(file, std::ios::binary);
    std::ostringstream out;
    out << stream.rdbuf();
    return out.str();
}

class AtomicFile : public testing::Test {
protected:
    void SetUp() override {
        const auto* info = testing::UnitTest::GetInstance()->current_test_info();
        folder_ = fs::temp_directory_path() /
                  ("obscura_atomic_" + std::to_string(::getpid()) + "_" + info->name());
        fs::remove_all(folder_);
        fs::create_directories(folder_);
    }
    void TearDown() override { fs::remove_all(folder_); }

    size_t files_in_folder() const {
        return static_cast<size_t>(
            std::distance(fs::directory_iterator(folder_), fs::directory_iterator()));
    }

    fs::path folder_;
};

/// Lowers this process's largest file size for as long as it lives.
class FileSizeLimit {
public:
    explicit FileSizeLimit(rlim_t bytes) {
        getrlimit(RLIMIT_FSIZE, &before_);
        rlimit low = before_;
        low.rlim_cur = bytes;
        setrlimit(RLIMIT_FSIZE, &low);
    }
    ~FileSizeLimit() { setrlimit(RLIMIT_FSIZE, &before_); }
    FileSizeLimit(const FileSizeLimit&) = delete;
    FileSizeLimit& operator=(const FileSizeLimit&) = delete;

private:
    rlimit before_ = {};
};

TEST_F(AtomicFile, WritesANewFileAndLeavesNothingElse) {
    const fs::path file = folder_ / "new.bin";
    ASSERT_TRUE(write_file_atomically(file, bytes_of("hello")));
    EXPECT_EQ(content(file), "hello");
    EXPECT_EQ(files_in_folder(), 1U);
}

TEST_F(AtomicFile, WritesAnEmptyFile) {
    ASSERT_TRUE(write_file_atomically(folder_ / "empty", {}));
    EXPECT_EQ(fs::file_size(folder_ / "empty"), 0U);
}

TEST_F(AtomicFile, ReplacesAnExistingFileAndKeepsItsPermissions) {
    const fs::path file = folder_ / "old.bin";
    ASSERT_TRUE(write_file_atomically(file, bytes_of("a longer old content")));
    ASSERT_EQ(::chmod(file.c_str(), 0640), 0);
    ASSERT_TRUE(write_file_atomically(file, bytes_of("new")));
    EXPECT_EQ(content(file), "new");
    EXPECT_EQ(fs::status(file).permissions(), static_cast<fs::perms>(0640));
    EXPECT_EQ(files_in_folder(), 1U);
}

TEST_F(AtomicFile, FollowsASymbolicLink) {
    fs::create_directory(folder_ / "real");
    ASSERT_TRUE(write_file_atomically(folder_ / "real" / "file", bytes_of("old")));
    fs::create_symlink("real/file", folder_ / "link");
    ASSERT_TRUE(write_file_atomically(folder_ / "link", bytes_of("new")));
    EXPECT_TRUE(fs::is_symlink(folder_ / "link"));
    EXPECT_EQ(content(folder_ / "real" / "file"), "new");
}

TEST_F(AtomicFile, WritesIntoTheCurrentFolderWithoutAnyFolderInTheName) {
    const fs::path before = fs::current_path();
    fs::current_path(folder_);
    const Result<void> written = write_file_atomically("plain name % %s\n", bytes_of("x"));
    fs::current_path(before);
    ASSERT_TRUE(written) << written.error().message;
    EXPECT_EQ(content(folder_ / "plain name % %s\n"), "x");
}

TEST_F(AtomicFile, TheLongestAllowedNameWorksAndOneMoreByteIs73) {
    EXPECT_TRUE(write_file_atomically(folder_ / std::string(255, 'n'), bytes_of("x")));
    const Result<void> result =
        write_file_atomically(folder_ / std::string(256, 'n'), bytes_of("x"));
    ASSERT_FALSE(result);
    EXPECT_EQ(result.error().code, ExitCode::cannot_create);
    EXPECT_EQ(result.error().id, "E-OUT-CREATE");
    EXPECT_EQ(files_in_folder(), 1U);
}

TEST_F(AtomicFile, EveryImpossibleTargetIs73BeforeAndWhileWriting) {
    ASSERT_EQ(::mkfifo((folder_ / "pipe").c_str(), 0600), 0);
    const fs::path targets[] = {folder_ / "missing" / "out.exr",
                                folder_,
                                folder_ / "",
                                folder_ / "..",
                                folder_ / "pipe",
                                "/dev/full",
                                "/proc/out.exr",
                                ""};
    for (const fs::path& target : targets) {
        const Result<void> written = write_file_atomically(target, bytes_of("x"));
        const Result<void> checked = check_file_can_be_written(target);
        ASSERT_FALSE(written) << target;
        ASSERT_FALSE(checked) << target;
        EXPECT_EQ(written.error().code, ExitCode::cannot_create) << target;
        EXPECT_EQ(checked.error().code, ExitCode::cannot_create) << target;
        EXPECT_EQ(checked.error().id, "E-OUT-CREATE");
        EXPECT_EQ(checked.error().where, target.string());
        EXPECT_FALSE(checked.error().message.empty());
    }
    EXPECT_EQ(files_in_folder(), 1U);
}

TEST_F(AtomicFile, AWriteProtectedFolderOrFileIs73) {
    ASSERT_TRUE(write_file_atomically(folder_ / "kept", bytes_of("old")));
    ASSERT_EQ(::chmod((folder_ / "kept").c_str(), 0400), 0);
    constexpr uid_t nobody = 65534;  // the superuser could write everywhere
    const bool is_root = ::geteuid() == 0;
    if (is_root) {
        ASSERT_EQ(::chown((folder_ / "kept").c_str(), nobody, nobody), 0);
        ASSERT_EQ(::chown(folder_.c_str(), nobody, nobody), 0);
        ASSERT_EQ(::seteuid(nobody), 0);
    }
    const Result<void> protected_file = write_file_atomically(folder_ / "kept", bytes_of("new"));
    ::chmod(folder_.c_str(), 0500);
    const Result<void> protected_folder = check_file_can_be_written(folder_ / "other");
    ::chmod(folder_.c_str(), 0700);
    ASSERT_EQ(::seteuid(is_root ? 0 : ::geteuid()), 0);
    ASSERT_FALSE(protected_file);
    ASSERT_FALSE(protected_folder);
    EXPECT_EQ(protected_file.error().code, ExitCode::cannot_create);
    EXPECT_EQ(protected_folder.error().code, ExitCode::cannot_create);
    EXPECT_EQ(content(folder_ / "kept"), "old");
}

TEST_F(AtomicFile, TheCheckTouchesNothing) {
    ASSERT_TRUE(check_file_can_be_written(folder_ / "absent"));
    EXPECT_EQ(files_in_folder(), 0U);
    ASSERT_TRUE(write_file_atomically(folder_ / "there", bytes_of("old")));
    ASSERT_TRUE(check_file_can_be_written(folder_ / "there"));
    EXPECT_EQ(content(folder_ / "there"), "old");
    EXPECT_EQ(files_in_folder(), 1U);
}

TEST_F(AtomicFile, BeyondTheFileSizeLimitIs74AndTheOldFileSurvives) {
    const fs::path file = folder_ / "out.exr";
    ASSERT_TRUE(write_file_atomically(file, bytes_of("old")));
    const std::string large(100000, 'x');
    Result<void> result;
    {
        const FileSizeLimit limit(65536);
        result = write_file_atomically(file, bytes_of(large));
    }
    ASSERT_FALSE(result);
    EXPECT_EQ(result.error().code, ExitCode::io_error);
    EXPECT_EQ(result.error().id, "E-OUT-WRITE");
    EXPECT_NE(result.error().message.find(std::strerror(EFBIG)), std::string::npos)
        << result.error().message;
    EXPECT_EQ(content(file), "old");
    EXPECT_EQ(files_in_folder(), 1U);

    sigset_t pending;
    sigpending(&pending);
    EXPECT_FALSE(sigismember(&pending, SIGXFSZ)) << "the held-back signal must not be left over";
    ASSERT_TRUE(write_file_atomically(file, bytes_of(large)));
    EXPECT_EQ(content(file), large);
}

TEST_F(AtomicFile, AFullDeviceIs74) {
    const int full = ::open("/dev/full", O_WRONLY | O_CLOEXEC);
    ASSERT_GE(full, 0);
    const Result<void> result = write_fully(full, bytes_of("x"), "out.png");
    ::close(full);
    ASSERT_FALSE(result);
    EXPECT_EQ(result.error().code, ExitCode::io_error);
    EXPECT_EQ(result.error().id, "E-OUT-WRITE");
    EXPECT_EQ(result.error().where, "out.png");
    EXPECT_NE(result.error().message.find(std::strerror(ENOSPC)), std::string::npos);
}

TEST_F(AtomicFile, SignalsAndShortWritesLoseNoByte) {
    int ends[2];
    ASSERT_EQ(::pipe2(ends, O_CLOEXEC), 0);
    std::string sent(3U << 20, '\0');
    for (size_t i = 0; i < sent.size(); ++i)
        sent[i] = static_cast<char>(i * 31 % 251);

    struct sigaction interrupt = {};
    struct sigaction before = {};
    interrupt.sa_handler = [](int) {};  // without SA_RESTART, so that write() is interrupted
    ASSERT_EQ(::sigaction(SIGALRM, &interrupt, &before), 0);
    std::string received;
    sigset_t alarm;
    sigemptyset(&alarm);
    sigaddset(&alarm, SIGALRM);
    pthread_sigmask(SIG_BLOCK, &alarm, nullptr);
    std::thread reader([&] {
        char part[7001];
        ssize_t count = 0;
        while ((count = ::read(ends[0], part, sizeof part)) > 0) {
            received.append(part, static_cast<size_t>(count));
            ::usleep(200);
        }
    });
    pthread_sigmask(SIG_UNBLOCK, &alarm, nullptr);
    const itimerval often{{0, 500}, {0, 500}};
    const itimerval never{};
    ::setitimer(ITIMER_REAL, &often, nullptr);
    const Result<void> result = write_fully(ends[1], bytes_of(sent), "pipe");
    ::setitimer(ITIMER_REAL, &never, nullptr);
    ::close(ends[1]);
    reader.join();
    ::close(ends[0]);
    ::sigaction(SIGALRM, &before, nullptr);
    ASSERT_TRUE(result) << result.error().message;
    EXPECT_TRUE(received == sent) << received.size() << " of " << sent.size() << " bytes arrived";
}

TEST_F(AtomicFile, AKilledWriterLeavesTheOldOrTheNewFile) {
    const fs::path file = folder_ / "out.bin";
    const std::string old_content(1 << 20, 'o');
    const std::string new_content(1 << 20, 'n');
    ASSERT_TRUE(write_file_atomically(file, bytes_of(old_content)));
    for (useconds_t delay = 0; delay < 4000; delay += 400) {
        const pid_t child = ::fork();
        ASSERT_GE(child, 0);
        if (child == 0) {
            for (;;) {
                if (!write_file_atomically(file, bytes_of(new_content))) ::_exit(1);
                if (!write_file_atomically(file, bytes_of(old_content))) ::_exit(1);
            }
        }
        ::usleep(delay);
        ::kill(child, SIGKILL);
        int status = 0;
        ::waitpid(child, &status, 0);
        ASSERT_TRUE(WIFSIGNALED(status));
        const std::string found = content(file);
        EXPECT_TRUE(found == old_content || found == new_content) << "torn after " << delay;
    }
}

TEST_F(AtomicFile, TwoThreadsWritingOneFileLeaveOneOfTheTwo) {
    const fs::path file = folder_ / "shared.bin";
    const std::string a(300000, 'a');
    const std::string b(200000, 'b');
    std::atomic<int> failures{0};
    const auto write_often = [&](const std::string& text) {
        for (int i = 0; i < 20; ++i) {
            if (!write_file_atomically(file, bytes_of(text))) ++failures;
        }
    };
    std::thread first([&] { write_often(a); });
    write_often(b);
    first.join();
    EXPECT_EQ(failures, 0);
    const std::string found = content(file);
    EXPECT_TRUE(found == a || found == b);
    EXPECT_EQ(files_in_folder(), 1U);
}

TEST_F(AtomicFile, PiecesBecomeOneFile) {
    const fs::path target = folder_ / "pieces";
    const auto two = [](const ByteSink& sink) -> Result<void> {
        if (auto done = sink(bytes_of("one ")); !done) return done;
        return sink(bytes_of("two"));
    };
    ASSERT_TRUE(write_pieces_atomically(target, two));
    EXPECT_EQ(content(target), "one two");
    const auto fails = [](const ByteSink& sink) -> Result<void> {
        if (auto done = sink(bytes_of("half")); !done) return done;
        return fail(ExitCode::internal, "E-TEST", "here", "no more");
    };
    const Result<void> failed = write_pieces_atomically(target, fails);
    ASSERT_FALSE(failed);
    EXPECT_EQ(failed.error().id, "E-TEST");
    EXPECT_EQ(content(target), "one two");
    EXPECT_EQ(files_in_folder(), 1u);
}

TEST_F(AtomicFile, OldTemporariesOfDeadProcessesAreRemoved) {
    const pid_t gone = ::fork();
    if (gone == 0) ::_exit(0);
    ::waitpid(gone, nullptr, 0);
    const std::string dead = std::to_string(gone);
    const std::string alive = std::to_string(::getpid());
    const std::string stale = "a.exr." + dead + ".0.part";
    const std::string young = "a.exr." + dead + ".1.part";
    const auto hours_ago = fs::file_time_type::clock::now() - std::chrono::hours(2);
    for (const std::string& name : {stale,
                                    young,
                                    "a.exr." + alive + ".0.part",
                                    "b.exr." + dead + ".0.part",
                                    "a.exr." + dead + ".0.partial"}) {
        std::ofstream(folder_ / name) << "x";
        if (name != young) fs::last_write_time(folder_ / name, hours_ago);
    }
    remove_stale_temporaries(folder_ / "a.exr");
    EXPECT_FALSE(fs::exists(folder_ / stale));
    EXPECT_TRUE(fs::exists(folder_ / young));  // another machine may be writing it
    EXPECT_EQ(files_in_folder(), 4u);
}

}  // namespace
}  // namespace obscura
