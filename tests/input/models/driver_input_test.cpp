// The table of a driver on the command line: refused with its place before anything moves, listed, described,
// recorded.
#include <fstream>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "tests/support/built.h"
#include "tests/support/bytes_of.h"
#include "tests/support/run_program.h"
#include "tests/support/temporary_folder.h"

namespace enc::tests {
namespace {

using testing::AllOf;
using testing::HasSubstr;
using testing::Not;
using testing::StartsWith;

class DriverInput : public testing::Test {
 protected:
  DriverInput() {
    text_ = test::bytes_of(tests::source_dir() + "/models/rigs/sim.toml");
    for (const std::string role : {"[manipulator]\n", "[force]\n"}) {
      const std::size_t at = text_.find(role + "driver = \"sim\"");
      text_.replace(at, role.size() + 14, role + "driver = \"sample\"");
    }
    line_ = static_cast<int>(std::count(text_.begin(), text_.end(), '\n')) + 1;
  }
  Result program(const std::string& command, const std::string& table, std::vector<std::string> more = {},
                 const std::string& modules = module_folder()) {
    std::ofstream(rig()) << text_ << table;
    more.insert(more.begin(), {command, scene_, "--rig", rig()});
    return run_program(more, {{"ENCOUNTER_MODULES", modules}});
  }
  [[nodiscard]] std::string rig() const { return folder_.file("lab.toml"); }
  [[nodiscard]] std::string at(int line, int column) const {
    return "encounter: " + rig() + ":" + std::to_string(line_ + line) + ":" + std::to_string(column) + ": ";
  }
  test::TemporaryFolder folder_;
  std::string scene_ = tests::source_dir() + "/models/scenes/rig_A.toml", text_;
  int line_ = 0;
};

TEST_F(DriverInput, AWrongTableIsOneLineWithItsPlaceAndNothingMoves) {
  for (const char* command : {"run", "check", "params"}) {
    const Result unknown = program(command, "[driver.sample]\nprot = 4712\n");
    EXPECT_EQ(unknown.code, 2) << command;
    EXPECT_EQ(unknown.out, "");
    EXPECT_EQ(unknown.err,
              at(1, 1) + "unknown key 'prot'; expected a key of [driver.sample]; did you mean 'port'?\n");
    const Result kind = program(command, "[driver.sample]\naddress = 7\n");
    EXPECT_EQ(kind.code, 2) << command;
    EXPECT_THAT(kind.err, StartsWith(at(1, 1) + "'address' is a whole number; expected a text"));
    EXPECT_EQ(program(command, "[driver.sample]\nport = 0\n").code, 2) << command;
    EXPECT_THAT(program(command, "[driver.sample]\naddress = 2020-01-01\n").err,
                StartsWith(at(1, 1) + "'address' is a date or time; expected"));
    EXPECT_EQ(program(command, "[driver.smaple]\nport = 1\n").code, 2) << command;
  }
}

TEST_F(DriverInput, RunCheckAndDoctorSayWhatTheDriverSays) {
  const std::string table = "[driver.sample]\naddress = \"10.0.0.7\"\nport = 4712\n";
  const std::string says = "device      manipulator: sample 10.0.0.7:4712, answered";
  EXPECT_THAT(program("check", table).out,
              AllOf(HasSubstr(says), HasSubstr("device      force: sample 10.0.0.7")));
  EXPECT_THAT(program("run", table, {"--for-s", "0.05"}).out, HasSubstr(says));
  EXPECT_THAT(program("run", table, {"--for-s", "0.05", "--json"}).out,
              HasSubstr("\"manipulator\": \"sample 10.0.0.7:4712, answered"));
  EXPECT_THAT(program("check", table, {"--set", "rig.driver.sample.port=99"}).out,
              HasSubstr("sample 10.0.0.7:99"));
  EXPECT_THAT(program("check", table, {"--resolved", "--set", "rig.driver.sample.port=99"}).out,
              HasSubstr("[rig.driver.sample]\naddress = \"10.0.0.7\"\nport = 99\n"));
  const std::string alone = folder_.file("alone.toml");
  std::ofstream(alone) << program("check", table, {"--resolved"}).out;
  EXPECT_THAT(run_program({"check", alone}, {{"ENCOUNTER_MODULES", module_folder()}}).out, HasSubstr(says));
  EXPECT_THAT(run_program({"doctor"}).out,
              HasSubstr("driver sample: manipulator, force sensor; [driver.sample] address, port"));
  EXPECT_THAT(program("params", table).out,
              HasSubstr("rig.driver.sample.port,,4712,driver,chosen,\"of the controller, TCP\"\n"));
  EXPECT_THAT(run_program({"check", scene_}).out, Not(HasSubstr("device ")));
}

// Where the module is not there the file is still read, listed and kept; only a run wants the device.
TEST_F(DriverInput, WithoutItsModuleATableIsKept) {
  const std::string table = "[driver.sample]\nport = 4712\n";
  const Result check = program("check", table, {}, "/nowhere");
  EXPECT_EQ(check.code, 0) << check.err;
  EXPECT_THAT(check.out, HasSubstr("device      manipulator: NOT THERE: /nowhere/encounter_sample.so"));
  const Result resolved = program("check", table, {"--resolved"}, "/nowhere");
  EXPECT_THAT(resolved.out, HasSubstr("[rig.driver.sample]\nport = 4712\n"));
  EXPECT_THAT(program("params", table, {}, "/nowhere").out,
              HasSubstr("rig.driver.sample.port,,4712,driver,chosen,known to its driver alone\n"));
  EXPECT_EQ(program("run", table, {}, "/nowhere").code, 3);
}

TEST_F(DriverInput, ARecordKeepsItAndReplaysWithoutTheModule) {
  const std::string record = folder_.file("r.encrec");
  const Result run = program("run", "[driver.sample]\nport = 4712\n", {"--for-s", "0.1", "--record", record});
  EXPECT_NE(run.code, 2) << run.err;
  EXPECT_THAT(test::bytes_of(record),
              HasSubstr("[rig.driver.sample]\naddress = \"127.0.0.1\"\nport = 4712\n"));
  const Result replayed = run_program({"replay", record}, {{"ENCOUNTER_MODULES", "/nowhere"}});
  EXPECT_EQ(replayed.code, 0) << replayed.err;
}

}  // namespace
}  // namespace enc::tests
