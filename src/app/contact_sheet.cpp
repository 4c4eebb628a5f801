// app/contact_sheet.cpp - an HTML page of a job's images, made of its manifest.
// SPDX-License-Identifier: Apache-2.0
#include "app/contact_sheet.h"

#include "base/atomic_file.h"
#include "base/json/json.h"
#include "base/xml_text.h"
#include "image/output_format.h"

#include <algorithm>
#include <fstream>
#include <istream>
#include <span>
#include <string>
#include <string_view>
#include <system_error>
#include <utility>
#include <vector>

namespace obscura::app {

namespace {

constexpr std::string_view head = R"(<!DOCTYPE html>
<html lang="en">
<head>
<meta charset="utf-8">
<meta name="viewport" content="width=device-width, initial-scale=1">
<title>Contact sheet</title>
<style>
body { font: 14px/1.4 sans-serif; margin: 1em; color: #222; background: #fff; }
h2 { font-size: 1.1em; margin: 1.5em 0 .5em; }
div { display: flex; flex-wrap: wrap; gap: .75em; }
figure { margin: 0; width: 12em; }
img, figure > span { width: 100%; height: 9em; object-fit: contain; background: #eee; }
figure > span { display: block; color: #900; overflow: auto; }
figcaption { overflow-wrap: anywhere; }
</style>
</head>
<body>
)";

/// A path as the reference of a page: what stands for itself there, all else as %XX.
std::string reference(const std::filesystem::path& file) {
    constexpr std::string_view plain =
        "ABCDEFGHIJKLMNOPQRSTUVWXYZabcdefghijklmnopqrstuvwxyz0123456789-_.~/";
    constexpr std::string_view hex = "0123456789ABCDEF";
    std::string out;
    for (const char c : file.generic_string()) {
        const auto code = static_cast<unsigned char>(c);
        if (plain.find(c) != std::string_view::npos) {
            out += c;
        } else {
            out += '%';
            out += hex[code >> 4];
            out += hex[code & 15];
        }
    }
    return out;
}

/// True for pictures that browsers show.
///
/// In      file: of a manifest's line
bool is_shown(const Json& file) {
    if (file.value("mask", false)) return false;
    const auto format = output_format_of(file.value("file", ""));
    return format && *format != OutputFormat::exr && *format != OutputFormat::tiff;
}

/// "white, red, front, 7": what tells an image from others of its asset.
std::string caption_of(const Json& line) {
    std::string out;
    for (const char* member : {"look", "variant", "view", "frame"}) {
        const auto value = line.find(member);
        if (value == line.end() || value->is_null() || *value == "default") continue;
        out += (out.empty() ? "" : ", ") +
               (value->is_string() ? value->get<std::string>() : value->dump());
    }
    return out;
}

std::string figure_of(const Json& line, const std::filesystem::path& folder) {
    std::string out = "<figure>";
    std::string shown;
    std::error_code error;
    for (const Json& file : line.value("files", Json::array())) {
        const std::filesystem::path path =
            std::filesystem::absolute(file.value("file", ""), error).lexically_normal();
        if (shown.empty() && is_shown(file)) shown = reference(path.lexically_proximate(folder));
    }
    const std::string caption = escape_xml(caption_of(line));
    if (!shown.empty()) {
        out += "<a href=\"" + shown + "\"><img loading=\"lazy\" src=\"" + shown + "\" alt=\"" +
               caption + "\"></a>";
    } else {
        out += "<span>" + escape_xml(line.value("message", "no file that a browser shows")) +
               "</span>";
    }
    return out + "<figcaption>" + caption + "</figcaption></figure>\n";
}

/// What is to be seen, without the files: a picture takes the place of its failure.
std::string subject_of(const Json& line) {
    std::string out;
    for (const char* member : {"asset", "look", "variant", "view", "frame"})
        out += line.value(member, Json()).dump() + "\n";
    return out;
}

std::string first_file(const Json& line) {
    const Json files = line.value("files", Json::array());
    return files.empty() ? "" : files.front().value("file", "");
}

/// The lines of each asset; of several of one picture the last one, in the place of the first.
std::vector<std::pair<std::string, std::vector<Json>>> lines_by_asset(std::istream& in) {
    std::vector<std::pair<std::string, std::vector<Json>>> out;
    for (std::string text; std::getline(in, text);) {
        const Json line = Json::parse(text, nullptr, false);
        if (!line.is_object()) continue;  // cut off by a kill
        const std::string asset = line.value("asset", "");
        auto found = std::find_if(
            out.begin(), out.end(), [&](const auto& entry) { return entry.first == asset; });
        if (found == out.end()) found = out.insert(out.end(), {asset, {}});
        std::vector<Json>& lines = found->second;
        const auto same = std::find_if(lines.begin(), lines.end(), [&](const Json& other) {
            const std::string file = first_file(other);
            return subject_of(other) == subject_of(line) &&
                   (file.empty() || file == first_file(line));
        });
        if (same == lines.end()) {
            lines.push_back(line);
        } else {
            *same = line;
        }
    }
    return out;
}

}  // namespace

Result<void> write_contact_sheet(const std::filesystem::path& manifest,
                                 const std::filesystem::path& page) {
    std::ifstream in(manifest);
    if (!in) return fail(ExitCode::io_error, "E-OUT-WRITE", manifest.string(), "cannot be read");
    std::error_code error;
    const std::filesystem::path folder =
        std::filesystem::absolute(page, error).lexically_normal().parent_path();
    std::string html(head);
    for (const auto& [asset, lines] : lines_by_asset(in)) {
        html += "<h2>" + escape_xml(asset) + "</h2>\n<div>\n";
        for (const Json& line : lines)
            html += figure_of(line, folder);
        html += "</div>\n";
    }
    html += "</body>\n</html>\n";
    return write_file_atomically(page, std::as_bytes(std::span(html)));
}

}  // namespace obscura::app
