// app/render_command.h - the subcommand `obscura render`.
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "app/render_request.h"

namespace obscura {
class ImageParts;
}  // namespace obscura

namespace obscura::app {

/// Renders one image and writes it; prints messages. Returns the exit code.
///
/// In      parts: the pixels come from there; null: they are rendered
int run_render(const RenderArguments& arguments, const ImageParts* parts);

}  // namespace obscura::app
