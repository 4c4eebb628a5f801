// session/image_list.cpp - the images of one command: frames, views and variants of an asset.
// SPDX-License-Identifier: Apache-2.0
#include "session/image_list.h"

#include "base/name_search.h"
#include "base/setting_names.h"
#include "base/text.h"
#include "session/image_names.h"
#include "session/render_request.h"

#include <algorithm>
#include <fmt/format.h>
#include <map>

namespace obscura {

namespace {

/// The indices of the names that fit patterns with commas between them, in the order of the names;
/// all: "all". In `unknown` the pattern that fits none.
std::vector<size_t> fitting(const std::string& patterns,
                            const std::vector<std::string>& names,
                            std::optional<std::string>& unknown) {
    std::vector<char> fits(names.size(), patterns == "all" ? 1 : 0);
    for (size_t begin = 0; patterns != "all" && begin <= patterns.size();) {
        const size_t end = std::min(patterns.find(',', begin), patterns.size());
        const std::string pattern = patterns.substr(begin, end - begin);
        bool found = false;
        for (size_t i = 0; i < names.size(); ++i) {
            if (!fits_pattern(pattern, names[i])) continue;
            found = true;
            fits[i] = 1;
        }
        if (!found && !unknown) unknown = pattern;
        begin = end + 1;
    }
    std::vector<size_t> out;
    for (size_t i = 0; i < names.size(); ++i) {
        if (fits[i] != 0) out.push_back(i);
    }
    return out;
}

tl::unexpected<Error> unknown_name(const char* id,
                                   const char* option,
                                   const std::string& pattern,
                                   const std::vector<std::string>& names,
                                   const char* things) {
    return fail(ExitCode::usage,
                id,
                setting(option),
                in_quotes(pattern) + " fits none of the asset's " + things +
                    names_instead(pattern, names, things));
}

Result<std::vector<View>> views_of_cameras(const RenderRequest& request,
                                           const std::vector<std::string>& cameras) {
    std::vector<std::string> names = cameras;
    for (size_t i = 0; i < names.size(); ++i) {
        if (names[i].empty()) names[i] = fmt::format("camera {}", i);
    }
    std::optional<std::string> unknown;
    const std::vector<size_t> chosen = fitting(*request.lists.cameras, names, unknown);
    if (unknown) return unknown_name("E-CAM-UNKNOWN", "cameras", *unknown, names, "cameras");
    names = distinct_names(std::move(names));
    std::vector<View> views;
    for (const size_t index : chosen) {
        View view{names[index], request.camera};
        view.camera.index = index;
        view.text = fmt::format("camera {}", index);
        views.push_back(std::move(view));
    }
    if (views.empty()) views.push_back({"view", request.camera});  // the automatic framing
    return views;
}

/// The views of a whole turn, which begins where the framing says and goes on to the right.
std::vector<View> views_of_turntable(const RenderRequest& request) {
    const int count = request.lists.turntable;
    std::vector<View> views;
    for (int i = 0; i < count; ++i) {
        View view{"turntable", request.camera};
        view.camera.frames = true;
        view.camera.framing.azimuth_rad += 2 * pi_d * i / count;
        view.text = fmt::format("step {} of {}", i, count);
        views.push_back(std::move(view));
    }
    return views;
}

Result<std::vector<View>> listed_views(const RenderRequest& request, const AssetOffer& offer) {
    if (!request.lists.views->empty()) return *request.lists.views;
    if (request.lists.cameras) return views_of_cameras(request, offer.cameras);
    if (request.lists.turntable > 0) return views_of_turntable(request);
    if (request.lists.sampling.count > 0)
        return sample_views(request.lists.sampling, request.camera, offer.variants);
    const std::string& camera = request.camera.choice;
    return std::vector<View>{{camera.empty() ? "view" : camera, request.camera}};
}

struct ListedTime {
    std::optional<int> number;
    double time_s = 0;
};

std::vector<ListedTime> listed_times(const RenderRequest& request) {
    if (!request.frames) return {{{}, request.load.time_s.value_or(0)}};
    std::vector<ListedTime> out;
    for (const int number : request.frames->numbers)
        out.push_back({number, request.frames->time_s(number)});
    return out;
}

/// A file's name for one image: # and fields are replaced.
std::filesystem::path file_of(const std::filesystem::path& pattern,
                              const NameFields& fields,
                              std::optional<int> number) {
    const std::filesystem::path file =
        number ? frame_file(pattern, *number).value_or(pattern) : pattern;
    return name_by_pattern(file, fields);
}

std::string label_of(const ListedImage& image, const View& view, const ListRequest& lists) {
    std::string out;
    const auto add = [&](const std::string& text) { out += (out.empty() ? "" : ", ") + text; };
    if (!image.variant.empty() && lists.is_asked()) add(image.variant);
    if (!view.text.empty() && lists.turntable == 0) add(view.name);
    if (image.number) add(fmt::format("frame {}", *image.number));
    return out;
}

std::vector<std::pair<std::string, std::string>> facts_of_image(const RenderRequest& request,
                                                                const ListedImage& image,
                                                                const View& view) {
    std::vector<std::pair<std::string, std::string>> facts;
    if (request.frames && image.number) {
        facts = {{"the frame", std::to_string(*image.number)},
                 {"the first frame", std::to_string(request.frames->numbers.front())}};
    }
    if (!view.text.empty()) facts.emplace_back("the view", view.text);
    if (request.lists.variants) facts.emplace_back("the variant", image.variant);
    return facts;
}

/// Views and variants as parts of files' names, all different.
class ListNames {
public:
    ListNames(const RenderRequest& request,
              const std::vector<View>& views,
              const std::vector<std::string>& variants)
        : asset_(asset_name(request)), look_(request.lists.look) {
        for (const View& view : views)
            views_.push_back(name_part(view.name));
        // The steps of a turntable have numbers.
        if (request.lists.turntable == 0) views_ = distinct_names(std::move(views_));
        std::vector<std::string> parts;
        for (const std::string& variant : variants)
            parts.push_back(name_part(variant));
        parts = distinct_names(std::move(parts));
        for (size_t i = 0; i < variants.size(); ++i)
            variants_.emplace(variants[i], parts[i]);
    }

