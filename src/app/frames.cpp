// app/frames.cpp - the options that ask for a sequence and for an open shutter.
// SPDX-License-Identifier: Apache-2.0
#include "app/frames.h"

#include "app/numbers.h"

namespace obscura::app {

namespace {

constexpr int64_t last_frame = 999999;

constexpr double max_frames_open = 1000;

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

Result<FrameRange> parse_frames(std::string_view text, std::string_view option) {
    const size_t dash = text.find('-');
    const std::string_view last_text =
        dash == std::string_view::npos ? text : text.substr(dash + 1);
    const Result<int64_t> first = parse_integer(text.substr(0, dash), option, 0, last_frame);
    if (!first) return fail(first.error());
    const Result<int64_t> last = parse_integer(last_text, option, 0, last_frame);
    if (!last) return fail(last.error());
    if (*last < *first) {
        return fail(ExitCode::usage,
                    "E-USAGE-RANGE",
                    std::string(option),
                    in_quotes(text) + " ends before it begins; expected FIRST-LAST such as 1-120");
    }
    FrameRange out;
    out.first = static_cast<int>(*first);
    out.last = static_cast<int>(*last);
    return out;
}

}  // namespace obscura::app
