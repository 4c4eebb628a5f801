// tests/app/option_tables_test.cpp - rules for every entry of the option tables.
// SPDX-License-Identifier: Apache-2.0
#include "app/bench_options.h"
#include "app/crosscheck_options.h"
#include "app/explain_pixel_options.h"
#include "app/info_options.h"
#include "app/render_options.h"
#include "base/setting_names.h"
#include "scene/camera_setting_table.h"

#include <gtest/gtest.h>

#include <functional>
#include <set>

namespace obscura::app {
namespace {

/// All commands with the texts that their options fill.
struct Tables {
    RenderArguments render;
    InfoArguments info;
    BenchArguments bench;
    CrosscheckArguments crosscheck;
    ExplainPixelArguments explain;
    std::vector<Command> commands = {render_command(render),
                                     info_command(info),
                                     bench_command(bench),
                                     crosscheck_command(crosscheck),
                                     explain_pixel_command(explain)};
};

const BoundOption* find(const Command& command, const std::string& name) {
    for (const BoundOption& option : command.options)
        if (long_name(option.info) == name) return &option;
    return nullptr;
}

TEST(OptionTables, EntriesAreWholeAndNamesAreThereOnce) {
    const Tables tables;
    for (const Command& command : tables.commands) {
        std::set<std::string> names;
        for (const BoundOption& option : command.options) {
            const std::string name = long_name(option.info);
            SCOPED_TRACE(command.name + (" " + name));
            EXPECT_TRUE(names.insert(name).second) << "twice";
            EXPECT_STRNE(option.info.help, "");
            EXPECT_LE(option.info.range.low, option.info.range.high);
            const bool flag = std::holds_alternative<bool*>(option.target);
            EXPECT_EQ(name[0] == '-' && !flag, *option.info.argument != 0);
            const bool lists_names = std::string(option.info.help).back() == ':';
            EXPECT_TRUE(!lists_names || !option.names.empty());
        }
    }
}

TEST(OptionTables, WhatIsExcludedOrNeededIsThere) {
    const Tables tables;
    for (const Command& command : tables.commands) {
        for (const BoundOption& option : command.options) {
            std::vector<const char*> others(option.info.excludes.begin(),
                                            option.info.excludes.end());
            others.insert(others.end(), option.info.needs.begin(), option.info.needs.end());
            for (const char* other : others) {
                if (!other) continue;
                const std::string words = other;
                EXPECT_TRUE(find(command, words.substr(0, words.find(' '))))
                    << command.name << " " << option.info.name << ": " << words;
            }
        }
    }
}

TEST(OptionTables, EveryTextHasItsOwnPlace) {
    Tables tables;
    for (const Command& command : tables.commands) {
        std::set<const void*> places;
        for (const BoundOption& option : command.options) {
            const auto address = [](auto* target) -> const void* { return target; };
            EXPECT_TRUE(places.insert(std::visit(address, option.target)).second)
                << command.name << " " << option.info.name << ": another option fills that text";
        }
    }
}

TEST(OptionTables, DefaultsAreThoseOfAnUntouchedRequest) {
    const Tables tables;
    const Command& render = tables.commands.front();
    for (const auto& [name, value] : {std::pair{"--size", "1280x720"},
                                      std::pair{"--spp", "64"},
                                      std::pair{"--filter", "box"},
                                      std::pair{"--point-size", "3px"},
                                      std::pair{"--env-intensity", "1"},
                                      std::pair{"--occlusion", "off"},
                                      std::pair{"--isa", "auto"}}) {
        EXPECT_EQ(find(render, name)->fallback, value) << name;
    }
    EXPECT_EQ(find(tables.commands[2], "--spp")->fallback, bench_spp);
    EXPECT_EQ(find(tables.commands[3], "--size")->fallback, crosscheck_size);
}

TEST(OptionTables, LensOptionsAreCalledAsTheirSettings) {
    const Tables tables;
    for_each_camera_setting([&](const auto& entry) {
        const std::string name = std::string("--") + entry.info.name;
        EXPECT_TRUE(find(tables.commands.front(), name)) << name;
    });
}

TEST(OptionTables, ExcludedAndNeededOptionsAreReported) {
    const auto fault = [](const std::function<void(RenderArguments&)>& change) {
        RenderArguments arguments;
        arguments.scene_file = "s.glb";
        change(arguments);
        const Result<RenderRequest> request = make_render_request(arguments);
        return request ? ""
                       : spell_settings(request.error().where + ": " + request.error().message,
                                        SettingNames::options);
    };
    EXPECT_EQ(fault([](RenderArguments& a) {
                  a.camera = "0";
                  a.up = "0,1,0";
              }),
              "--camera: it cannot go together with --eye, --target or --up; give one or the "
              "other");
    EXPECT_EQ(fault([](RenderArguments& a) { a.ao_distance = "1"; }),
              "--ao-distance: it is for --integrator ao; leave it out or add that");
    EXPECT_EQ(fault([](RenderArguments& a) { a.lens.sensor = "36x24"; }),
              "--sensor: it is for --focal-length or --fstop; leave it out or add that");
    EXPECT_EQ(fault([](RenderArguments& a) {
                  a.lens.sensor = "36x24";
                  a.lens.focal_length = "50";
                  a.integrator = "ao";
                  a.ao_distance = "1";
              }),
              "");
    EXPECT_EQ(fault([](RenderArguments& a) {
                  a.lens.blades = "6";
                  a.camera_model = "fisheye";
              }),
              "--blades: a camera of the model fisheye does not have it; leave it out or choose "
              "another --camera-model");
}

}  // namespace
}  // namespace obscura::app
