// serve/job_check.cpp - a client's job becomes one that may run.
// SPDX-License-Identifier: Apache-2.0
#include "serve/job_check.h"

#include "base/json/object_reader.h"
#include "base/log.h"
#include "base/text.h"

#include "serve/known_files.h"
#include "serve/option_names.h"
#include <algorithm>
#include <charconv>
#include <initializer_list>
#include <optional>
#include <string_view>

namespace obscura::serve {

namespace {

using nlohmann::json;

constexpr size_t max_assets = 2000;

/// Whether a name stays in the folder that it is looked up from.
bool stays_inside(const std::string& name) {
    const std::filesystem::path path = name;
    return !name.empty() && name.find('\0') == std::string::npos && path.is_relative() &&
           std::find(path.begin(), path.end(), "..") == path.end();
}

bool has_signs(const std::string& pattern) {
    return pattern.find_first_of("*?[") != std::string::npos;
}

void replace_all(std::string& text, const std::string& old, const std::string& by) {
    for (size_t at = 0; (at = text.find(old, at)) != std::string::npos; at += by.size())
        text.replace(at, old.size(), by);
}

/// Keeps the first fault; all else goes on as if there were none.
class JobCheck {
public:
    JobCheck(const json& given, const JobFiles& files, const Options& common)
        : given_(given), files_(files), common_(common) {}

    Result<CheckedJob> check() {
        check_keys(
            given_,
            "",
            {"assets", "options", "looks", "outputs", "manifest", "contact_sheet", "comment"});
        if (!given_.contains("assets"))
            fault("E-DOC-MISSING", "", "the member \"assets\" is required");
        Options options = common_;
        options.update(checked_options(given_, ""));
        out_.job = json{{"options", options}, {"assets", json::array()}};
        each_element("assets", "files", [&](json element, size_t index, const std::string& place) {
            add_assets(std::move(element), index, place);
        });
        each_element("looks", "name", [&](json element, size_t, const std::string&) {
            out_.job["looks"].push_back(std::move(element));
        });
        each_element("outputs", "file", [&](json element, size_t, const std::string& place) {
            add_output(std::move(element), place);
        });
        choose_own_files();
        if (error_) return fail(std::move(*error_));
        return std::move(out_);
    }

private:
    void fault(const char* id, const std::string& place, const std::string& message) {
        if (!error_) error_ = Error{ExitCode::bad_data, id, escape_control(place), message};
    }
    /// An error of the server's files, with its place in the job.
    void refuse(Error error, const std::string& place) {
        if (!error.where.empty()) error.message = error.where + ": " + error.message;
        error.where = escape_control(place);
        if (!error_) error_ = std::move(error);
    }

    void check_keys(const json& object,
                    const std::string& place,
                    std::initializer_list<std::string_view> known) {
        for (const auto& [key, value] : object.items()) {
            if (std::find(known.begin(), known.end(), key) == known.end())
                fault("E-JOB-KEY", place + json_pointer_part(key), "there is no such member");
        }
    }

    /// Calls add(element, index, place) for each element of an array, with checked options. A
    /// string stands for an object with that string as the member `name`.
    template <typename Add>
    void each_element(const char* key, const char* name, const Add& add) {
        const auto list = given_.find(key);
        if (list == given_.end()) return;
        const std::string pointer = json_pointer_part(key);
        if (!list->is_array() || list->empty()) {
            fault("E-JOB-VALUE", pointer, "expected an array with one element at least");
            return;
        }
        for (size_t i = 0; i < list->size() && !error_; ++i) {
            const std::string place = pointer + "/" + std::to_string(i);
            json element = list->at(i);
            if (element.is_string()) element = json::object({{name, element}});
            if (!element.is_object()) {
                fault("E-JOB-VALUE", place, "expected a string or an object");
                return;
            }
            check_keys(element, place, {name, "options"});
            if (element.contains(name) && !element.at(name).is_string())
                fault("E-JOB-VALUE", place + "/" + name, "expected a string");
            if (element.contains("options")) element["options"] = checked_options(element, place);
            if (!error_) add(std::move(element), i, place);
        }
    }

    /// The member "options" of an object; none: an empty object.
    Options checked_options(const json& object, const std::string& place) {
        const auto options = object.find("options");
        if (options == object.end()) return Options::object();
        const std::string inside = place + "/options";
        if (!options->is_object()) {
            fault("E-JOB-VALUE", inside, "expected an object");
            return Options::object();
        }
        for (const auto& [key, value] : options->items()) {
            if (!is_job_option(key)) {
                fault("E-JOB-KEY",
                      inside + json_pointer_part(key),
                      "there is no such option for a job of a server");
            }
        }
        // Its value is looked up as one name: an array would be put together later.
        const auto env = options->find("env");
        if (env != options->end() && !env->is_string())
            fault("E-JOB-VALUE", inside + "/env", "expected a string");
        if (error_) return Options::object();
        Result<Options> found = files_.options(*options);
        if (found) return keep_env_name(*options, std::move(*found));
        refuse(found.error(), inside + "/env");
        return Options::object();
    }

    Options keep_env_name(const Options& given, Options found) {
        const auto env = found.find("env");
        if (env != found.end() && *env != given.at("env"))
            out_.names[env->get<std::string>()] = given.at("env").get<std::string>();
        return found;
    }

