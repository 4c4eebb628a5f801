// app/option_readers.h - how entries of option tables find their texts and are parsed.
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "app/numbers.h"
#include "app/option_entry.h"

#include <algorithm>
#include <filesystem>
#include <type_traits>

namespace obscura::app {

namespace option_detail {

template <typename T>
struct Member;
template <typename Owner, typename T>
struct Member<T Owner::*> {
    using Class = Owner;
};
template <auto first, auto...>
struct Root {
    using Class = typename Member<decltype(first)>::Class;
};

template <typename T>
struct Value {
    using Type = T;
};
template <typename T>
struct Value<std::optional<T>> {
    using Type = T;
};

template <typename T>
const T* if_said(const T& value) {
    return &value;
}
template <typename T>
const T* if_said(const std::optional<T>& value) {
    return value ? &*value : nullptr;
}

}  // namespace option_detail

/// The struct in which a path of members begins.
template <auto... path>
using RootOf = typename option_detail::Root<path...>::Class;

/// The member at the end of a path: field<&A::b, &B::c>(a) is a.b.c.
template <auto... path, typename Struct>
auto& field(Struct& root) {
    return (root.*....*path);
}

/// The type of the value there, without optional.
template <auto... path>
using FieldValue = typename option_detail::Value<
    std::remove_cvref_t<decltype(field<path...>(std::declval<RootOf<path...>&>()))>>::Type;

/// Where the text of an entry's option is kept.
template <auto... path>
OptionTarget text_at(RootOf<path...>& arguments) {
    return &field<path...>(arguments);
}

template <auto... path>
Result<void> read_number(const OptionInfo& info,
                         const std::string& text,
                         RootOf<path...>& request) {
    using T = FieldValue<path...>;
    const auto& [low, high] = info.range;
    if constexpr (std::is_floating_point_v<T>) {
        const Result<double> number = parse_real(text, long_name(info), low, high);
        if (!number) return fail(number.error());
        field<path...>(request) = *number * info.scale;
    } else if (low < high) {
        const Result<int64_t> number = parse_integer(
            text, long_name(info), static_cast<int64_t>(low), static_cast<int64_t>(high));
        if (!number) return fail(number.error());
        field<path...>(request) = static_cast<T>(*number);
    } else {
        const Result<uint64_t> number = parse_unsigned(text, long_name(info));
        if (!number) return fail(number.error());
        field<path...>(request) = static_cast<T>(*number);
    }
    return {};
}

template <auto... path>
std::string show_number(const OptionInfo& info, const RootOf<path...>& request) {
    const auto* value = option_detail::if_said(field<path...>(request));
    return value ? shortest(static_cast<double>(*value) / info.scale) : "";
}

/// A number in the entry's range, times its scale; without a range any that is not negative.
template <auto... path>
inline constexpr OptionReader<RootOf<path...>> number_at = {
    .read = read_number<path...>, .show = show_number<path...>, .names = nullptr};

template <size_t least, auto... path>
Result<void> read_numbers(const OptionInfo& info,
                          const std::string& text,
                          RootOf<path...>& request) {
    FieldValue<path...> values = {};
    const NumberList list = {info.accepted, least, values.size(), info.range.low, info.range.high};
    const Result<std::vector<double>> read = parse_numbers(text, long_name(info), list);
    if (!read) return fail(read.error());
    std::copy(read->begin(), read->end(), values.begin());
    field<path...>(request) = values;
    return {};
}

/// A list that fills an array; missing numbers beyond `least` are zero.
template <size_t least, auto... path>
inline constexpr OptionReader<RootOf<path...>> numbers_at = {.read = read_numbers<least, path...>};

template <auto parse, auto... path>
Result<void> read_parsed(const OptionInfo& info,
                         const std::string& text,
                         RootOf<path...>& request) {
    const auto value = parse(text, long_name(info));
    if (!value) return fail(value.error());
    field<path...>(request) = *value;
    return {};
}

/// The result of `parse(text, option)`.
template <auto parse, auto... path>
inline constexpr OptionReader<RootOf<path...>> parsed_at = {.read = read_parsed<parse, path...>};

/// The value of a name in a list of {name, value}.
///
/// Errors  64 E-USAGE-CHOICE, with all names
template <typename List>
auto choose_option(const std::string& text, const std::string& option, const List& choices)
    -> Result<std::remove_cvref_t<decltype(choices[0].value)>> {
    std::string names;
    for (const auto& choice : choices) {
        if (text == choice.name) return choice.value;
        names += (names.empty() ? "" : ", ") + std::string(choice.name);
    }
    return fail(ExitCode::usage,
                "E-USAGE-CHOICE",
                option,
                in_quotes(text) + " is not accepted; expected one of: " + names);
}

template <const auto& choices, auto... path>
Result<void> read_choice(const OptionInfo& info,
                         const std::string& text,
                         RootOf<path...>& request) {
    const auto value = choose_option(text, long_name(info), choices);
    if (!value) return fail(value.error());
    field<path...>(request) = *value;
    return {};
}

template <const auto& choices, auto... path>
std::string show_choice(const OptionInfo& /*info*/, const RootOf<path...>& request) {
    const auto* value = option_detail::if_said(field<path...>(request));
    for (const auto& choice : choices) {
        if (value && choice.value == *value) return choice.name;
    }
    return "";
}

template <const auto& choices>
std::vector<std::string> choice_names() {
    std::vector<std::string> names;
    for (const auto& choice : choices)
        names.emplace_back(choice.name);
    return names;
}

/// One name of a list of {name, value}.
template <const auto& choices, auto... path>
inline constexpr OptionReader<RootOf<path...>> choice_at = {.read = read_choice<choices, path...>,
                                                            .show = show_choice<choices, path...>,
                                                            .names = choice_names<choices>};

/// A name or a file; an empty one is most likely an unset variable of a script.
///
/// Errors  64 E-USAGE-CONFLICT
Result<std::string> parse_name(const std::string& text, const std::string& option);

template <auto... path>
inline constexpr OptionReader<RootOf<path...>> name_at = parsed_at<parse_name, path...>;

template <auto... path>
Result<void> read_flag(const OptionInfo& /*info*/,
                       const std::string& /*text*/,
                       RootOf<path...>& request) {
    field<path...>(request) = true;
    return {};
}

/// Sets a bool.
template <auto... path>
inline constexpr OptionReader<RootOf<path...>> flag_at = {.read = read_flag<path...>};

}  // namespace obscura::app
