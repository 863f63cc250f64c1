// `export`: a record as a table or as MCAP, a scene as MuJoCo's own programs open it; and what is none of
// these, in one line.
#include <algorithm>
#include <filesystem>
#include <fstream>
#include <string>
#include <vector>

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <nlohmann/json.hpp>

#include "tests/support/built.h"
#include "tests/support/bytes_of.h"
#include "tests/support/run_program.h"
#include "tests/support/temporary_folder.h"

namespace enc::tests {
namespace {

using ::testing::AllOf;
using ::testing::HasSubstr;
using ::testing::Not;
using ::testing::StartsWith;
using Words = std::vector<std::string>;

const std::string kRoot = tests::source_dir();
const std::string kWall = kRoot + "/models/scenes/wall.toml", kRecord = kRoot + "/tests/data/press.encrec";

std::string line(const Words& args) {
  const Result r = run_program(args);
  EXPECT_EQ(r.code, 2) << r.out << r.err;
  EXPECT_EQ(r.out, "");
  EXPECT_EQ(std::count(r.err.begin(), r.err.end(), '\n'), 1) << r.err;
  return r.err;
}

TEST(Export, AWorldHasTheRigAndTheNumbersThatItIsGiven) {
  const test::TemporaryFolder folder;
  const auto world = [&](const char* name, const Words& more) {
    Words args{"export", kWall, folder.file(name)};
    args.insert(args.end(), more.begin(), more.end());
    const Result r = run_program(args);
    EXPECT_EQ(r.code, 0) << r.err;
    return test::bytes_of(folder.file(name));
  };
  const std::string as_shipped = world("a.xml", {});
  EXPECT_THAT(as_shipped, AllOf(HasSubstr("<mujoco"), Not(HasSubstr("timestep=\"0.0005\""))));
  EXPECT_THAT(world("b.xml", {"--set", "truth.arm.timestep_us=500"}), HasSubstr("timestep=\"0.0005\""));
  EXPECT_NE(world("c.xml", {"--rig", "stage"}), as_shipped);
  EXPECT_THAT(line({"export", kWall, folder.file("d.xml"), "--set", "truth.arm.timestep_us=501"}),
              HasSubstr("does not divide the haptic period"));
  EXPECT_THAT(line({"export", kWall, folder.file("d.xml"), "--rig", "none"}), HasSubstr("none"));
  EXPECT_FALSE(std::filesystem::exists(folder.file("d.xml")));
}

// As the run had it, to the last digit; of a record that has none, why.
TEST(Export, TheLedgerOfARecordIsThatOfItsRun) {
  const test::TemporaryFolder folder;
  const std::string record = folder.file("keypad.encrec"), keypad = kRoot + "/models/scenes/keypad.toml";
  const Result ran = run_program({"run", keypad, "--for-s", "6", "--json", "--record", record});
  ASSERT_EQ(ran.code, 0) << ran.err;
  const auto json = nlohmann::json::parse(ran.out).at("ledger");
  ASSERT_EQ(json.size(), 1U);
  const Result ledger = run_program({"export", record, "--ledger"});
  ASSERT_EQ(ledger.code, 0) << ledger.err;
  EXPECT_EQ(std::count(ledger.out.begin(), ledger.out.end(), '\n'), 2);
  EXPECT_THAT(ledger.out, StartsWith("contact,object,rendered,began_s,ended_s,hand_mJ,"));
  const std::string row = ledger.out.substr(ledger.out.find('\n') + 1);
  EXPECT_THAT(row, StartsWith("1,"));
  EXPECT_EQ(std::stod(row.substr(row.find_last_of(',') + 1)), json.at(0).at("closure_percent").get<double>());
  const Result again = run_program({"replay", record});
  EXPECT_EQ(again.code, 0);
  EXPECT_THAT(again.out, HasSubstr("\nenergy ledger of 1 contact, as the run had it: export --ledger\n"));
  EXPECT_THAT(line({"export", kRecord, "--ledger"}), HasSubstr("press.encrec: has no energy ledger"));
}

TEST(Export, WhatIsOfTheOtherIsRefused) {
  const test::TemporaryFolder folder;
  const std::string xml = folder.file("w.xml"), csv = folder.file("t.csv");
  EXPECT_THAT(line({"export", kWall, xml, "--csv", csv}), HasSubstr("--csv: only of a record"));
  EXPECT_THAT(line({"export", kWall, xml, "--csv", "-"}), HasSubstr("--csv: only of a record"));
  EXPECT_THAT(line({"export", kWall, xml, "--partial"}), HasSubstr("--partial: only of a record"));
  EXPECT_THAT(line({"export", kWall, xml, "--ledger"}), HasSubstr("--ledger: only of a record"));
  EXPECT_THAT(line({"export", kWall, "-"}), HasSubstr("expected a file"));
  EXPECT_THAT(line({"export", kWall, ""}), HasSubstr("xml"));
  EXPECT_THAT(line({"export", kRecord, xml}), HasSubstr("press.encrec: is a record"));
  EXPECT_THAT(line({"export", kWall}), HasSubstr("wall.toml: is a scene"));
  EXPECT_THAT(line({"export", kWall, "--csv", csv}), HasSubstr("wall.toml: is a scene"));
  EXPECT_THAT(line({"export", kRecord, "--rig", "sim"}), HasSubstr("--rig: only of a scene"));
  EXPECT_THAT(line({"export", kRecord, "--set", "a=1"}), HasSubstr("--set: only of a scene"));
  EXPECT_THAT(line({"export", kWall, kWall, "--force"}), HasSubstr("is read by this command"));
  EXPECT_TRUE(std::filesystem::is_empty(std::filesystem::path(xml).parent_path()));
}

// MCAP is a file of its own beside table, ledger and world, and its readers look for its end: no pipe.
TEST(Export, McapIsAFileOfItsOwn) {
  const test::TemporaryFolder folder;
  const std::string mcap = folder.file("r.mcap"), csv = folder.file("t.csv");
  EXPECT_THAT(line({"export", kRecord, "--mcap", "-"}),
              AllOf(StartsWith("encounter: --mcap -: "), HasSubstr("expected a file; name one")));
  EXPECT_THAT(line({"export", kRecord, "--mcap", ""}), AllOf(HasSubstr("--mcap"), HasSubstr("empty")));
  EXPECT_THAT(line({"export", kRecord, "--mcap"}), HasSubstr("--mcap"));
  EXPECT_THAT(line({"export", kRecord, "--mcap", mcap, "--csv", csv}), HasSubstr("--csv: only of a table"));
  EXPECT_THAT(line({"export", kRecord, "--mcap", mcap, "--csv", "-"}), HasSubstr("--csv: only of a table"));
  EXPECT_THAT(line({"export", kRecord, "--mcap", mcap, "--ledger"}), HasSubstr("--ledger: only of a table"));
  EXPECT_THAT(line({"export", kRecord, "--mcap", mcap, "--rig", "sim"}), HasSubstr("--rig: only of a scene"));
  EXPECT_THAT(line({"export", kWall, folder.file("w.xml"), "--mcap", mcap}),
              HasSubstr("--mcap: only of a record"));
  EXPECT_THAT(line({"export", kWall, "--mcap", mcap}), HasSubstr("wall.toml: is a scene"));
  EXPECT_THAT(line({"export", kRecord, "--mcap", folder.file("none/r.mcap")}),
              HasSubstr("cannot be written"));
  EXPECT_TRUE(std::filesystem::is_empty(folder.path()));
}

// As any other file that the program writes: never over one that is there, nor over what it reads.
TEST(Export, McapReplacesNothingUnasked) {
  const test::TemporaryFolder folder;
  const std::string mcap = folder.file("r.mcap");
  const std::string record = folder.file("r.encrec");
  std::filesystem::copy_file(kRecord, record);
  ASSERT_EQ(run_program({"export", record, "--mcap", mcap}).code, 0);
  const std::string first = test::bytes_of(mcap);
  EXPECT_THAT(line({"export", record, "--mcap", mcap}), HasSubstr("is there already"));
  EXPECT_EQ(run_program({"export", record, "--mcap", mcap, "--force"}).code, 0);
  EXPECT_EQ(test::bytes_of(mcap), first);  // the same record gives the same bytes
  EXPECT_THAT(line({"export", record, "--mcap", record, "--force"}), HasSubstr("is read by this command"));
  const Result full = run({"bash", "-c",
                           "ulimit -f 100; exec '" + program_file() + "' export '" + record + "' --mcap '" +
                               folder.file("full.mcap") + "'"});
  EXPECT_EQ(full.code, 2);
  EXPECT_THAT(full.err, HasSubstr("cannot be written"));
  EXPECT_EQ(test::bytes_of(record), test::bytes_of(kRecord));
  std::filesystem::remove(mcap);
  std::filesystem::remove(record);
  EXPECT_TRUE(std::filesystem::is_empty(folder.path()));
}

// What is not there is said where somebody looks: in the terminal, as for a table, and in the file.
TEST(Export, McapSaysWhatOfItsRecordIsMissing) {
  const test::TemporaryFolder folder;
  const std::string mcap = folder.file("r.mcap"), cut = folder.file("cut.encrec");
  std::string bytes = test::bytes_of(kRecord);
  const auto write = [&] { std::ofstream(cut, std::ios::binary) << bytes; };
  const auto both = [&](int code) {
    const Result table = run_program({"export", cut, "--partial"});
    const Result file = run_program({"export", cut, "--partial", "--mcap", mcap, "--force"});
    EXPECT_EQ(table.code, code) << table.err;
    EXPECT_EQ(file.code, code) << file.err;
    EXPECT_EQ(file.out, "");
    std::string said = table.err;
    said.replace(said.rfind("table"), 5, "file");
    EXPECT_EQ(file.err, said);
    const std::string in_file = said.substr(said.find(cut) + cut.size() + 2);
    EXPECT_THAT(test::bytes_of(mcap), HasSubstr(in_file.substr(0, in_file.size() - 1)));
    return said;
  };
  bytes.resize(bytes.size() * 3 / 4);
  write();
  EXPECT_THAT(line({"export", cut, "--mcap", mcap}), HasSubstr("--partial"));
  EXPECT_FALSE(std::filesystem::exists(mcap));
  EXPECT_THAT(both(0), HasSubstr("is not sealed"));
  bytes = test::bytes_of(kRecord);
  bytes[bytes.size() * 3 / 4] = static_cast<char>(bytes[bytes.size() * 3 / 4] ^ 1);
  write();
  EXPECT_THAT(both(1), HasSubstr("checksum"));
}

}  // namespace
}  // namespace enc::tests
