// Every shipped scene ends with exit code 0, whichever hand is drawn, or its file says why not. Those here
// ended in a limit or a hold once: a tray that the machine followed the tool to, a bound that knew nothing of
// the drawn reach.
#include <fstream>
#include <regex>
#include <string>
#include <vector>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "models/setup/scene_names.h"
#include "tests/support/built.h"
#include "tests/support/run_program.h"

namespace enc::tests {
namespace {

using ::testing::AllOf;
using ::testing::HasSubstr;
using ::testing::Not;

Result run_seed(const std::string& scene, int seed) {
  return run_program(
      {"run", source_dir() + "/models/scenes/" + scene + ".toml", "--seed", std::to_string(seed)});
}

// What a scene file says of a seed: "# Expected: seed 20 ends with exit code 1." and why.
int expected_code(const std::string& scene, int seed) {
  std::ifstream in(source_dir() + "/models/scenes/" + scene + ".toml");
  const std::regex says("# Expected: seed ([0-9]+) ends with exit code ([0-9])\\..+");
  for (std::string line; std::getline(in, line);)
    if (std::smatch found; std::regex_search(line, found, says) && std::stoi(found[1]) == seed)
      return std::stoi(found[2]);
  return 0;
}

void expect_well(const std::string& scene, int seed) {
  const Result run = run_seed(scene, seed);
  EXPECT_EQ(run.code, expected_code(scene, seed)) << scene << ", seed " << seed << "\n" << run.out << run.err;
}

TEST(ShippedScenes, EndWellWhereTheyOnceDidNot) {
  for (const int seed : {1, 5, 11}) {
    const Result run = run_seed("training", seed);
    EXPECT_EQ(run.code, 0) << run.out;
    EXPECT_THAT(run.out,
                AllOf(Not(HasSubstr("\nhold ")), HasSubstr("limit 0.15 mm"), HasSubstr("limit not reached")));
  }
  for (const int seed : {9, 12}) expect_well("session", seed);
}

TEST(ShippedScenesLong, EndWellWithSeeds1To20) {
  for (const std::string& scene : models::scene_names(source_dir() + "/models"))
    for (int seed = 1; seed <= 20; ++seed) expect_well(scene, seed);
}

}  // namespace
}  // namespace enc::tests
