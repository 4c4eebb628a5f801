// session/image_parts.cpp - parts of one picture in files, and the picture made of all of them.
// SPDX-License-Identifier: Apache-2.0
#include "session/image_parts.h"

#include "base/checksum.h"
#include "render/counts.h"

#include <algorithm>
#include <array>
#include <cstdlib>
#include <fmt/format.h>
#include <fstream>
#include <span>
#include <string_view>
#include <system_error>

namespace obscura {

namespace {

namespace fs = std::filesystem;

/// Reads piece by piece: before loading there may be no memory for the whole file.
std::optional<std::string> checksum_of_file(const fs::path& file) {
    std::error_code error;
    if (!fs::is_regular_file(file, error)) return {};
    std::ifstream stream(file, std::ios::binary);
    std::vector<char> piece(size_t{1} << 20);
    RunningChecksum sum;
    while (stream) {
        stream.read(piece.data(), static_cast<std::streamsize>(piece.size()));
        sum.add(std::as_bytes(std::span(piece.data(), static_cast<size_t>(stream.gcount()))));
    }
    if (!stream.eof()) return {};
    return checksum_text(sum.value());
}

tl::unexpected<Error> refuse_parts(const char* id,
                                   const std::string& where,
                                   const std::string& message) {
    return fail(ExitCode::configuration, id, where, message);
}

/// All texts of a name, in order.
std::string texts_of(const NamedTexts& all, const std::string& name) {
    std::string out;
    for (const auto& [key, text] : all) {
        if (key == name) out += (out.empty() ? "" : ", ") + (text.empty() ? "on" : text);
    }
    return out.empty() ? "nothing" : out;
}

/// What differs between two lists: "--spp: 16 and 64; ..."; "": nothing does.
std::string differing(const NamedTexts& a, const NamedTexts& b) {
    if (a == b) return "";
    std::string out;
    std::vector<std::string> told;
    for (const NamedTexts* list : {&a, &b}) {
        for (const auto& [name, text] : *list) {
            if (std::find(told.begin(), told.end(), name) != told.end()) continue;
            told.push_back(name);
            const std::string of_a = texts_of(a, name);
            const std::string of_b = texts_of(b, name);
            if (of_a == of_b) continue;
            out += fmt::format("{}{}: {} and {}", out.empty() ? "" : "; ", name, of_a, of_b);
        }
    }
    return out.empty() ? "the order of options" : out;
}

/// A list without the names of outputs, which no pixel depends on.
/// Files, and lists of images: what an image shows is among its facts.
bool is_left_out(const std::string& option) {
    constexpr std::array<std::string_view, 5> all = {
        "--output", "--views", "--cameras", "--variants", "--turntable"};
    return std::find(all.begin(), all.end(), option) != all.end();
}

NamedTexts without_outputs(const NamedTexts& options) {
    NamedTexts out;
    for (const auto& option : options) {
        if (!is_left_out(option.first)) out.push_back(option);
    }
    return out;
}

/// 78 E-PART-MIX when two parts are of different pictures.
Result<void> check_alike(const fs::path& file, const FilmStateHead& one, const FilmStateHead& two) {
    std::string differs = differences(one, two);
    if (differs.empty()) differs = differing(one.images, two.images);
    if (differs.empty() && (one.width != two.width || one.height != two.height))
        differs = "the picture's size";
    if (differs.empty() && one.part.count != two.part.count)
        differs = fmt::format("--part: of {} and of {}", one.part.count, two.part.count);
    if (differs.empty() && one.part.of != two.part.of) differs = "--part-by: tiles and samples";
    if (differs.empty()) return {};
    return refuse_parts(
        "E-PART-MIX",
        file.string(),
        "it is not of the same picture as the parts before it; these differ: " + differs);
}

/// 78 E-PART-SET unless every part is there once.
Result<void> check_complete(const std::vector<fs::path>& files,
                            const std::vector<FilmPart>& parts) {
    const int count = parts.front().count;
    std::string faults;
    for (int index = 0; index < count; ++index) {
        std::string names;
        for (size_t i = 0; i < parts.size(); ++i) {
            if (parts[i].index == index) names += (names.empty() ? "" : ", ") + files[i].string();
        }
        const auto times = std::count_if(
            parts.begin(), parts.end(), [&](const FilmPart& part) { return part.index == index; });
        if (times == 1) continue;
        faults += fmt::format("{}part {} of {} is {}",
                              faults.empty() ? "" : "; ",
                              index + 1,
                              count,
                              times == 0 ? "missing" : "there more than once: " + names);
    }
    if (faults.empty()) return {};
    return refuse_parts("E-PART-SET", files.front().string(), faults + "; expected each part once");
}

}  // namespace

std::string differences(const FilmStateHead& one, const FilmStateHead& two) {
    const std::string options =
        differing(without_outputs(one.options), without_outputs(two.options));
    return options.empty() ? differing(one.facts, two.facts) : options;
}

fs::path part_file(const fs::path& output, const FilmPart& part) {
    fs::path out = output;
    out += fmt::format(".{}-of-{}.film", part.index + 1, part.count);
    return out;
}

bool is_part_of_image(const RenderRequest& request) {
    return request.part && request.part_by != PartBy::frames;
}

bool is_part_of_samples(const RenderRequest& request) {
    return request.part && request.part_by == PartBy::samples;
}

fs::path checkpoint_file(const RenderRequest& request) {
    const fs::path& asked = request.long_run.checkpoint;
    if (asked.empty()) {
        fs::path out = request.outputs.front();
        if (is_part_of_image(request)) out = part_file(out, *request.part);
        out += ".checkpoint";
        return out;
    }
    if (is_part_of_image(request)) return part_file(asked, *request.part);
    return asked;
}

std::optional<std::string> FileChecksums::of(const fs::path& file) {
    const auto known = known_.find(file);
    if (known != known_.end()) return known->second;
    return known_.emplace(file, checksum_of_file(file)).first->second;
}

NamedTexts facts_of_asset(const std::vector<fs::path>& files) {
    NamedTexts facts;
    for (const fs::path& file : files) {
        if (const auto sum = checksum_of_file(file))
            facts.emplace_back(std::string(asset_file_fact) + file.filename().string(), *sum);
    }
    return facts;
}

NamedTexts facts_of(const RenderRequest& request,
                    const NamedTexts& asset,
                    const std::string& isa,
                    const std::string& embree,
                    FileChecksums& checksums) {
    NamedTexts facts = {{"the program's version", OBSCURA_VERSION},
                        {"Embree's version", embree},
                        {"the instruction set", isa}};
    facts.insert(facts.end(), asset.begin(), asset.end());
    const auto add_file = [&](const char* name, const fs::path& file) {
        if (const auto sum = checksums.of(file)) facts.emplace_back(name, *sum);
    };
    if (request.environment) add_file("the environment's file", *request.environment);
    if (request.camera_json) add_file("the camera's file", *request.camera_json);
    if (request.camera.settings.aperture_file)
        add_file("the aperture's file", *request.camera.settings.aperture_file);
    const char* const ocio = std::getenv("OCIO");
    if (!request.display.ocio_file.empty()) {
        add_file("the OpenColorIO config", request.display.ocio_file);
    } else if (ocio != nullptr) {
        add_file("the OpenColorIO config", ocio);
    }
    return facts;
}

Result<ImageParts> ImageParts::open(const std::vector<fs::path>& files) {
    ImageParts out;
    out.files_ = files;
    std::optional<FilmStateHead> first;
    std::vector<FilmPart> parts;
    std::array<uint64_t, 6> sums = {};
    for (const fs::path& file : files) {
        Result<FilmStateHead> head = read_film_state(file, nullptr);
        if (!head) return fail(head.error());
        for (size_t i = 0; i < sums.size(); ++i)
            sums[i] += head->counters[i];
        if (!is_whole(*head)) {
            return refuse_parts("E-PART-SET",
                                file.string(),
                                "it is a checkpoint: the part is not finished. Carry on with the "
                                "command that wrote it");
        }
        parts.push_back(head->part);
        if (!first) {
            first = std::move(*head);
        } else if (auto alike = check_alike(file, *first, *head); !alike) {
            return fail(alike.error());
        }
    }
    if (auto complete = check_complete(files, parts); !complete) return fail(complete.error());
    for (size_t i = 0; i < files.size(); ++i)
        out.files_[static_cast<size_t>(parts[i].index)] = files[i];
    out.part_of_ = parts.front().of;
    out.options_ = std::move(first->options);
    out.facts_ = std::move(first->facts);
    out.counters_ = counters_from_file(sums);
    return out;
}

Result<void> ImageParts::check_facts(const NamedTexts& facts) const {
    const std::string differs = differing(facts_, facts);
    if (differs.empty()) return {};
    return refuse_parts(
        "E-PART-MIX",
        files_.front().string(),
        "the parts were rendered from something else than what is here; these differ: " + differs);
}

Result<void> ImageParts::fill(Film& film) const {
    for (const fs::path& file : files_) {
        const Result<FilmStateHead> head = read_film_state(file, &film);
        if (!head) return fail(head.error());
    }
    return {};
}

Result<void> ImageParts::fill(const PassFilm& film) const {
    const auto count = static_cast<int>(files_.size());
    for (int index = 0; index < count; ++index) {
        const fs::path& file = files_[static_cast<size_t>(index)];
        const SampleRange samples =
            samples_of_part(film.sums->target(), {index, count, PartOf::samples});
        bool fits = true;
        const Result<FilmStateHead> head = read_film_sums(file, film.film, [&](StateReader& in) {
            fits = film.sums->append(film.work, samples, in);
        });
        if (!head) return fail(head.error());
        if (fits) continue;
        return fail(ExitCode::io_error,
                    "E-PART-DAMAGED",
                    file.string(),
                    "its tiles or samples are not those of this part");
    }
    return {};
}

}  // namespace obscura
