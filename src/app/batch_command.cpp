// app/batch_command.cpp - the subcommand `obscura batch`: a job of many pictures.
// SPDX-License-Identifier: Apache-2.0
#include "app/batch_command.h"

#include "app/batch_job.h"
#include "app/contact_sheet.h"
#include "app/distinct_files.h"
#include "app/outcome.h"
#include "app/part_options.h"
#include "app/render_command.h"
#include "app/render_options.h"

#include <algorithm>
#include <filesystem>
#include <system_error>

namespace obscura::app {

namespace {

constexpr const char* batch_notes = R"(
The job is a JSON file (docs/batch.md): which assets, in which looks, to which outputs. What
stands in the options of `obscura render` stands there by the same names.

Example:
  {"assets": ["products/*.glb"],
   "options": {"size": "800x600", "page": "white", "variants": "all"},
   "looks": [{"name": "day", "options": {"env": "sky:40,30"}}, {"name": "studio"}],
   "outputs": ["out/{asset}/{look}/{variant}.webp"],
   "contact_sheet": "out/index.html"}

  obscura batch job.json --dry-run
      names the files
  obscura batch job.json --check
      says what would fail
  obscura batch job.json --skip-existing
      renders what is not there yet)";

constexpr OptionInfo job_option = {.name = "JOB", .help = "The job, a JSON file", .files = "json"};
constexpr OptionInfo dry_run_option = {
    .name = "--dry-run",
    .help =
        "Print the names of all files, and render nothing. Assets are read where only they "
        "tell cameras or variants"};
constexpr OptionInfo check_option = {
    .name = "--check",
    .help =
        "Read every asset, look for the cameras and variants of every picture, and report; nothing "
        "is rendered or written. The exit code is the one that rendering would begin with",
    .excludes = {"--dry-run"}};
constexpr OptionInfo part_option = {
    .name = "--part",
    .argument = "I/N|auto",
    .help =
        "Render share I of N: every N-th asset, or, where there are fewer assets than N, every "
        "N-th picture. auto takes both from the launcher, as for `obscura render`",
    .fallback = "all"};

/// Options of `obscura render` that are a command's and not a picture's.
constexpr std::array command_options = {"--skip-existing",
                                        "--time-limit",
                                        "--threads",
                                        "--priority",
                                        "--max-memory",
                                        "--texture-memory",
                                        "--texture-cache",
                                        "--isa",
                                        "--display-server",
                                        "--write-retries",
                                        "--quiet",
                                        "--verbose"};

/// Whether a run is for another part: assets are divided where there are enough of them.
bool is_of_another_part(const JobRun& run, const BatchJob& job, const FilmPart& part) {
    if (job.assets < static_cast<size_t>(part.count)) return false;
    return run.asset % static_cast<size_t>(part.count) != static_cast<size_t>(part.index);
}

/// The runs of a job; those of other parts are marked.
Result<std::vector<SceneRun>> runs_of(const BatchJob& job,
                                      const BatchArguments& arguments,
                                      const std::optional<FilmPart>& part) {
    std::vector<SceneRun> runs;
    for (size_t i = 0; i < job.runs.size(); ++i) {
        const JobRun& run = job.runs[i];
        Result<RenderRequest> request = request_of_run(run);
        if (!request) return fail(request.error());
        if (part && job.assets < static_cast<size_t>(part->count)) {
            request->part = part;
            request->part_by = PartBy::frames;
            request->lists.part_offset = i;
        }
        request->lists.lists_only = arguments.dry_run;
        request->lists.makes_folders = true;
        request->check = arguments.check;
        request->lists.shares_manifest = part.has_value();
        runs.push_back({std::move(*request), options_for_merge(run.arguments)});
        runs.back().places = run.places;
        runs.back().is_of_another_part = part && is_of_another_part(run, job, *part);
    }
    return runs;
}

/// A job's own files replace neither the job nor what it reads.
Result<void> check_own_files(const BatchJob& job,
                             const std::string& job_file,
                             const std::vector<SceneRun>& runs) {
    std::vector<std::filesystem::path> read = {job_file}, written;
    for (const SceneRun& run : runs) {
        for (const std::filesystem::path& file : files_read(run.request))
            read.push_back(file);
    }
    if (job.manifest) written.emplace_back(*job.manifest);
    if (job.contact_sheet) written.emplace_back(*job.contact_sheet);
    return check_not_read(written, read);
}

/// The folders of the job's own files; where that fails, writing will say why.
void make_folders(const BatchJob& job) {
    for (const auto* file : {&job.manifest, &job.contact_sheet}) {
        std::error_code ignored;
        if (*file)
            std::filesystem::create_directories(std::filesystem::path(**file).parent_path(),
                                                ignored);
    }
}

int run_batch(const BatchArguments& arguments) {
    TerminalLog log(verbosity_of(arguments.render));
    BatchArguments texts = arguments;
    if (auto fit = check_combinations(batch_command(texts).options); !fit)
        return report_failure(fit.error(), log);
    std::optional<FilmPart> part;
    if (arguments.part) {
        const Result<FilmPart> parsed = parse_part(*arguments.part, "--part");
        if (!parsed) return report_failure(parsed.error(), log);
        part = *parsed;
    }
    Result<BatchJob> job = read_batch_job(arguments.job_file, arguments.render, log);
    if (!job) return report_failure(job.error(), log);
    Result<std::vector<SceneRun>> runs = runs_of(*job, arguments, part);
    if (!runs) return report_failure(runs.error(), log);
    const Result<void> apart = check_own_files(*job, arguments.job_file, *runs);
    if (!apart) return report_failure(apart.error(), log);
    const bool has_none = std::all_of(
        runs->begin(), runs->end(), [](const SceneRun& run) { return run.is_of_another_part; });
    if (has_none) {
        log.info("this part of the job has no pictures");
        return report_success(arguments.job_file, log);
    }
    std::vector<const RenderRequest*> requests;
    for (const SceneRun& run : *runs)
        requests.push_back(&run.request);
    warn_of_unused_options(*job, requests, log);
    const bool renders = !arguments.dry_run && !arguments.check;
    if (renders) make_folders(*job);
    return run_scenes(*runs, arguments.job_file, log, [&]() -> Result<void> {
        if (!job->contact_sheet || !renders) return {};
        return write_contact_sheet(*job->manifest, *job->contact_sheet);
    });
}

}  // namespace

Command batch_command(BatchArguments& arguments) {
    Command command{"batch", "Render a job: many assets in many looks", batch_notes};
    command.options = {{job_option, "", &arguments.job_file},
                       {dry_run_option, "", &arguments.dry_run},
                       {check_option, "", &arguments.check},
                       {part_option, "", &arguments.part}};
    for (const char* name : command_options)
        add_render_option(command, arguments.render, name, "Program");
    command.run = [&arguments] { return run_batch(arguments); };
    return command;
}

}  // namespace obscura::app
