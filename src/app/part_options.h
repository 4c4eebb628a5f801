// app/part_options.h - the options for a share of a picture or a sequence.
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "app/option_entry.h"
#include "film/film_state.h"

namespace obscura {
struct RenderRequest;
}  // namespace obscura

namespace obscura::app {

struct RenderArguments;

/// The texts of these options as they stood on the command line.
struct PartArguments {
    OptionText part, by, farm;
};

/// "2/7": the second of seven. "auto": what the launcher says, in the variables of Slurm (an
/// array's before a step's), Open MPI or PMI.
///
/// Errors  64 E-USAGE-NUMBER, E-USAGE-RANGE; E-USAGE-CONFLICT no launcher says
Result<FilmPart> parse_part(const std::string& text, const std::string& option);

/// Chooses between frames and tiles, and refuses what has no parts.
///
/// Errors  64 E-USAGE-CONFLICT
Result<void> complete_part(const PartArguments& arguments, RenderRequest& request);

/// The options that a merge needs to know, in the order of the table: all but those that change
/// neither pixels nor outputs.
NamedTexts options_for_merge(const RenderArguments& arguments);

/// Gives arguments the texts of options_for_merge.
///
/// Errors  78 E-PART-MIX an option that this version has not
Result<void> replay_options(const NamedTexts& options, RenderArguments& arguments);

OptionGroup<RenderArguments, RenderRequest> part_of_work_group();

}  // namespace obscura::app
