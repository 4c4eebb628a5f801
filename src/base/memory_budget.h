// base/memory_budget.h - the process's memory budget: what is to be allocated is charged before.
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "base/error.h"

#include <cstdint>
#include <memory>
#include <string>

namespace obscura {

/// What memory is for. To add one: append it, and its words in memory_budget.cpp.
enum class MemoryUse { program, scene_text, buffers, textures, geometry, environment, bvh, film };

/// The budget of the process, whose memory all its sessions share. There is none until one is set.
///
/// In      source: for messages: "--max-memory 4 GiB"
void set_memory_limit(uint64_t bytes, const std::string& source);
void remove_memory_limit();

/// How much of the budget is taken, from 0 to 1; 0: there is none.
double memory_share_taken();

/// What the program takes before it reads anything: its code, its libraries, its threads' stacks.
inline constexpr uint64_t program_memory_bytes = 160U << 20;

/// Bytes of the budget, given back when the last copy goes. Kept beside what they pay for.
class MemoryCharge {
public:
    struct Item;

    MemoryCharge() = default;
    explicit MemoryCharge(std::shared_ptr<Item> item) : item_(std::move(item)) {}

    uint64_t bytes() const;

    /// Adds bytes, or gives some back. Returns false, and adds none, when they do not fit. Without
    /// an item nothing is counted and everything fits.
    bool change(int64_t bytes) const;

private:
    std::shared_ptr<Item> item_;
};

/// Takes bytes from the budget.
///
/// In      where: what they are for, a file or an option; the largest are named in messages
/// Errors  33 E-MEM they do not fit: the message names the limit and the largest uses
Result<MemoryCharge> charge_memory(MemoryUse use, const std::string& where, uint64_t bytes);

/// The error of charge_memory.
Error memory_refusal(MemoryUse use, const std::string& where, uint64_t bytes);

/// The largest uses: "textures 3.1 GiB, of which a.png 1.6 GiB; geometry 0.4 GiB"; empty: none.
std::string memory_items();

/// "1.6 GiB", "25 MiB", "312 bytes".
std::string memory_text(uint64_t bytes);

}  // namespace obscura
