// serve/own_folder.h - a temporary folder, removed in the end.
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "base/error.h"

#include <filesystem>
#include <memory>
#include <string>

namespace obscura::serve {

/// A folder of its own for temporary files, removed with all that is in it.
class OwnFolder {
public:
    /// In      purpose: a word of its name: "uploads"
    /// Errors  74 E-OUT-WRITE
    static Result<std::unique_ptr<const OwnFolder>> make(const std::string& purpose);
    ~OwnFolder();
    OwnFolder(const OwnFolder&) = delete;
    OwnFolder& operator=(const OwnFolder&) = delete;

    /// Without links in it.
    const std::filesystem::path& path() const { return path_; }

private:
    explicit OwnFolder(std::filesystem::path path) : path_(std::move(path)) {}

    const std::filesystem::path path_;
};

}  // namespace obscura::serve
