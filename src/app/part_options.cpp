// app/part_options.cpp - the options for a share of a picture or a sequence.
// SPDX-License-Identifier: Apache-2.0
#include "app/part_options.h"

#include "app/option_readers.h"
#include "app/render_options.h"
#include "app/render_request.h"
#include "render/integrators.h"

#include <cstdlib>

namespace obscura::app {

namespace {

using A = RenderArguments;
using P = PartArguments;
using R = RenderRequest;

constexpr std::array<Choice<PartBy>, 4> divisions = {{{"auto", PartBy::automatic},
                                                      {"tiles", PartBy::tiles},
                                                      {"samples", PartBy::samples},
                                                      {"frames", PartBy::frames}}};

constexpr std::array<Choice<FarmManager>, 4> managers = {{{"none", FarmManager::none},
                                                          {"deadline", FarmManager::deadline},
                                                          {"alf", FarmManager::alfred},
                                                          {"openjd", FarmManager::openjd}}};

// clang-format off
constexpr OptionEntry<A, R> entries[] = {
    {{.name = "--part", .argument = "I/N|auto",
      .help = "Render the I-th of N parts, I from 1: a picture's into the file "
              "OUTPUT.I-of-N.film, for `obscura merge`; a sequence's frames into their files. "
              "auto: as srun, sbatch --array or mpirun numbers this process",
      .fallback = "all of it", .excludes = {"--check"}},
     text_at<&A::part, &P::part>, parsed_at<parse_part, &R::part>},
    {{.name = "--part-by", .argument = "NAME",
      .help = "What parts divide among them: bands of a picture's tiles, the samples of all its "
              "pixels in blocks of 16, or a sequence's frames:",
      .fallback = "frames with --frames, else tiles", .needs = {"--part"}},
     text_at<&A::part, &P::by>, choice_at<divisions, &R::part_by>},
    {{.name = "--farm", .argument = "NAME",
      .help = "Print what a farm manager reads beside `Progress: 42%`, on terminals and with "
              "--quiet, too:"},
     text_at<&A::part, &P::farm>, choice_at<managers, &R::farm>}};
// clang-format on

/// Variables by which a launcher numbers its processes.
struct Launcher {
    const char* index;
    const char* count;
    const char* first;  ///< the index of the first one; null: 0
};
constexpr std::array<Launcher, 4> launchers = {
    {{"SLURM_ARRAY_TASK_ID", "SLURM_ARRAY_TASK_COUNT", "SLURM_ARRAY_TASK_MIN"},
     {"SLURM_PROCID", "SLURM_NTASKS", nullptr},
     {"OMPI_COMM_WORLD_RANK", "OMPI_COMM_WORLD_SIZE", nullptr},
     {"PMI_RANK", "PMI_SIZE", nullptr}}};

Result<FilmPart> checked_part(int64_t index, int64_t count, const std::string& option) {
    if (index >= 0 && index < count)
        return FilmPart{static_cast<int>(index), static_cast<int>(count)};
    return fail(ExitCode::usage,
                "E-USAGE-RANGE",
                option,
                "there is no part " + std::to_string(index + 1) + " of " + std::to_string(count) +
                    "; expected I/N such as 2/7, I from 1 to N");
}

Result<FilmPart> part_of_launcher(const std::string& option) {
    for (const Launcher& launcher : launchers) {
        const char* const index = std::getenv(launcher.index);
        const char* const count = std::getenv(launcher.count);
        if (index == nullptr || count == nullptr) continue;
        const char* const first = launcher.first ? std::getenv(launcher.first) : nullptr;
        const auto number = [&](const char* text, const char* name) {
            return parse_integer(text, name, 0, INT32_MAX);
        };
        const Result<int64_t> i = number(index, launcher.index);
        if (!i) return fail(i.error());
        const Result<int64_t> n = number(count, launcher.count);
        if (!n) return fail(n.error());
        const Result<int64_t> base = first ? number(first, launcher.first) : Result<int64_t>(0);
        if (!base) return fail(base.error());
        return checked_part(*i - *base, *n, option);
    }
    return conflict(option,
                    "auto: neither Slurm nor Open MPI nor PMI numbers this process; give I/N such "
                    "as 2/7");
}

/// True for options that change neither pixels nor outputs.
bool is_left_out(const std::string& name) {
    static const std::vector<std::string> names = {"--part",
                                                   "--part-by",
                                                   "--farm",
                                                   "--display-server",
                                                   "--checkpoint",
                                                   "--checkpoint-interval",
                                                   "--keep-checkpoint",
                                                   "--resume",
                                                   "--time-limit",
                                                   "--snapshot",
                                                   "--skip-existing",
                                                   "--priority",
                                                   "--threads",
                                                   "--max-memory",
                                                   "--texture-memory",
                                                   "--texture-cache",
                                                   "--tile-size",
                                                   "--stats",
                                                   "--manifest",
                                                   "--write-retries",
                                                   "--quiet",
                                                   "--verbose"};
    return std::find(names.begin(), names.end(), name) != names.end();
}

void set(const OptionTarget& target, const std::string& text) {
    if (auto* const* one = std::get_if<OptionText*>(&target)) **one = text;
    if (auto* const* flag = std::get_if<bool*>(&target)) **flag = true;
    if (auto* const* list = std::get_if<std::vector<std::string>*>(&target)) {
        (*list)->push_back(text);
    }
    if (auto* const* name = std::get_if<std::string*>(&target)) **name = text;
}

}  // namespace

Result<FilmPart> parse_part(const std::string& text, const std::string& option) {
    if (text == "auto") return part_of_launcher(option);
    const size_t slash = text.find('/');
    if (slash == std::string::npos) {
        return fail(ExitCode::usage,
                    "E-USAGE-NUMBER",
                    option,
                    in_quotes(text) + " is no part; expected I/N such as 2/7, or auto");
    }
    const Result<int64_t> index = parse_integer(text.substr(0, slash), option, 1, max_film_parts);
    if (!index) return fail(index.error());
    const Result<int64_t> count = parse_integer(text.substr(slash + 1), option, 1, max_film_parts);
    if (!count) return fail(count.error());
    return checked_part(*index - 1, *count, option);
}

Result<void> complete_part(const PartArguments& arguments, RenderRequest& request) {
    if (!request.part) return {};
    const bool has_many = request.frames || request.lists.is_asked();
    if (request.part_by == PartBy::automatic)
        request.part_by = has_many ? PartBy::frames : PartBy::tiles;
    if (request.part_by == PartBy::frames) {
        if (has_many) return {};
        return conflict("--part-by", "frames are of a sequence; add --frames, or use tiles");
    }
    if (has_many) {
        return conflict("--part-by", "many images are divided by frames; leave this out");
    }
    if (request.options.adaptive) {
        return conflict(arguments.part ? "--part" : "--part-by",
                        "adaptive sampling looks at the whole picture; give a fixed --spp");
    }
    if (request.part_by == PartBy::samples) {
        if (is_aov(request.options.integrator))
            return conflict("--part-by", "this integrator takes no samples; use tiles");
        if (request.display_server) {
            return conflict("--display-server",
                            "a share of a picture's samples cannot be shown; use --part-by tiles");
        }
        request.part->of = PartOf::samples;
    }
    if (!request.standard_output) return {};
    return conflict("--part", "a part is written beside an output; give -o a file's name");
}

NamedTexts options_for_merge(const RenderArguments& arguments) {
    RenderArguments copy = arguments;
    NamedTexts out;
    for (const BoundOption& option : bind_all(std::span(render_option_groups()), copy)) {
        const std::string name = long_name(option.info);
        if (is_left_out(name)) continue;
        for (const std::string& text : given_texts(option.target))
            out.emplace_back(name, text);
    }
    return out;
}

Result<void> replay_options(const NamedTexts& options, RenderArguments& arguments) {
    const std::vector<BoundOption> table = bind_all(std::span(render_option_groups()), arguments);
    for (const auto& given : options) {
        const auto option = std::find_if(table.begin(), table.end(), [&](const BoundOption& one) {
            return long_name(one.info) == given.first;
        });
        if (option == table.end()) {
            return fail(ExitCode::configuration,
                        "E-PART-MIX",
                        given.first,
                        "the parts were rendered with an option that this program has not");
        }
        set(option->target, given.second);
    }
    return {};
}

OptionGroup<RenderArguments, RenderRequest> part_of_work_group() {
    return {"Parts", entries};
}

}  // namespace obscura::app
