// session/fingerprint.cpp - tells by its files whether an image has been rendered.
// SPDX-License-Identifier: Apache-2.0
#include "session/fingerprint.h"

#include "base/checksum.h"
#include "base/json/json_file.h"
#include "base/setting_names.h"
#include "image/fingerprint.h"
#include "session/image_parts.h"
#include "session/segmentation.h"

#include <algorithm>
#include <array>
#include <span>
#include <string_view>
#include <system_error>

namespace obscura {

namespace {

namespace fs = std::filesystem;

/// Options that say where something is, or which images are rendered.
bool is_name_or_range(const std::string& option) {
    constexpr std::array<std::string_view, 9> all = {"SCENE",
                                                     "--output",
                                                     "--format",
                                                     "--frames",
                                                     "--segmentation",
                                                     "--views",
                                                     "--cameras",
                                                     "--variants",
                                                     "--turntable"};
    return std::find(all.begin(), all.end(), option) != all.end();
}

bool is_file_of_asset(const std::string& fact) {
    return fact.starts_with(asset_file_fact);
}

/// Adds a text with an end that no text holds.
void sum_text(const std::string& text, RunningChecksum& sum) {
    sum.add(std::as_bytes(std::span(text.c_str(), text.size() + 1)));
}

void sum_texts(const NamedTexts& texts, RunningChecksum& sum) {
    for (const auto& [name, text] : texts) {
        if (is_name_or_range(name)) continue;
        // Files may have other names: in their order, their bytes tell them.
        sum_text(is_file_of_asset(name) ? "" : name, sum);
        sum_text(text, sum);
    }
    sum_text("", sum);  // no option or fact is called so
}

bool file_is_there(const fs::path& file) {
    std::error_code error;
    return fs::exists(file, error);
}

/// What is wrong with one file; "": nothing is.
std::string fault_of(const fs::path& file, const std::string& fingerprint) {
    if (!file_is_there(file)) return file.string() + " is missing";
    const std::optional<std::string> found = read_fingerprint(file);
    if (!found) return file.string() + " cannot be read";
    if (found->empty()) return file.string() + " has no fingerprint";
    return *found == fingerprint ? "" : file.string() + " has another fingerprint";
}

}  // namespace

std::string image_fingerprint(const NamedTexts& options,
                              const NamedTexts& facts,
                              const NamedTexts& of_image) {
    RunningChecksum sum;
    sum_texts(options, sum);
    sum_texts(facts, sum);
    sum_texts(of_image, sum);
    return checksum_text(sum.value());
}

ExistingImage find_existing(const RenderRequest& request,
                            const ListedImage& image,
                            const std::string& fingerprint) {
    std::vector<fs::path> images = image_files(request, image);
    std::vector<fs::path> others;  // JSON
    if (image.segmentation) {
        const auto [png, json] = segmentation_files(*image.segmentation);
        images.push_back(png);
        others.push_back(json);
    }
    if (request.crypto_manifest) others.push_back(*request.crypto_manifest);
    ExistingImage out;
    if (std::none_of(images.begin(), images.end(), file_is_there)) return out;
    for (const fs::path& file : images) {
        if (out.differs.empty()) out.differs = fault_of(file, fingerprint);
    }
    for (const fs::path& file : others) {
        if (!out.differs.empty() || is_whole_json(file)) continue;
        out.differs = file.string() + (file_is_there(file) ? " cannot be read" : " is missing");
    }
    out.is_finished = out.differs.empty();
    return out;
}

fs::path lock_file(const ListedImage& image) {
    fs::path out = image.outputs.front();
    out += ".lock";
    return out;
}

Result<void> check_skips_existing(const RenderRequest& request) {
    if (!request.long_run.skips_existing) return {};
    const auto conflict = [](const std::string& message) {
        return fail(ExitCode::usage, "E-USAGE-CONFLICT", setting("skip-existing"), message);
    };
    if (request.standard_output || request.outputs.empty())
        return conflict("what is written to standard output is not kept; give -o a file's name");
    if (request.options.light_groups.each && request.exr.layout == ExrLayout::separate) {
        return conflict("with " + setting("light-groups") + " each and " + setting("exr-layout") +
                        " separate the files have names that the scene tells; leave out one");
    }
    if (is_part_of_image(request)) {
        return conflict(
            "a part of an image is no image; leave out one of them, or divide a "
            "sequence by frames");
    }
    for (const fs::path& output : request.outputs) {
        const std::optional<OutputFormat> format = output_format_of(output);
        if (!format || entry_of(*format).has_texts) continue;
        return conflict(output.string() +
                        " cannot hold a fingerprint, by which a finished image is known; "
                        "EXR, PNG, JPEG, TIFF and WebP can");
    }
    return {};
}

}  // namespace obscura
