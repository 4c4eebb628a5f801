// base/log.cpp - collects warnings and notes, and hands them to a sink.
// SPDX-License-Identifier: Apache-2.0
#include "base/log.h"

namespace obscura {

namespace {

/// Length in bytes of the well-formed UTF-8 sequence at `text[0]`, 0 if there is none.
size_t utf8_length(std::string_view text) {
    const auto byte = [&](size_t i) { return static_cast<unsigned char>(text[i]); };
    const unsigned char first = byte(0);
    if (first < 0x80) return 1;
    const size_t length = first >= 0xF0 && first <= 0xF4 ? 4 : first >= 0xE0 ? 3 : 2;
    if (first < 0xC2 || first > 0xF4 || text.size() < length) return 0;
    for (size_t i = 1; i < length; ++i) {
        if ((byte(i) & 0xC0) != 0x80) return 0;
    }
    return length;
}

}  // namespace

std::string escape_control(std::string_view text) {
    static constexpr char hex[] = "0123456789abcdef";
    std::string out;
    out.reserve(text.size());
    while (!text.empty()) {
        const unsigned char first = static_cast<unsigned char>(text[0]);
        const size_t length = utf8_length(text);
        const bool c1_control =
            length == 2 && first == 0xC2 && static_cast<unsigned char>(text[1]) < 0xA0;
        if (length == 0 || first < 0x20 || first == 0x7F || c1_control) {
            out += "\\x";
            out += hex[first >> 4];
            out += hex[first & 15];
            text.remove_prefix(1);
        } else {
            out += text.substr(0, length);
            text.remove_prefix(length);
        }
    }
    return out;
}

std::string Log::shown(std::string_view text) const {
    return escape_control(spell_settings(text, names_));
}

void Log::warn(std::string_view where, std::string_view text) {
    const std::string place = shown(where);
    const std::string sentence = shown(text);
    const std::lock_guard lock(mutex_);
    warnings_.push_back(place + ": " + sentence);
    if (sink_ && verbosity_ != Verbosity::quiet) sink_({true, place, sentence});
}

void Log::warn_again(std::string_view where, std::string_view text) {
    const std::lock_guard lock(mutex_);
    warnings_.push_back(shown(where) + ": " + shown(text));
}

void Log::info(std::string_view text) {
    if (!sink_ || verbosity_ == Verbosity::quiet) return;
    const std::string sentence = shown(text);
    const std::lock_guard lock(mutex_);
    sink_({false, {}, sentence});
}

void Log::detail(std::string_view text) {
    if (verbosity_ == Verbosity::verbose) info(text);
}

std::vector<std::string> Log::warnings() const {
    const std::lock_guard lock(mutex_);
    return warnings_;
}

}  // namespace obscura
