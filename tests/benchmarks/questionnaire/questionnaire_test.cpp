// The questionnaire: its form, how it asks for, reads, stores and summarises answers (computed by hand), and
// `encounter questionnaire` as a person uses it.
#include <algorithm>
#include <filesystem>
#include <fstream>
#include <sstream>
#include <thread>

#include <fmt/format.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <nlohmann/json.hpp>

#include "benchmarks/questionnaire/opinion.h"
#include "core/base/error.h"
#include "tests/support/built.h"
#include "tests/support/files.h"
#include "tests/support/run_program.h"

namespace enc::bench::questionnaire {
namespace {

using ::testing::AllOf;
using ::testing::ElementsAre;
using ::testing::Field;
using ::testing::HasSubstr;
using ::testing::StartsWith;
using tests::Environment;
using tests::program_file;
using tests::Result;
using tests::run;
using tests::run_program;

const std::string kModels = tests::source_dir() + "/models";

// Two items on a scale of three steps, and one product used before.
Form small_form() {
  Form form;
  form.name = "small";
  form.title = "Small";
  form.steps = {{"1", "No"}, {"2", "Perhaps"}, {"3", "Yes"}};
  form.experience = {{"vr", "VR before?"}};
  form.groups = {{"g", "Group"}};
  form.items = {{"1", "It is good.", "g", "b.x"}, {"2", "It is real.", "g", ""}};
  return form;
}

template <class F>
std::string refusal(const F& f) {
  try {
    f();
  } catch (const Error& e) {
    return e.what();
  }
  return "nothing";
}
std::string refused(const std::string& text) {
  return refusal([&] { (void)parse_answers(text, "a.csv", small_form()); });
}

TEST(QuestionnaireForm, IsThePapers) {
  const Form form = load_form(kModels, "vhmr_2020");
  EXPECT_EQ(form.items.size(), 11U);
  EXPECT_EQ(form.highest(), 7);
  EXPECT_EQ(form.steps[3].text, "Neutral");
  EXPECT_THAT(form.experience,
              ElementsAre(Field(&Wording::name, "force_feedback"), Field(&Wording::name, "vr_mr"),
                          Field(&Wording::name, "visuo_haptics")));
  std::string groups;  // items 1 to 4, 5 and 6, 7 and 8, 9 to 11 [VHMR 4.4]
  for (const Item& item : form.items) groups += item.group[0];
  EXPECT_EQ(groups, "oooohhvvccc");
  // The printed means give the printed global mean of 5.3.
  const std::vector<ItemReference> items = items_of(form, kModels);
  double sum = 0.0;
  for (const ItemReference& item : items) sum += item.paper;
  EXPECT_EQ(items[4].with_experience[1], 6.0);  // VR/MR devices
  EXPECT_EQ(items[6].with_experience[2], 5.5);  // visuo-haptics
  EXPECT_TRUE(std::isnan(items[0].with_experience[0]));
  EXPECT_NEAR(sum / 11.0, 5.3, 0.05);
}

TEST(QuestionnaireForm, SaysWhatIsWrongAndWhere) {
  const auto with = [](const std::string& tail) {
    return refusal([&] {
      (void)parse_form(
          "format = 1\ntitle = \"t\"\nsource = \"s\"\n[[step]]\nname = \"1\"\ntext = \"a\"\n" + tail,
          "f.toml");
    });
  };
  const std::string step = "[[step]]\nname = \"2\"\ntext = \"b\"\n";
  const std::string group = "[[group]]\nname = \"g\"\ntext = \"G\"\n";
  const std::string item = "[[item]]\nname = \"1\"\ngroup = \"g\"\ntext = \"x\"\n";
  EXPECT_EQ(with(step + group + item), "nothing");
  EXPECT_THAT(with(""), HasSubstr("fewer than two steps"));
  EXPECT_THAT(with(step), HasSubstr("no items"));
  EXPECT_THAT(with("[[step]]\nname = \"3\"\ntext = \"b\"\n"),
              AllOf(StartsWith("f.toml:8:1: step '3'"), HasSubstr("in order")));
  EXPECT_THAT(with(step + item), AllOf(StartsWith("f.toml:12:1: there is no group 'g'")));
  EXPECT_THAT(with(step + group + "[[item]]\nname = \"a,b\"\ngroup = \"g\"\ntext = \"x\"\n"),
              HasSubstr("letters, digits and _"));
  EXPECT_THAT(refusal([] { (void)load_form(kModels, "vhmr_2021"); }), HasSubstr("did you mean 'vhmr_2020'?"));
}

TEST(QuestionnaireAnswers, AreReadByTheirColumns) {
  const Answers answers = parse_answers(
      "# note\nitem_2,vr,participant,item_1,date\r\n3,yes,a,1,2026-01-02\r\n", "a.csv", small_form());
  ASSERT_EQ(answers.rows.size(), 1U);
  EXPECT_TRUE(answers.dated);
  EXPECT_EQ(answers.rows[0].participant, "a");
  EXPECT_THAT(answers.rows[0].points, ElementsAre(1, 3));
  EXPECT_THAT(answers.rows[0].experience, ElementsAre(1));
  EXPECT_EQ(answers.rows[0].date, "2026-01-02");
}

TEST(QuestionnaireAnswers, SayWhatIsWrongAndWhere) {
  const std::string header = "participant,vr,item_1,item_2\n";
  EXPECT_EQ(refused(header), "nothing");
  EXPECT_THAT(refused(""), StartsWith("a.csv:1:1: there is no header"));
  EXPECT_THAT(refused("participant,vr,item_1\n"), AllOf(StartsWith("a.csv:1:1: "), HasSubstr("item_2")));
  EXPECT_THAT(refused("participant,vr,item_1,item_2,item_3\n"),
              AllOf(StartsWith("a.csv:1:30: column 'item_3'"), HasSubstr("form 'small'")));
  EXPECT_THAT(refused(header + "1,yes,4,2\n"),
              AllOf(StartsWith("a.csv:2:7: 'item_1' is '4'"), HasSubstr("whole number from 1 to 3")));
  EXPECT_THAT(refused(header + "1,yes,0,2\n"), StartsWith("a.csv:2:7: "));
  EXPECT_THAT(refused(header + "1,yes,1.5,2\n"), StartsWith("a.csv:2:7: "));
  EXPECT_THAT(refused(header + "1,yes,1,nan\n"), StartsWith("a.csv:2:9: 'item_2' is 'nan'"));
  EXPECT_THAT(refused(header + "1,yes,1,\n"), StartsWith("a.csv:2:9: 'item_2' is empty"));
  EXPECT_THAT(refused(header + "1,yes,1\n"), StartsWith("a.csv:2:"));
  EXPECT_THAT(refused(header + "1,maybe,1,2\n"),
              AllOf(StartsWith("a.csv:2:3: 'vr'"), HasSubstr("yes or no")));
  EXPECT_THAT(refused(header + ",yes,1,2\n"), StartsWith("a.csv:2:1: the participant is empty"));
  EXPECT_THAT(refused(header + "1,yes,1,2\n1,no,1,2\n"),
              StartsWith("a.csv:3:1: participant '1' is there twice"));
}

class QuestionnaireFile : public testing::Test {
 protected:
  std::string path() const { return (folder_.path() / "a.csv").string(); }
  std::string bytes() const {
    const auto all = test::bytes_of(path());
    return {all.begin(), all.end()};
  }
  void write(const std::string& text) const { std::ofstream(path(), std::ios::binary) << text; }
  test::TemporaryFolder folder_;
};

TEST_F(QuestionnaireFile, GrowsAtItsEndAndKeepsWhatIsThere) {
  append_answers(path(), small_form(), {{"", {1}, {1, 3}}});
  append_answers(path(), small_form(), {{"", {0}, {2, 2}}});
  EXPECT_EQ(bytes(), "participant,vr,item_1,item_2\n1,yes,1,3\n2,no,2,2\n");
}

TEST_F(QuestionnaireFile, ALineWithoutItsEndGetsOne) {
  write("participant,vr,item_1,item_2\n7,no,2,1");
  const Answers all = append_answers(path(), small_form(), {{"", {1}, {1, 3}}, {"x", {0}, {2, 2}}});
  EXPECT_EQ(bytes(), "participant,vr,item_1,item_2\n7,no,2,1\n8,yes,1,3\nx,no,2,2\n");
  EXPECT_EQ(all.rows.size(), 3U);
}

TEST_F(QuestionnaireFile, AMarkBeforeTheTextIsReadOver) {
  const std::string before = "\xEF\xBB\xBFparticipant,vr,item_1,item_2\n7,no,2,1\n";
  write(before);
  EXPECT_EQ(append_answers(path(), small_form(), {{"", {1}, {1, 3}}}).rows.size(), 2U);
  EXPECT_EQ(bytes(), before + "8,yes,1,3\n");
}

TEST_F(QuestionnaireFile, NothingIsWrittenWhereSomethingIsWrong) {
  const std::string before = "participant,vr,item_1,item_2\n7,no,2,1\n";
  write(before);
  const auto append = [&](std::vector<Answer> rows) {
    return refusal([&] { append_answers(path(), small_form(), std::move(rows)); });
  };
  EXPECT_THAT(append({{"8", {1}, {1, 3}}, {"7", {1}, {1, 3}}}),
              HasSubstr("participant '7' is there already"));
  EXPECT_THAT(append({{"8", {1}, {1, 3}, "2026-01-02"}}), HasSubstr("no column 'date'"));
  EXPECT_EQ(bytes(), before);
  write("# by hand\nparticipant,vr,item_2,item_1\n");
  EXPECT_THAT(append({{"8", {1}, {1, 3}}}), HasSubstr("a.csv:2:1: the columns stand in another order"));
  write("participant,vr,item_1\n");
  EXPECT_THAT(append({{"8", {1}, {1, 3}}}), HasSubstr("item_2"));
  EXPECT_EQ(bytes(), "participant,vr,item_1\n");
  EXPECT_THAT(refusal([&] { append_answers("/nowhere/a.csv", small_form(), {}); }),
              HasSubstr("cannot be written"));
  EXPECT_THAT(refusal([&] {
                append_answers("/dev/full", small_form(), {{"1", {1}, {1, 3}}});
              }),
              HasSubstr("cannot be written"));
}

TEST_F(QuestionnaireFile, TwoThatWriteAtOnceLoseNothing) {
  constexpr int kEach = 40;
  const auto many = [&](const std::string& who) {
    for (int i = 0; i < kEach; ++i)
      append_answers(path(), small_form(), {{fmt::format("{}{}", who, i), {1}, {1, 3}}});
  };
  std::jthread other([&] { many("a"); });
  many("b");
  other.join();
  EXPECT_EQ(append_answers(path(), small_form(), {}).rows.size(), 2U * kEach);
}

TEST(QuestionnaireAsk, AsksEverythingInOrder) {
  std::istringstream in("no\n3\n1\n");
  std::ostringstream out;
  const Answer a = ask(small_form(), in, out, false);
  EXPECT_THAT(a.experience, ElementsAre(0));
  EXPECT_THAT(a.points, ElementsAre(3, 1));
  EXPECT_THAT(out.str(), AllOf(HasSubstr("VR before? [yes or no]"), HasSubstr("3  Yes"),
                               HasSubstr("2. It is real. [1 to 3]")));
}

TEST(QuestionnaireAsk, APersonIsAskedAgainAndAFileIsRefused) {
  std::ostringstream out;
  std::istringstream person("yes\n4\n3\n1\n");
  EXPECT_THAT(ask(small_form(), person, out, true).points, ElementsAre(3, 1));
  EXPECT_THAT(out.str(), HasSubstr("'4' is no answer; please give 1 to 3"));
  std::istringstream file("yes\n4\n3\n1\n");
  EXPECT_THAT(refusal([&] { (void)ask(small_form(), file, out, false); }),
              StartsWith("standard input:2:1: '4' is no answer; expected 1 to 3"));
  std::istringstream cut("yes\n3\n");
  EXPECT_THAT(refusal([&] { (void)ask(small_form(), cut, out, true); }),
              AllOf(StartsWith("standard input:3:1: it ended"), HasSubstr("nothing was stored")));
}

TEST(QuestionnaireOpinion, IsMeanRangeAndCounts) {
  const Form form = small_form();
  const std::vector<Answer> rows{{"1", {1}, {1, 3}}, {"2", {0}, {2, 3}}, {"3", {1}, {2, 3}}};
  const Opinion first = opinion_of(form, rows, 0);
  EXPECT_DOUBLE_EQ(first.mean, 5.0 / 3.0);
  EXPECT_EQ(first.least, 1);
  EXPECT_EQ(first.most, 2);
  EXPECT_THAT(first.counts, ElementsAre(1, 2, 0));
  EXPECT_DOUBLE_EQ(global_mean(rows), 14.0 / 6.0);
  const std::vector<ItemReference> items = items_of(form, kModels);
  EXPECT_THAT(opinion_table(form, items, rows).rows[0],
              ElementsAre("1", "It is good.", "1.7", "1-2", "1", "2", "0", ""));
  EXPECT_THAT(experience_table(form, items, rows).columns, ElementsAre("item", "vr (2)", "no vr (1)"));
  EXPECT_THAT(experience_table(form, items, rows).rows[0], ElementsAre("1", "1.5", "2.0"));
  // Without answers there is no mean and no division by zero.
  EXPECT_THAT(opinion_table(form, items, {}).rows[0],
              ElementsAre("1", "It is good.", "", "", "0", "0", "0", ""));
}

// A figure stands beside its item; items without a measurement are left out.
TEST(QuestionnaireProxies, AreFiguresAndNoAnswers) {
  const std::vector<ItemReference> items = items_of(small_form(), kModels);
  FigureVerdict j;
  j.figure = {"b.x", kUnset, 0.5, "mm", Role::ours, kUnset, kUnset, ""};
  j.felt = Perception::yes;
  const Table table = proxy_table(items, {j});
  ASSERT_EQ(table.rows.size(), 1U);
  EXPECT_EQ(table.rows[0][0], "1");
  EXPECT_EQ(table.rows[0][3], "b.x");
  EXPECT_EQ(table.rows[0][6], "felt");
  EXPECT_TRUE(proxy_table(items, {}).rows.empty());
}

const std::string kHeader =
    "participant,force_feedback,vr_mr,visuo_haptics,item_1,item_2,item_3,item_4,item_5,item_6,item_7,item_8,"
    "item_9,item_10,item_11\n";

class Questionnaire : public testing::Test {
 protected:
  std::string path(const std::string& name) const { return (temporary_.path() / name).string(); }
  std::string write(const std::string& name, const std::string& text) const {
    std::ofstream(path(name), std::ios::binary) << text;
    return path(name);
  }
  // The answers come through a pipe, as from a script.
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

// The command refuses a missing folder or a known participant before the first question, not after the last.
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

// The command reports existing tables before the first question and stores nothing.
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
}  // namespace enc::bench::questionnaire
