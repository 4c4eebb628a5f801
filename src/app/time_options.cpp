// app/time_options.cpp - the options for animations and sequences: a table.
// SPDX-License-Identifier: Apache-2.0
#include "app/time_options.h"

#include "app/frames.h"
#include "app/option_readers.h"
#include "app/render_options.h"
#include "app/render_request.h"

namespace obscura::app {

namespace {

using A = RenderArguments;
using L = gltf::LoadOptions;
using R = RenderRequest;
using Entry = RenderOptionEntry;

// clang-format off
constexpr Entry time[] = {
    {{.name = "--time", .argument = "SECONDS",
      .help = "Show the scene as its animations have it then; before their beginning and after "
              "their end they stand still",
      .range = {-1e6, 1e6}, .fallback = "as stored"},
     text_at<&A::time>, number_at<&R::load, &L::time_s>},
    {{.name = "--animation", .argument = "NAME|INDEX",
      .help = "Which animation plays: a name or an index, all, or none",
      .fallback = "the first with --time or --frames, else none"},
     text_at<&A::animation>, name_at<&R::load, &L::animation>},
    {{.name = "--frames", .argument = "FIRST-LAST[xSTEP][,...]",
      .help = "Render a sequence, such as 1-48 or 1-10x2,15; the ### in the names of outputs "
              "become each frame's number. Frame n is at n / fps seconds",
      .excludes = {"--time"}},
     text_at<&A::frames>, parsed_at<parse_frames, &R::frames>},
    {{.name = "--animate-seed",
      .help = "Add each frame's number to --seed: noise differs from frame to frame, where nothing "
              "moves, too",
      .needs = {"--frames", "--turntable"}},
     text_at<&A::animate_seed>, flag_at<&R::animates_seed>},
    {{.name = "--fps", .argument = "X",
      .help = "Frames per second of --frames, --shutter and --aov motion", .range = {1e-3, 1e5}},
     text_at<&A::fps>, number_at<&R::fps>}};
// clang-format on

}  // namespace

OptionGroup<A, R> time_group() {
    return {"Time", time};
}

}  // namespace obscura::app
