// What every scene that ships does, tick by tick: one hash over outputs and truth (none over memory, which
// may be laid out anew) and the state hash. A change that shall change nothing leaves the table as it is.
#include <cmath>
#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <set>
#include <string>
#include <vector>

#include <fmt/format.h>
#include <gtest/gtest.h>

#include "models/setup/scene_file.h"
#include "sim/truth/truth_fields.h"
#include "tests/support/built.h"
#include "trial/trial.h"

namespace enc {
namespace {

namespace fs = std::filesystem;
const fs::path kScenes = tests::source_dir() + "/models/scenes";
const fs::path kTable = tests::source_dir() + "/tests/golden/outcomes.csv";
constexpr const char* kHeader = "scene,seed,length,ticks,state_hash,outcome_hash";
constexpr double kShort = 1.5;  // s

// length is "whole", or "short": its first kShort seconds.
std::string row_of(const std::string& scene, std::uint64_t seed, const std::string& length) {
  StateHash outcome;
  trial::TrialOptions options;
  options.seed = seed;
  if (length == "short") options.seconds = kShort;
  options.watch = [&](const trial::Glance& glance) {
    Outputs out = glance.out;
    sim::Truth truth = glance.truth;
    fields(outcome, out);
    fields(outcome, truth);
  };
  trial::Trial trial(models::load((kScenes / (scene + ".toml")).string(), {}, {}), options);
  const trial::TrialResult result = trial.run();
  return fmt::format("{},{},{},{},{:016x},{:016x}", scene, seed, length, result.ticks, result.hash,
                     outcome.value);
}

std::vector<std::string> table() {
  std::vector<std::string> rows;
  std::ifstream file(kTable);
  for (std::string line; std::getline(file, line);) rows.push_back(line);
  return rows;
}

std::vector<std::string> words_of(const std::string& row) {
  std::vector<std::string> words{""};
  for (const char c : row) {
    if (c == ',')
      words.emplace_back();
    else
      words.back().push_back(c);
  }
  return words;
}

void expect_rows(const std::string& length) {
  for (const std::string& row : table()) {
    const std::vector<std::string> words = words_of(row);
    if (words.size() < 3 || words[2] != length) continue;
    EXPECT_EQ(row_of(words[0], std::stoull(words[1]), length), row)
        << "if the change is meant, look at what moved, write the table anew with\n  "
           "ENCOUNTER_WRITE_OUTCOMES=1 build/release/test_golden --gtest_filter=Outcome.TheTable*\n"
           "and say in the commit why";
  }
}

TEST(Outcome, TheTableHasEverySceneTwice) {
  std::set<std::string> scenes, expected;
  for (const auto& entry : fs::directory_iterator(kScenes))
    if (entry.path().extension() == ".toml") scenes.insert(entry.path().stem());
  for (const std::string& scene : scenes)
    for (const char* end : {",1,short", ",2,short", ",1,whole", ",2,whole"}) expected.insert(scene + end);
  if (std::getenv("ENCOUNTER_WRITE_OUTCOMES") != nullptr) {
    std::ofstream file(kTable);
    file << kHeader << "\n";
    for (const std::string& scene : scenes)
      for (const char* length : {"short", "whole"})
        for (const std::uint64_t seed : {1U, 2U}) file << row_of(scene, seed, length) << "\n";
    FAIL() << kTable << " was written anew: look at the difference";
  }
  const std::vector<std::string> rows = table();
  ASSERT_FALSE(rows.empty());
  EXPECT_EQ(rows.front(), kHeader);
  std::set<std::string> found;
  for (std::size_t i = 1; i < rows.size(); ++i) {
    const std::vector<std::string> words = words_of(rows[i]);
    ASSERT_EQ(words.size(), 6U) << rows[i];
    found.insert(words[0] + "," + words[1] + "," + words[2]);
  }
  EXPECT_EQ(found, expected);
}

// A member that is new must be hashed, too: then this does not compile until somebody has looked.
struct Count {
  int leaves = 0;
  template <class T>
  void operator()(std::string_view, const T&) {
    ++leaves;
  }
};
TEST(Outcome, EveryMemberOfTheTruthIsNamed) {
  const sim::Truth truth;
  const auto& [t, tool_tip, tool_velocity, tip, tip_velocity, tip_acceleration, contact_force, hand_force,
               leg_force, joints, motor_torque, warmth, touching, penetration, tool_radius, tip_radius, press,
               aim, phase, approach_speed, aborted, tool, work] = truth;
  EXPECT_EQ(&t, &truth.t);
  EXPECT_EQ(&tool, &truth.tool);
  EXPECT_EQ(&work, &truth.work);  // is of the ledger alone, and follows from the rest
  Count count;
  sim::Truth copy = truth;
  fields(count, copy);
  EXPECT_EQ(count.leaves, 1 + 7 * 3 + 6 + 3 * 3 + 1 + 4 + 3 + 2);
}

TEST(OutcomeLong, TheFirstSecondsOfEveryScene) { expect_rows("short"); }

TEST(OutcomeLong, EverySceneToItsEnd) { expect_rows("whole"); }

}  // namespace
}  // namespace enc
