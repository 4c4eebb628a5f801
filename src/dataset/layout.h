// dataset/layout.h - a data set on disk: which formats it has, and where its files are.
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <filesystem>
#include <string>
#include <vector>

namespace obscura::dataset {

/// Formats beside the plain one, which is always there: the others are made of it.
struct Formats {
    bool bop = false;   ///< with a file for each mask; scenes have numbers in place of names
    bool coco = false;  ///< coco_annotations.json of all scenes
    bool nerf = false;  ///< transforms.json in each scene's folder
};

/// One scene of a data set.
struct SceneFolder {
    std::filesystem::path folder;  ///< "data/shoe"
    std::string name;              ///< "shoe"
    std::string asset;             ///< the scene's file
};

struct Dataset {
    std::filesystem::path root;
    std::vector<SceneFolder> scenes;
    Formats formats;
    int count = 0;           ///< images of each scene
    bool is_shared = false;  ///< other processes may be making images of it
};

inline constexpr double min_depth_unit_mm = 1e-6;
inline constexpr double max_depth_unit_mm = 1e6;
inline constexpr double mm_per_m = 1000;  ///< lengths in files are millimetres

inline constexpr const char* color_folder = "rgb";
inline constexpr const char* depth_folder = "depth";
inline constexpr const char* segmentation_folder = "segmentation";
inline constexpr const char* labels_folder = "labels";
inline constexpr const char* mask_folder = "mask";
inline constexpr const char* visible_mask_folder = "mask_visib";
inline constexpr const char* layers_folder = "exr";
inline constexpr std::array all_folders = {color_folder,
                                           depth_folder,
                                           segmentation_folder,
                                           labels_folder,
                                           mask_folder,
                                           visible_mask_folder,
                                           layers_folder};
inline constexpr const char* objects_file = "objects.json";

/// "000017": of an image in all files' names.
std::string image_name(int number);

}  // namespace obscura::dataset
