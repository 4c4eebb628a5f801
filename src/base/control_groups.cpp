// base/control_groups.cpp - the folders of Linux's control groups that limit the process.
// SPDX-License-Identifier: Apache-2.0
#include "base/control_groups.h"

#include <fstream>
#include <sstream>

namespace obscura {

namespace {

using Path = std::filesystem::path;

/// Whether "cpu" is one of the controllers "cpu,cpuacct".
bool is_among(const std::string& controller, const std::string& controllers) {
    return ("," + controllers + ",").find("," + controller + ",") != std::string::npos;
}

}  // namespace

void visit_control_groups(const Path& root,
                          const std::string& controller,
                          const std::function<void(const Path&)>& visit) {
    const Path mounts = root / "sys/fs/cgroup";
    const auto visit_down = [&](const Path& mount, const Path& group) {
        Path at = mount;
        visit(at);
        for (const Path& name : group.relative_path())
            visit(at /= name);
    };
    std::ifstream groups(root / "proc/self/cgroup");
    for (std::string line; std::getline(groups, line);) {  // "1:cpu,cpuacct:/group" or "0::/group"
        std::istringstream fields(line);
        std::string number;
        std::string controllers;
        std::string group;
        std::getline(fields, number, ':');
        std::getline(fields, controllers, ':');
        std::getline(fields, group);
        if (controllers.empty()) {
            visit_down(mounts, group);
            visit_down(mounts / "unified", group);
        } else if (is_among(controller, controllers)) {
            visit_down(mounts / controllers, group);
            visit_down(mounts / controller, group);
        }
    }
}

}  // namespace obscura
