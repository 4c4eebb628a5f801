// app/option_group.h - options of one heading in a subcommand's help.
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <CLI/App.hpp>
#include <optional>
#include <string>

namespace obscura {

class OptionGroup {
public:
    OptionGroup(CLI::App& command, const char* heading) : command_(command), heading_(heading) {}

    /// An option with one argument; `type` stands for it in the help.
    void text(const char* name,
              std::optional<std::string>& target,
              const char* type,
              const std::string& help) {
        const auto store = [&target](const std::string& given) { target = given; };
        command_.add_option_function<std::string>(name, store, help)
            ->type_name(type)
            ->group(heading_);
    }
    void flag(const char* name, bool& target, const char* help) {
        command_.add_flag(name, target, help)->group(heading_);
    }

private:
    CLI::App& command_;
    const char* heading_;
};

}  // namespace obscura
