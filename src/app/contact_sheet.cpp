// app/contact_sheet.cpp - an HTML page of a job's images, made of its manifest.
// SPDX-License-Identifier: Apache-2.0
#include "app/contact_sheet.h"

#include "base/atomic_file.h"
#include "base/json/json.h"
#include "image/output_format.h"

#include <fstream>
#include <span>
#include <string>
#include <string_view>
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

std::string escaped(std::string_view text) {
    std::string out;
    for (const char c : text) {
        switch (c) {
            case '&':
                out += "&amp;";
                break;
            case '<':
                out += "&lt;";
                break;
            case '>':
                out += "&gt;";
                break;
            case '"':
                out += "&quot;";
                break;
            default:
                out += c;
        }
    }
    return out;
}

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

/// True for files that browsers show.
bool is_shown(const std::filesystem::path& file) {
    const auto format = output_format_of(file);
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
    for (const Json& file : line.value("files", Json::array())) {
        const std::filesystem::path path = file.value("file", "");
        if (shown.empty() && is_shown(path)) shown = reference(path.lexically_proximate(folder));
    }
    const std::string caption = escaped(caption_of(line));
    if (!shown.empty()) {
        out += "<a href=\"" + shown + "\"><img loading=\"lazy\" src=\"" + shown + "\" alt=\"" +
               caption + "\"></a>";
    } else {
        out +=
            "<span>" + escaped(line.value("message", "no file that a browser shows")) + "</span>";
    }
    return out + "<figcaption>" + caption + "</figcaption></figure>\n";
}

}  // namespace

Result<void> write_contact_sheet(const std::filesystem::path& manifest,
                                 const std::filesystem::path& page) {
    std::ifstream in(manifest);
    if (!in) return fail(ExitCode::io_error, "E-OUT-WRITE", manifest.string(), "cannot be read");
    std::error_code error;
    const std::filesystem::path folder =
        std::filesystem::absolute(page, error).lexically_normal().parent_path();
    std::string html(head), asset;
    bool is_open = false;
    for (std::string text; std::getline(in, text);) {
        const Json line = Json::parse(text, nullptr, false);
        if (!line.is_object()) continue;  // cut off by a kill
        const std::string name = line.value("asset", "");
        if (!is_open || name != asset) {
            html +=
                std::string(is_open ? "</div>\n" : "") + "<h2>" + escaped(name) + "</h2>\n<div>\n";
            asset = name;
            is_open = true;
        }
        Json full = line;
        for (Json& file : full["files"]) {
            const std::filesystem::path path = file.value("file", "");
            file["file"] = std::filesystem::absolute(path, error).lexically_normal().string();
        }
        html += figure_of(full, folder);
    }
    html += std::string(is_open ? "</div>\n" : "") + "</body>\n</html>\n";
    return write_file_atomically(page, std::as_bytes(std::span(html)));
}

}  // namespace obscura::app
