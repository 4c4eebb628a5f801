// app/option_entry.cpp - entries of option tables: names, values, targets, checks.
// SPDX-License-Identifier: Apache-2.0
#include "app/option_entry.h"

#include "app/option_readers.h"

#include <cmath>

namespace obscura::app {

namespace {

/// "--eye, --target or --up".
template <size_t count>
std::string alternatives(const std::array<const char*, count>& names) {
    std::string out;
    for (size_t i = 0; i < count && names[i]; ++i) {
        const bool last = i + 1 == count || !names[i + 1];
        const bool option = names[i][0] == '-';
        out += (i == 0 ? "" : last ? " or " : ", ") + std::string(option ? "" : "a ") + names[i];
    }
    return out;
}

/// `wanted` is "--sensor", or "--integrator ao" for that value of it.
bool is_given(std::span<const BoundOption> options, const std::string& wanted) {
    const size_t blank = wanted.find(' ');
    for (const BoundOption& option : options) {
        if (long_name(option.info) != wanted.substr(0, blank)) continue;
        const std::vector<std::string> texts = given_texts(option.target);
        if (blank == std::string::npos) return !texts.empty();
        return !texts.empty() && texts.front() == wanted.substr(blank + 1);
    }
    return false;
}

std::string end_of_range(double end) {
    return end == std::floor(end) ? std::to_string(static_cast<int64_t>(end)) : shortest(end);
}

}  // namespace

tl::unexpected<Error> conflict(const std::string& where, const std::string& message) {
    return fail(ExitCode::usage, "E-USAGE-CONFLICT", where, message);
}

bool has_optional_value(const OptionInfo& info) {
    return info.argument[0] == '[';
}

std::string long_name(const OptionInfo& info) {
    const std::string names = info.name;
    const size_t comma = names.find(',');
    return comma == std::string::npos ? names : names.substr(comma + 1);
}

std::vector<std::string> given_texts(const OptionTarget& target) {
    if (auto* const* text = std::get_if<OptionText*>(&target)) {
        return **text ? std::vector{***text} : std::vector<std::string>{};
    }
    if (auto* const* flag = std::get_if<bool*>(&target)) {
        return std::vector<std::string>(**flag ? 1 : 0);
    }
    if (auto* const* list = std::get_if<std::vector<std::string>*>(&target)) return **list;
    return {*std::get<std::string*>(target)};
}

bool is_given(const BoundOption& option) {
    return !given_texts(option.target).empty();
}

std::string full_help(const BoundOption& option) {
    std::string out = option.info.help;
    if (!out.empty() && out.back() == ':') {
        for (const std::string& name : option.names)
            out += (out.back() == ':' ? " " : ", ") + name;
    }
    // Ends that only keep numbers sane are not worth showing.
    const auto& [low, high] = option.info.range;
    const bool tells = low < high && low >= -1000 && high <= 1 << 20 && *option.info.accepted == 0;
    return tells ? out + " (" + end_of_range(low) + " to " + end_of_range(high) + ")" : out;
}

Result<void> check_combinations(std::span<const BoundOption> options) {
    for (const BoundOption& option : options) {
        if (!is_given(option)) continue;
        for (const char* other : option.info.excludes) {
            if (!other || !is_given(options, other)) continue;
            return conflict(long_name(option.info),
                            "it cannot go together with " + alternatives(option.info.excludes) +
                                "; give one or the other");
        }
        bool lacks = option.info.needs[0] != nullptr;
        for (const char* other : option.info.needs)
            lacks = lacks && !(other && is_given(options, other));
        if (lacks) {
            return conflict(
                long_name(option.info),
                "it is for " + alternatives(option.info.needs) + "; leave it out or add that");
        }
    }
    return {};
}

Result<std::string> parse_name(const std::string& text, const std::string& option) {
    if (!text.empty()) return text;
    return fail(ExitCode::usage,
                "E-USAGE-CONFLICT",
                option,
                "the name is empty; give one or leave out the option");
}

}  // namespace obscura::app
