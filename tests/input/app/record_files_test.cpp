// Records: where they cannot be written, what is wrong with one, and that a replay is the run again.
#include <algorithm>
#include <regex>
#include <string>

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <nlohmann/json.hpp>

#include "core/record/record.h"
#include "tests/input/app/program.h"
#include "tests/support/built.h"
#include "tests/support/bytes_of.h"

namespace enc::tests {
namespace {

namespace fs = std::filesystem;
using Json = nlohmann::json;
using test::bytes_of;
using ::testing::AllOf;
using ::testing::HasSubstr;
using ::testing::MatchesRegex;
using ::testing::StartsWith;

TEST_F(Program, UnwritableRecordFolder) {
  write("file", "");
  for (const std::string& record : {path("file/run.encrec"), path("nowhere/run.encrec"), path("models")})
    EXPECT_THAT(refused({"run", ball(), "--for-s", "0.1", "--record", record}),
                AllOf(StartsWith(record + ": cannot be written: "), HasSubstr("; choose a file")));
  EXPECT_THAT(refused({"run", ball(), "--for-s", "0.1", "--record", "/dev/full"}),
              HasSubstr("No space left on device"));
}

// 200 KiB hold the header and three chunks of 64 KiB; each has about a hundred ticks.
TEST_F(Program, FullDiskWhileRecordingEndsTheRunAndLeavesWhatWasWritten) {
  const std::string record = path("full.encrec");
  const Result r = run({"bash", "-c",
                        "ulimit -f 200; exec '" + program_file() + "' run '" + plane() +
                            "' --for-s 3 --record '" + record + "'"});
  EXPECT_EQ(r.code, 2);
  EXPECT_EQ(std::count(r.err.begin(), r.err.end(), '\n'), 1) << r.err;
  EXPECT_THAT(r.err, AllOf(StartsWith("encounter: cannot write the record"), HasSubstr("File too large")));
  EXPECT_THAT(r.out, AllOf(HasSubstr("\nmodes "), HasSubstr("\nstate hash ")));  // the report of what did run
  EXPECT_FALSE(fs::exists(record));                                              // it is not whole
  const std::string aside = record + ".part";
  EXPECT_THAT(r.err, AllOf(HasSubstr(aside), HasSubstr("replay --partial")));
  EXPECT_LE(fs::file_size(aside), 200U * 1024U);
  EXPECT_EQ(run_program({"replay", aside}).code, 2);
  const Result part = run_program({"replay", aside, "--partial"});
  EXPECT_EQ(part.code, 0) << part.err;
  std::smatch ticks;
  ASSERT_TRUE(std::regex_search(part.out, ticks, std::regex("^([0-9]+) ticks run again, equal to the bit")));
  EXPECT_GE(std::stoi(ticks[1]), 190);
  EXPECT_LT(std::stoi(ticks[1]), 500);
  EXPECT_THAT(part.out, HasSubstr("not sealed"));
}

// The first 2 KiB do not even hold the header: nothing runs, so nothing may be left.
TEST_F(Program, DiskTooFullForTheHeaderLeavesNoFile) {
  const std::string record = path("full.encrec");
  const Result r = run({"bash", "-c",
                        "ulimit -f 1; exec '" + program_file() + "' run '" + plane() +
                            "' --for-s 3 --record '" + record + "'"});
  EXPECT_EQ(r.code, 2);
  EXPECT_EQ(r.out, "");
  EXPECT_THAT(r.err, HasSubstr("cannot write the record"));
  EXPECT_FALSE(fs::exists(record) || fs::exists(record + ".part"));
}

TEST_F(Program, TruncatedRecord) {
  const std::string whole = bytes_of(recorded());
  write("cut.encrec", whole.substr(0, whole.size() / 2));
  EXPECT_THAT(refused({"replay", path("cut.encrec")}),
              MatchesRegex(".*cut\\.encrec: byte [0-9]+: the record is cut off here.*--partial.*\n"));
  const Result part = run_program({"replay", path("cut.encrec"), "--partial"});
  EXPECT_EQ(part.code, 0) << part.err;
  EXPECT_THAT(part.out, HasSubstr("equal to the bit"));
  write("cut.encrec", whole.substr(0, 100));  // in its header
  EXPECT_THAT(refused({"replay", path("cut.encrec")}), HasSubstr("cut off in its header"));
  EXPECT_THAT(refused({"replay", path("cut.encrec"), "--partial"}), HasSubstr("cut off in its header"));
}

TEST_F(Program, RecordThatIsNone) {
  EXPECT_THAT(refused({"replay", path("nothing.encrec")}), HasSubstr("cannot read the record"));
  EXPECT_THAT(refused({"replay", ball()}), HasSubstr("byte 0: this is not a record of Encounter"));
  EXPECT_THAT(refused({"replay", path("models")}), HasSubstr("record"));
  write("none.encrec", "");
  EXPECT_THAT(refused({"replay", path("none.encrec")}), HasSubstr("byte 0: "));
}

TEST_F(Program, RecordOfAnotherLayout) {
  { RecordWriter other(path("other.encrec"), {{"version", "9.8.7"}}, layout_hash(Scene()) ^ 1U); }
  EXPECT_THAT(refused({"replay", path("other.encrec")}),
              AllOf(HasSubstr("record of another layout"), HasSubstr("of Encounter 9.8.7"),
                    HasSubstr("use the version of Encounter that wrote it")));
}

TEST_F(Program, RecordWithoutAScene) {
  {
    RecordWriter bare(path("bare.encrec"), {}, layout_hash(Scene()));
    bare.close();
  }
  EXPECT_THAT(refused({"replay", path("bare.encrec")}), HasSubstr("holds no scene"));
}

TEST_F(Program, ChecksumFailure) {
  std::string bytes = bytes_of(recorded());
  bytes[bytes.size() / 2] = static_cast<char>(bytes[bytes.size() / 2] ^ 1);
  write("bad.encrec", bytes);
  EXPECT_THAT(refused({"replay", path("bad.encrec")}), HasSubstr("checksum failure"));
}

// One input changed by one part in 10^12 and sealed again: the file is sound, the answer is no.
TEST_F(Program, AlteredAndResealedRecordDiffers) {
  RecordReader reader(recorded());
  {
    RecordWriter changed(path("changed.encrec"), reader.texts(), reader.layout());
    RecordedTick frame;
    while (reader.next(frame)) {
      if (frame.tick.index == 400) frame.in.wrench.value.force.xyz[2] *= 1.0 + 1e-12;
      changed.write(frame.tick, frame.in, frame.out, frame.hash);
    }
    changed.close();
  }
  const Result r = run_program({"replay", path("changed.encrec")});
  EXPECT_EQ(r.code, 1);
  EXPECT_EQ(r.err, "");
  EXPECT_THAT(r.out, StartsWith("differs from tick 400 on: "));
}

TEST_F(Program, ReplayIsEqualAndNamesTheHashOfTheRun) {
  const Result run =
      run_program({"run", ball(), "--for-s", "0.5", "--json", "--seed", "5", "--record", path("run.encrec")});
  ASSERT_EQ(run.code, 0) << run.err;
  fs::remove_all(path("models"));  // the record needs nothing else
  const Result replay = run_program({"replay", path("run.encrec")});
  EXPECT_EQ(replay.code, 0) << replay.err;
  EXPECT_EQ(replay.out, "501 ticks run again, equal to the bit; state hash " +
                            Json::parse(run.out).at("state_hash").get<std::string>() + "\n");
}

}  // namespace
}  // namespace enc::tests
