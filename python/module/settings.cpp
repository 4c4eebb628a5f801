// python/module/settings.cpp - the settings of the library by the names that Python gives them.
// SPDX-License-Identifier: Apache-2.0
#include "settings.h"

namespace obscura::python {

namespace {

/// An object that can be called, or None.
struct Callable {
    static py::object from(py::handle value, const Place& place) {
        if (value.is_none()) return {};
        if (PyCallable_Check(value.ptr()) == 0) wrong_type(place, "a callable", value);
        return py::reinterpret_borrow<py::object>(value);
    }
    static py::object to(const py::object& value) { return value ? value : py::none(); }
};

/// A threading.Event or what has its is_set().
struct Event : Callable {
    static py::object from(py::handle value, const Place& place) {
        if (value.is_none()) return {};
        if (!py::hasattr(value, "is_set")) wrong_type(place, "a threading.Event", value);
        return py::reinterpret_borrow<py::object>(value);
    }
};

constexpr std::array opencv_list = {
    field<&OpenCvCamera::K>("K", "3x3: fx 0 cx, 0 fy cy, 0 0 1, in pixels"),
    field<&OpenCvCamera::R>("R", "3x3, a rotation: X_camera = R X_world + t"),
    field<&OpenCvCamera::t>("t", "3 numbers, metres"),
    field<&OpenCvCamera::width>("width", "of the image that K is for, pixels; 0: the View's"),
    field<&OpenCvCamera::height>("height", "likewise"),
    field<&OpenCvCamera::pixel_center>(
        "pixel_center", "where K has the first pixel's centre: 0.5 (as COLMAP) or 0 (as OpenCV)"),
};

constexpr std::array view_list = {
    field<&View::width>("width", "pixels; 1280"),
    field<&View::height>("height", "pixels; 720"),
    field<&View::crop>("crop", "(x, y, width, height) in pixels from the top left: this part only"),
    field<&View::camera, Choice>("camera", "one of the file, by its name or index"),
    field<&View::eye>("eye", "(x, y, z), metres in the world"),
    field<&View::target>("target", "(x, y, z), metres: what is looked at"),
    field<&View::up>("up", "(x, y, z); (0, 1, 0)"),
    field<&View::world_from_camera>("world_from_camera",
                                    "4x4, rigid, for column vectors; the camera looks along -Z"),
    field<&View::camera_json, FileName>("camera_json", "a file of docs/cameras.md"),
    field<&View::opencv>("opencv", "an OpenCvCamera; see View.from_opencv"),
    field<&View::camera_model>("camera_model",
                               "'pinhole', 'orthographic', 'thin_lens', 'fisheye', 'environment'"),
    field<&View::fov_deg>("fov_deg", "vertical angle, degrees; of a fisheye the whole one"),
    field<&View::near_m>("near_m", "metres; what is nearer is cut off"),
    field<&View::far_m>("far_m", "metres; what is further away is cut off"),
    field<&View::magnification_m>("magnification_m",
                                  "(half width, half height) of an orthographic view, metres"),
    field<&View::focal_length_m>("focal_length_m", "metres"),
    field<&View::sensor_m>("sensor_m", "(width, height), metres"),
    field<&View::shift>("shift", "(right, up), in images"),
    field<&View::distortion>("distortion", "(k1, k2, p1, p2, k3), as OpenCV defines them"),
    field<&View::fstop>("fstop", "opens a thin lens: the f-number"),
    field<&View::lens_radius_m>("lens_radius_m", "in its place: metres"),
    field<&View::focus_distance_m>("focus_distance_m", "metres from the lens"),
    field<&View::focus_on_px>("focus_on_px", "(x, y): focuses on what this pixel shows"),
    field<&View::blades>("blades", "corners of the opening"),
    field<&View::blade_rotation_deg>("blade_rotation_deg", "degrees"),
    field<&View::anamorphic>("anamorphic", "how much higher than wide the opening is"),
    field<&View::aperture, FileName>("aperture", "an image: light passes where it is bright"),
    field<&View::fisheye>("fisheye",
                          "'equidistant', 'equisolid', 'stereographic', 'orthographic', 'opencv'"),
    field<&View::fisheye_fit>("fisheye_fit", "'circle', 'diagonal'"),
    field<&View::fisheye_coefficients>("fisheye_coefficients", "(k1, k2, k3, k4) of 'opencv'"),
    field<&View::projection>("projection",
                             "of all directions: 'latlong', 'cylindrical', 'cubemap'"),
    field<&View::align>("align", "centre of such an image: 'world' (+X), 'view' (ahead)"),
    field<&View::stereo_m>("stereo_m", "metres between two eyes, the left one's image on top"),
    field<&View::ev100>("ev100", "exposure of files for a display: EV at ISO 100"),
    field<&View::exposure_s>("exposure_s", "in its place, with fstop: seconds"),
    field<&View::iso>("iso", "speed, with exposure_s"),
    field<&View::time_s>("time_s", "seconds of the animation; None: the asset as it is stored"),
    field<&View::shutter_s>("shutter_s", "(opens, closes), seconds from time_s: motion blur"),
};

constexpr std::array look_list = {
    field<&Look::environment, FileName>("environment",
                                        "a file, .exr .hdr .png .jpg; None: the asset's own light"),
    field<&Look::environment_intensity>("environment_intensity", "a factor; 1"),
    field<&Look::environment_rotation_deg>("environment_rotation_deg",
                                           "degrees about +Y, counter-clockwise from above"),
    field<&Look::background>("background", "'environment', 'transparent', 'color'"),
    field<&Look::background_color>("background_color", "(r, g, b), linear Rec.709"),
    field<&Look::point_size_px>("point_size_px", "of glTF's points, pixels; 3"),
    field<&Look::line_width_px>("line_width_px", "of glTF's lines, pixels; 2"),
};

constexpr std::array sampling_list = {
    field<&Sampling::integrator>("integrator",
                                 "'path', 'direct', 'raycast', 'ao', 'normal', 'facing', 'depth', "
                                 "'distance', 'uv', 'albedo', 'id', 'wireframe', 'heat'"),
    field<&Sampling::samples_per_pixel>("samples_per_pixel", "64; with noise_target the most"),
    field<&Sampling::noise_target>("noise_target", "relative error at which a pixel is finished"),
    field<&Sampling::spp_min>("spp_min", "samples that every pixel takes, with noise_target"),
    field<&Sampling::max_bounces>("max_bounces", "8"),
    field<&Sampling::seed>("seed", "of the random numbers; 0"),
    field<&Sampling::filter>("filter", "'box', 'gaussian', 'blackman_harris'"),
    field<&Sampling::ao_distance_m>("ao_distance_m", "metres; None: a fifth of the diagonal"),
    field<&Sampling::wire_width_px>("wire_width_px", "pixels; 1"),
    field<&Sampling::clamp_direct>("clamp_direct", "against fireflies; 0: nothing is clamped"),
    field<&Sampling::clamp_indirect>("clamp_indirect", "likewise"),
    field<&Sampling::caustics>("caustics", "False: no light by way of mirrors to rough surfaces"),
    field<&Sampling::regularize>("regularize", "True: smooth surfaces are rougher to such light"),
    field<&Sampling::aov>("aov", "layers beside the beauty: ['normal', 'crypto_object']"),
    field<&Sampling::crypto_levels>("crypto_levels", "ids of a pixel in Cryptomatte layers; 6"),
};

constexpr std::array asset_list = {
    field<&AssetOptions::scene, Choice>("scene", ""),
    field<&AssetOptions::variant>("variant", ""),
    field<&AssetOptions::animation, Plain<std::optional<std::string>>>("animation", ""),
    field<&AssetOptions::threads>("threads", ""),
    field<&AssetOptions::lenient>("lenient", ""),
    field<&AssetOptions::ambient_occlusion>("ambient_occlusion", ""),
    field<&AssetOptions::fps>("fps", ""),
};

constexpr std::array write_list = {
    field<&WriteOptions::float32>("float32", ""),
    field<&WriteOptions::exr_layout>("exr_layout", ""),
    field<&WriteOptions::exposure_ev>("exposure_ev", ""),
    field<&WriteOptions::ocio_config, FileName>("ocio_config", ""),
    field<&WriteOptions::display>("display", ""),
    field<&WriteOptions::view>("view", ""),
    field<&WriteOptions::bits>("bits", ""),
    field<&WriteOptions::quality>("quality", ""),
    field<&WriteOptions::dither>("dither", ""),
    field<&WriteOptions::page>("page", ""),
};

using R = RenderControl;

constexpr std::array control_list = {
    field<&Control::threads, Plain<int>, R>("threads", ""),
    field<&Control::isa, Plain<std::string>, R>("isa", ""),
    field<&Control::tile_size, Plain<int>, R>("tile_size", ""),
    field<&R::cancel_event, Event>("cancel", ""),
    field<&R::on_progress, Callable>("progress", ""),
    field<&R::on_tile, Callable>("tile", ""),
};

}  // namespace

Fields<AssetOptions> asset_fields() {
    return fields("Session.open", asset_list);
}

Fields<WriteOptions> write_fields() {
    return fields("Session.write", write_list);
}

Fields<RenderControl> control_fields() {
    return fields("Session.render", control_list);
}

void bind_settings(py::module_& module) {
    bind_fields(module,
                fields("OpenCvCamera", opencv_list),
                "A camera as OpenCV and COLMAP describe it: +X right, +Y down, it looks along +Z.");
    bind_fields(
        module,
        fields("View", view_list),
        "A camera, an image size and a time. What is None is as the file says; a file "
        "without camera is\nframed as a whole. docs/cameras.md explains models and lenses.");
    bind_fields(module,
                fields("Look", look_list),
                "The light around the asset, the background, the size of points and lines.");
    bind_fields(module, fields("Sampling", sampling_list), "What is computed and how well.");
}

}  // namespace obscura::python
