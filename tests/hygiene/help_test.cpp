// The manual page and the completion for bash have every subcommand and every option of --help.
#include <fstream>
#include <map>
#include <regex>
#include <set>
#include <sstream>
#include <string>
#include <vector>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "tests/support/files.h"
#include "tests/support/run_program.h"

namespace enc::tests {
namespace {

using ::testing::Contains;
using ::testing::ElementsAre;
using ::testing::HasSubstr;
using ::testing::IsEmpty;
using ::testing::IsSupersetOf;

using Words = std::vector<std::string>;

std::string with(const std::string& words, const std::string& last) {
  return words.empty() ? last : words + " " + last;
}

// Adds the options that `encounter COMMAND --help` prints, and those of its subcommands: by command, "" or
// "calibrate tip".
void add_printed(const std::string& command, std::map<std::string, std::set<std::string>>& all) {
  static const std::regex kName("(-[-a-zA-Z]*)(,|$)");
  std::istringstream words(with(command, "--help"));
  const Words arguments{std::istream_iterator<std::string>(words), {}};
  std::istringstream help(run_program(arguments).out);
  bool listed = false;
  for (std::string line; std::getline(help, line);) {
    listed = listed || line == "Subcommands:";
    if (line.size() < 3 || !line.starts_with("  ") || line[2] == ' ') continue;
    const std::string head = line.substr(2, line.find(' ', 2) - 2);
    if (listed) add_printed(with(command, head), all);
    if (!listed && head.starts_with('-'))
      for (std::sregex_iterator at(head.begin(), head.end(), kName), end; at != end; ++at)
        all[command].insert((*at)[1]);
  }
}

const std::map<std::string, std::set<std::string>>& printed() {
  static const auto kAll = [] {
    std::map<std::string, std::set<std::string>> all;
    add_printed("", all);
    return all;
  }();
  return kAll;
}

TEST(HelpTable, IsReadFromWhatTheProgramPrints) {
  EXPECT_GE(printed().size(), 26U) << "subcommands, those of calibrate, and the program itself";
  EXPECT_TRUE(printed().at("calibrate stereo").contains("--square-mm"));
  EXPECT_TRUE(printed().at("run").contains("-h"));
}

// ---- the manual page

std::string escaped(const std::string& text) { return std::regex_replace(text, std::regex("-"), "\\-"); }

TEST(ManualPage, HasEverySubcommandAndEveryOption) {
  const std::string page = run_program({"help", "--man"}, kShipped).out;
  for (const auto& [command, options] : printed()) {
    const std::string title = command.empty() ? ".SH OPTIONS\n" : ".SS encounter " + escaped(command) + "\n";
    const std::size_t from = page.find(title);
    ASSERT_NE(from, std::string::npos) << title;
    const std::string section = page.substr(from, page.find("\n.S", from + 1) - from);
    for (const std::string& option : options)
      EXPECT_TRUE(std::regex_search(
          section,
          std::regex("\n\\.TP\n\\\\fB[^ ]*" +
                     std::regex_replace(escaped(option), std::regex(R"(\\)"), R"(\\)") + "(,|\\\\fP)")))
          << command << " " << option;
  }
  for (const char* part : {".SH NAME\n", ".SH SYNOPSIS\n", ".SH EXIT STATUS\n", ".SH ENVIRONMENT\n"})
    EXPECT_THAT(page, HasSubstr(part));
}

TEST(ManualPage, IsTypesetWithoutAWarning) {
  if (run({"groff", "--version"}).code != 0) GTEST_SKIP() << "groff is not installed";
  const test::TemporaryFolder folder;
  const std::string file = folder.file("encounter.1");
  std::ofstream(file) << run_program({"help", "--man"}, kShipped).out;
  const Result set = run({"groff", "-man", "-Tutf8", "-ww", "-P-cbu", file});
  EXPECT_EQ(set.code, 0);
  EXPECT_THAT(set.err, IsEmpty());
  EXPECT_THAT(set.out, HasSubstr("--not-real-time"));
  EXPECT_THAT(set.out, HasSubstr("Example: encounter run tennis_ball --record press.encrec"));
}

// ---- completion

// The answers of bash for command lines, each with the cursor at its end; a line that ends with a space asks
// for the next word.
std::vector<Words> completed(const Words& lines) {
  const test::TemporaryFolder folder;
  const std::string file = folder.file("completion");
  std::ofstream(file) << run_program({"help", "--bash"}, kShipped).out;
  EXPECT_EQ(run({"bash", "-n", file}).err, "");
  std::string script = "cd '" + source_dir() + "' && . " + file + "\ncomplete -p encounter\n";
  for (const std::string& line : lines)
    script += "COMP_WORDS=(" + line + (line.ends_with(' ') ? "''" : "") +
              "); COMP_CWORD=$((${#COMP_WORDS[@]} - 1)); _encounter; echo \"${COMPREPLY[*]}\"\n";
  const Result ran = run({"bash", "--norc", "-c", script});
  EXPECT_EQ(ran.err, "");
  std::istringstream out(ran.out);
  std::string answer;
  std::getline(out, answer);
  EXPECT_EQ(answer, "complete -F _encounter encounter");
  std::vector<Words> all;
  while (std::getline(out, answer)) {
    std::istringstream words(answer);
    all.emplace_back(std::istream_iterator<std::string>(words), std::istream_iterator<std::string>());
  }
  EXPECT_EQ(all.size(), lines.size());
  all.resize(lines.size());
  return all;
}

TEST(Completion, HasEverySubcommandAndEveryOption) {
  Words lines, subcommands;
  for (const auto& [command, options] : printed()) {
    lines.push_back(with("encounter", with(command, "-")));
    if (!command.empty() && command.find(' ') == std::string::npos) subcommands.push_back(command);
  }
  lines.emplace_back("encounter ");
  const std::vector<Words> answers = completed(lines);
  std::size_t i = 0;
  for (const auto& [command, options] : printed())
    EXPECT_THAT(answers[i++], IsSupersetOf(options)) << command;
  EXPECT_THAT(answers.back(), IsSupersetOf(subcommands));
}

TEST(Completion, CompletesNamesValuesAndFiles) {
  const std::vector<Words> answers = completed(
      {"encounter ru", "encounter calibrate sk", "encounter run tennis", "encounter run models/sce",
       "encounter run tennis_ball --rig lab", "encounter run tennis_ball --rig = lab",
       "encounter view tennis_ball --through-camera ", "encounter run tennis_ball --seed ",
       "encounter bench --fu", "encounter help devi", "encounter replay tests/data/pr", "encounter doctor "});
  EXPECT_THAT(answers[0], ElementsAre("run"));
  EXPECT_THAT(answers[1], ElementsAre("skin"));
  EXPECT_THAT(answers[2], ElementsAre("tennis_ball"));
  EXPECT_THAT(answers[3], ElementsAre("models/scenes"));
  EXPECT_THAT(answers[4], ElementsAre("laboratory", "laboratory_vishap"));
  EXPECT_THAT(answers[5], ElementsAre("laboratory", "laboratory_vishap"));
  EXPECT_THAT(answers[6], ElementsAre("raw", "removed", "augmented"));
  EXPECT_THAT(answers[7], IsEmpty());
  EXPECT_THAT(answers[8], ElementsAre("--full"));
  EXPECT_THAT(answers[9], ElementsAre("devices"));
  EXPECT_THAT(answers[10], ElementsAre("tests/data/press.encrec"));
  EXPECT_THAT(answers[11], IsEmpty());
}

// ---- encounter help

TEST(HelpCommand, PrintsTheHelpOfEachCommand) {
  EXPECT_EQ(run_program({"help"}).out, run_program({"--help"}).out);
  EXPECT_EQ(run_program({"help", "run"}).out, run_program({"run", "--help"}).out);
  EXPECT_EQ(run_program({"help", "calibrate", "tip"}).out, run_program({"calibrate", "tip", "--help"}).out);
  EXPECT_THAT(one_line(run_program({"help", "rum"})), HasSubstr("unknown subcommand 'rum'"));
}

}  // namespace
}  // namespace enc::tests
