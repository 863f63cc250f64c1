// Equal bits on every processor. The program calls no function that the C library selects by processor. Whole
// runs agree if parts of the processor are hidden. The README shows the hash that a run prints.
#include <filesystem>
#include <regex>
#include <set>
#include <sstream>
#include <string>
#include <vector>

#include <dlfcn.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <link.h>

#include "tests/support/built.h"
#include "tests/support/files.h"
#include "tests/support/run_program.h"

namespace enc::tests {
namespace {

namespace fs = std::filesystem;
const fs::path kRoot = tests::source_dir();

// Path of a library that this process has loaded.
std::string loaded(const std::string& part) {
  struct Search {
    std::string part, found;
  } search{part, ""};
  ::dl_iterate_phdr(
      [](dl_phdr_info* info, std::size_t, void* data) {
        Search& s = *static_cast<Search*>(data);
        const std::string name = info->dlpi_name;
        if (name.find(s.part) != std::string::npos) s.found = name;
        return 0;
      },
      &search);
  return search.found;
}

// Symbols that a file imports (which = "--undefined-only") or exports ("--defined-only").
std::set<std::string> names(const std::string& file, const std::string& which) {
  std::istringstream lines(run({"nm", "-D", which, file}).out);
  std::set<std::string> all;
  for (std::string line; std::getline(lines, line);) {
    const std::string name = line.substr(line.rfind(' ') + 1);
    all.insert(name.substr(0, name.find('@')));
  }
  return all;
}

// These functions round nothing, or once as the standard says, and so have equal bits everywhere.
const std::set<std::string> kExact{"ceil",      "fabs",      "floor",     "fma",     "fmax",   "fmin",
                                   "fmod",      "frexp",     "ldexp",     "llround", "lround", "modf",
                                   "nearbyint", "nextafter", "remainder", "rint",    "round",  "scalbn",
                                   "sqrt",      "sqrtf",     "trunc"};

TEST(Bits, NothingRoundedComesFromTheCLibrary) {
  const std::string libm = loaded("libm.so"), mujoco = loaded("libmujoco.so");
  ASSERT_FALSE(libm.empty() || mujoco.empty());
  const std::set<std::string> of_libm = names(libm, "--defined-only");
  const std::set<std::string> own = names(program_file(), "--defined-only");
  ASSERT_TRUE(of_libm.contains("sin") && own.contains("sin"));
  std::vector<std::string> files{program_file(), mujoco};
  for (const auto& entry : fs::directory_iterator(module_folder())) files.push_back(entry.path().string());
  for (const std::string& file : files)
    for (const std::string& name : names(file, "--undefined-only"))
      EXPECT_TRUE(!of_libm.contains(name) || own.contains(name) || kExact.contains(name))
          << file << " calls " << name
          << " of libm, whose bits depend on processor and version: it belongs into core/math";
}

const Environment kPlain{};
const std::vector<Environment> kMasks{
    {{"GLIBC_TUNABLES", "glibc.cpu.hwcaps=-FMA,-AVX2"}},                              // Sandy Bridge
    {{"GLIBC_TUNABLES", "glibc.cpu.hwcaps=-FMA4,-FMA,-AVX2,-AVX,-SSE4_1,-SSE4_2"}}};  // Core 2

// Processor features that the C library detects.
std::string abilities(const Environment& environment) {
  std::istringstream lines(run({"/lib64/ld-linux-x86-64.so.2", "--list-diagnostics"}, environment).out);
  std::string all;
  for (std::string line; std::getline(lines, line);)
    if (line.find("x86.cpu_features") == 0 && line.find("active") != std::string::npos) all += line + "\n";
  return all;
}

const std::regex kHash("state hash +([0-9a-f]{16} after [0-9]+ ticks)");

std::string hash_of(const std::vector<std::string>& args, const Environment& environment) {
  const Result result = run_program(args, environment, 600.0);
  std::smatch match;
  return std::regex_search(result.out, match, kHash) ? match[1].str() : result.out + result.err;
}

#if defined(__SANITIZE_ADDRESS__) || defined(__SANITIZE_THREAD__)
constexpr const char* kSeconds = "0.3";  // sanitizers are slow
#else
constexpr const char* kSeconds = "2";
#endif

TEST(Bits, AreTheSameWithoutFmaAndAvx) {
  for (const Environment& mask : kMasks)
    if (abilities(mask) == abilities(kPlain)) GTEST_SKIP() << mask[0].second << " hides nothing here";
  for (const auto& entry : fs::directory_iterator(kRoot / "models/scenes")) {
    if (!entry.is_regular_file()) continue;  // a folder: scenes that look through a camera
    const std::vector<std::string> args{"run", entry.path().string(), "--for-s", kSeconds};
    const std::string plain = hash_of(args, kPlain);
    ASSERT_THAT(plain, testing::MatchesRegex("[0-9a-f]+ after [0-9]+ ticks")) << entry.path();
    for (const Environment& mask : kMasks)
      EXPECT_EQ(hash_of(args, mask), plain) << entry.path() << " with " << mask[0].second;
  }
}

TEST(BitsLong, WholeRunsReplayWithoutFmaAndAvx) {
  const test::TemporaryFolder folder;
  for (const auto& entry : fs::directory_iterator(kRoot / "models/scenes")) {
    if (!entry.is_regular_file()) continue;  // a folder: scenes that look through a camera
    const std::string record = (folder.path() / (entry.path().stem().string() + ".encrec")).string();
    const std::string plain = hash_of({"run", entry.path().string(), "--record", record}, kPlain);
    const std::string hash = plain.substr(0, plain.find(' '));
    for (const Environment& mask : kMasks)
      EXPECT_THAT(run_program({"replay", record}, mask, 600.0).out,
                  testing::HasSubstr("equal to the bit; state hash " + hash))
          << entry.path() << " with " << mask[0].second;
    fs::remove(record);
  }
}

TEST(Bits, TheReadmeShowsThem) {
  const std::string readme = test::bytes_of(kRoot / "README.md");
  std::smatch match;
  ASSERT_TRUE(std::regex_search(readme, match, kHash));
  EXPECT_EQ(match[1], hash_of({"run", (kRoot / "models/scenes/tennis_ball.toml").string()}, kPlain));
}

}  // namespace
}  // namespace enc::tests
