// app/render_options.cpp - the options of `obscura render` and the help a person can work from.
// SPDX-License-Identifier: Apache-2.0
#include "app/render_options.h"

#include "app/option_group.h"

#include <CLI/Config.hpp>
#include <CLI/Formatter.hpp>

namespace obscura {

namespace {

constexpr const char* examples = R"(
Examples:
  obscura render helmet.glb
      writes helmet.exr, framed by the file's first camera or as a whole
  obscura render helmet.glb --env sky.hdr --spp 256 -o helmet.exr -o helmet.png
      one rendering, two files: scene-linear data and a picture to look at
  obscura render room.gltf --camera Door --size 1920x1080 --exposure 1.5 -o room.jpg
  obscura render part.glb --eye 2,1,3 --target 0,0.5,0 --fov 30 --background transparent

  obscura render walk.glb --check
      says all that is wrong with the file and what belongs to it, in seconds
  obscura render walk.glb --frames 1-48 --fps 24 -o walk.####.exr
      48 files, walk.0001.exr to walk.0048.exr, from one reading of the asset

Exit codes: 0 done, 33 out of memory, 64 usage, 65 bad scene data, 66 scene missing,
67 referenced file missing or corrupt, 69 unsupported, 70 internal error, 73 output
cannot be created, 74 I/O error, 76 too many non-finite samples, 77 refused by a limit
or a policy, 78 colour configuration, 128+N stopped by signal N.
Names that begin with a dash: obscura render -o ./-out.exr -- -scene.glb)";

void add_picture_options(CLI::App& command, RenderArguments& arguments) {
    command
        .add_option("-o,--output",
                    arguments.outputs,
                    "File to write: .exr scene-linear, .png or .jpg for a display.\n"
                    "May be given several times [SCENE's name with .exr, here]")
        ->type_name("FILE")
        ->allow_extra_args(false)
        ->group("Picture");
    OptionGroup group(command, "Picture");
    group.text("--size", arguments.size, "WxH", "Width and height in pixels [1280x720]");
    group.text("--crop",
               arguments.crop,
               "X,Y,W,H",
               "Render only this part, in pixels from the top left;\n"
               "the rest of the picture stays zero");
    group.flag("--float", arguments.float32, "Store EXR colours as 32-bit floats [16-bit half]");
    group.text("--background",
               arguments.background,
               "KIND",
               "What rays that hit nothing see: env, transparent, or\n"
               "a linear colour R,G,B [env]");
    group.text(
        "--filter", arguments.filter, "NAME", "Pixel filter: box, gaussian, blackman-harris [box]");
    group.text("--point-size",
               arguments.point_size,
               "LENGTH",
               "Diameter of glTF's points: metres (0.01 or 0.01m) or\n"
               "pixels (3px) [3px]");
    group.text(
        "--line-width", arguments.line_width, "LENGTH", "Diameter of glTF's lines, likewise [2px]");
}

void add_time_options(CLI::App& command, RenderArguments& arguments) {
    OptionGroup group(command, "Time");
    group.text("--time",
               arguments.time,
               "SECONDS",
               "Show the scene as its animations have it then; before their\n"
               "beginning and after their end they stand still [as stored]");
    group.text("--animation",
               arguments.animation,
               "NAME|INDEX",
               "Which animation plays: a name or an index, all, or none [the\n"
               "first with --time or --frames, else none]");
    group.text("--frames",
               arguments.frames,
               "FIRST-LAST",
               "Render a sequence; the ### in the names of outputs become\n"
               "each frame's number. Frame n is at n / fps seconds");
    group.text("--fps", arguments.fps, "X", "Frames per second of --frames and --shutter [24]");
}

void add_display_options(CLI::App& command, RenderArguments& arguments) {
    OptionGroup group(command, "Display (PNG and JPEG only)");
    group.text("--exposure", arguments.exposure, "EV", "Brighter by this many stops [0]");
    group.text("--view",
               arguments.view,
               "NAME",
               "View of the OpenColorIO display. Built in: \"ACES 1.0 SDR\",\n"
               "\"Un-tone-mapped\", \"Khronos PBR Neutral\", Raw [ACES 1.0 SDR]");
    group.text("--display", arguments.display, "NAME", "OpenColorIO display [sRGB]");
    group.text("--ocio", arguments.ocio, "FILE", "OpenColorIO config [$OCIO, else built in]");
}

void add_program_options(CLI::App& command, RenderArguments& arguments) {
    OptionGroup group(command, "Program");
    group.text("--scene",
               arguments.scene,
               "NAME|INDEX",
               "Scene of a file that holds several [the file's default]");
    group.text("--variant",
               arguments.variant,
               "NAME",
               "Look of a product, as `obscura info` lists them\n"
               "[the file's own materials]");
    group.text("--threads", arguments.threads, "N", "Threads, 0 to 1024; 0 is every core [0]");
    group.text(
        "--isa", arguments.isa, "NAME", "Instruction set: auto, baseline, avx2, avx512 [auto]");
    group.text("--tile-size",
               arguments.tile_size,
               "N",
               "Side of a tile in pixels, 1 to 256; does not change\n"
               "the picture [16]");
    group.text(
        "--stats", arguments.stats, "FILE.json", "Write times, rays, memory and warnings as JSON");
    group.flag("--quiet", arguments.quiet, "Print errors only");
    group.flag("--verbose", arguments.verbose, "Print more notes");
}

}  // namespace

