// dataset/write_formats.cpp - makes the files of BOP, COCO and NeRF of a data set's labels.
// SPDX-License-Identifier: Apache-2.0
#include "dataset/write_formats.h"

#include "base/atomic_file.h"
#include "base/json/json.h"
#include "base/json/json_file.h"
#include "base/name_search.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <map>
#include <span>
#include <system_error>

namespace obscura::dataset {

namespace {

namespace fs = std::filesystem;
using nlohmann::json;

constexpr uint64_t largest_file = uint64_t{1} << 30U;

/// A mesh as it is stretched; objects are its instances.
struct Model {
    size_t scene = 0;
    std::string name;
    json mesh;     ///< its index; null: `object` stands for itself
    json stretch;  ///< rows of a matrix
    int object = 0;
    bool has_own_shape = false;
    std::vector<std::string> nodes = {};
};

/// The labels of one image.
struct Record {
    size_t scene = 0;
    int image = 0;  ///< its number in the scene
    json labels;
};

bool is_alike(const json& a, const json& b) {
    constexpr double tolerance = 1e-5;  // matrices may be written in single precision
    double largest = 0;
    double difference = 0;
    for (size_t r = 0; r < 3; ++r) {
        for (size_t c = 0; c < 3; ++c) {
            const double x = a[r][c].get<double>();
            const double y = b[r][c].get<double>();
            largest = std::max({largest, std::abs(x), std::abs(y)});
            difference = std::max(difference, std::abs(x - y));
        }
    }
    return difference <= tolerance * largest;
}

/// Knows the number of each object's model, from 1 on in the order of scenes and nodes.
class Models {
public:
    void add(size_t scene, const json& objects) {
        for (const json& object : objects) {
            const int id = object.at("id").get<int>();
            Model model{
                scene, object.at("mesh"), object.at("mesh_index"), object.at("stretch"), id};
            model.has_own_shape = object.at("own_shape");
            const std::string node = object.at("node");
            if (model.name.empty()) model.name = node.substr(node.rfind('/') + 1);
            const auto same = std::find_if(all_.begin(), all_.end(), [&](const Model& other) {
                return !object.at("own_shape").get<bool>() && !other.has_own_shape &&
                       other.scene == scene && !model.mesh.is_null() && other.mesh == model.mesh &&
                       is_alike(other.stretch, model.stretch);
            });
            const auto number = static_cast<int>(same - all_.begin()) + 1;
            if (same == all_.end()) all_.push_back(std::move(model));
            all_[static_cast<size_t>(number) - 1].nodes.push_back(node);
            numbers_[{scene, id}] = number;
        }
    }

    int number_of(size_t scene, int object) const {
        const auto found = numbers_.find({scene, object});
        return found == numbers_.end() ? 0 : found->second;
    }

