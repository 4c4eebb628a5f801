// tests/cli/explain_test.cpp - the program's report of extensions, variants and metadata.
// SPDX-License-Identifier: Apache-2.0
#include "cli/cli.h"
#include <nlohmann/json.hpp>

namespace obscura {
namespace {

using nlohmann::json;
using testing::HasSubstr;

/// The box with two variants, of which "Night" glows, an unknown extension, and an XMP packet.
class Explain : public Cli {
protected:
    void SetUp() override {
        Cli::SetUp();
        json tree = json::parse(gltf_text(box_scene()));
        tree["materials"] = {{{"name", "Paint"}, {"extensions", {{"X_new", json::object()}}}},
                             {{"name", "Glow"}, {"emissiveFactor", {1, 1, 1}}}};
        tree["extensions"]["KHR_materials_variants"]["variants"] = {{{"name", "Day"}},
                                                                    {{"name", "Night"}}};
        tree["meshes"][0]["primitives"][0]["extensions"]["KHR_materials_variants"]["mappings"] = {
            {{"material", 0}, {"variants", {0}}}, {{"material", 1}, {"variants", {1}}}};
        tree["extensions"]["KHR_xmp_json_ld"]["packets"] = {{{"dc:title", "Box"}}};
        tree["asset"]["extensions"]["KHR_xmp_json_ld"]["packet"] = 0;
        folder_.write("looks.gltf", tree.dump());
    }
};

TEST_F(Explain, SaysWhatBecomesOfEachPart) {
    const ProgramRun table = run({"info", "looks.gltf", "--explain"});
    expect_result(table, 0, "OK");
    EXPECT_THAT(table.out, HasSubstr("material 0 Paint\n  ignored      X_new: it is not known\n"));
    EXPECT_THAT(table.out,
                HasSubstr("  honoured     KHR_materials_variants: chosen by --variant\n"));
    const json report = json::parse(run({"info", "looks.gltf", "--explain", "--json"}).out);
    EXPECT_EQ(report.at("file"), "looks.gltf");
    EXPECT_EQ(report.at("ignored"), 1);
    EXPECT_EQ(report.at("approximated"), 0);
    size_t found = 0;
    for (const json& row : report.at("report")) {
        if (row.at("feature") != "X_new") continue;
        ++found;
        EXPECT_EQ(row.at("place"), "material 0 Paint");
        EXPECT_EQ(row.at("verdict"), "ignored");
        EXPECT_EQ(row.at("note"), "it is not known");
    }
    EXPECT_EQ(found, 1U);
}

TEST_F(Explain, VariantsAreListedAndChosen) {
    EXPECT_THAT(run({"info", "looks.gltf"}).out, HasSubstr("'Day'\n"));
    const ProgramRun night = run({"info", "looks.gltf", "--variant", "Night"});
    EXPECT_THAT(night.out, HasSubstr("'Night' (shown)"));
    const json info = json::parse(run({"info", "looks.gltf", "--json"}).out);
    EXPECT_EQ(info.at("variants"), json::array({"Day", "Night"}));
    EXPECT_EQ(info.at("variant"), "");
    EXPECT_THAT(render("looks.gltf", {"--variant", "Day"}).err, HasSubstr("studio"));
    EXPECT_THAT(render("looks.gltf", {"--variant", "Night"}).err,
                testing::Not(HasSubstr("studio")));
    const ProgramRun unknown = render("looks.gltf", {"--variant", "Noon"});
    expect_result(unknown, 64, "E-VARIANT-UNKNOWN");
    EXPECT_THAT(unknown.err, HasSubstr("\"Day\", \"Night\""));
}

TEST_F(Explain, ThePacketAndTheVariantGoIntoTheHeader) {
    expect_result(render("looks.gltf", {"--variant", "Night", "-o", "a.exr"}), 0, "OK");
    const auto exr = read_image_file(folder_ / "a.exr");
    ASSERT_TRUE(exr);
    EXPECT_EQ(exr->spec.get_string_attribute("obscura:xmp"), R"({"dc:title":"Box"})");
    EXPECT_EQ(exr->spec.get_string_attribute("obscura:variant"), "Night");
    EXPECT_EQ(exr->spec.get_string_attribute("copyright"), "CC0");
}

}  // namespace
}  // namespace obscura
