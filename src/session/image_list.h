// session/image_list.h - the images of one command: frames, views and variants of an asset.
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "base/error.h"
#include "session/camera_choice.h"
#include "session/frames.h"
#include "session/view_sampling.h"

#include <array>
#include <filesystem>
#include <memory>
#include <optional>
#include <string>
#include <utility>
#include <vector>

namespace obscura {

struct RenderRequest;

/// One way to look at an asset, and what else an image of it has of its own.
struct View {
    std::string name;
    CameraRequest camera;
    std::optional<std::array<int, 2>> size_px = {};
    std::optional<std::string> variant = {};
    std::optional<double> time_s = {};
    std::optional<double> environment_rotation_deg = {}, environment_intensity = {};
    std::string text = {};   ///< says all of the above, for fingerprints; "": the options do
    std::string place = {};  ///< of --views: "views.json#/views/3"
    std::vector<std::string> keys = {};  ///< that it has there
};

/// An error with the place in the file of --views, where the view says what is wrong.
Error at_its_view(Error error, const View& view);

/// What is asked for in place of one image.
struct ListRequest {
    std::optional<std::string> cameras;   ///< --cameras: "all", or patterns of names
    std::optional<std::string> variants;  ///< --variants: likewise
    int turntable = 0;                    ///< --turntable: this many steps of a whole turn
    std::optional<std::filesystem::path> views_file;  ///< --views
    /// Those of the file; images' requests share them.
    std::shared_ptr<const std::vector<View>> views = std::make_shared<const std::vector<View>>();
    ViewSampling sampling;                          ///< of `obscura dataset`
    std::optional<std::filesystem::path> manifest;  ///< --manifest
    bool shares_manifest = false;  ///< with other parts of a job: what is there stays
    std::string asset;             ///< {asset} in names; empty: the scene's name
    std::string look = "default";  ///< {look}, of a job of `obscura batch`
    size_t part_offset = 0;        ///< added to an image's index when parts share the images
    bool lists_only = false;       ///< files are named and nothing is rendered
    bool makes_folders = false;    ///< of all images, not only where names have fields
    bool keeps_asset = false;      ///< a rendering of the same asset follows

    /// True when there is a list of images that is no sequence.
    bool is_asked() const {
        return cameras || variants || turntable > 0 || views_file || sampling.count > 0;
    }
    /// True when only the asset tells what is in it.
    bool needs_asset() const {
        return cameras || variants || (sampling.count > 0 && sampling.chooses_variant);
    }
};

/// One image of a command: its output files, and what is to be seen.
struct ListedImage {
    std::optional<int> number = {};  ///< of a sequence or a turntable
    double time_s = 0;
    std::vector<std::filesystem::path> outputs = {};
    std::optional<std::filesystem::path> segmentation = {};
    size_t view = 0;                        ///< index in ImageList::views
    std::string variant = {};               ///< "": the file's own materials
    std::filesystem::path checkpoint = {};  ///< "": beside the output
    std::string label = {};                 ///< for messages: "frame 7", "front, red"
    /// What tells its pixels from those of the command's other images, for fingerprints.
    std::vector<std::pair<std::string, std::string>> facts = {};
};

struct ImageList {
    std::vector<View> views;  ///< one at least
    /// Those of one time and variant follow each other, so that a pose is made once.
    std::vector<ListedImage> images;
};

/// What an asset offers to a list.
struct AssetOffer {
    std::vector<std::string> variants, cameras;
};

/// The variants of views that name none, by their names; "" alone: the file's own materials.
///
/// Errors  64 E-VARIANT-UNKNOWN a pattern of --variants fits none
Result<std::vector<std::string>> listed_variants(const RenderRequest& request,
                                                 const std::vector<std::string>& offered);

/// These and those of single views, as far as the asset has them.
///
/// Errors  as listed_variants
Result<std::vector<std::string>> variants_to_plan(const RenderRequest& request,
                                                  const std::vector<std::string>& offered);

/// What {asset} stands for in the names of files.
std::string asset_name(const RenderRequest& request);

/// Lists the images of a request.
///
/// In      offer: may be empty unless ListRequest::needs_asset
/// Errors  those of listed_variants; 64 E-CAM-UNKNOWN a pattern of --cameras fits none
Result<ImageList> list_images(const RenderRequest& request, const AssetOffer& offer);

/// The request of one image, of what the whole command is asked for.
RenderRequest request_of(const RenderRequest& whole, const View& view, const ListedImage& image);

}  // namespace obscura
