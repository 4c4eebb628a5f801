// image/corrupt.h - the errors for image files whose content cannot be used.
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "base/error.h"

#include <string>

namespace obscura {

/// 67 E-IMG-CORRUPT: a texture's image.
inline tl::unexpected<Error> corrupt_image(const std::string& where, const std::string& why) {
    return fail(ExitCode::bad_resource, "E-IMG-CORRUPT", where, why);
}

/// 67 E-ENV-CORRUPT: an environment.
inline tl::unexpected<Error> corrupt_environment(const std::string& where, const std::string& why) {
    return fail(ExitCode::bad_resource, "E-ENV-CORRUPT", where, why);
}

}  // namespace obscura
