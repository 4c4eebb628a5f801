// app/main.cpp - starts the program and turns uncaught exceptions into an exit code.
// SPDX-License-Identifier: Apache-2.0
#include "app/program.h"

#include <cstdio>
#include <exception>
#include <new>
#include <system_error>

namespace {

int report_no_memory() {
    std::fputs(
        "ERROR out of memory: the system gives no more; a higher limit (ulimit -v, the "
        "container's), a smaller --size or smaller textures help\n"
        "RESULT code=33 id=E-MEM where=- warnings=0\n",
        stderr);
    return 33;
}

/// Threads that have no room for their stacks cannot start.
bool is_lack_of_memory(const std::exception& error) {
    const auto* system = dynamic_cast<const std::system_error*>(&error);
    return system != nullptr && (system->code() == std::errc::resource_unavailable_try_again ||
                                 system->code() == std::errc::not_enough_memory);
}

}  // namespace

int main(int argc, char** argv) {
    try {
        return obscura::app::run_program(argc, argv);
    } catch (const std::bad_alloc&) {
        return report_no_memory();
    } catch (const std::exception& error) {
        if (is_lack_of_memory(error)) return report_no_memory();
        std::fprintf(stderr, "ERROR internal error: %s\n", error.what());
    } catch (...) {
        std::fputs("ERROR internal error of unknown kind\n", stderr);
    }
    std::fputs("RESULT code=70 id=E-INTERNAL where=- warnings=0\n", stderr);
    return 70;
}
