// app/batch_job.cpp - reads the job of `obscura batch`: assets, looks and outputs.
// SPDX-License-Identifier: Apache-2.0
#include "app/batch_job.h"

#include "app/command_line.h"
#include "app/distinct_files.h"
#include "app/json_options.h"
#include "app/numbers.h"
#include "app/render_options.h"
#include "app/unused_options.h"
#include "base/json/json_file.h"
#include "base/name_search.h"
#include "image/output_format.h"
#include "image/write.h"
#include "session/image_names.h"

#include <algorithm>
#include <array>
#include <filesystem>
#include <glob.h>
#include <map>
#include <set>
#include <string_view>

namespace obscura::app {

namespace {

using nlohmann::json;

constexpr const char* value_id = "E-JOB-VALUE";
constexpr uint64_t largest_file = 64U << 20;

/// Options that are a command's and not a picture's.
bool is_of_command(const std::string& name) {
    constexpr std::array<std::string_view, 12> all = {"--output",
                                                      "--format",
                                                      "--quiet",
                                                      "--verbose",
                                                      "--check",
                                                      "--list-aovs",
                                                      "--part",
                                                      "--part-by",
                                                      "--skip-existing",
                                                      "--manifest",
                                                      "--stats",
                                                      "--display-server"};
    return std::find(all.begin(), all.end(), name) != all.end();
}

/// What options of pictures are called in a job.
std::vector<std::string> keys_of(const std::vector<BoundOption>& table) {
    std::vector<std::string> out;
    for (const BoundOption& option : table) {
        const std::string name = long_name(option.info);
        if (name.starts_with("--") && !is_of_command(name)) out.push_back(name.substr(2));
    }
    return out;
}

/// The members "options" of one object, over what is set already.
void read_options(const JsonReader& reader, const json& tree, JobRun& run) {
    const auto options = tree.find("options");
    if (options == tree.end()) return;
    const JsonReader inside = reader.child("options");
    const std::vector<BoundOption> table =
        bind_all(std::span(render_option_groups()), run.arguments);
    inside.each_key([&](const std::string& key) {
        const std::string name = "--" + key;
        const BoundOption* const found = find_option(table, name);
        if (found == nullptr || is_of_command(name)) {
            inside.fault(key,
                         "E-JOB-KEY",
                         "there is no such option for a job's pictures" +
                             near_names(key, keys_of(table)) +
                             "; `obscura help render` lists them, here without the hyphens");
            return;
        }
        const std::string expected = set_from_json(*found, options->at(key));
        if (!expected.empty()) inside.fault(key, value_id, expected);
        const std::string place = inside.pointer() + json_pointer_part(key);
        run.places[name] = place;
        if (*found->info.files != 0 && options->at(key).is_string())
            run.places[options->at(key).get<std::string>()] = place;
    });
}

/// The files that a pattern fits, in the order of their names; no folders.
std::vector<std::string> files_of(const std::string& pattern) {
    std::vector<std::string> out;
    std::error_code error;
    if (std::filesystem::exists(pattern, error)) return {pattern};  // whatever signs it has
    glob_t found = {};
    if (::glob(pattern.c_str(), 0, nullptr, &found) == 0) {
        for (size_t i = 0; i < found.gl_pathc; ++i) {
            const char* const name = found.gl_pathv[i];
            if (!std::filesystem::is_directory(name, error)) out.emplace_back(name);
        }
    }
    ::globfree(&found);
    return out;
}

class JobReading {
public:
    JobReading(const json& tree, const RenderArguments& common, JsonFault& fault)
        : fault_(fault), reader_(tree, "", fault), tree_(tree), common_(common) {}

    BatchJob read() {
        constexpr std::array<std::string_view, 7> known = {
            "assets", "options", "looks", "outputs", "manifest", "contact_sheet", "comment"};
        check_known_keys(reader_, known, "E-JOB-KEY");
        reader_.require("assets");
        if (reader_.has("manifest")) job_.manifest = reader_.text("manifest");
        if (reader_.has("contact_sheet")) job_.contact_sheet = reader_.text("contact_sheet");
        if (job_.contact_sheet && !job_.manifest)
            job_.manifest = std::filesystem::path(*job_.contact_sheet).replace_extension(".jsonl");
        if (job_.contact_sheet && same_file(*job_.contact_sheet, *job_.manifest))
            reader_.fault("contact_sheet", value_id, "the manifest has this file");
        if (job_.contact_sheet && output_format_of(*job_.contact_sheet))
            reader_.fault("contact_sheet", value_id, "it is a page; expected .html");
        each_element("assets", "files", [&](const auto& reader, const json& tree) {
            read_asset(reader, tree);
        });
        name_assets();
        return std::move(job_);
    }

    /// The first pattern that fits no file; empty: there is none.
    struct Missing {
        std::string pattern;
        std::string place;  ///< a JSON pointer
    };
    const Missing& missing() const { return missing_; }

private:
    /// Calls read(reader, tree) for each element of an array: an object, or a string, which stands
    /// for an object with that string as the member `name`. An absent array is one empty object.
    template <typename Read>
    void each_element(const char* key, const char* name, const Read& read) {
        const auto list = tree_.find(key);
        if (list == tree_.end()) {
            const json nothing = json::object();
            read(JsonReader(nothing, json_pointer_part(key), fault_), nothing);
            return;
        }
        if (!list->is_array() || list->empty()) {
            reader_.fault(key, value_id, "expected an array with one element at least");
            return;
        }
        for (size_t i = 0; i < list->size(); ++i) {
            const json& given = list->at(i);
            json element = given;
            if (!given.is_object()) element = json::object({{name, given}});
            const std::string pointer = json_pointer_part(key) + "/" + std::to_string(i);
            const JsonReader reader(element, pointer, fault_);
            if (!given.is_object() && !given.is_string()) {
                const std::string shown = given.is_array() ? "an array" : given.dump();
                reader.fault(
                    "", "E-JSON-TYPE", "this is " + shown + "; it must be a string or an object");
            }
            if (!reader.failed()) read(reader, element);
        }
    }

