// serve/own_folder.cpp - a temporary folder, removed in the end.
// SPDX-License-Identifier: Apache-2.0
#include "serve/own_folder.h"

#include <cerrno>
#include <cstdlib>
#include <system_error>

namespace obscura::serve {

namespace fs = std::filesystem;

Result<std::unique_ptr<const OwnFolder>> OwnFolder::make(const std::string& purpose) {
    std::error_code error;
    std::string pattern = fs::temp_directory_path(error) / ("obscura-" + purpose + "-XXXXXX");
    if (!error && ::mkdtemp(pattern.data()) == nullptr)
        error = std::error_code(errno, std::generic_category());
    const fs::path path = error ? fs::path() : fs::canonical(pattern, error);
    if (error) return fail(ExitCode::io_error, "E-OUT-WRITE", pattern, error.message());
    return std::unique_ptr<const OwnFolder>(new OwnFolder(path));
}

OwnFolder::~OwnFolder() {
    std::error_code ignored;
    fs::remove_all(path_, ignored);
}

}  // namespace obscura::serve
