// tests/base/work_lock_test.cpp - locks are held once, and stale ones are taken over.
// SPDX-License-Identifier: Apache-2.0
#include "base/work_lock.h"

#include <gtest/gtest.h>

#include "support/run_program.h"
#include "support/temp_folder.h"
#include "support/text_files.h"
#include <algorithm>
#include <chrono>
#include <cstdlib>
#include <fcntl.h>
#include <future>
#include <sys/stat.h>
#include <sys/wait.h>
#include <thread>
#include <unistd.h>

namespace obscura {
namespace {

class WorkLocks : public testing::Test {
protected:
    std::filesystem::path file() const { return folder_ / "a.exr.lock"; }
    bool exists() const { return std::filesystem::exists(file()); }

    /// Null: another holds it.
    std::unique_ptr<WorkLock> take() const {
        Result<std::unique_ptr<WorkLock>> lock = WorkLock::take(file());
        EXPECT_TRUE(lock);
        return lock ? std::move(*lock) : nullptr;
    }
    void leave(const LockHolder& holder) const { folder_.write("a.exr.lock", lock_text(holder)); }
    void age(double seconds) const {
        struct stat status = {};
        ASSERT_EQ(stat(file().c_str(), &status), 0);
        const timespec then = {status.st_mtim.tv_sec - static_cast<time_t>(seconds), 0};
        const timespec times[2] = {then, then};
        ASSERT_EQ(utimensat(AT_FDCWD, file().c_str(), times, 0), 0);
    }

    TempFolder folder_;
};

const LockHolder elsewhere = {"elsewhere", "pid:[1]", 7, "2026-01-01T00:00:00Z"};

constexpr const char* file_of_child = "OBSCURA_TEST_LOCK";
constexpr const char* end_of_child = "OBSCURA_TEST_END";  ///< a file: the holder may end
constexpr int code_of_holder = 42;

/// The number of a process that has ended.
int64_t ended_process() {
    const pid_t child = fork();
    if (child == 0) _exit(0);
    waitpid(child, nullptr, 0);
    return child;
}

TEST_F(WorkLocks, SayWhoHoldsThemAndGoWithTheirHolder) {
    {
        const auto lock = take();
        ASSERT_TRUE(lock);
        EXPECT_EQ(lock->taken_from(), "");
        const LockHolder holder = parse_lock(read_text(file()));
        EXPECT_EQ(holder.process, getpid());
        EXPECT_EQ(holder.host, this_process().host);
        EXPECT_EQ(holder.since.size(), 20U);
        lock->release();
        EXPECT_FALSE(exists());
        lock->release();
    }
    EXPECT_TRUE(take());
    EXPECT_FALSE(exists());
}

TEST_F(WorkLocks, OfALivingProcessAreHeeded) {
    LockHolder parent = this_process();
    parent.process = getppid();
    leave(parent);
    EXPECT_FALSE(take());
    EXPECT_EQ(read_text(file()), lock_text(parent));
    age(59);
    EXPECT_FALSE(take());
    for (const auto& entry : std::filesystem::directory_iterator(folder_.path()))
        EXPECT_EQ(entry.path(), file());
}

TEST_F(WorkLocks, OfADeadProcessOfThisMachineAreTakenOverAtOnce) {
    LockHolder dead = this_process();
    dead.process = ended_process();
    leave(dead);
    const auto lock = take();
    ASSERT_TRUE(lock);
    EXPECT_NE(lock->taken_from().find("process " + std::to_string(dead.process)),
              std::string::npos);
    EXPECT_EQ(parse_lock(read_text(file())).process, getpid());
    // The same number elsewhere, or in another container, may live.
    lock->release();
    dead.process_space = "pid:[1]";
    leave(dead);
    EXPECT_FALSE(take());
}

TEST_F(WorkLocks, OfOtherMachinesAreStaleWhenNobodyTouchesThem) {
    leave(elsewhere);
    EXPECT_FALSE(take());
    age(lock_stale_after_s + 2);
    const auto lock = take();
    ASSERT_TRUE(lock);
    EXPECT_EQ(lock->taken_from(), "elsewhere, process 7, since 2026-01-01T00:00:00Z");
    folder_.write("a.exr.lock", "");
    EXPECT_FALSE(take()) << "its holder has not said yet who it is";
}

TEST_F(WorkLocks, AreNotRemovedOnceTheyAreAnothers) {
    const auto lock = take();
    ASSERT_TRUE(lock);
    leave(elsewhere);
    lock->release();
    EXPECT_TRUE(exists());
}

TEST_F(WorkLocks, OfManyThatTakeOverOneGetsIt) {
    LockHolder dead = this_process();
    dead.process = ended_process();
    leave(dead);
    ProgramSetup setup;
    setup.arguments = {std::filesystem::read_symlink("/proc/self/exe").string(),
                       "--gtest_also_run_disabled_tests",
                       "--gtest_filter=WorkLockChild.*"};
    const std::filesystem::path end = folder_ / "end";
    setup.environment = {std::string(file_of_child) + "=" + file().string(),
                         std::string(end_of_child) + "=" + end.string()};
    std::vector<std::future<ProgramRun>> children;
    for (int i = 0; i < 6; ++i) {
        children.push_back(std::async(std::launch::async, [&] { return run_program_with(setup); }));
    }
    const auto has_ended = [](const std::future<ProgramRun>& child) {
        return child.wait_for(std::chrono::seconds(0)) == std::future_status::ready;
    };
    // The holder stays until all others have looked: nobody may find its lock stale. Two holders
    // would stay until they are killed.
    while (std::count_if(children.begin(), children.end(), has_ended) + 1 < 6)
        std::this_thread::sleep_for(std::chrono::milliseconds(10));
    folder_.write("end", "");
    int holders = 0;
    for (std::future<ProgramRun>& child : children) {
        const int code = child.get().code;
        EXPECT_TRUE(code == 0 || code == code_of_holder) << code;
        holders += code == code_of_holder ? 1 : 0;
    }
    EXPECT_EQ(holders, 1);
}

/// What a process of the test above does: one that begins anew, as a fork may take over locks.
TEST(WorkLockChild, DISABLED_TakesAndHolds) {
    const char* const file = std::getenv(file_of_child);
    const char* const end = std::getenv(end_of_child);
    ASSERT_TRUE(file != nullptr && end != nullptr);
    const Result<std::unique_ptr<WorkLock>> lock = WorkLock::take(file);
    if (!lock || !*lock) return;
    while (!std::filesystem::exists(end))
        std::this_thread::sleep_for(std::chrono::milliseconds(10));
    std::quick_exit(code_of_holder);
}

TEST_F(WorkLocks, ThatCannotBeMadeAreAnError) {
    const auto lock = WorkLock::take(folder_ / "absent" / "a.lock");
    ASSERT_FALSE(lock);
    EXPECT_EQ(lock.error().id, "E-OUT-CREATE");
}

}  // namespace
}  // namespace obscura
