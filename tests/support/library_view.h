// tests/support/library_view.h - a small view of the library, for tests that embed it.
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <obscura/obscura.h>

namespace obscura {

inline View small_view() {
    View view;
    view.width = 40;
    view.height = 24;
    return view;
}

}  // namespace obscura
