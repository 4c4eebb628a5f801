// tests/cli/exercises_test.cpp - docs/lecture/exercises.md has the answers that are printed.
// SPDX-License-Identifier: Apache-2.0
#include "cli/cli.h"
#include "support/text_files.h"
#include <map>
#include <nlohmann/json.hpp>

namespace obscura {
namespace {

using nlohmann::json;

/// One command and the answers below it: names with the text behind the equals sign.
struct Exercise {
    std::vector<std::string> command;
    std::vector<std::pair<std::string, std::string>> answers;
};

std::vector<Exercise> exercises_of(const std::string& document) {
    std::vector<Exercise> found;
    bool answers = false;
    for (const std::string& line : split_lines(document)) {
        if (line.rfind("obscura ", 0) == 0) {
            std::istringstream words(line);
            found.emplace_back();
            for (std::string word; words >> word;)
                found.back().command.push_back(word);
            continue;
        }
        if (line.rfind("```", 0) == 0) {
            answers = line == "```answer";
            continue;
        }
        const size_t equals = line.find(" = ");
        if (!answers || equals == std::string::npos) continue;
        found.back().answers.emplace_back(line.substr(0, equals), line.substr(equals + 3));
    }
    return found;
}

/// "(1, 2.5)" or "1".
std::vector<std::string> numbers_in(const std::string& text) {
    std::vector<std::string> out;
    std::string number;
    for (const char c : text + ",") {
        if (c == ',') {
            out.push_back(number);
            number.clear();
        } else if (c != '(' && c != ')' && c != ' ') {
            number += c;
        }
    }
    return out;
}

/// One unit of the last written digit, or the error of single precision.
double tolerance_of(const std::string& number) {
    const size_t point = number.find('.');
    const size_t digits = point == std::string::npos ? 6 : number.size() - point - 1;
    return std::max(std::pow(10.0, -static_cast<double>(digits)),
                    2e-6 * std::max(std::abs(std::stod(number)), 1.0));
}

using Values = std::map<std::string, std::vector<double>>;

/// The text before the first " = " of a term's name; of several names the first.
void add_terms(const json& terms, Values& values) {
    for (const json& term : terms) {
        std::string name = term.at("name");
        name = name.substr(0, name.find(" = "));
        values[name.substr(0, name.find(','))] = term.at("value").get<std::vector<double>>();
    }
}

Values values_of(const json& report) {
    Values values;
    add_terms(report.at("camera").at("terms"), values);
    values["R_d"] = report.at("ray").at("direction").get<std::vector<double>>();
    const json& seen = report.at("seen");
    const json& object = report.at("objects").at(seen.at("object").get<size_t>());
    add_terms(object.at("terms"), values);
    values["t"] = {object.at("t").get<double>()};
    values["P"] = seen.at("place").get<std::vector<double>>();
    values["N"] = seen.at("normal").get<std::vector<double>>();
    const json& light = report.at("lights").at(0);
    add_terms(light.at("terms"), values);
    values["E"] = light.at("irradiance").get<std::vector<double>>();
    values["N . L"] = {light.at("cosine").get<double>()};
    values["pixel"] = report.at("rgba").get<std::vector<double>>();
    values["pixel"].pop_back();
    return values;
}

class Exercises : public Cli {
protected:
    json report_of(std::vector<std::string> command) {
        command.erase(command.begin());
        command.at(1) = OBSCURA_SOURCE_DIR "/" + command.at(1);
        command.emplace_back("--json");
        const ProgramRun done = run(command);
        expect_result(done, 0, "OK");
        return json::parse(done.out);
    }
};

TEST_F(Exercises, AnswersAreWhatIsPrinted) {
    const auto file = std::filesystem::path(OBSCURA_SOURCE_DIR) / "docs/lecture/exercises.md";
    const std::vector<Exercise> exercises = exercises_of(read_text(file));
    EXPECT_EQ(exercises.size(), 8U);
    size_t compared = 0;
    for (const Exercise& exercise : exercises) {
        SCOPED_TRACE(exercise.command.at(3));
        EXPECT_GT(exercise.answers.size(), 4U);
        const json report = report_of(exercise.command);
        const Values values = values_of(report);
        for (const auto& [name, answer] : exercise.answers) {
            if (name == "shadow") {
                const std::string blocker = report.at("lights").at(0).at("blocked_by");
                EXPECT_THAT(blocker, testing::HasSubstr("'" + answer + "'"));
                continue;
            }
            ASSERT_EQ(values.count(name), 1U) << name;
            const std::vector<std::string> numbers = numbers_in(answer);
            ASSERT_EQ(numbers.size(), values.at(name).size()) << name;
            for (size_t i = 0; i < numbers.size(); ++i, ++compared) {
                EXPECT_NEAR(values.at(name)[i], std::stod(numbers[i]), tolerance_of(numbers[i]))
                    << name << " " << i;
            }
        }
    }
    EXPECT_GT(compared, 100U);
}

}  // namespace
}  // namespace obscura
