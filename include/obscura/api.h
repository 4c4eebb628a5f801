// include/obscura/api.h - what every header begins with: visibility and the namespace.
// SPDX-License-Identifier: Apache-2.0
#pragma once

#if defined(__GNUC__)
#define OBSCURA_API __attribute__((visibility("default")))
#else
#define OBSCURA_API
#endif

/// All names lie in obscura::v0, which users write as obscura. While the library itself is compiled
/// they are not mixed with its own of the same name.
#ifdef OBSCURA_BUILDS_LIBRARY
#define OBSCURA_BEGIN_API \
    namespace obscura {   \
    namespace v0 {
#else
#define OBSCURA_BEGIN_API \
    namespace obscura {   \
    inline namespace v0 {
#endif
#define OBSCURA_END_API \
    }                   \
    }

OBSCURA_BEGIN_API

/// "0.1.0" of the library that runs.
OBSCURA_API const char* version() noexcept;

OBSCURA_END_API
