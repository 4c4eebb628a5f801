// app/memory_option.cpp - `--max-memory`, `--texture-memory`: sizes, and the memory budget.
// SPDX-License-Identifier: Apache-2.0
#include "app/memory_option.h"

#include "app/numbers.h"
#include "base/memory_budget.h"
#include "base/parallel.h"
#include "base/setting_names.h"

#include <cstdlib>
#include <fmt/format.h>

namespace obscura::app {

namespace {

constexpr double default_percent = 80;

/// Bytes of a unit: "", K, M, G or T, which B or iB may follow; nothing for other texts.
std::optional<double> unit_bytes(std::string_view unit) {
    if (unit.ends_with("iB")) {
        unit.remove_suffix(2);
        if (unit.empty()) return {};
    } else if (unit.ends_with("B")) {
        unit.remove_suffix(1);
    }
    if (unit.empty()) return 1;
    constexpr std::string_view letters = "KMGT";
    const size_t power = letters.find(unit);
    if (unit.size() != 1 || power == std::string_view::npos) return {};
    return static_cast<double>(1ULL << 10 * (power + 1));
}

/// Where programs keep what they can make again; "": the user has no such folder.
/// Source  XDG Base Directory Specification 0.8
std::filesystem::path user_cache() {
    if (const char* const folder = std::getenv("XDG_CACHE_HOME");
        folder != nullptr && *folder == '/')
        return folder;
    const char* const home = std::getenv("HOME");
    if (home == nullptr || *home == '\0') return {};
    return std::filesystem::path(home) / ".cache";
}

uint64_t share_of(uint64_t bytes, double percent) {
    return static_cast<uint64_t>(static_cast<double>(bytes) * (percent / 100));
}

}  // namespace

Result<MemorySize> parse_memory_size(const std::string& text, const std::string& option) {
    const size_t end = std::min(text.find_first_not_of("0123456789."), text.size());
    const std::string number = text.substr(0, end);
    const std::string_view unit = std::string_view(text).substr(end);
    constexpr double max_bytes = 1ULL << 60;
    if (unit == "%") {
        const Result<double> percent = parse_real(number, option, 1, 100);
        if (!percent) return fail(percent.error());
        return MemorySize{0, *percent};
    }
    const std::optional<double> scale = unit_bytes(unit);
    if (!scale || number.empty()) {
        return fail(ExitCode::usage,
                    "E-USAGE-NUMBER",
                    option,
                    "\"" + text +
                        "\" is no size; accepted are 512M, 4G, 1.5G, 80% or a number of "
                        "bytes");
    }
    constexpr double min_bytes = 1U << 20;
    const Result<double> count = parse_real(number, option, min_bytes / *scale, max_bytes / *scale);
    if (!count) return fail(count.error());
    return MemorySize{static_cast<uint64_t>(*count * *scale), 0};
}

Result<void> use_memory_limit(const std::optional<MemorySize>& asked, const MemoryBound& bound) {
    const MemorySize size = asked.value_or(MemorySize{0, default_percent});
    if (size.percent == 0) {
        set_memory_limit(size.bytes, "which is " + setting("max-memory"));
    } else if (bound.bytes == UINT64_MAX) {
        remove_memory_limit();
    } else {
        set_memory_limit(share_of(bound.bytes, size.percent),
                         fmt::format("{:g} % of {}", size.percent, bound.source));
    }
    // Nothing more, but an error where the program alone is too large.
    const Result<MemoryCharge> itself = charge_memory(MemoryUse::program, "", 0);
    if (!itself) return fail(itself.error());
    return {};
}

Result<void> start_threads_ahead() {
    static bool started = false;
    const uint64_t left = address_space_left();
    if (started || left == UINT64_MAX) return {};
    // Beside the stacks, what any scene needs.
    constexpr uint64_t mebibyte = uint64_t{1} << 20;
    const uint64_t needed = 160 * mebibyte + max_thread_index() * 8 * mebibyte;
    if (auto fit = check_address_space(left, needed, "rendering"); !fit) return fit;
    start_threads();
    started = true;
    return {};
}

Result<void> complete_texture_limit(RenderRequest& request) {
    if (!request.texture_memory) return {};
    const MemorySize& size = *request.texture_memory;
    std::filesystem::path folder = request.texture_cache;
    if (folder.empty()) {
        const std::filesystem::path cache = user_cache();
        if (cache.empty()) {
            return fail(
                ExitCode::usage,
                "E-USAGE-CONFLICT",
                setting("texture-memory"),
                "there is no $HOME to keep texels in; give " + setting("texture-cache") + " DIR");
        }
        folder = cache / "obscura" / "textures";
    }
    const uint64_t bytes =
        size.percent == 0 ? size.bytes : share_of(memory_bound().bytes, size.percent);
    request.load.texture_limit = {bytes, std::move(folder)};
    return {};
}

}  // namespace obscura::app
