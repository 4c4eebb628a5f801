// app/list_options.h - the options that ask for many images of one asset.
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "app/option_entry.h"

namespace obscura {
struct RenderRequest;
}  // namespace obscura

namespace obscura::app {

struct RenderArguments;

/// The texts of these options as they stood on the command line.
struct ListArguments {
    OptionText views, cameras, variants, turntable, manifest;

    bool is_asked() const { return views || cameras || variants || turntable; }
};

/// Pattern of an image's file where no output is given: "helmet.{variant}.{view}.exr".
std::string listed_output(const RenderArguments& arguments);

/// The options that need others checked.
///
/// Errors  64 E-USAGE-CONFLICT
Result<void> complete_list(const RenderArguments& arguments, RenderRequest& request);

OptionGroup<RenderArguments, RenderRequest> list_group();

}  // namespace obscura::app