    const std::vector<Model>& all() const { return all_; }

private:
    std::vector<Model> all_;
    std::map<std::pair<size_t, int>, int> numbers_;  ///< by scene and object
};

Result<void> write_document(const fs::path& file, const Json& document) {
    const std::string text = json_line(document) + "\n";
    return write_file_atomically(file, std::as_bytes(std::span(text)));
}

bool is_there(const fs::path& file) {
    std::error_code error;
    return fs::exists(file, error);
}

Result<json> read(const fs::path& file, Log& log) {
    return read_json_file(file,
                          largest_file,
                          {ExitCode::bad_resource, "E-DATASET-LABELS", file.string(), "the labels"},
                          log);
}

/// The rows of a matrix one after the other.
Json flat(const json& rows) {
    Json out = Json::array();
    for (const json& row : rows) {
        for (const json& number : row)
            out.push_back(number.get<double>());
    }
    return out;
}

Json in_mm(const json& vector_m) {
    Json out = Json::array();
    for (const json& number : vector_m)
        out.push_back(number.get<double>() * mm_per_m);
    return out;
}

Json box_or_none(const json& box) {
    return box.is_null() ? Json{-1, -1, -1, -1} : Json(box);
}

/// BOP's three files of one scene, in millimetres.
Result<void> write_bop(const SceneFolder& scene,
                       const std::vector<Record>& records,
                       const Models& models) {
    Json cameras = Json::object();
    Json poses = Json::object();
    Json infos = Json::object();
    for (const Record& record : records) {
        const std::string number = std::to_string(record.image);
        const json& camera = record.labels.at("camera");
        cameras[number] = {{"cam_K", flat(camera.at("K"))},
                           {"depth_scale", record.labels.at("depth_unit_mm")},
                           {"cam_R_w2c", flat(camera.at("R"))},
                           {"cam_t_w2c", in_mm(camera.at("t"))}};
        Json& pose = poses[number] = Json::array();
        Json& info = infos[number] = Json::array();
        for (const json& object : record.labels.at("objects")) {
            pose.push_back(
                {{"cam_R_m2c", flat(object.at("R"))},
                 {"cam_t_m2c", in_mm(object.at("t"))},
                 {"obj_id", models.number_of(record.scene, object.at("id").get<int>())}});
            info.push_back({{"bbox_obj", box_or_none(object.at("box"))},
                            {"bbox_visib", box_or_none(object.at("box_visible"))},
                            {"px_count_all", object.at("pixels")},
                            {"px_count_valid", object.at("pixels_with_depth")},
                            {"px_count_visib", object.at("pixels_visible")},
                            {"visib_fract", object.at("visibility")}});
        }
    }
    auto written = write_document(scene.folder / "scene_camera.json", cameras);
    if (written) written = write_document(scene.folder / "scene_gt.json", poses);
    if (written) written = write_document(scene.folder / "scene_gt_info.json", infos);
    return written;
}

/// transforms.json: cameras look along -Z, +Y is up; lengths are metres. Readers know the depth
/// files and their steps by one name or the other.
Result<void> write_nerf(const SceneFolder& scene, const std::vector<Record>& records) {
    if (records.empty()) return {};
    const json& labels = records.front().labels;
    const json& k = labels.at("camera").at("K");
    const double width = labels.at("width");
    const double height = labels.at("height");
    const double metres = labels.at("depth_unit_mm").get<double>() / mm_per_m;  // of a step
    Json document = {{"camera_angle_x", 2 * std::atan(0.5 * width / k[0][0].get<double>())},
                     {"camera_angle_y", 2 * std::atan(0.5 * height / k[1][1].get<double>())},
                     {"fl_x", k[0][0]},
                     {"fl_y", k[1][1]},
                     {"cx", k[0][2]},
                     {"cy", k[1][2]},
                     {"w", width},
                     {"h", height},
                     {"integer_depth_scale", metres},
                     {"depth_unit_scale_factor", metres}};
    if (const auto found = labels.at("camera").find("distortion");
        found != labels.at("camera").end()) {
        constexpr std::array names = {"k1", "k2", "p1", "p2", "k3"};
        for (size_t i = 0; i < names.size(); ++i)
            document[names[i]] = (*found)[i];
    }
    Json frames = Json::array();
    for (const Record& record : records) {
        frames.push_back(
            {{"file_path", record.labels.at("image")},
             {"depth_file_path", record.labels.at("depth")},
             {"transform_matrix", record.labels.at("camera").at("world_from_camera")}});
    }
    document["frames"] = std::move(frames);
    return write_document(scene.folder / "transforms.json", document);
}

/// Adds the images and the visible masks of one scene.
void add_coco(const SceneFolder& scene,
              const std::vector<Record>& records,
              const Models& models,
              Json& document) {
    Json& images = document["images"];
    Json& annotations = document["annotations"];
    for (const Record& record : records) {
        const size_t image = images.size() + 1;
        images.push_back(
            {{"id", image},
             {"file_name", scene.name + "/" + record.labels.at("image").get<std::string>()},
             {"width", record.labels.at("width")},
             {"height", record.labels.at("height")}});
        for (const json& object : record.labels.at("objects")) {
            if (object.at("pixels_visible").get<size_t>() == 0) continue;
            annotations.push_back(
                {{"id", annotations.size() + 1},
                 {"image_id", image},
                 {"category_id", models.number_of(record.scene, object.at("id").get<int>())},
                 {"iscrowd", 0},
                 {"area", object.at("pixels_visible")},
                 {"bbox", object.at("box_visible")},
                 {"segmentation", object.at("mask_visible")},
                 {"visibility", object.at("visibility")}});
        }
    }
}

/// Names of all models, all different.
std::vector<std::string> names_of(const Models& models) {
    std::vector<std::string> names;
    for (const Model& model : models.all())
        names.push_back(model.name);
    return distinct_names(std::move(names));
}

Json coco_document(const Dataset& dataset, const Models& models) {
    const std::vector<std::string> names = names_of(models);
    Json categories = Json::array();
    for (size_t i = 0; i < names.size(); ++i) {
        categories.push_back({{"id", i + 1},
                              {"name", names[i]},
                              {"supercategory", dataset.scenes[models.all()[i].scene].name}});
    }
    return {{"info", {{"description", "rendered by Obscura " OBSCURA_VERSION}}},
            {"licenses", Json::array()},
            {"images", Json::array()},
            {"annotations", Json::array()},
            {"categories", std::move(categories)}};
}

Json models_document(const Dataset& dataset, const Models& models) {
    const std::vector<std::string> names = names_of(models);
    Json list = Json::array();
    for (size_t i = 0; i < names.size(); ++i) {
        const Model& model = models.all()[i];
        list.push_back({{"obj_id", i + 1},
                        {"name", names[i]},
                        {"scene", dataset.scenes[model.scene].name},
                        {"asset", dataset.scenes[model.scene].asset},
                        {"mesh_index", model.mesh},
                        {"stretch", model.stretch},
                        {"nodes", model.nodes}});
    }
    return {{"objects", std::move(list)}};
}

/// A scene that failed leaves nothing that looks like one.
void remove_empty_folders(const fs::path& scene) {
    std::error_code ignored;
    for (const char* name : all_folders)
        fs::remove(scene / name, ignored);
    fs::remove(scene, ignored);
}

/// The labels of a scene's images that are there.
Result<std::vector<Record>> read_records(const Dataset& dataset, size_t scene, Log& log) {
    std::vector<Record> out;
    for (int i = 0; i < dataset.count; ++i) {
        const fs::path file =
            dataset.scenes[scene].folder / labels_folder / (image_name(i) + ".json");
        if (!is_there(file)) continue;
        Result<json> labels = read(file, log);
        if (!labels) return fail(labels.error());
        // Of an image in the making there are the labels alone.
        const std::string image = labels->at("image");
        if (!is_there(dataset.scenes[scene].folder / image)) continue;
        out.push_back({scene, i, std::move(*labels)});
    }
    return out;
}

Result<Models> read_models(const Dataset& dataset, Log& log) {
    Models models;
    for (size_t scene = 0; scene < dataset.scenes.size(); ++scene) {
        const fs::path file = dataset.scenes[scene].folder / objects_file;
        if (!is_there(file)) continue;
        const Result<json> objects = read(file, log);
        if (!objects) return fail(objects.error());
        models.add(scene, objects->at("objects"));
    }
    return models;
}

Result<void> write_all(const Dataset& dataset, Log& log) {
    const Result<Models> found = read_models(dataset, log);
    if (!found) return fail(found.error());
    const Models& models = *found;
    Json coco = coco_document(dataset, models);
    for (size_t scene = 0; scene < dataset.scenes.size(); ++scene) {
        const Result<std::vector<Record>> records = read_records(dataset, scene, log);
        if (!records) return fail(records.error());
        const SceneFolder& folder = dataset.scenes[scene];
        if (records->empty() && !dataset.is_shared) remove_empty_folders(folder.folder);
        Result<void> written;
        if (dataset.formats.bop && !records->empty()) written = write_bop(folder, *records, models);
        if (written && dataset.formats.nerf) written = write_nerf(folder, *records);
        if (!written) return written;
        add_coco(folder, *records, models, coco);
    }
    if (dataset.formats.coco) {
        auto written = write_document(dataset.root / "coco_annotations.json", coco);
        if (!written) return written;
    }
    return write_document(dataset.root / objects_file, models_document(dataset, models));
}

}  // namespace

Result<void> write_formats(const Dataset& dataset, Log& log) {
    std::error_code ignored;
    if (!std::filesystem::exists(dataset.root, ignored)) return {};  // no image was begun
    try {
        return write_all(dataset, log);
    } catch (const json::exception& error) {
        return fail(ExitCode::bad_data,
                    "E-DATASET-LABELS",
                    dataset.root.string(),
                    std::string("the labels are not as this program writes them (") + error.what() +
                        "); render the images anew, without --skip-existing");
    }
}

}  // namespace obscura::dataset
