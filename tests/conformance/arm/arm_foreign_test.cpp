// The fake libraries of arms against clients by other authors, each in a program of its own: pyOpenHaptics
// and forcedimension-core.
#include <filesystem>
#include <string>
#include <vector>

#include <dlfcn.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <sys/utsname.h>

#include "tests/conformance/arm/delta_bench.h"
#include "tests/conformance/arm/phantom_bench.h"
#include "tests/support/built.h"
#include "tests/support/files.h"
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

// As uname -m has it.
std::string machine() {
  utsname name{};
  return ::uname(&name) == 0 ? name.machine : "";
}

// The client runs with this environment, and finds all as it must be.
void expect_good(const std::string& client, const std::string& judge, tests::Environment environment) {
  const std::vector<std::string> words{"/usr/bin/python3", "-B",
                                       tests::source_dir() + "/tests/conformance/foreign/" + client, judge};
  if (const std::string runtime = sanitizer_runtime(); !runtime.empty()) {
    environment.emplace_back("LD_PRELOAD", runtime);
    environment.emplace_back("ASAN_OPTIONS", "detect_leaks=0");  // of Python
  }
  const tests::Result result = tests::run(words, environment);
  EXPECT_EQ(result.code, 0) << result.out << result.err;
}

TEST(PhantomForeign, PyOpenHapticsDrivesTheFake) {
  const std::string judge = tests::source_dir() + "/.deps/pyopenhaptics";
  if (!std::filesystem::exists(judge)) GTEST_SKIP() << "no " << judge << ": ./check fetches it";
  PhantomBench there;
  there.with([&] { there.arm.joints = {}; });
  expect_good("pyopenhaptics_client.py", judge,
              {{"LD_LIBRARY_PATH", tests::module_folder() + "/fakes"},
               {phantom::kPlaceVariable, there.table.device}});
  EXPECT_TRUE(PhantomBench::until([&] { return there.force().norm() == 0.0; })) << "none after the end";
  EXPECT_THAT(there.log.lines(),
              testing::Contains(testing::MatchesRegex(
                  "fake PHANToM: the client is gone; it commanded [0-9]+ forces of up to 3.74 N")));
}

// It looks for libdrd, of which libdhd is a part, in the vendor's SDK.
TEST(ForceDimensionForeign, ForcedimensionCoreDrivesTheFake) {
  namespace fs = std::filesystem;
  const std::string judge = tests::source_dir() + "/.deps/forcedimension_core";
  if (!fs::exists(judge)) GTEST_SKIP() << "no " << judge << ": ./check fetches it";
  const TemporaryFolder sdk;
  const fs::path folder = sdk.path() / "lib/release" / (std::string("lin-") + machine() + "-gcc");
  fs::create_directories(folder);
  fs::create_symlink(fs::path(tests::module_folder()) / "fakes/libdhd.so", folder / "libdrd.so.3");
  DeltaBench there;
  expect_good("forcedimension_client.py", judge,
              {{"FDSDK", sdk.path()},
               {forcedimension::kPlaceVariable, "127.0.0.1:" + std::to_string(there.server.port())}});
  EXPECT_TRUE(DeltaBench::until([&] { return there.force().norm() == 0.0; })) << "none after the end";
  EXPECT_TRUE(DeltaBench::until([&] { return !there.log.lines().empty(); }));
  EXPECT_THAT(there.log.lines(), testing::Contains(testing::MatchesRegex(
                                     "fake Force Dimension: the client is gone; it commanded "
                                     "[0-9]+ forces of up to 3.74 N.*")));
}

}  // namespace
}  // namespace enc::test
