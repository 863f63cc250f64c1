// Records: where they cannot be written, what is wrong with one, and that a replay is the run again.
#include <algorithm>
#include <array>
#include <cstring>
#include <limits>
#include <regex>
#include <string>

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <nlohmann/json.hpp>

#include "core/record/ranges.h"
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

// Sealed as a whole record is, so that its numbers alone can tell.
TEST_F(Program, NumbersOutOfRangeAreRefusedByEachReaderOfRecords) {
  RecordReader reader(recorded());
  const auto spoiled = [&](const std::string& name, const RecordTexts& texts, const auto& spoil) {
    RecordWriter record(path(name), texts, reader.layout());
    RecordedTick frame;
    for (reader.rewind(); reader.next(frame);) {
      spoil(frame);
      record.write(frame.tick, frame.in, frame.out, frame.hash);
    }
    record.close();
    return path(name);
  };
  const std::string mode = spoiled("mode.encrec", reader.texts(), [](RecordedTick& f) {
    if (f.tick.index == 300) f.out.mode = static_cast<Mode>(200);
  });
  const std::string time = spoiled("time.encrec", reader.texts(), [](RecordedTick& f) {
    if (f.tick.index == 0) f.tick.t = Time(Duration(std::numeric_limits<std::int64_t>::max()));
  });
  for (const std::string& record : {mode, time})
    for (const Words& words : {Words{"replay"}, Words{"export", "--csv", path("t.csv")},
                               Words{"export", "--mcap", path("t.mcap")}, Words{"fit"}, Words{"shadow"}}) {
      Words args = words;
      args.insert(args.begin() + 1, record);
      EXPECT_THAT(refused(args),
                  MatchesRegex(".*: byte [0-9]+: '(mode|t)' of a tick is [0-9]+; expected .*\n"))
          << words.back();
    }
  // Each is possible, and together they are more than the record can be of.
  const std::string late =
      spoiled("late.encrec", reader.texts(), [](RecordedTick& f) { f.tick.t += Duration(kMostTime / 2); });
  EXPECT_THAT(refused({"shadow", late}), HasSubstr("expected at most as many lost cycles"));
  const std::string lost = spoiled("lost.encrec", reader.texts(), [](RecordedTick& f) {
    if (f.tick.index >= 400) f.tick.index += kMostTicks / 2;
  });
  EXPECT_THAT(refused({"shadow", lost}), HasSubstr("expected at most as many lost cycles"));
}

// The mesh in a record is looked at as one of a file is.
TEST_F(Program, AMeshInARecordIsASolidOrRefused) {
  const std::string models = source_dir() + "/models", scene = models + "/scenes/hare.toml",
                    whole = path("hare.encrec");
  const test::Variable all("ENCOUNTER_MODELS", models);  // the copy has no meshes
  ASSERT_EQ(run_program({"run", scene, "--for-s", "0.02", "--record", whole}).code, 0);
  ASSERT_EQ(run_program({"replay", whole}).code, 0);
  RecordReader reader(whole);
  const auto with_mesh = [&](const auto& spoil) {
    RecordTexts texts = reader.texts();
    std::string& mesh = texts.at("mesh:hare.glb");
    std::array<std::uint64_t, 2> counts{};
    std::memcpy(counts.data(), mesh.data(), sizeof(counts));
    std::vector<double> places(3 * counts[0]);
    std::memcpy(places.data(), mesh.data() + sizeof(counts), 8 * places.size());
    spoil(places);
    std::memcpy(mesh.data() + sizeof(counts), places.data(), 8 * places.size());
    std::string& resolved = texts.at("resolved");  // its hash is anybody's to write, too
    const std::size_t key = resolved.find("mesh_hash"), end = resolved.find('\n', key);
    resolved.erase(key, end - key);
    RecordWriter record(path("other.encrec"), texts, reader.layout());
    RecordedTick frame;
    for (reader.rewind(); reader.next(frame);) record.write(frame.tick, frame.in, frame.out, frame.hash);
    record.close();
    return refused({"replay", path("other.encrec")});
  };
  using Places = std::vector<double>;
  EXPECT_THAT(with_mesh([](Places& places) {
                for (double& x : places) x *= 1e300;
              }),
              HasSubstr("expected at most 1e+06 m from the origin"));
  EXPECT_THAT(with_mesh([](Places& places) { places[7] = kUnset; }), HasSubstr("vertex 2 is at y = nan m"));
  EXPECT_THAT(with_mesh([](Places& places) { std::fill(places.begin(), places.end(), 0.0); }),
              HasSubstr("hare.glb"));
  EXPECT_THAT(
      with_mesh([](Places& places) { places[0] = places[3], places[1] = places[4], places[2] = places[5]; }),
      HasSubstr("hare.glb"));
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
