// base/json/json_file.cpp - reads JSON files of people's own: views, cameras, jobs.
// SPDX-License-Identifier: Apache-2.0
#include "base/json/json_file.h"

#include "base/file_bytes.h"
#include "base/json/json_text.h"

#include <algorithm>
#include <string>

namespace obscura {

Result<nlohmann::json> read_json_file(const std::filesystem::path& file,
                                      uint64_t max_bytes,
                                      Error missing,
                                      Log& log) {
    const FileBytes read = read_file_bytes(file, {max_bytes, UINT64_MAX});
    if (read.fault != FileFault::none) {
        missing.message += " cannot be read: " + read.reason;
        return fail(std::move(missing));
    }
    const std::string_view text(reinterpret_cast<const char*>(read.bytes.data()),
                                read.bytes.size());
    return parse_json_text(text, file.string(), log);
}

bool is_whole_json(const std::filesystem::path& file) {
    const FileBytes read = read_file_bytes(file, {});
    const auto* const text = reinterpret_cast<const char*>(read.bytes.data());
    return read.fault == FileFault::none && nlohmann::json::accept(text, text + read.bytes.size());
}

void check_known_keys(const JsonReader& reader,
                      std::span<const std::string_view> known,
                      const char* id) {
    reader.each_key([&](const std::string& key) {
        if (std::find(known.begin(), known.end(), key) != known.end()) return;
        std::string names;
        for (const std::string_view name : known)
            names += (names.empty() ? "" : ", ") + std::string(name);
        reader.fault(key, id, "there is no such key; expected one of: " + names);
    });
}

}  // namespace obscura
