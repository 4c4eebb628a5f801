// stages/isa_entry.cpp - the table of stage functions; compiled once for each instruction set.
// SPDX-License-Identifier: Apache-2.0
#include "stages/1_camera.h"
#include "stages/1_shutter.h"
#include "stages/2_probes.h"
#include "stages/2_scatter.h"
#include "stages/3_albedo.h"
#include "stages/3_catcher.h"
#include "stages/3_light_paths.h"
#include "stages/3_shade.h"
#include "stages/4_transparent_shadows.h"
#include "stages/5_accumulate.h"

#define OBSCURA_TEXT_OF(name) #name
#define OBSCURA_TEXT(name) OBSCURA_TEXT_OF(name)

namespace obscura {
inline namespace OBSCURA_ISA {

static_assert(lane_count == OBSCURA_LANES, "compiled for another instruction set than intended");

extern const StageTable stage_table;
const StageTable stage_table = {
    .isa = &OBSCURA_TEXT(OBSCURA_ISA)[4],  // without "isa_"
    .lanes = lane_count,
    .camera = make_camera_rays,
    .centre_camera = make_centre_rays,
    .open_shutter = open_shutter,
    .begin_scatter = begin_scatter,
    .scatter = scatter,
    .make_probes = make_probes,
    .shade = shade,
    .shade_catchers = shade_catchers,
    .shade_ao = shade_ao,
    .begin_raycast = begin_raycast,
    .shade_raycast = shade_raycast,
    .aovs = write_aovs,
    .follow_albedo = follow_albedo,
    .wireframe = write_wireframe,
    .absorb_shadows = absorb_shadows,
    .take_waiting = take_waiting,
    .cross_thin_walls = cross_thin_walls,
    .add_shadows = add_shadow_light,
    .add_shadow_layers = add_shadow_layers,
    .accumulate = accumulate,
    .clear_nonfinite = clear_nonfinite,
};

}  // namespace OBSCURA_ISA
}  // namespace obscura