    NameFields of(const ListedImage& image) const {
        const auto variant = variants_.find(image.variant);
        return {asset_,
                variant != variants_.end() ? variant->second
                : image.variant.empty()    ? "default"
                                           : image.variant,
                views_[image.view],
                image.number.value_or(1),
                look_};
    }

private:
    std::string asset_, look_;
    std::vector<std::string> views_;
    std::map<std::string, std::string> variants_;
};

ListedImage listed_image(const RenderRequest& request,
                         ListedImage image,
                         const View& view,
                         const ListNames& names) {
    const NameFields fields = names.of(image);
    for (const std::filesystem::path& pattern : request.outputs)
        image.outputs.push_back(file_of(pattern, fields, image.number));
    if (request.segmentation)
        image.segmentation = file_of(*request.segmentation, fields, image.number);
    image.checkpoint = file_of(request.long_run.checkpoint, fields, image.number);
    image.label = label_of(image, view, request.lists);
    image.facts = facts_of_image(request, image, view);
    return image;
}

/// Brings images of one pose together, in the order in which poses come first.
void group_by_pose(std::vector<ListedImage>& images) {
    std::map<std::pair<double, std::string>, size_t> order;
    for (const ListedImage& image : images)
        order.try_emplace({image.time_s, image.variant}, order.size());
    std::stable_sort(images.begin(), images.end(), [&](const auto& a, const auto& b) {
        return order.at({a.time_s, a.variant}) < order.at({b.time_s, b.variant});
    });
}

}  // namespace

Error at_its_view(Error error, const View& view) {
    const std::string name = spell_settings(error.where, SettingNames::plain);
    const bool is_there = std::find(view.keys.begin(), view.keys.end(), name) != view.keys.end();
    if (is_there) error.where = view.place + "/" + name;
    return error;
}

std::string asset_name(const RenderRequest& request) {
    const std::string& name = request.lists.asset;
    return name.empty() ? request.scene.stem().string() : name;
}

Result<std::vector<std::string>> listed_variants(const RenderRequest& request,
                                                 const std::vector<std::string>& offered) {
    std::vector<std::string> out;
    const auto add = [&](const std::string& name) {
        if (std::find(out.begin(), out.end(), name) == out.end()) out.push_back(name);
    };
    if (const auto& patterns = request.lists.variants) {
        std::optional<std::string> unknown;
        for (const size_t index : fitting(*patterns, offered, unknown))
            add(offered[index]);
        if (unknown)
            return unknown_name("E-VARIANT-UNKNOWN", "variants", *unknown, offered, "variants");
    }
    if (out.empty()) add(request.load.variant);
    return out;
}

Result<std::vector<std::string>> variants_to_plan(const RenderRequest& request,
                                                  const std::vector<std::string>& offered) {
    Result<std::vector<std::string>> out = listed_variants(request, offered);
    if (!out) return out;
    const auto has = [](const std::vector<std::string>& names, const std::string& name) {
        return std::find(names.begin(), names.end(), name) != names.end();
    };
    for (const View& view : *request.lists.views) {
        if (view.variant && has(offered, *view.variant) && !has(*out, *view.variant))
            out->push_back(*view.variant);
    }
    const ViewSampling& sampling = request.lists.sampling;
    if (sampling.count > 0 && sampling.chooses_variant && !offered.empty()) return offered;
    return out;
}

Result<ImageList> list_images(const RenderRequest& request, const AssetOffer& offer) {
    ImageList out;
    Result<std::vector<View>> views = listed_views(request, offer);
    if (!views) return fail(views.error());
    out.views = std::move(*views);
    Result<std::vector<std::string>> variants = listed_variants(request, offer.variants);
    if (!variants) return fail(variants.error());
    const ListNames names(request, out.views, offer.variants);
    for (const ListedTime& time : listed_times(request)) {
        for (const std::string& variant : *variants) {
            for (size_t i = 0; i < out.views.size(); ++i) {
                const View& view = out.views[i];
                if (view.variant && variant != variants->front()) continue;  // it has its own
                ListedImage image{.number = time.number,
                                  .time_s = view.time_s.value_or(time.time_s),
                                  .view = i,
                                  .variant = view.variant.value_or(variant)};
                if (request.lists.turntable > 0) image.number = static_cast<int>(i) + 1;
                out.images.push_back(listed_image(request, std::move(image), view, names));
            }
        }
    }
    group_by_pose(out.images);
    return out;
}

RenderRequest request_of(const RenderRequest& whole, const View& view, const ListedImage& image) {
    RenderRequest out = whole;
    out.outputs = image.outputs;
    out.segmentation = image.segmentation;
    out.frame = image.number;
    if (whole.animates_seed) out.options.seed += static_cast<uint64_t>(image.number.value_or(0));
    out.long_run.checkpoint = image.checkpoint;
    out.camera = view.camera;
    out.camera.framed_nodes = whole.camera.framed_nodes;  // they are found when the asset is there
    if (view.size_px) {
        out.options.width = (*view.size_px)[0];
        out.options.height = (*view.size_px)[1];
    }
    if (view.environment_rotation_deg) {
        out.environment_rotation_deg = *view.environment_rotation_deg;
        out.environment_follows_camera = false;
    }
    if (view.environment_intensity) out.environment_intensity = *view.environment_intensity;
    return out;
}

}  // namespace obscura
