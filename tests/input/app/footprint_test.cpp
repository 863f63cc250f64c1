// What the program is made of and maps: a scene gets what it names, and nothing of what others need.
#include <fstream>
#include <iterator>
#include <string>

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <nlohmann/json.hpp>

#include "tests/support/built.h"
#include "tests/support/run_program.h"

namespace enc::tests {
namespace {

using testing::Contains;
using testing::Each;
using testing::HasSubstr;
using testing::Not;
using Json = nlohmann::json;

std::string symbols_of(const std::string& file) {
  std::ifstream in(file, std::ios::binary);
  return {std::istreambuf_iterator<char>(in), {}};
}

// enc::bench as the compiler writes it into the names of functions.
TEST(Footprint, TheProgramHoldsNoBenchmark) {
  const std::string program = symbols_of(program_file());
  ASSERT_GT(program.size(), 100'000U);
  EXPECT_NE(program.find("3enc5trial"), std::string::npos);  // so names can be found
  EXPECT_EQ(program.find("3enc5bench"), std::string::npos);
  EXPECT_EQ(program.find("fit_ball"), std::string::npos);
}

TEST(Footprint, APlaneMapsNoModuleAndHasOneThread) {
  const Result result =
      run_program({"run", tests::source_dir() + "/models/scenes/plane.toml", "--for-s", "0.1", "--json"});
  ASSERT_EQ(result.code, 0) << result.err;
  const Json json = Json::parse(result.out);
  EXPECT_EQ(json["threads"], 1);
  EXPECT_GT(json["mujoco_elements"], 0);
  const auto libraries = json["libraries"].get<std::vector<std::string>>();
  EXPECT_THAT(libraries, Contains(HasSubstr("libmujoco")));
  for (const char* other : {"encounter_", "libGL", "libEGL", "opencv", "embree", "orocos", "png"})
    EXPECT_THAT(libraries, Each(Not(HasSubstr(other))));
#if !defined(__SANITIZE_ADDRESS__)
  EXPECT_LT(json["peak_memory_MiB"], 20.0);
#endif
}

TEST(Footprint, VersionIsOneLine) {
  const Result result = run_program({"--version"});
  EXPECT_EQ(result.code, 0);
  EXPECT_THAT(result.out,
              testing::MatchesRegex("Encounter [0-9]+\\.[0-9]+\\.[0-9]+, commit [-0-9a-z]+ of [-0-9a-z]+\n"));
}

}  // namespace
}  // namespace enc::tests