void add_sampling_options(CLI::App& command,
                          RenderArguments& arguments,
                          const std::string& default_spp) {
    OptionGroup group(command, "Sampling");
    group.text(
        "--spp", arguments.spp, "N", "Samples per pixel, 1 to 1048576 [" + default_spp + "]");
    group.text("--depth", arguments.depth, "N", "Most bounces of a path, 0 to 1000 [8]");
    group.text("--seed", arguments.seed, "N", "Random numbers; equal seeds, equal pictures [0]");
    group.text("--integrator",
               arguments.integrator,
               "NAME",
               "path: full light transport; direct: no indirect light;\n"
               "raycast: one ray a pixel, hard shadows, no noise; ao:\n"
               "ambient occlusion; wireframe; or a quantity, one ray\n"
               "through each pixel's centre: normal, facing, depth,\n"
               "distance, uv, albedo, id, heat [path]");
    group.text("--ao-distance",
               arguments.ao_distance,
               "METRES",
               "How far ao looks [a fifth of the scene's diagonal]");
    group.text(
        "--wire-width", arguments.wire_width, "PIXELS", "Lines of wireframe, 0.01 to 1000 [1]");
}

void add_camera_options(CLI::App& command, RenderArguments& arguments) {
    OptionGroup group(command, "Camera");
    group.text("--camera",
               arguments.camera,
               "NAME|INDEX",
               "A camera of the file [the first; without any, the whole\n"
               "scene is framed from the front, right and above]");
    group.text("--eye",
               arguments.eye,
               "X,Y,Z",
               "Place the camera by hand, in metres, +Y up. What is not\n"
               "given of eye, target and up comes from the framing");
    group.text("--target", arguments.target, "X,Y,Z", "Point that the camera looks at");
    group.text("--up", arguments.up, "X,Y,Z", "Direction that is up in the picture [0,1,0]");
    group.text("--fov",
               arguments.fov,
               "DEG",
               "Vertical angle of view, 0.01 to 179 [the camera's, or\n"
               "35]; of a fisheye the whole circle's, up to 360 [180]");
    group.text("--camera-model",
               arguments.camera_model,
               "NAME",
               "pinhole, orthographic, thinlens, fisheye or environment\n"
               "[the camera's, or what the options below mean, or\n"
               "pinhole]; orthographic shows what the angle shows at\n"
               "the target");
}

void add_fault_options(CLI::App& command, RenderArguments& arguments) {
    OptionGroup group(command, "Faulty scenes");
    group.flag("--strict",
               arguments.strict,
               "Refuse what would silently change the picture, such as a\n"
               "texture that cannot be read; every problem is listed before\n"
               "anything is rendered. This is the default");
    group.flag("--lenient",
               arguments.lenient,
               "Make do instead, with a warning each: magenta textures,\n"
               "skipped primitives, dropped triangles");
}

void add_light_options(CLI::App& command, RenderArguments& arguments) {
    OptionGroup group(command, "Light");
    group.text("--env",
               arguments.env,
               "FILE",
               "Latitude-longitude environment, .hdr or .exr\n"
               "[the file's own, else a neutral studio if the scene has\n"
               "no light]");
    group.text("--env-intensity", arguments.env_intensity, "X", "Multiplies the environment [1]");
    group.text("--env-rotation",
               arguments.env_rotation,
               "DEG",
               "Turns it about +Y, counter-clockwise from above [0]");
    group.text("--occlusion",
               arguments.occlusion,
               "KIND",
               "What occlusion textures do: off, or ambient, as in viewers:\n"
               "they dim the environment's light, for assets whose crevices\n"
               "are in the texture alone [off]");
}

void add_render_options(CLI::App& command, RenderArguments& arguments) {
    command.add_option("SCENE", arguments.scene_file, "glTF 2.0 file, .gltf or .glb")
        ->type_name("")
        ->required();
    add_picture_options(command, arguments);
    add_time_options(command, arguments);
    add_sampling_options(command, arguments, "64");
    add_camera_options(command, arguments);
    add_lens_options(command, arguments.lens);
    add_light_options(command, arguments);
    add_display_options(command, arguments);
    add_fault_options(command, arguments);
    OptionGroup(command, "Faulty scenes")
        .flag("--check",
              arguments.check,
              "Load and report only: nothing is rendered or written; the\n"
              "exit code is the one that rendering would begin with");
    add_program_options(command, arguments);
    command.footer(examples);
}

}  // namespace obscura
