// app/lens_options.cpp - the options of `obscura render` that make a camera more than a pinhole.
// SPDX-License-Identifier: Apache-2.0
#include "app/lens_options.h"

#include "app/option_group.h"

#include <CLI/Config.hpp>
#include <CLI/Formatter.hpp>

namespace obscura {

namespace {

void add_film_options(CLI::App& command, LensArguments& a) {
    OptionGroup group(command, "Film");
    group.text("--camera-json",
               a.camera_json,
               "FILE",
               "A camera as computer vision writes it: fx fy cx cy,\n"
               "distortion, world to camera (docs/cameras.md)");
    group.text("--focal-length", a.focal_length, "MM", "With --sensor: sets the angle of view");
    group.text("--sensor", a.sensor, "WxH", "Size of the film in millimetres, such as 36x24");
    group.text("--shift",
               a.shift,
               "X,Y",
               "Moves the film by so many pictures to the right and up,\n"
               "without turning the camera [0,0]");
    group.text("--mag",
               a.magnification,
               "X,Y",
               "Orthographic: half width and half height in metres, as\n"
               "glTF's xmag and ymag");
    group.text("--distortion",
               a.distortion,
               "K1,K2,P1,P2[,K3]",
               "Of a pinhole or thin lens, as OpenCV defines them");
    group.text("--near", a.near_m, "METRES", "Show nothing nearer [all is shown]");
    group.text("--far", a.far_m, "METRES", "Show nothing further [all is shown]");
}

void add_thin_lens_options(CLI::App& command, LensArguments& a) {
    OptionGroup group(command, "Lens (--camera-model thinlens)");
    group.text("--fstop",
               a.fstop,
               "N",
               "Focal length over opening; without --focal-length it is\n"
               "that of 35 mm film");
    group.text("--lens-radius", a.lens_radius, "METRES", "Half the opening; 0 is a pinhole");
    group.text("--focus-distance",
               a.focus_distance,
               "METRES",
               "To the sharp plane, along the view [to --target, or the\n"
               "middle of the scene]");
    group.text("--focus-on", a.focus_on, "X,Y", "Make sharp what this pixel shows");
    group.text("--blades", a.blades, "N", "Opening with so many edges, 3 to 64 [round]");
    group.text("--blade-rotation", a.blade_rotation, "DEG", "Turns the opening [0]");
    group.text("--anamorphic", a.anamorphic, "X", "Opening so many times as high as wide [1]");
    group.text(
        "--aperture", a.aperture, "FILE", "Opening as a picture: light passes where it is bright");
}

void add_wide_options(CLI::App& command, LensArguments& a) {
    OptionGroup fisheye(command, "Fisheye (--camera-model fisheye)");
    fisheye.text("--fisheye",
                 a.fisheye,
                 "NAME",
                 "equidistant, equisolid, stereographic, orthographic or\n"
                 "opencv [equidistant]");
    fisheye.text("--fisheye-fit",
                 a.fisheye_fit,
                 "NAME",
                 "circle: all of it in the picture; diagonal: it reaches\n"
                 "the corners [circle]");
    fisheye.text("--fisheye-coefficients",
                 a.fisheye_coefficients,
                 "K1,K2,K3,K4",
                 "Of the opencv fisheye (Kannala-Brandt)");
    OptionGroup around(command, "All around (--camera-model environment)");
    around.text(
        "--environment", a.environment, "NAME", "latlong, cylindrical or cubemap [latlong]");
    around.text("--stereo",
                a.stereo,
                "METRES",
                "Two eyes so far apart: the left one above, the right one\n"
                "below, each seen straight ahead in every direction");
    around.text("--align",
                a.align,
                "NAME",
                "world: +X in the middle, as --env reads maps; view: what\n"
                "is ahead [world]");
}

void add_exposure_options(CLI::App& command, LensArguments& a) {
    OptionGroup group(command, "Photographic exposure (PNG and JPEG only)");
    group.text("--shutter",
               a.shutter,
               "SECONDS",
               "Such as 0.008 or 1/125; needs --fstop. Or OPEN,CLOSE, in\n"
               "frames from the picture's time, such as 0,0.5: motion blur\n"
               "in every kind of picture");
    group.text("--iso", a.iso, "N", "Sensitivity [100]");
    group.text("--ev100", a.ev100, "EV", "Exposure value at ISO 100, instead of these");
}

}  // namespace

void add_lens_options(CLI::App& command, LensArguments& arguments) {
    add_film_options(command, arguments);
    add_thin_lens_options(command, arguments);
    add_wide_options(command, arguments);
    add_exposure_options(command, arguments);
}

}  // namespace obscura
