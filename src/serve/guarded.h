// serve/guarded.h - exceptions become errors, where a thread must not end by them.
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "base/error.h"

#include <exception>
#include <new>

namespace obscura::serve {

/// What `body` returns.
///
/// Errors  33 E-MEM, 70 E-INTERNAL for its exceptions
template <typename T, typename Body>
Result<T> guarded(const Body& body) {
    try {
        return body();
    } catch (const std::bad_alloc&) {
        return fail(ExitCode::out_of_memory, "E-MEM", "render", "out of memory");
    } catch (const std::exception& error) {
        return fail(ExitCode::internal, "E-INTERNAL", "render", error.what());
    }
}

}  // namespace obscura::serve
