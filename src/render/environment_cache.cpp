// render/environment_cache.cpp - the sampling tables of environments, for scenes that follow.
// SPDX-License-Identifier: Apache-2.0
#include "render/environment_cache.h"

#include "image/environment_memory.h"
#include "light/studio.h"

#include <algorithm>

namespace obscura {

Result<std::shared_ptr<const EnvironmentCache::Charged>> EnvironmentCache::make(
    const EnvironmentSource& source, const std::string& name) {
    std::vector<float> studio_pixels;
    EnvironmentImage image{studio_width, studio_height, nullptr};
    if (source.image) {
        image = {source.image->width, source.image->height, source.image->pixels.data()};
    } else {
        studio_pixels = make_studio_pixels();
        image.rgb = studio_pixels.data();
    }
    const uint64_t bytes = environment_table_bytes(image.width, image.height);
    Result<MemoryCharge> charge = charge_memory(MemoryUse::environment, name, bytes);
    if (!charge) return fail(std::move(charge.error()));
    Result<EnvironmentTable> table =
        EnvironmentTable::create(image, source.intensity, 0, source.sampling);
    if (!table) return fail(std::move(table.error()));
    return std::make_shared<const Charged>(Charged{std::move(*table), std::move(*charge)});
}

Result<std::shared_ptr<const EnvironmentTable>> EnvironmentCache::table(
    const EnvironmentSource& source, const std::string& name) {
    const auto share = [](const std::shared_ptr<const Charged>& made) {
        return std::shared_ptr<const EnvironmentTable>(made, &made->table);
    };
    for (const Entry& entry : entries_) {
        if (entry.source == source) return share(entry.made);
    }
    // Before the new one is made, as both may not fit.
    drop_unheld();
    std::erase_if(entries_, [&](const Entry& entry) { return entry.source.image == source.image; });
    Result<std::shared_ptr<const Charged>> made = make(source, name);
    if (!made) return fail(std::move(made.error()));
    entries_.push_back({source, *made});
    return share(*made);
}

void EnvironmentCache::drop_unheld() {
    std::erase_if(entries_, [](const Entry& entry) { return entry.source.image.use_count() == 1; });
}

bool EnvironmentCache::drop_unused() {
    return std::erase_if(entries_, [](const Entry& entry) { return entry.made.use_count() == 1; }) >
           0;
}

}  // namespace obscura
