// image/oiio.cpp - opens the module with OpenImageIO when an image first needs it.
// SPDX-License-Identifier: Apache-2.0
#include "image/oiio.h"

#include "base/memory_limit.h"
#include "image/process_settings.h"

#include <algorithm>
#include <dlfcn.h>
#include <filesystem>
#include <mutex>
#include <string_view>
#include <sys/resource.h>
#include <system_error>
#include <thread>
#include <vector>

namespace obscura {

namespace {

namespace fs = std::filesystem;

/// Addresses that the libraries take when they are opened, with the stacks of threads that some of
/// them start. They end the process, or wait for good, where such a thread has no stack.
uint64_t addresses_of_libraries() {
    constexpr uint64_t mebibyte = uint64_t{1} << 20;
    constexpr uint64_t threads = 4;
    constexpr uint64_t usual_stack = 8 * mebibyte;
    rlimit stack = {};
    const bool is_known = ::getrlimit(RLIMIT_STACK, &stack) == 0 && stack.rlim_cur != RLIM_INFINITY;
    const uint64_t more =
        is_known ? std::max<uint64_t>(stack.rlim_cur, usual_stack) - usual_stack : 0;
    return 480 * mebibyte + threads * std::min(more, UINT64_MAX / (2 * threads));
}

tl::unexpected<Error> cannot_open(const std::string& why) {
    return fail(ExitCode::unsupported,
                "E-OIIO",
                OBSCURA_OIIO_MODULE,
                "the module with OpenImageIO, which textures in PNG and JPEG, Radiance HDR and "
                "writing JPEG, TIFF and AVIF need, cannot be opened: " +
                    why + "; install it beside the program, and the package of OpenImageIO");
}

/// The program or library that this function is part of; "": the system does not tell.
fs::path own_file() {
    std::error_code error;
    Dl_info found = {};
    const auto* const here = reinterpret_cast<const void*>(&own_file);
    if (::dladdr(here, &found) != 0 && found.dli_fname != nullptr) {
        const fs::path file = fs::weakly_canonical(found.dli_fname, error);
        // Of the program itself it tells only how it was called.
        if (file.filename().string().find(".so") != std::string::npos) return file;
    }
    fs::path program = fs::read_symlink("/proc/self/exe", error);
    if (!program.empty()) return program;
    return found.dli_fname != nullptr ? fs::weakly_canonical(found.dli_fname, error) : fs::path();
}

/// Beside libobscura.so, or below a program's sibling folder of libraries.
std::vector<fs::path> candidates() {
    const fs::path folder = own_file().parent_path();
    const fs::path name = fs::path("obscura") / OBSCURA_OIIO_MODULE;
    return {
        folder / name, folder / OBSCURA_LIBRARIES_FROM_PROGRAMS / name, folder / "../lib" / name};
}

Result<const OiioModule*> open_module() {
    const Result<void> fits =
        check_address_space(address_space_left(),
                            addresses_of_libraries(),
                            "OpenImageIO, for textures in PNG and JPEG, Radiance HDR, "
                            "and writing JPEG, TIFF and AVIF");
    if (!fits) return fail(fits.error());
    std::string why = "it is not there";
    for (const fs::path& file : candidates()) {
        std::error_code error;
        if (!fs::exists(file, error)) continue;
        // Its symbols are for nobody else, and those of its libraries are looked up when called.
        void* const library = ::dlopen(file.c_str(), RTLD_LAZY | RTLD_LOCAL);
        if (library == nullptr) {
            why = ::dlerror();
            continue;
        }
        using Entry = const OiioModule* (*)();
        const auto entry = reinterpret_cast<Entry>(::dlsym(library, oiio_module_symbol));
        const OiioModule* const module = entry != nullptr ? entry() : nullptr;
        if (module == nullptr || std::string_view(module->version) != OBSCURA_VERSION) {
            why = file.string() + " is not of version " OBSCURA_VERSION;
            continue;
        }
        if (owns_process_settings()) module->own_process();
        return module;
    }
    return cannot_open(why);
}

/// At the end of a process that ends by exit, it is waited for.
std::jthread& opening_thread() {
    static std::jthread thread;
    return thread;
}

}  // namespace

const Result<const OiioModule*>& oiio_module() {
    static const Result<const OiioModule*> opened = open_module();
    return opened;
}

void open_oiio_ahead() {
    // Where addresses are limited, others that start as well might take them after the check.
    if (address_space_left() != UINT64_MAX) return;
    try {
        static std::once_flag begun;
        std::call_once(begun, [] { opening_thread() = std::jthread([] { (void)oiio_module(); }); });
    } catch (const std::system_error&) {  // no more threads: it is opened when it is needed
    }
}

void wait_for_oiio() {
    if (opening_thread().joinable()) opening_thread().join();
}

bool is_written_by_oiio(OutputFormat format) {
    return format != OutputFormat::exr && format != OutputFormat::png &&
           format != OutputFormat::webp;
}

}  // namespace obscura
