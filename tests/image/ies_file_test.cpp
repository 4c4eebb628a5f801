// tests/image/ies_file_test.cpp - photometric files of every edition, whole, odd and broken.
// SPDX-License-Identifier: Apache-2.0
#include "image/ies_file.h"

#include <gtest/gtest.h>

#include <gmock/gmock.h>
#include <numeric>
#include <string>
#include <vector>

namespace obscura {
namespace {

using testing::ElementsAre;
using testing::HasSubstr;
using testing::SizeIs;

std::string joined(const std::vector<double>& numbers) {
    std::string out;
    for (const double number : numbers)
        out += std::to_string(number) + " ";
    return out + "\r\n";
}

/// A file whose candela are 1, 2, 3 ... in the order in which they stand.
struct IesText {
    std::string head = "IESNA:LM-63-2002\r\n[TEST] none\r\n[MANUFAC] nobody\r\n";
    std::string tilt = "TILT=NONE\r\n";
    int type = 1;
    std::string factors = "1 1 100";
    std::vector<double> vertical = {0, 45, 90};
    std::vector<double> horizontal = {0};

    std::string text() const {
        std::vector<double> candela(vertical.size() * horizontal.size());
        std::iota(candela.begin(), candela.end(), 1.0);
        return head + tilt + "1 -1 10 " + std::to_string(vertical.size()) + " " +
               std::to_string(horizontal.size()) + " " + std::to_string(type) +
               " 2 0.1, 0.2 , 0\r\n" + factors + "\r\n" + joined(vertical) + joined(horizontal) +
               joined(candela);
    }
};

Result<LightProfile> read_text(const std::string& text) {
    return read_ies(std::as_bytes(std::span(text)), "lamp.ies");
}

LightProfile profile_of(const IesText& file) {
    const Result<LightProfile> profile = read_text(file.text());
    EXPECT_TRUE(profile) << profile.error().message;
    return profile.value_or(LightProfile{});
}

std::string fault_of(const std::string& text) {
    const Result<LightProfile> profile = read_text(text);
    EXPECT_FALSE(profile);
    if (profile) return "";
    EXPECT_EQ(profile.error().code, ExitCode::bad_data);
    EXPECT_EQ(profile.error().where, "lamp.ies");
    return profile.error().id + " " + profile.error().message;
}

TEST(IesFile, OnePlaneWithItsMultiplier) {
    const LightProfile profile = profile_of({});
    EXPECT_TRUE(profile.polar_is_aim);
    EXPECT_THAT(profile.polar_deg, ElementsAre(0, 45, 90));
    EXPECT_THAT(profile.azimuth_deg, ElementsAre(0));
    EXPECT_THAT(profile.candela, ElementsAre(10, 20, 30));
}

TEST(IesFile, EditionsAndTheirFactors) {
    IesText file;
    file.factors = "0.5 0.25 100";
    EXPECT_THAT(profile_of(file).candela, ElementsAre(5, 10, 15));  // the second is for future use
    for (const char* head : {"IESNA:LM-63-1995\n", "IES:LM-63-2019\n", "IESNA:LM-63-2002\n"}) {
        file.head = head;
        EXPECT_THAT(profile_of(file).candela, ElementsAre(5, 10, 15)) << head;
    }
    for (const char* head : {"", "[TEST] 1\n", "IESNA91\n", "IESNA:LM-63-1986\n"}) {
        file.head = head;
        EXPECT_THAT(profile_of(file).candela, ElementsAre(1.25, 2.5, 3.75)) << head;
    }
}

TEST(IesFile, ReadsOverTilt) {
    IesText file;
    file.tilt = "TILT=INCLUDE\r\n1\r\n3\r\n0 45 90\r\n1.0 0.9 0.8\r\n";
    EXPECT_THAT(profile_of(file).candela, ElementsAre(10, 20, 30));
    file.tilt = "TILT=lamp tilt.txt\n";
    EXPECT_THAT(profile_of(file).candela, ElementsAre(10, 20, 30));
}

/// Planes of type C, each named by the first of its two values.
std::vector<float> first_of_planes(const LightProfile& profile) {
    std::vector<float> out;
    for (size_t i = 0; i < profile.candela.size(); i += profile.polar_deg.size())
        out.push_back(profile.candela[i]);
    return out;
}

TEST(IesFile, SymmetryMakesTheFullCircle) {
    IesText file;
    file.vertical = {0, 90};
    file.horizontal = {0, 30, 90};
    LightProfile profile = profile_of(file);
    EXPECT_THAT(profile.azimuth_deg, ElementsAre(0, 30, 90, 150, 180, 210, 270, 330, 360));
    EXPECT_THAT(first_of_planes(profile), ElementsAre(10, 30, 50, 30, 10, 30, 50, 30, 10));

    file.horizontal = {0, 60, 180};
    profile = profile_of(file);
    EXPECT_THAT(profile.azimuth_deg, ElementsAre(0, 60, 180, 300, 360));
    EXPECT_THAT(first_of_planes(profile), ElementsAre(10, 30, 50, 30, 10));

    file.horizontal = {90, 100, 270};
    profile = profile_of(file);
    EXPECT_THAT(profile.azimuth_deg, ElementsAre(90, 100, 270, 440, 450));
    EXPECT_THAT(first_of_planes(profile), ElementsAre(10, 30, 50, 30, 10));

    file.horizontal = {0, 120, 360};
    EXPECT_THAT(first_of_planes(profile_of(file)), ElementsAre(10, 30, 50));

    file.horizontal = {0, 120, 240};  // the plane at 360 is left out
    profile = profile_of(file);
    EXPECT_THAT(profile.azimuth_deg, ElementsAre(0, 120, 240, 360));
    EXPECT_THAT(first_of_planes(profile), ElementsAre(10, 30, 50, 10));
}

TEST(IesFile, TypesAAndBCountFromTheAim) {
    for (const int type : {2, 3}) {
        IesText file;
        file.type = type;
        file.vertical = {-90, 0, 60};
        file.horizontal = {-30, 20};
        LightProfile profile = profile_of(file);
        EXPECT_FALSE(profile.polar_is_aim);
        EXPECT_THAT(profile.polar_deg, ElementsAre(30, 90, 180));
        EXPECT_THAT(profile.azimuth_deg, ElementsAre(-30, 20));
        EXPECT_THAT(profile.candela, ElementsAre(30, 20, 10, 60, 50, 40));

        file.vertical = {0, 90};
        file.horizontal = {0, 40};
        profile = profile_of(file);  // both sides are alike
        EXPECT_THAT(profile.polar_deg, ElementsAre(0, 90, 180));
        EXPECT_THAT(profile.azimuth_deg, ElementsAre(-40, 0, 40));
        EXPECT_THAT(profile.candela, ElementsAre(40, 30, 40, 20, 10, 20, 40, 30, 40));
    }
}

TEST(IesFile, SaysWhatIsWrongAndWhere) {
    EXPECT_THAT(fault_of(""), HasSubstr("E-IES-FORMAT no line begins with TILT="));
    EXPECT_THAT(fault_of("IESNA:LM-63-2002\nno tilt\n"), HasSubstr("E-IES-FORMAT"));
    EXPECT_THAT(fault_of("TILT=NONE\n"), HasSubstr("E-IES-SHORT line 2"));
    IesText file;
    std::string text = file.text();
    EXPECT_THAT(fault_of(text.substr(0, text.size() - 12)), HasSubstr("the candela value"));
    text.replace(text.find("45.0"), 2, "x\x01");
    EXPECT_THAT(fault_of(text),
                HasSubstr("E-IES-NUMBER line 7: \"x?.000000\" is read as the vertical angle; "
                          "accepted are numbers from 0 to 180"));
    for (const char* word : {"nan", "inf", "1e999", "-1", "0x10", "1e13"}) {
        text = file.text();
        text.replace(text.rfind("3.0"), 8, word);
        EXPECT_THAT(fault_of(text), HasSubstr("E-IES-NUMBER")) << word;
    }
    file.vertical = {0, 45, 45};
    EXPECT_THAT(fault_of(file.text()), HasSubstr("E-IES-ANGLES line 7: the vertical angles"));
    file.vertical = {0, 45, 190};
    EXPECT_THAT(fault_of(file.text()), HasSubstr("from 0 to 180"));
    file.vertical = {0, 90};
    file.horizontal = {0, 80, 70};
    EXPECT_THAT(fault_of(file.text()), HasSubstr("the horizontal angles do not rise"));
    file.horizontal = {0, 45};
    EXPECT_THAT(fault_of(file.text()), HasSubstr("go from 0 to 45; accepted are 0 alone"));
    file.horizontal = {0};
    file.type = 4;
    EXPECT_THAT(fault_of(file.text()), HasSubstr("photometric type; accepted are numbers from 1"));
}

TEST(IesFile, CountsThatTheFileCannotHoldAskForNoMemory) {
    for (const char* counts : {"1000000000000 1", "3 1e300", "100 100", "2.5 1", "1 1", "3 0"}) {
        const std::string text = "TILT=NONE\n1 1 1 " + std::string(counts) +
                                 " 1 2 0 0 0\n1 1 1\n0 45 90 0 1 2 3 4 5 6 7 8 9 0 1 2 3 4 5 6 7\n";
        EXPECT_THAT(fault_of(text), testing::ContainsRegex("E-IES-(NUMBER|SHORT)")) << counts;
    }
    EXPECT_THAT(fault_of("TILT=INCLUDE\n1 1e18\n"), HasSubstr("E-IES-NUMBER"));
}

TEST(IesFile, AnyBytesEitherReadOrAreRefused) {
    IesText file;
    file.tilt = "TILT=INCLUDE\r\n1\r\n2\r\n0 90\r\n1.0 0.9\r\n";
    file.horizontal = {0, 30, 90};
    const std::string whole = file.text();
    const auto check = [](const std::string& text) {
        const Result<LightProfile> profile = read_text(text);
        if (!profile) {
            EXPECT_THAT(profile.error().id, testing::StartsWith("E-IES-"));
            return;
        }
        EXPECT_THAT(profile->candela,
                    SizeIs(profile->polar_deg.size() * profile->azimuth_deg.size()));
        EXPECT_TRUE(std::isfinite(profile_lumens(*profile)));
    };
    for (size_t length = 0; length <= whole.size(); ++length)
        check(whole.substr(0, length));
    uint32_t state = 1;
    const auto random = [&state] { return (state = state * 1664525U + 1013904223U) >> 8; };
    constexpr std::string_view likely("0123456789 .,-+eE\n\r\t=TILTX\0\xFF", 29);
    for (int round = 0; round < 20000; ++round) {
        std::string text = whole;
        for (uint32_t changes = 1 + random() % 4; changes > 0; --changes)
            text[random() % text.size()] = likely[random() % likely.size()];
        check(text);
    }
}

}  // namespace
}  // namespace obscura
