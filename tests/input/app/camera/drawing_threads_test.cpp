// With how many threads the twin's images are drawn is nobody's business: the bits are the same.
#include <filesystem>
#include <map>
#include <string>
#include <vector>

#include <gtest/gtest.h>
#include <nlohmann/json.hpp>

#include "tests/support/built.h"
#include "tests/support/bytes_of.h"
#include "tests/support/run_program.h"
#include "tests/support/temporary_folder.h"
#include "tests/support/vision/quarter_size.h"

namespace enc::tests {
namespace {

const std::string kFolder = tests::source_dir() + "/models";

// A finger that comes, is seen from 0.9 s on, and touches at 1.4 s; images of a quarter of the pixels.
const std::vector<std::string> kPress{"run",
                                      kFolder + "/scenes/camera/wall.toml",
                                      "--json",
                                      "--for-s",
                                      "2",
                                      "--set",
                                      "user.approach_mm_s=[200]",
                                      "user.approach_from_mm=125"};

struct Drawn {
  nlohmann::json report;
  std::map<std::string, std::string> images;  // by name
};

// Mesa asks for the number once, when OpenGL starts; so each is a process. Of the drivers llvmpipe has
// threads.
Drawn drawn_by(const std::string& threads) {
  const test::TemporaryFolder folder;
  const std::filesystem::path frames = folder.path() / "frames";
  std::vector<std::string> words = kPress;
  const std::vector<std::string> small = test::quarter_size();
  words.insert(words.end(), small.begin(), small.end());
  words.insert(words.begin() + 2, {"--frames", frames});
  const Result r = run_program(words, {{"LP_NUM_THREADS", threads},
                                       {"LIBGL_ALWAYS_SOFTWARE", "1"},
                                       {"GALLIUM_DRIVER", "llvmpipe"},
                                       {"ENCOUNTER_MODELS", kFolder}});
  EXPECT_EQ(r.code, 0) << r.err << r.out;
  Drawn drawn;
  if (r.code != 0) return drawn;
  drawn.report = nlohmann::json::parse(r.out);
  for (const auto& entry : std::filesystem::recursive_directory_iterator(frames))
    if (entry.path().extension() == ".png")
      drawn.images[std::filesystem::relative(entry.path(), frames)] = test::bytes_of(entry.path());
  return drawn;
}

TEST(DrawingThreads, OneOrTwoGiveTheSameBits) {
  const Drawn one = drawn_by("1"), two = drawn_by("2");
  ASSERT_FALSE(one.report.empty() || two.report.empty());
  EXPECT_GT(two.report["threads"], one.report["threads"]) << "the number has not come to the renderer";
  for (const Drawn* drawn : {&one, &two}) {
    EXPECT_EQ(drawn->images.size(), 82U) << "at 20 Hz, two of them, from 0 to 2 s";
    EXPECT_EQ(drawn->report["vision"]["rate_hz"], 20.0);
    EXPECT_GT(drawn->report["modes_s"]["follow"], 0.3) << "the finger was seen";
    EXPECT_GE(drawn->report["contacts"], 1);
  }
  EXPECT_EQ(one.report["state_hash"], two.report["state_hash"]);
  for (const auto& [name, bytes] : one.images)
    EXPECT_TRUE(two.images.contains(name) && bytes == two.images.at(name)) << name;
}

}  // namespace
}  // namespace enc::tests
