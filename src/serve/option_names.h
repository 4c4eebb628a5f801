// serve/option_names.h - the options of `obscura render` that clients may give.
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string_view>

namespace obscura::serve {

/// Options of a view, by their names without dashes. Those that name files would let a client
/// read or write any; `env` is the one whose files are found below the roots.
///
/// To add one: make sure that no value of it is the name of a file, and append it to the list that
/// fits in option_names.cpp.
bool is_view_option(std::string_view name);

/// These, and those of many pictures and of their files.
bool is_job_option(std::string_view name);

}  // namespace obscura::serve
