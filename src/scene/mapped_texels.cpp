// scene/mapped_texels.cpp - texels that lie in files and come into memory where rays look at them.
// SPDX-License-Identifier: Apache-2.0
#include "scene/mapped_texels.h"

#include <cerrno>
#include <chrono>
#include <cstring>
#include <fcntl.h>
#include <fstream>
#include <sys/mman.h>
#include <unistd.h>

namespace obscura {

namespace {

uint64_t page_size() {
    return static_cast<uint64_t>(sysconf(_SC_PAGESIZE));
}

size_t bytes_of(size_t texels) {
    return texels * sizeof(uint32_t);
}

/// Bytes of files that are in the process's memory; 0 where the system does not tell.
uint64_t resident_file_bytes() {
    std::ifstream statm("/proc/self/statm");
    uint64_t all = 0;
    uint64_t resident = 0;
    uint64_t of_files = 0;
    statm >> all >> resident >> of_files;
    return statm ? of_files * page_size() : 0;
}

tl::unexpected<Error> no_room(size_t bytes) {
    return fail(ExitCode::out_of_memory,
                "E-MEMORY",
                "textures",
                std::to_string(bytes) + " bytes of addresses cannot be had: " + strerror(errno));
}

}  // namespace

Result<std::shared_ptr<MappedTexels>> MappedTexels::reserve(size_t texels, uint64_t max_bytes) {
    constexpr int flags = MAP_PRIVATE | MAP_ANONYMOUS | MAP_NORESERVE;
    void* const memory = mmap(nullptr, bytes_of(texels), PROT_NONE, flags, -1, 0);
    if (memory == MAP_FAILED) return no_room(bytes_of(texels));
    return std::shared_ptr<MappedTexels>(new MappedTexels(memory, texels, max_bytes));
}

MappedTexels::MappedTexels(void* memory, size_t texels, uint64_t max_bytes)
    : memory_(memory),
      texels_(texels),
      max_bytes_(max_bytes),
      other_bytes_(resident_file_bytes()),
      keeper_([this] { keep_small(); }) {}

MappedTexels::~MappedTexels() {
    {
        const std::lock_guard lock(mutex_);
        is_over_ = true;
    }
    ended_.notify_all();
    keeper_.join();
    munmap(memory_, bytes_of(texels_));
}

Result<void> MappedTexels::map(size_t first,
                               size_t texels,
                               const std::filesystem::path& file,
                               uint64_t file_offset) {
    const int descriptor = open(file.c_str(), O_RDONLY | O_CLOEXEC);
    if (descriptor < 0) {
        return fail(ExitCode::bad_resource,
                    "E-RES-MISSING",
                    file.string(),
                    std::string("the file cannot be opened: ") + strerror(errno));
    }
    void* const at = static_cast<uint32_t*>(memory_) + first;
    const void* const got = mmap(at,
                                 bytes_of(texels),
                                 PROT_READ,
                                 MAP_SHARED | MAP_FIXED,
                                 descriptor,
                                 static_cast<off_t>(file_offset));
    close(descriptor);
    if (got == MAP_FAILED) return no_room(bytes_of(texels));
    const std::lock_guard lock(mutex_);
    files_.push_back({first, texels});
    return {};
}

Result<uint32_t*> MappedTexels::memory(size_t first, size_t texels) {
    constexpr int flags = MAP_PRIVATE | MAP_ANONYMOUS | MAP_FIXED;
    void* const at = static_cast<uint32_t*>(memory_) + first;
    void* const got = mmap(at, bytes_of(texels), PROT_READ | PROT_WRITE, flags, -1, 0);
    if (got == MAP_FAILED) return no_room(bytes_of(texels));
    return static_cast<uint32_t*>(got);
}

/// Gives pages back while there are too many.
void MappedTexels::keep_small() {
    constexpr auto pause = std::chrono::milliseconds(20);
    std::unique_lock lock(mutex_);
    while (!ended_.wait_for(lock, pause, [&] { return is_over_; })) {
        if (resident_file_bytes() <= other_bytes_ + max_bytes_) continue;
        for (const Range& range : files_) {  // memory() would become zeros
            void* const at = static_cast<uint32_t*>(memory_) + range.first;
            madvise(at, bytes_of(range.texels), MADV_DONTNEED);
        }
    }
}

}  // namespace obscura
