// base/memory_budget.cpp - the process's memory budget: what is to be allocated is charged before.
// SPDX-License-Identifier: Apache-2.0
#include "base/memory_budget.h"

#include "base/setting_names.h"

#include <algorithm>
#include <array>
#include <atomic>
#include <cmath>
#include <cstdio>
#include <mutex>
#include <set>
#include <vector>

namespace obscura {

struct MemoryCharge::Item {
    Item(MemoryUse use_of, std::string where_of) : use(use_of), where(std::move(where_of)) {}
    ~Item();
    Item(const Item&) = delete;
    Item& operator=(const Item&) = delete;

    MemoryUse use;
    std::string where;
    std::atomic<int64_t> bytes = 0;
};

namespace {

using Item = MemoryCharge::Item;

constexpr std::array use_words = {"the program",
                                  "the scene's text",
                                  "buffers",
                                  "textures",
                                  "geometry",
                                  "the environment",
                                  "the BVH",
                                  "the film"};

struct Budget {
    std::atomic<int64_t> limit = INT64_MAX;
    std::atomic<int64_t> used = static_cast<int64_t>(program_memory_bytes);
    std::mutex mutex;    // of what follows
    std::string source;  // of the limit
    std::set<Item*> items;
};

Budget& budget() {
    static Budget* const one = new Budget;  // outlives every charge, those of statics too
    return *one;
}

/// Takes bytes unless they exceed the limit.
bool take(int64_t bytes) {
    Budget& all = budget();
    int64_t used = all.used.load(std::memory_order_relaxed);
    do {
        if (bytes >= 0 && bytes > all.limit.load(std::memory_order_relaxed) - used) return false;
    } while (!all.used.compare_exchange_weak(used, used + bytes, std::memory_order_relaxed));
    return true;
}

struct Use {
    int64_t sum = 0;
    int64_t largest = 0;
    std::string where;  ///< of the largest
    size_t count = 0;
};

std::string text_of(MemoryUse use, const Use& all) {
    std::string text = std::string(use_words[static_cast<size_t>(use)]) + " " +
                       memory_text(static_cast<uint64_t>(all.sum));
    if (all.where.empty()) return text;
    if (all.count == 1) return text + " (" + all.where + ")";
    return text + ", of which " + all.where + " " + memory_text(static_cast<uint64_t>(all.largest));
}

}  // namespace

MemoryCharge::Item::~Item() {
    const std::lock_guard lock(budget().mutex);
    budget().items.erase(this);
    take(-bytes.load());
}

uint64_t MemoryCharge::bytes() const {
    return item_ ? static_cast<uint64_t>(std::max<int64_t>(item_->bytes.load(), 0)) : 0;
}

bool MemoryCharge::change(int64_t bytes) const {
    if (!item_) return true;
    if (!take(bytes)) return false;
    item_->bytes.fetch_add(bytes, std::memory_order_relaxed);
    return true;
}

void set_memory_limit(uint64_t bytes, const std::string& source) {
    const std::lock_guard lock(budget().mutex);
    budget().limit = static_cast<int64_t>(std::min<uint64_t>(bytes, INT64_MAX));
    budget().source = source;
}

void remove_memory_limit() {
    set_memory_limit(UINT64_MAX, "");
}

double memory_share_taken() {
    const int64_t limit = budget().limit;
    if (limit == INT64_MAX) return 0;
    return static_cast<double>(budget().used) / static_cast<double>(std::max<int64_t>(limit, 1));
}

Result<MemoryCharge> charge_memory(MemoryUse use, const std::string& where, uint64_t bytes) {
    if (bytes > INT64_MAX / 2) return fail(memory_refusal(use, where, bytes));
    auto item = std::make_shared<Item>(use, where);
    {
        const std::lock_guard lock(budget().mutex);
        budget().items.insert(item.get());
    }
    MemoryCharge charge(std::move(item));
    if (!charge.change(static_cast<int64_t>(bytes))) return fail(memory_refusal(use, where, bytes));
    return charge;
}

Error memory_refusal(MemoryUse use, const std::string& where, uint64_t bytes) {
    Budget& all = budget();
    const auto limit = static_cast<uint64_t>(all.limit.load());
    const uint64_t wanted = use == MemoryUse::program ? program_memory_bytes : bytes;
    std::string source;
    {
        const std::lock_guard lock(all.mutex);
        source = all.source;
    }
    return Error{ExitCode::out_of_memory,
                 "E-MEM",
                 where,
                 std::string(use_words[static_cast<size_t>(use)]) + " would take " +
                     memory_text(wanted) + ", which does not fit in " + memory_text(limit) + ", " +
                     source + "; in use: " + memory_items() + ". A higher " +
                     setting("max-memory") + ", smaller textures, a smaller " + setting("size") +
                     " or fewer layers help"};
}

std::string memory_items() {
    std::array<Use, use_words.size()> uses;
    uses[0] = {static_cast<int64_t>(program_memory_bytes), 0, {}, 1};
    {
        const std::lock_guard lock(budget().mutex);
        for (const Item* item : budget().items) {
            Use& use = uses[static_cast<size_t>(item->use)];
            const int64_t bytes = item->bytes.load();
            if (bytes <= 0) continue;
            use.sum += bytes;
            ++use.count;
            // Of equals the first by name, so that threads' order does not show.
            if (bytes < use.largest || (bytes == use.largest && item->where > use.where)) continue;
            use.largest = bytes;
            use.where = item->where;
        }
    }
    std::vector<size_t> order;
    for (size_t i = 0; i < uses.size(); ++i) {
        if (uses[i].sum > 0) order.push_back(i);
    }
    std::stable_sort(
        order.begin(), order.end(), [&](size_t a, size_t b) { return uses[a].sum > uses[b].sum; });
    std::string text;
    for (const size_t i : order)
        text += (text.empty() ? "" : "; ") + text_of(static_cast<MemoryUse>(i), uses[i]);
    return text;
}

std::string memory_text(uint64_t bytes) {
    constexpr double gibibyte = 1U << 30;
    constexpr double mebibyte = 1U << 20;
    const auto size = static_cast<double>(bytes);
    if (size < mebibyte) return std::to_string(bytes) + " bytes";
    std::array<char, 32> text = {};
    if (size < gibibyte) {
        std::snprintf(text.data(), text.size(), "%.0f MiB", size / mebibyte);
    } else {
        std::snprintf(text.data(), text.size(), "%.1f GiB", size / gibibyte);
    }
    return text.data();
}

}  // namespace obscura
