// render/environment_cache.h - the sampling tables of environments, for scenes that follow.
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "base/memory_budget.h"
#include "image/pixels.h"
#include "light/environment_table.h"

#include <memory>
#include <string>
#include <vector>

namespace obscura {

/// What an environment's table is made of: all but how it is turned.
struct EnvironmentSource {
    std::shared_ptr<const ImageRgb32f> image;  ///< null: the built-in studio
    double intensity = 1;
    EnvironmentSampling sampling = EnvironmentSampling::compensated;

    bool operator==(const EnvironmentSource&) const = default;
};

/// Makes the table of an environment once for all scenes that it lights. Used by one thread at a
/// time.
class EnvironmentCache {
public:
    /// The table of a source, not turned. It stays here until its image has another one. Its bytes
    /// are in the memory budget.
    ///
    /// In      name: for messages
    /// Errors  those of EnvironmentTable::create; 33 E-MEM
    Result<std::shared_ptr<const EnvironmentTable>> table(const EnvironmentSource& source,
                                                          const std::string& name);

    /// Drops tables whose image nobody else holds; table() does so, too, before it makes one.
    void drop_unheld();

    /// Drops tables that no scene uses. False: there was none.
    bool drop_unused();

private:
    struct Charged {
        EnvironmentTable table;
        MemoryCharge charge;
    };
    struct Entry {
        EnvironmentSource source;
        std::shared_ptr<const Charged> made;
    };

    static Result<std::shared_ptr<const Charged>> make(const EnvironmentSource& source,
                                                       const std::string& name);

    std::vector<Entry> entries_;
};

}  // namespace obscura
