// film/light_path_plan.h - compiles the light layers of an image into the tables of the stages.
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "film/layers.h"
#include "film/light_groups.h"
#include "stages/light_paths.h"

#include <cstdint>
#include <span>
#include <string>
#include <vector>

namespace obscura {

/// The layers of light groups: of each "light_<group>", and with components
/// "diffuse_direct_<group>" and so on.
std::vector<Layer> light_group_layers(std::span<const std::string> names, bool components);

/// Owns the arrays of LightPathTable. Its light layers are numbered in the order in which they come
/// among all layers.
class LightPathPlan {
public:
    /// In      groups: those of the scene; with one name, "rest", when none are asked for
    ///         class_of_light: by index of light sampling
    /// Errors  64 E-LPE when the expressions need too many states
    static Result<LightPathPlan> make(std::span<const Layer> layers,
                                      const Scene& scene,
                                      const LightGroups& groups,
                                      std::vector<uint16_t> class_of_light);

    LightPathTable table() const;

private:
    void group_emitters(const Scene& scene, const LightGroups& groups);
    void find_class_runs();
    void find_common_states();
    void number_sums();

    /// Light classes that states do not tell apart.
    struct Sums {
        std::vector<uint16_t> of_class;  ///< number of the sum by class, or no_light_sum
        std::vector<uint16_t> classes;   ///< by number: one of its classes
    };
    template <typename Counts>
    Sums sums_for(const Counts& counts) const;

    std::vector<uint16_t> next_, common_next_, layers_, class_of_light_;
    std::vector<LightClassRun> class_runs_;
    Sums settled_sums_, resting_sums_;
    std::vector<uint16_t> group_of_primitive_, group_of_instance_;
    std::vector<uint8_t> settled_;
    std::vector<uint32_t> layer_begin_;
    int layer_count_ = 0;
    uint32_t group_count_ = 1;
    uint32_t environment_group_ = 0;
    bool shadow_ = false;
};

}  // namespace obscura
