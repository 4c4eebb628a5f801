// base/control_groups.h - the folders of Linux's control groups that limit the process.
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>
#include <functional>
#include <string>

namespace obscura {

/// Visits the folder of the process's control group and of those above it, down to the folder of a
/// mount, of either version. A container may see its own group as the mount, and still be told the
/// group's name outside.
///
/// In      root: where /proc and /sys are; controller: "cpu"; visit: with folders that may not be
///         there
/// Source  Linux, Documentation/admin-guide/cgroup-v2.rst; cgroup-v1/cgroups.rst; cgroups(7)
void visit_control_groups(const std::filesystem::path& root,
                          const std::string& controller,
                          const std::function<void(const std::filesystem::path&)>& visit);

}  // namespace obscura
