// app/render_options.h - the table of the options of `obscura render`, shared with others.
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "app/command.h"
#include "app/render_request.h"

namespace obscura::app {

using RenderOptionEntry = OptionEntry<RenderArguments, RenderRequest>;
using RenderOptionGroup = OptionGroup<RenderArguments, RenderRequest>;

/// Every option of a rendering, in the order of its help; bench, crosscheck and explain-pixel take
/// theirs from here.
const std::vector<RenderOptionGroup>& render_option_groups();

/// The instruction sets that --isa accepts, and their aliases.
template <typename T>
struct Choice {
    const char* name;
    T value;
};
inline constexpr std::array<Choice<Isa>, 4> instruction_sets = {{{"auto", Isa::automatic},
                                                                 {"baseline", Isa::baseline},
                                                                 {"avx2", Isa::avx2},
                                                                 {"avx512", Isa::avx512}}};

/// The subcommand; parsing fills `arguments`, which must outlive it.
Command render_command(RenderArguments& arguments);

/// Adds options of a rendering to another command: a whole group, all groups of lenses, or one
/// option, by its name in the table, under another heading ("": its own). The returned entry may be
/// changed until the next is added.
void add_render_group(Command& command, RenderArguments& arguments, const char* heading);
void add_lens_groups(Command& command, RenderArguments& arguments);
BoundOption& add_render_option(Command& command,
                               RenderArguments& arguments,
                               const char* name,
                               const char* heading);

}  // namespace obscura::app
