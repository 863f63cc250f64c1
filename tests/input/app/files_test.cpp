// The program and its files: it overwrites and loses nothing. Records: damage to a record, and a replay that
// equals the run.
#include "tests/support/files.h"

#include <algorithm>
#include <array>
#include <cstring>
#include <filesystem>
#include <fstream>
#include <limits>
#include <regex>
#include <sstream>
#include <string>
#include <vector>

#include <fmt/format.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <nlohmann/json.hpp>

#include "core/record/ranges.h"
#include "core/record/record.h"
#include "tests/input/app/program.h"
#include "tests/support/built.h"
#include "tests/support/run_program.h"

namespace enc::tests {
namespace {

namespace fs = std::filesystem;
using test::bytes_of;
using ::testing::AllOf;
using ::testing::HasSubstr;
using ::testing::MatchesRegex;
using ::testing::StartsWith;

// ---- The program and its files: it overwrites nothing, loses nothing, and accepts no nonsense.

using Words = std::vector<std::string>;

class ProgramFiles : public testing::Test {
 protected:
  [[nodiscard]] std::string path(const std::string& name) const { return folder_.file(name); }
  [[nodiscard]] std::string write(const std::string& name, const std::string& text) const {
    std::ofstream(path(name), std::ios::binary) << text;
    return path(name);
  }
  [[nodiscard]] std::string plane() const { return write("p.toml", bytes_of(shipped_scene("plane"))); }
  // A loop that is pressed to 6 mm and released.
  template <class Force>
  [[nodiscard]] std::string loop(const std::string& name, Force force) const {
    std::string text = "time_s,deflection_mm,force_N,repeat\n";
    for (int k = 0; k < 600; ++k) {
      const double d = 6.0 * (k < 300 ? k : 600 - k) / 300.0;
      text += fmt::format("{},{},{},1\n", k * 1e-3, d, force(d));
    }
    return write(name, text);
  }
  [[nodiscard]] std::string good_loop() const {
    return loop("loop.csv", [](double d) { return 2.0 * d; });
  }
  // The single line on stderr of a refusal.
  static std::string line(const Words& args, int code = 2, double timeout = 60.0) {
    const Result r = run_program(args, kShipped, timeout);
    EXPECT_EQ(r.code, code) << args[0] << ": " << r.out << r.err;
    EXPECT_EQ(std::count(r.err.begin(), r.err.end(), '\n'), 1) << r.err;
    return r.err;
  }
  [[nodiscard]] std::string recorded(const std::string& seconds = "0.5") const {
    const Result r = run_program(
        {"run", shipped_scene("plane"), "--for-s", seconds, "--record", path("r.encrec")}, kShipped);
    EXPECT_EQ(r.code, 0) << r.err;
    return path("r.encrec");
  }
  test::TemporaryFolder folder_;
};

// ---- the program overwrites nothing
TEST_F(ProgramFiles, AnInputIsNeverAnOutputEvenWithForce) {
  const std::string p = plane(), csv = good_loop(), record = recorded();
  const std::string view = module_folder() + "/encounter_view.so";
  std::vector<Words> all{{"run", p, "--for-s", "0.1", "--record", p},
                         {"fit", csv, "--out", csv},
                         {"export", record, "--csv", record}};
  const std::string picture = path("scene.png");  // a scene with such a name
  std::filesystem::copy_file(p, picture);
  if (std::filesystem::exists(view)) {
    all.push_back({"view", picture, "--at-s", "0.1", "--shot", picture});
    const std::string kept = path("record.png");
    std::filesystem::copy_file(record, kept);
    all.push_back({"view", kept, "--at-s", "0.05", "--shot", kept});
  }
  for (Words& args : all) {
    const std::string file = args.back(), before = bytes_of(file);
    args.emplace_back("--force");
    EXPECT_THAT(line(args), HasSubstr("is read by this command"));
    EXPECT_EQ(bytes_of(file), before) << args[0];
  }
}

TEST_F(ProgramFiles, WhatIsThereStaysWithoutForce) {
  const std::string csv = good_loop(), record = recorded();
  const std::vector<Words> all{{"run", shipped_scene("plane"), "--for-s", "0.1", "--record"},
                               {"export", record, "--csv"},
                               {"fit", csv, "--out"},
                               {"mesh", "cube", "--out"},
                               {"calibrate", "camera", "vishap", "--pairs", "4", "--frames", "1", "--out"}};
  for (Words args : all) {
    const std::string file = write("kept.stl", "mine");
    args.push_back(file);
    EXPECT_THAT(line(args), AllOf(HasSubstr("is there already"), HasSubstr("--force")));
    EXPECT_EQ(bytes_of(file), "mine") << args[0];
    args.emplace_back("--force");
    const Result r = run_program(args, kShipped);
    EXPECT_EQ(r.code, 0) << args[0] << r.err;
    EXPECT_NE(bytes_of(file), "mine") << args[0];
    EXPECT_FALSE(std::filesystem::exists(file + ".part"));
  }
}

TEST_F(ProgramFiles, TwoRunsDoNotRecordIntoOneFile) {
  const Result r = run({"bash", "-c",
                        "\"$1\" run \"$2\" --pace wall --for-s 3 --record \"$3\" >\"$3.out\" 2>&1 & "
                        "while [ ! -s \"$3.part\" ]; do sleep 0.05; done; "
                        "\"$1\" run \"$2\" --for-s 0.1 --force --record \"$3\"; echo second $?; wait $!; "
                        "echo first $?; \"$1\" replay \"$3\"",
                        "bash", program_file(), shipped_scene("plane"), path("r.encrec")},
                       kShipped);
  EXPECT_THAT(r.out, AllOf(HasSubstr("second 2"), HasSubstr("first 0"), HasSubstr("3001 ticks run again")));
  EXPECT_THAT(r.err, HasSubstr("another run is writing it"));
}

// ---- the program loses nothing
TEST_F(ProgramFiles, AFullStandardOutputIsSaid) {
  const std::string record = recorded(), csv = good_loop();
  const std::string points = write("points.csv", "x_m,y_m,z_m\n0,0,0.1\n");
  const std::string mesh = tests::source_dir() + "/models/meshes/hare.glb";
  const std::vector<Words> all{{"run", shipped_scene("plane"), "--for-s", "0.1"},
                               {"check", shipped_scene("plane")},
                               {"params", shipped_scene("plane")},
                               {"replay", record},
                               {"export", record},
                               {"nearest", mesh, points},
                               {"fit", csv},
                               {"calibrate", "camera", "vishap", "--pairs", "4", "--frames", "1"},
                               {"doctor"},
                               {"--help"},
                               {"--version"}};
  for (const Words& args : all) {
    Words command{"bash", "-c", "\"$@\" >/dev/full", "bash", program_file()};
    command.insert(command.end(), args.begin(), args.end());
    Environment environment = kShipped;
    environment.emplace_back("ASAN_OPTIONS", "detect_leaks=0");  // leaks in the libraries that doctor checks
    const Result r = run(command, environment);
    EXPECT_EQ(r.code, 2) << args[0];
    EXPECT_THAT(r.err, HasSubstr("standard output")) << args[0];
  }
}

// The next file that the program opens would get the number of a closed standard output, and the report.
TEST_F(ProgramFiles, AClosedStandardOutputIsSaidAndTheRecordIsWhole) {
  const Words closed{"bash", "-c", "\"$1\" run \"$2\" --for-s 0.1 --record \"$3\" >&-"};
  Words command = closed;
  for (const std::string& word :
       {std::string("bash"), program_file(), shipped_scene("plane"), path("c.encrec")})
    command.push_back(word);
  const Result r = run(command, kShipped);
  EXPECT_EQ(r.code, 2);
  EXPECT_THAT(r.err, HasSubstr("standard output"));
  EXPECT_THAT(run_program({"replay", path("c.encrec")}, kShipped).out,
              HasSubstr("101 ticks run again, equal"));
}

TEST_F(ProgramFiles, ARecordIsNotStandardOutput) {
  for (const char* words :
       {"/dev/stdout > \"$3\"", "\"$3\" --force > \"$3\"", "\"$3\" > \"$3.part\"", "/dev/stdout | cat"}) {
    const Result r =
        run({"bash", "-c", "set -o pipefail; \"$1\" run \"$2\" --for-s 0.1 --record " + std::string(words),
             "bash", program_file(), shipped_scene("plane"), path("o.encrec")},
            kShipped);
    EXPECT_EQ(r.code, 2) << words;
    EXPECT_THAT(r.err, HasSubstr("is standard output, where the report goes")) << words;
    std::filesystem::remove(path("o.encrec"));
    std::filesystem::remove(path("o.encrec.part"));
  }
}

TEST_F(ProgramFiles, APipeIsNoRecord) {
  const Result r =
      run({"bash", "-c", "\"$1\" replay <(cat \"$2\")", "bash", program_file(), recorded("0.1")}, kShipped);
  EXPECT_EQ(r.code, 2) << r.out;
  EXPECT_THAT(r.err, HasSubstr("is a pipe; expected a file"));
}

// The run was incomplete, so the user is not to blame for a missing touch.
TEST_F(ProgramFiles, AFullDiskIsNoVerdictOnTheUser) {
  const Result r = run({"bash", "-c", "ulimit -f 200; exec \"$1\" run \"$2\" --record \"$3\"", "bash",
                        program_file(), shipped_scene("tennis_ball"), path("l.encrec")},
                       kShipped);
  EXPECT_EQ(r.code, 2) << r.err;
  EXPECT_THAT(r.out, AllOf(HasSubstr("has not touched anything yet"), testing::Not(HasSubstr("LIMIT"))));
}

TEST_F(ProgramFiles, ATipIsNotLargerThanTheMachine) {
  for (const char* key : {"rig.manipulator", "tool.stylus", "truth.hexapod"})
    EXPECT_THAT(line({"run", shipped_scene("session"), "--for-s", "0.1", "--set",
                      std::string(key) + ".tip_radius_mm=1e300"}),
                HasSubstr("1000 in mm"))
        << key;
}

TEST_F(ProgramFiles, AReportSaysHowItWasMade) {
  const Words words{"run",   shipped_scene("plane"),      "--for-s", "0.1", "--seed", "7",
                    "--set", "rig.tracker.lost_age_ms=90"};
  EXPECT_THAT(run_program(words, kShipped).out,
              AllOf(HasSubstr("\nmade by     Encounter "), HasSubstr("plane.toml, rig "),
                    HasSubstr(", seed 7, --for-s 0.1, --set rig.tracker.lost_age_ms=90\n")));
  Words json = words;
  json.emplace_back("--json");
  EXPECT_THAT(
      run_program(json, kShipped).out,
      AllOf(HasSubstr("\"encounter\": \""), testing::ContainsRegex("\"commit\": \"([0-9a-f]{12}|unknown)"),
            testing::ContainsRegex("\"date\": \"[0-9]{4}-[0-9]{2}-[0-9]{2}\""),
            testing::Not(HasSubstr("\"started\"")), HasSubstr("\"seed\": 7"), HasSubstr("\"for_s\": 0.1"),
            HasSubstr("\"rig.tracker.lost_age_ms=90\"")));
}

// A ball that returns more energy than it takes is not passive; the command is silent about a loss.
TEST_F(ProgramFiles, ALoopThatGivesEnergyIsDoubted) {
  std::string text = "time_s,deflection_mm,force_N,repeat\n";
  for (int k = 0; k < 600; ++k) {
    const double d = 6.0 * (k < 300 ? k : 600 - k) / 300.0;
    text += fmt::format("{},{},{},1\n", k * 1e-3, d, (k < 300 ? 1.0 : 1.1) * d);
  }
  const Result gives = run_program({"fit", write("gives.csv", text)}, kShipped);
  EXPECT_THAT(gives.out, HasSubstr("nothing passive does that"));
  const Result good = run_program({"fit", good_loop()}, kShipped);
  EXPECT_EQ(good.code, 0) << good.err;
  EXPECT_THAT(good.out, testing::Not(HasSubstr("passive")));
}

TEST_F(ProgramFiles, ANameThatIsEmptyIsNoName) {
  for (const Words& args :
       std::vector<Words>{{"run", shipped_scene("plane"), "--for-s", "0.1", "--record", ""},
                          {"export", path("r.encrec"), "--csv", ""},
                          {"fit", path("l.csv"), "--out", ""},
                          {"mesh", "cube", "--out", ""}})
    EXPECT_THAT(line(args), HasSubstr(args[args.size() - 2])) << args[0];
}

TEST_F(ProgramFiles, DamageIsNotCalledCutOff) {
  const std::string record = recorded("2"), whole = bytes_of(record);
  std::string bad = whole;
  bad[whole.size() / 2] = static_cast<char>(bad[whole.size() / 2] ^ 1);
  const std::string damaged = write("bad.encrec", bad);
  const Result r = run_program({"replay", damaged, "--partial"}, kShipped);
  EXPECT_EQ(r.code, 1);
  EXPECT_THAT(r.out, AllOf(HasSubstr("ticks run again"), HasSubstr("damaged"), HasSubstr("checksum failure"),
                           testing::Not(HasSubstr("cut off"))));
  EXPECT_THAT(line({"export", damaged, "--partial", "--csv", path("bad.csv")}, 1),
              HasSubstr("checksum failure"));
  const std::string cut = write("cut.encrec", whole.substr(0, whole.size() / 2));
  EXPECT_EQ(run_program({"replay", cut, "--partial"}, kShipped).code, 0);
  EXPECT_THAT(line({"replay", cut}), HasSubstr("--partial"));
  // The header is whole, the first chunk is not.
  EXPECT_THAT(line({"replay", write("none.encrec", whole.substr(0, 30000)), "--partial"}),
              HasSubstr("holds no whole tick"));
}

// ---- the program accepts no nonsense
TEST_F(ProgramFiles, ALoopWhoseForceDoesNotRiseIsNoLoop) {
  for (const std::string& file : {loop("zero.csv", [](double) { return 0.0; }),
                                  loop("falling.csv", [](double d) { return 6.0 - d; })}) {
    EXPECT_THAT(line({"fit", file, "--out", path("f.toml")}), HasSubstr("the force rises by"));
    EXPECT_FALSE(std::filesystem::exists(path("f.toml")));
  }
}

TEST_F(ProgramFiles, AMarkBeforeTheTextIsReadOver) {
  const std::string good = bytes_of(good_loop());
  EXPECT_EQ(run_program({"fit", write("bom.csv", "\xEF\xBB\xBF" + good)}, kShipped).code, 0);
  std::string semicolons = good;
  std::replace(semicolons.begin(), semicolons.end(), ',', ';');
  EXPECT_THAT(line({"fit", write("semi.csv", semicolons)}), HasSubstr("parted by ';'"));
  const std::string mesh = tests::source_dir() + "/models/meshes/hare.glb";
  EXPECT_EQ(run_program({"nearest", mesh, write("p.csv", "\xEF\xBB\xBFx_m,y_m,z_m\n0,0,0\n")}, kShipped).code,
            0);
}

TEST_F(ProgramFiles, NearestKnowsArmsAndHowFarIsTooFar) {
  const std::string mesh = tests::source_dir() + "/models/meshes/hare.glb";
  EXPECT_THAT(line({"nearest", mesh, write("far.csv", "x_m,y_m,z_m\n0,1e300,0\n")}),
              HasSubstr("far.csv:2:3: 1e300 m is farther than"));
  const Result arm = run_program(
      {"nearest", shipped_scene("wall") + "#wall", write("p.csv", "x_m,y_m,z_m\n0.1,0,0\n")}, kShipped);
  EXPECT_EQ(arm.code, 0) << arm.err;
  EXPECT_THAT(arm.out, HasSubstr("\n0,0.1,0,0,0,0,1,"));
}

TEST_F(ProgramFiles, WhatNeverEndsIsRefused) {
  std::filesystem::create_symlink("/dev/zero", path("zero.toml"));
  for (const Words& args : std::vector<Words>{
           {"run", shipped_scene("tennis_ball"), "--set", "user.hold_s=1e12"},
           {"run", shipped_scene("wall"), "--set", "user.hold_s=1e12"},
           {"run", shipped_scene("rig_A"), "--set", "probe.repeats=1000000"},
           {"run", shipped_scene("tennis_ball"), "--for-s", "0.1", "--set", "truth.tracker.rate_hz=1e-12"},
           {"run", shipped_scene("tennis_ball"), "--for-s", "0.1", "--set",
            "truth.tracker.server_rate_hz=1e-12"},
           {"run", shipped_scene("tennis_ball"), "--for-s", "0.1", "--set", "truth.display.rate_hz=1e-12"},
           {"run", path("zero.toml")},
           {"run", shipped_scene("plane"), "--rig", path("zero.toml")},
           {"fit", "/dev/zero"},
           {"calibrate", "tracker", "/dev/zero"},
           {"nearest", tests::source_dir() + "/models/meshes/hare.glb", "/dev/zero"}})
    EXPECT_THAT(line(args, 2, 30.0), AllOf(HasSubstr("expected "), testing::Not(HasSubstr("bad_alloc"))));
}

TEST_F(ProgramFiles, DivergedPhysicsIsNoDevice) {
  const Result r = run_program(
      {"run", shipped_scene("tennis_ball"), "--for-s", "1", "--set", "truth.hand.mass_kg=1e-9"}, kShipped);
  EXPECT_EQ(r.code, 4) << r.err;
  EXPECT_THAT(r.err, HasSubstr("the physics diverged at tick"));
}

TEST_F(ProgramFiles, AnArmsTableHasItsTip) {
  ASSERT_EQ(
      run_program({"run", shipped_scene("wall"), "--for-s", "5", "--record", path("w.encrec")}, kShipped)
          .code,
      0);
  std::istringstream rows(run_program({"export", path("w.encrec")}, kShipped).out);
  std::string row;
  std::getline(rows, row);
  double least = 1e9, most = -1e9;  // extremes of tip_x_mm
  while (std::getline(rows, row)) {
    const std::size_t cell = row.find(',', row.find(',') + 1) + 1;
    ASSERT_NE(row[cell], ',') << row;
    least = std::min(least, std::stod(row.substr(cell)));
    most = std::max(most, std::stod(row.substr(cell)));
  }
  EXPECT_GT(most - least, 1.0);
}

// ---- Records: unwritable places, damage to a record, and a replay that equals the run.

using Json = nlohmann::json;

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
  // The report covers the part that ran.
  EXPECT_THAT(r.out, AllOf(HasSubstr("\nmodes "), HasSubstr("\nstate hash ")));
  EXPECT_FALSE(fs::exists(record));  // it is incomplete
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
  write("cut.encrec", whole.substr(0, 100));  // within its header
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

// One input changes by one part in 10^12 and the record is sealed again: the file is sound, the replay
// differs.
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

// Sealed as a complete record, so that only its numbers reveal the error.
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
  // Each number is possible; together they exceed the size of the record.
  const std::string late =
      spoiled("late.encrec", reader.texts(), [](RecordedTick& f) { f.tick.t += Duration(kMostTime / 2); });
  EXPECT_THAT(refused({"shadow", late}), HasSubstr("expected at most as many lost cycles"));
  const std::string lost = spoiled("lost.encrec", reader.texts(), [](RecordedTick& f) {
    if (f.tick.index >= 400) f.tick.index += kMostTicks / 2;
  });
  EXPECT_THAT(refused({"shadow", lost}), HasSubstr("expected at most as many lost cycles"));
}

// The program checks the mesh in a record like one from a file.
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
    std::string& resolved = texts.at("resolved");  // anybody can write its hash, too
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
  fs::remove_all(path("models"));  // the record needs no other file
  const Result replay = run_program({"replay", path("run.encrec")});
  EXPECT_EQ(replay.code, 0) << replay.err;
  EXPECT_EQ(replay.out, "501 ticks run again, equal to the bit; state hash " +
                            Json::parse(run.out).at("state_hash").get<std::string>() + "\n");
}

}  // namespace
}  // namespace enc::tests