    void read_asset(const JsonReader& reader, const json& tree) {
        constexpr std::array<std::string_view, 2> known = {"files", "options"};
        check_known_keys(reader, known, "E-JOB-KEY");
        reader.require("files");
        const std::string pattern = reader.text("files");
        const std::vector<std::string> files = files_of(pattern);
        if (files.empty() && missing_.pattern.empty()) missing_ = {pattern, reader.pointer()};
        for (const std::string& file : files) {
            JobRun run{common_, job_.assets++};
            run.arguments.scene_file = file;
            read_options(reader_, tree_, run);
            read_options(reader, tree, run);
            each_element("looks", "name", [&](const auto& look, const json& of) {
                read_look(look, of, run);
            });
        }
    }

    void read_look(const JsonReader& reader, const json& tree, JobRun run) {
        constexpr std::array<std::string_view, 2> known = {"name", "options"};
        check_known_keys(reader, known, "E-JOB-KEY");
        run.arguments.look = reader.text("name", "default");
        read_options(reader, tree, run);
        // Outputs without options of their own are files of one rendering.
        JobRun together = run;
        const auto at = static_cast<long>(job_.runs.size());
        each_element("outputs", "file", [&](const auto& output, const json& of) {
            read_output(output, of, run, together);
        });
        if (!together.arguments.outputs.empty() || !tree_.contains("outputs"))
            job_.runs.insert(job_.runs.begin() + at, std::move(together));
    }

    void read_output(const JsonReader& reader, const json& tree, JobRun run, JobRun& together) {
        constexpr std::array<std::string_view, 2> known = {"file", "options"};
        check_known_keys(reader, known, "E-JOB-KEY");
        if (!tree_.contains("outputs")) return;
        reader.require("file");
        const std::string file = reader.text("file");
        run.places[file] = together.places[file] = reader.pointer();
        if (!tree.contains("options")) {
            together.arguments.outputs.push_back(file);
            return;
        }
        run.arguments.outputs = {file};
        read_options(reader, tree, run);
        job_.runs.push_back(std::move(run));
    }

    /// Equal names of assets get numbers.
    void name_assets() {
        std::vector<std::string> names(job_.assets);
        for (const JobRun& run : job_.runs) {
            const std::filesystem::path file = run.arguments.scene_file;
            names[run.asset] = name_part(file.stem().string());
        }
        names = distinct_names(std::move(names));
        for (JobRun& run : job_.runs) {
            run.arguments.asset = names[run.asset];
            run.arguments.list.manifest = job_.manifest;
            if (job_.manifest) run.places["--manifest"] = json_pointer_part("manifest");
        }
    }

    JsonFault& fault_;
    const JsonReader reader_;
    const json& tree_;
    const RenderArguments& common_;
    BatchJob job_;
    Missing missing_;
};

}  // namespace

Result<BatchJob> read_batch_job(const std::string& file, const RenderArguments& common, Log& log) {
    const Result<json> tree = read_json_file(
        file, largest_file, {ExitCode::bad_resource, "E-JOB-MISSING", file, "the job's file"}, log);
    if (!tree) return fail(tree.error());
    JsonFault fault;
    fault.file = file;
    JobReading reading(*tree, common, fault);
    BatchJob job = reading.read();
    if (fault.error) return fail(std::move(*fault.error));
    if (const auto& [pattern, place] = reading.missing(); !pattern.empty()) {
        return fail(ExitCode::missing_scene,
                    "E-JOB-ASSETS",
                    file + "#" + place,
                    in_quotes(pattern) + " fits no file");
    }
    for (JobRun& run : job.runs) {
        for (auto& [option, place] : run.places)
            place = file + "#" + place;
    }
    return job;
}

void warn_of_unused_options(const BatchJob& job,
                            const std::vector<const RenderRequest*>& requests,
                            Log& log) {
    // What is common to several outputs may be for one of them alone.
    std::map<std::string, UnusedOption> unused;  // by place
    std::set<std::string> used;
    for (size_t i = 0; i < job.runs.size(); ++i) {
        const JobRun& run = job.runs[i];
        std::map<std::string, UnusedOption> here;
        for (UnusedOption& option : unused_options(run.arguments, *requests[i])) {
            const auto place = run.places.find(option.name);
            if (place != run.places.end()) here.emplace(place->second, std::move(option));
        }
        for (const auto& [option, place] : run.places) {
            if (here.count(place) == 0) used.insert(place);
        }
        unused.merge(here);
    }
    for (const auto& [place, option] : unused) {
        if (used.count(place) == 0) log.warn(place, option.why);
    }
}

Result<RenderRequest> request_of_run(const JobRun& run) {
    for (const std::string& output : run.arguments.outputs) {
        const Result<OutputTarget> target = output_target(output);
        if (!target) return fail(at_its_place(target.error(), run.places));
    }
    Result<RenderRequest> request = make_render_request(run.arguments);
    if (!request) return fail(at_its_place(request.error(), run.places));
    return request;
}

}  // namespace obscura::app
