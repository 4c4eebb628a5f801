// app/layer_options.h - the options for layers beside the beauty: texts and tables.
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "app/option_entry.h"
#include "session/render_request.h"

#include <string>
#include <vector>

namespace obscura::app {

/// Texts of options; see RenderArguments.
struct LayerArguments {
    std::vector<std::string> lpe, light_group;
    OptionText light_groups;
    bool light_groups_components = false;
    bool denoise = false, denoising_data = false, keep_noisy = false;
};

struct RenderArguments;

/// One of the options that ask for layers, for messages; layers are asked for.
const char* layer_option_of(const RenderArguments& arguments);

/// Sets the layers that --aov, --lpe and --light-group name.
///
/// Errors  64 E-AOV-NAME, E-LPE, E-LAYER-NAME, E-LIGHT-GROUP; E-USAGE-CONFLICT when the integrator
///         computes no such layers, two layers have one name, or their files have no names yet
Result<void> read_layers(const RenderArguments& arguments, RenderRequest& request);

OptionGroup<RenderArguments, RenderRequest> layer_group();
OptionGroup<RenderArguments, RenderRequest> denoising_group();

}  // namespace obscura::app
