// app/option_steps.h - reads the texts of options one after the other; the first fault is kept.
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "app/numbers.h"
#include "base/error.h"

#include <array>
#include <optional>
#include <string>

namespace obscura {

using OptionText = std::optional<std::string>;

/// Runs each step in turn and stops at the first that fails.
class OptionSteps {
public:
    template <typename T, typename Use>
    void take(const Result<T>& result, Use use) {
        if (error_) return;
        if (result) {
            use(*result);
        } else {
            error_ = result.error();
        }
    }
    /// Reads an option only if it was given.
    template <typename Parse, typename Use>
    void option(const OptionText& text, Parse parse, Use use) {
        if (!error_ && text) take(parse(*text), use);
    }
    void refuse(bool condition, const std::string& where, const std::string& message) {
        if (!error_ && condition) {
            error_ = Error{ExitCode::usage, "E-USAGE-CONFLICT", where, message};
        }
    }
    Result<void> done() const {
        if (error_) return fail(*error_);
        return {};
    }

private:
    std::optional<Error> error_;
};

/// The value that a list of {name, value} gives to a text.
///
/// Errors  64 E-USAGE-CHOICE, with all names
template <typename List>
auto choose_option(const std::string& text, const std::string& option, const List& choices)
    -> Result<decltype(choices[0].value)> {
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

}  // namespace obscura
