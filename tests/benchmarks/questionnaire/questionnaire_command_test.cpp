// `encounter questionnaire` as a person uses it, and a scene that names a form.
#include <algorithm>
#include <filesystem>
#include <fstream>

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <nlohmann/json.hpp>

#include "tests/support/built.h"
#include "tests/support/run_program.h"
#include "tests/support/temporary_folder.h"

namespace enc::tests {
namespace {

using testing::AllOf;
using testing::HasSubstr;

const std::string kHeader =
    "participant,force_feedback,vr_mr,visuo_haptics,item_1,item_2,item_3,item_4,item_5,item_6,item_7,item_8,"
    "item_9,"
    "item_10,item_11\n";

class Questionnaire : public testing::Test {
 protected:
  std::string path(const std::string& name) const { return (temporary_.path() / name).string(); }
  std::string write(const std::string& name, const std::string& text) const {
    std::ofstream(path(name), std::ios::binary) << text;
    return path(name);
  }
  // The answers come through a pipe, as a script gives them.
  Result answer(const std::string& words, const std::string& more = "") const {
    return run(
        {"sh", "-c",
         "printf '" + words + "' | " + program_file() + " questionnaire --store " + path("a.csv") + more},
        kModels);
  }
  static void expect_line(const Result& r) {
    EXPECT_EQ(r.code, 2) << r.out;
    EXPECT_EQ(std::count(r.err.begin(), r.err.end(), '\n'), 1) << r.err;
  }
  const Environment kModels{{"ENCOUNTER_MODELS", tests::source_dir() + "/models"}};
  test::TemporaryFolder temporary_;
};

TEST_F(Questionnaire, KeepsARowForEachAndSumsUp) {
  const std::string words = "yes\\nno\\nno\\n6\\n4\\n6\\n6\\n5\\n5\\n5\\n4\\n6\\n6\\n5\\n";
  const Result first = answer(words);
  ASSERT_EQ(first.code, 0) << first.err;
  EXPECT_THAT(first.out, AllOf(HasSubstr("10. Visual and haptic stimuli are synchronized. [1 to 7]"),
                               HasSubstr("mean of all 5.3"), HasSubstr("these answers have the mean 6.0")));
  const Result second = answer(words, " --json");
  ASSERT_EQ(second.code, 0) << second.err;
  const auto json = nlohmann::json::parse(second.out);
  EXPECT_EQ(json["participants"], 2);
  EXPECT_EQ(json["simulated"], false);
  EXPECT_EQ(json["items"][9]["paper_mean"], 5.9);
  EXPECT_EQ(json["items"][9]["counts"][5], 2);
  std::ifstream file(path("a.csv"));
  const std::string text{std::istreambuf_iterator<char>(file), {}};
  EXPECT_EQ(text, kHeader + "1,yes,no,no,6,4,6,6,5,5,5,4,6,6,5\n2,yes,no,no,6,4,6,6,5,5,5,4,6,6,5\n");
}

TEST_F(Questionnaire, AnInputThatEndsInTheMiddleStoresNothing) {
  const Result r = answer("yes\\nno\\nno\\n6\\n");
  EXPECT_EQ(r.code, 2);
  EXPECT_THAT(r.err, AllOf(HasSubstr("standard input:5:1: it ended before the last answer")));
  EXPECT_FALSE(std::filesystem::exists(path("a.csv")));
}

// Refused before the first question, not after the last: a folder that is not there, a participant who is.
TEST_F(Questionnaire, WhatCannotBeStoredIsNotAsked) {
  const std::string there = write("there.csv", kHeader + "7,yes,no,no,6,4,6,6,5,5,5,4,6,6,5\n");
  for (const std::vector<std::string>& more :
       std::vector<std::vector<std::string>>{{"--store", path("none/a.csv")},
                                             {"--store", "/dev/full"},
                                             {"--store", there, "--participant", "7"},
                                             {"--store", there, "--date"}}) {
    std::vector<std::string> args{"questionnaire"};
    args.insert(args.end(), more.begin(), more.end());
    const Result r = run_program(args, kModels);
    expect_line(r);
    EXPECT_EQ(r.out, "") << "it was asked";
  }
}

// Tables that are there: said before the first question, with nothing stored.
TEST_F(Questionnaire, TablesThatAreThereAreSaidBeforeAnythingIsAsked) {
  std::filesystem::create_directory(path("out"));
  static_cast<void>(write("out/answers.csv", "mine"));
  for (const std::string& store : {path("a.csv"), path("out/answers_experience.csv")}) {
    const Result r = run_program({"questionnaire", "--store", store, "--out", path("out")}, kModels);
    expect_line(r);
    EXPECT_EQ(r.out, "") << "it was asked";
    EXPECT_FALSE(std::filesystem::exists(store));
  }
}

TEST_F(Questionnaire, APictureIsNotWrittenOverTheAnswers) {
  const std::string row = "a,no,yes,no,1,2,3,4,5,6,7,1,2,3,4\n";
  const std::string file = write("answers.csv", kHeader + row);  // the name of one of its tables
  const std::string folder = std::filesystem::path(file).parent_path();
  for (const char* force : {"--json", "--force"}) {
    const Result r = run_program({"questionnaire", "--answers", file, "--out", folder, force}, kModels);
    EXPECT_EQ(r.code, 2);
    EXPECT_THAT(r.err, HasSubstr("is read by this command"));
  }
}

TEST_F(Questionnaire, AFileOfManyIsReadAndDrawn) {
  const std::string file = write("m.csv", kHeader + "a,no,yes,no,1,2,3,4,5,6,7,1,2,3,4\n");
  const Result r = run_program({"questionnaire", "--answers", file, "--out", path("out")}, kModels);
  ASSERT_EQ(r.code, 0) << r.err;
  EXPECT_TRUE(std::filesystem::exists(path("out/answers.csv")));
  EXPECT_TRUE(std::filesystem::exists(path("out/answers.plot.csv")));
}

TEST_F(Questionnaire, MistakesAreOneLineEach) {
  expect_line(run_program({"questionnaire"}, kModels));
  expect_line(run_program({"questionnaire", "vhmr", "--answers", "x"}, kModels));
  expect_line(run_program({"questionnaire", "--answers", path("not_there.csv")}, kModels));
  expect_line(run_program({"questionnaire", "--answers", write("e.csv", "")}, kModels));
  expect_line(run_program({"questionnaire", "--store", path("s.csv"), "--participant", "Jane Doe"}, kModels));
  const Result r = run_program(
      {"questionnaire", "--answers", write("b.csv", kHeader + "a,no,yes,no,1,2,3,4,5,6,7,8,2,3,4\n")},
      kModels);
  expect_line(r);
  EXPECT_THAT(r.err, HasSubstr("b.csv:2:27: 'item_8' is '8'; expected a whole number from 1 to 7"));
}

TEST_F(Questionnaire, ASceneMayNameAForm) {
  std::ifstream plane(tests::source_dir() + "/models/scenes/plane.toml");
  const std::string scene{std::istreambuf_iterator<char>(plane), {}};
  const Result good =
      run_program({"check", write("g.toml", scene + "\n[questionnaire]\nform = \"vhmr_2020\"\n")}, kModels);
  EXPECT_EQ(good.code, 0) << good.err;
  EXPECT_THAT(good.out, HasSubstr("encounter questionnaire vhmr_2020 --store"));
  const Result bad =
      run_program({"check", write("b.toml", scene + "\n[questionnaire]\nform = \"vhmr_2021\"\n")}, kModels);
  expect_line(bad);
  EXPECT_THAT(bad.err, AllOf(HasSubstr("there is no questionnaire 'vhmr_2021'"),
                             HasSubstr("did you mean 'vhmr_2020'?")));
}

}  // namespace
}  // namespace enc::tests