    void add_assets(json element, size_t index, const std::string& place) {
        if (!element.contains("files")) {
            fault("E-DOC-MISSING", place, "the member \"files\" is required");
            return;
        }
        const auto pattern = element.at("files").get<std::string>();
        for (const std::string& name : names_of(pattern, place + "/files")) {
            const Result<std::filesystem::path> file = files_.find(name);
            if (!file) {
                refuse(file.error(), place + "/files");
                return;
            }
            if (out_.asset_of.size() == max_assets) {
                refuse({ExitCode::refused,
                        "E-JOB-LIMIT",
                        "",
                        "a job may have " + std::to_string(max_assets) + " assets at most"},
                       place);
                return;
            }
            element["files"] = file->string();
            out_.job["assets"].push_back(element);
            out_.asset_of.push_back(index);
            out_.names[file->string()] = name;
        }
    }

    /// The names that a pattern stands for: itself, where there is such a file.
    std::vector<std::string> names_of(const std::string& pattern, const std::string& place) {
        const bool was_sent = is_upload(pattern);
        if (!was_sent && !stays_inside(pattern)) {
            refuse({ExitCode::refused,
                    "E-URI-REFUSED",
                    escape_control(pattern),
                    "the name leads out of the folders that the server shows"},
                   place);
            return {};
        }
        if (was_sent || !has_signs(pattern) || files_.find(pattern)) return {pattern};
        std::vector<std::string> names = files_.match(pattern);
        if (names.empty()) {
            refuse({ExitCode::missing_scene,
                    "E-JOB-ASSETS",
                    "",
                    in_quotes(escape_control(pattern)) + " fits no file"},
                   place);
        }
        return names;
    }

    void check_own_name(const std::string& name, const std::string& place) {
        if (stays_inside(name) && name != "-") return;
        refuse({ExitCode::refused,
                "E-JOB-PATH",
                escape_control(name),
                "expected a file's name below the job's folder: relative, without .."},
               place);
    }

    void add_output(json element, const std::string& place) {
        if (!element.contains("file")) {
            fault("E-DOC-MISSING", place, "the member \"file\" is required");
            return;
        }
        const auto file = element.at("file").get<std::string>();
        check_own_name(file, place);
        // Without options it is a further file of one rendering, which a string stands for.
        if (!element.contains("options")) element = file;
        out_.job["outputs"].push_back(std::move(element));
    }

    std::optional<std::string> own_file(const char* key) {
        const auto name = given_.find(key);
        if (name == given_.end()) return {};
        if (!name->is_string()) {
            fault("E-JOB-VALUE", json_pointer_part(key), "expected a string");
            return {};
        }
        check_own_name(name->get<std::string>(), json_pointer_part(key));
        return name->get<std::string>();
    }

    /// A manifest there is always: it tells how far the job is.
    void choose_own_files() {
        const auto manifest = own_file("manifest"), sheet = own_file("contact_sheet");
        out_.manifest = "manifest.jsonl";
        if (sheet)
            out_.manifest = std::filesystem::path(*sheet).replace_extension(".jsonl").string();
        if (manifest) out_.manifest = *manifest;
        out_.job["manifest"] = out_.manifest;
        if (sheet) out_.job["contact_sheet"] = *sheet;
    }

    const json& given_;
    const JobFiles& files_;
    const Options& common_;
    CheckedJob out_;
    std::optional<Error> error_;
};

/// "/assets/7/options" with the client's index in place of the 7.
std::string client_pointer(const CheckedJob& job, const std::string& pointer) {
    constexpr std::string_view start = "/assets/";
    if (!pointer.starts_with(start)) return pointer;
    size_t index = 0;
    const char* const end = pointer.data() + pointer.size();
    const auto [rest, error] = std::from_chars(pointer.data() + start.size(), end, index);
    if (error != std::errc() || index >= job.asset_of.size()) return pointer;
    return std::string(start) + std::to_string(job.asset_of[index]) + std::string(rest, end);
}

/// Where a job first sets an option; "": nowhere.
std::string pointer_of_option(const json& job, const std::string& key) {
    const std::string inside = "/options" + json_pointer_part(key);
    const auto sets = [](const json& tree, const std::string& pointer) {
        return tree.contains(json::json_pointer(pointer));
    };
    for (const char* const list : {"/outputs", "/looks", "/assets"}) {
        const json::json_pointer place(list);
        const size_t count = job.contains(place) ? job.at(place).size() : 0;
        for (size_t i = 0; i < count; ++i) {
            const std::string pointer = list + ("/" + std::to_string(i)) + inside;
            if (sets(job, pointer)) return pointer;
        }
    }
    return sets(job, inside) ? inside : "";
}

}  // namespace

Result<CheckedJob> check_job(const json& job, const JobFiles& files, const Options& common) {
    return JobCheck(job, files, common).check();
}

std::string client_text(const CheckedJob& job, std::string text) {
    for (const auto& [file, name] : job.names)
        replace_all(text, file, name);
    replace_all(text, std::string(job_file_name) + "#", "");
    return text;
}

Error client_error(const CheckedJob& job, Error error) {
    error.where = client_text(job, std::move(error.where));
    if (error.where.starts_with("--")) {
        const std::string pointer = pointer_of_option(job.job, error.where.substr(2));
        if (!pointer.empty()) error.where = pointer;
    }
    error.where = client_pointer(job, error.where);
    if (error.where == job_file_name) error.where = "job";
    error.message = client_text(job, std::move(error.message));
    for (Error& other : error.also)
        other = client_error(job, std::move(other));
    return error;
}

}  // namespace obscura::serve
