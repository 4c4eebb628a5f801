// image/exr_guard.h - turns what OpenEXR throws while a file is read into errors.
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "base/error.h"

#include <exception>
#include <new>
#include <string>

namespace obscura {

/// 65 E-EXR-CORRUPT
inline tl::unexpected<Error> damaged_exr(const std::string& where, const std::string& why) {
    return fail(ExitCode::bad_data, "E-EXR-CORRUPT", where, why);
}

/// What `read` returns.
///
/// Errors  65 E-EXR-CORRUPT; 33 E-EXR-MEMORY
template <typename Read>
auto guarded_exr(const std::string& where, const Read& read) -> decltype(read()) {
    try {
        return read();
    } catch (const std::bad_alloc&) {
        return fail(ExitCode::out_of_memory, "E-EXR-MEMORY", where, "no memory for its pixels");
    } catch (const std::exception& error) {
        return damaged_exr(where, error.what());
    }
}

}  // namespace obscura
