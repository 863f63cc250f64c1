// The fake libHD.so against a client by other authors, pyOpenHaptics, in a program of its own.
#include <filesystem>
#include <string>
#include <vector>

#include <dlfcn.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "tests/conformance/arm/phantom_bench.h"
#include "tests/support/built.h"
#include "tests/support/run_program.h"

namespace enc::test {
namespace {

// The runtime of AddressSanitizer that this program has loaded; empty: none. A Python that loads a library
// with it must load the runtime first.
std::string sanitizer_runtime() {
  void* const symbol = dlsym(RTLD_DEFAULT, "__asan_init");
  Dl_info info{};
  if (symbol == nullptr || dladdr(symbol, &info) == 0 || info.dli_fname == nullptr) return {};
  return info.dli_fname;
}

TEST(PhantomForeign, PyOpenHapticsDrivesTheFake) {
  const std::string judge = tests::source_dir() + "/.deps/pyopenhaptics";
  if (!std::filesystem::exists(judge)) GTEST_SKIP() << "no " << judge << ": ./check fetches it";
  PhantomBench there;
  there.with([&] { there.arm.joints = {}; });
  const std::vector<std::string> words{
      "/usr/bin/python3", "-B", tests::source_dir() + "/tests/conformance/foreign/pyopenhaptics_client.py",
      judge};
  tests::Environment environment{{"LD_LIBRARY_PATH", tests::module_folder() + "/fakes"},
                                 {phantom::kPlaceVariable, there.table.device}};
  if (const std::string runtime = sanitizer_runtime(); !runtime.empty()) {
    environment.emplace_back("LD_PRELOAD", runtime);
    environment.emplace_back("ASAN_OPTIONS", "detect_leaks=0");  // of Python
  }
  const tests::Result result = tests::run(words, environment);
  EXPECT_EQ(result.code, 0) << result.out << result.err;
  EXPECT_TRUE(PhantomBench::until([&] { return there.force().norm() == 0.0; })) << "none after the end";
  EXPECT_THAT(there.log.lines(),
              testing::Contains(testing::MatchesRegex(
                  "fake PHANToM: the client is gone; it commanded [0-9]+ forces of up to 3.74 N")));
}

}  // namespace
}  // namespace enc::test
