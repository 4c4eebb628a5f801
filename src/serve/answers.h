// serve/answers.h - what the server says, as JSON.
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "base/json/json.h"

#include "serve/viewer.h"
#include <filesystem>
#include <string>
#include <vector>

namespace obscura::serve {

/// The HTTP status that fits an error best.
int http_status_of(const Error& error);

/// The same in few words, for clients that tell only success, their own faults and the server's.
int simple_status_of(const Error& error);

/// Puts the name that the client knows a file by in place of its path.
void replace_path(std::string& text, const std::filesystem::path& file, const std::string& name);

/// The same in all that an error says.
Error with_name(Error error, const std::filesystem::path& file, const std::string& name);

/// A line for each error, "E-... place: text", as people read it; cut off before it is a page.
std::string error_text(const Error& error);

/// {"error": {"id", "place", "text", "code", "also"}}; settings have their plain names.
Json error_answer(const Error& error);

/// What there is to choose from in an asset, and its bounds.
Json asset_answer(const Scene& scene, const std::vector<std::string>& warnings);

Json camera_answer(const LookAt& camera);

Json pick_answer(const Pick& pick);

}  // namespace obscura::serve
