// app/frames.cpp - texts of sequences: their frames, names of their files, the open shutter.
// SPDX-License-Identifier: Apache-2.0
#include "app/frames.h"

#include "app/command_line.h"
#include "app/numbers.h"
#include "session/image_names.h"

#include <vector>

namespace obscura::app {

namespace {

constexpr int64_t last_frame = 999999;

constexpr double max_frames_open = 1000;

/// Every step-th frame from the first to the last.
struct SteppedRange {
    int64_t first = 0;
    int64_t last = 0;  ///< inclusive
    int64_t step = 1;
};

/// "7", "1-120" or "1-120x2".
Result<SteppedRange> parse_range(std::string_view text, std::string_view option) {
    const size_t dash = text.find('-');
    const bool is_range = dash != std::string_view::npos;
    const size_t times = is_range ? text.find('x', dash) : std::string_view::npos;
    const bool has_step = times != std::string_view::npos;
    const std::string_view first_text = text.substr(0, dash);
    const std::string_view last_text =
        is_range ? text.substr(0, times).substr(dash + 1) : first_text;
    const std::string_view step_text = has_step ? text.substr(times + 1) : "1";
    const Result<int64_t> first = parse_integer(first_text, option, 0, last_frame);
    if (!first) return fail(first.error());
    const Result<int64_t> last = parse_integer(last_text, option, 0, last_frame);
    if (!last) return fail(last.error());
    const Result<int64_t> step = parse_integer(step_text, option, 1, last_frame);
    if (!step) return fail(step.error());
    if (*last >= *first) return SteppedRange{*first, *last, *step};
    return fail(ExitCode::usage,
                "E-USAGE-RANGE",
                std::string(option),
                in_quotes(text) + " ends before it begins; expected FIRST-LAST such as 1-120");
}

}  // namespace

bool is_shutter_interval(std::string_view text) {
    return text.find(',') != std::string_view::npos;
}

Result<ShutterFractions> parse_shutter_interval(const std::string& text) {
    const NumberList list{"OPEN,CLOSE such as 0,0.5, the second greater than the first",
                          2,
                          2,
                          -max_frames_open,
                          max_frames_open};
    const Result<std::vector<double>> numbers = parse_numbers(text, "--shutter", list);
    if (!numbers) return fail(numbers.error());
    const ShutterFractions out{(*numbers)[0], (*numbers)[1]};
    if (out.open < out.close) return out;
    return fail(ExitCode::usage,
                "E-USAGE-RANGE",
                "--shutter",
                in_quotes(text) + " closes before it opens; expected OPEN,CLOSE such as 0,0.5");
}

Result<FrameList> parse_frames(std::string_view text, std::string_view option) {
    FrameList out;
    std::vector<bool> is_listed(last_frame + 1);
    for (std::string_view rest = text;;) {
        const size_t comma = rest.find(',');
        const Result<SteppedRange> range = parse_range(rest.substr(0, comma), option);
        if (!range) return fail(range.error());
        for (int64_t frame = range->first; frame <= range->last; frame += range->step) {
            const auto at = static_cast<size_t>(frame);
            if (!is_listed[at]) out.numbers.push_back(static_cast<int>(frame));
            is_listed[at] = true;
        }
        if (comma == std::string_view::npos) return out;
        rest.remove_prefix(comma + 1);
    }
}

Result<void> check_frame_patterns(const std::vector<std::filesystem::path>& patterns) {
    for (const std::filesystem::path& pattern : patterns) {
        if (frame_file(pattern, 0) || has_field(pattern, "frame")) continue;
        return conflict(pattern.string(),
                        "with --frames a file's name must say where the frame's number goes; "
                        "expected one run of #, such as shot.####.exr, or {frame:04}");
    }
    return {};
}

}  // namespace obscura::app
