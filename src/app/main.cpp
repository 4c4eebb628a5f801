// app/main.cpp - starts the program and turns uncaught exceptions into an exit code.
// SPDX-License-Identifier: Apache-2.0
#include "app/program.h"

#include <cstdio>
#include <exception>
#include <new>

int main(int argc, char** argv) {
    try {
        return obscura::app::run_program(argc, argv);
    } catch (const std::bad_alloc&) {
        std::fputs(
            "ERROR out of memory: the system gives no more; a higher limit (ulimit -v, the "
            "container's), a smaller --size or smaller textures help\n"
            "RESULT code=33 id=E-MEM where=- warnings=0\n",
            stderr);
        return 33;
    } catch (const std::exception& error) {
        std::fprintf(stderr, "ERROR internal error: %s\n", error.what());
    } catch (...) {
        std::fputs("ERROR internal error of unknown kind\n", stderr);
    }
    std::fputs("RESULT code=70 id=E-INTERNAL where=- warnings=0\n", stderr);
    return 70;
}
