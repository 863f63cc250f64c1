// The window on a virtual screen, with real mouse and key events.
#include <string>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "tests/conformance/laboratory.h"
#include "tests/support/built.h"
#include "tests/support/files.h"
#include "tests/support/run_program.h"
#include "tests/terminal/run_record.h"

namespace enc::test {
namespace {

using testing::ContainsRegex;
using testing::HasSubstr;

class Window : public testing::Test {
 protected:
  void SetUp() override {
    if (!tests::is_built("window")) GTEST_SKIP() << "built without the window";
    if (tests::run({"bash", "-c", "command -v Xvfb && command -v xdotool"}).code != 0)
      GTEST_SKIP() << "neither Xvfb nor xdotool is installed";
  }
  // Starts a screen and `view` with these words, then runs the script; $V is the process of `view`, $X that
  // of the screen. The result has the output and the exit code of `view`.
  tests::Result on_screen(const std::string& words, const std::string& script,
                          const std::string& before = "") const {
    const std::string text =
        "cd \"" + folder_.path().string() + "\"\n" + before +
        "Xvfb -displayfd 3 -screen 0 1280x800x24 -nolisten tcp 3> number > /dev/null 2>&1 &\n"
        "X=$!\n"
        "for i in $(seq 100); do [ -s number ] && break; sleep 0.1; done\n"
        "export DISPLAY=:$(cat number)\n"
        "\"" +
        tests::program_file() + "\" view " + words +
        " > out 2> err &\n"
        "V=$!\n"
        "trap 'kill $X $V 2> /dev/null' EXIT\n"
        "timeout 60 xdotool search --sync --onlyvisible --name Encounter > /dev/null\n"
        "sleep 1\n" +
        script + "\nwait $V\ncode=$?\ncat out\ncat err >&2\nexit $code\n";
    return tests::run({"bash", "-c", text}, {{"LP_NUM_THREADS", "1"}}, 240.0);
  }
  [[nodiscard]] std::string file(const std::string& name) const { return folder_.file(name); }
  static std::string hash_of(const std::string& text) {
    const auto at = text.find("state hash");
    return at == std::string::npos ? "" : text.substr(at, 28);
  }

  const TemporaryFolder folder_;
  const std::string ball_ = tests::source_dir() + "/models/scenes/tennis_ball.toml";
};

// A click on the ball puts the tool above it, a drag presses it. The record replays, and `run --hand` plays
// this hand without a window with equal bits.
TEST_F(Window, TheMousePressesTheBallAndTheRecordReplays) {
  const tests::Result r =
      on_screen("\"" + ball_ + "\" --record r.encrec",
                "xdotool mousemove 640 270 click 1; sleep 3\n"
                "xdotool mousemove 640 200 mousedown 1\n"
                "for i in $(seq 45); do xdotool mousemove_relative -- 0 1; sleep 0.06; done\n"
                "sleep 3\n"
                "for i in $(seq 25); do xdotool mousemove_relative -- 0 -3; sleep 0.1; done\n"
                "xdotool mouseup 1; sleep 2; xdotool key q");
  ASSERT_THAT(r.code, testing::AnyOf(0, 1)) << r.err << r.out;
  EXPECT_THAT(r.out, ContainsRegex("modes .*[1-9] contact"));
  EXPECT_THAT(r.out, ContainsRegex("force +peak ([2-9]|1[0-9])\\."));
  const tests::Result replayed = tests::run_program({"replay", file("r.encrec")});
  EXPECT_EQ(replayed.code, 0) << replayed.err;
  EXPECT_THAT(replayed.out, HasSubstr("equal to the bit"));
  const tests::Result again = tests::run_program({"run", ball_, "--hand", file("r.encrec")});
  EXPECT_EQ(hash_of(again.out), hash_of(r.out));
  EXPECT_NE(hash_of(r.out), "");
}

// Keys press to the ball's limit, drag along its surface, release, change the tool and press again; a fault
// holds the machine and goes. The recorded hand plays again without a window. The record opens in the window,
// too.
TEST_F(Window, PressesDragsChangesTheToolAndPressesAgain) {
  const std::string scene = tests::source_dir() + "/models/scenes/session.toml";
  const std::string press =
      "xdotool key o; sleep 3; for i in $(seq 12); do xdotool key Down; sleep 0.15; done\n";
  const tests::Result r =
      on_screen("\"" + scene + "\" --record s.encrec",
                press +
                    "sleep 2; for i in $(seq 12); do xdotool key Left; sleep 0.1; done; sleep 1\n"
                    "for i in $(seq 20); do xdotool key Up; sleep 0.05; done; sleep 1\n"
                    "xdotool key t; sleep 5\n" +
                    press + "sleep 1; xdotool key 1; sleep 2; xdotool key 1; sleep 1; xdotool key q");
  EXPECT_THAT(r.out, ContainsRegex("hold [0-9.]+ s")) << r.err;
  EXPECT_THAT(r.out, ContainsRegex("deflection peak (5\\.[89]|6\\.)"));
  EXPECT_EQ(tests::run_program({"replay", file("s.encrec")}).code, 0);
  const tests::Result again = tests::run_program({"run", scene, "--hand", file("s.encrec")});
  EXPECT_EQ(hash_of(again.out), hash_of(r.out)) << r.out << again.out;
  EXPECT_NE(hash_of(r.out), "");
  const tests::Result seen = on_screen("s.encrec",
                                       "xdotool key n; sleep 1; xdotool mousemove 640 707 click 1; sleep 1\n"
                                       "xdotool key comma period BackSpace space; sleep 1; xdotool key q");
  EXPECT_EQ(seen.code, 0) << seen.err;
  EXPECT_EQ(seen.out + seen.err, "");
}

// A scene saved during the display starts anew; a mistake in it does not end the program.
TEST_F(Window, ASavedSceneIsLoadedAgain) {
  const tests::Result r = on_screen(
      "own.toml",
      "sed -i 's/^radius_mm = 33/radius_mm = wrong/' own.toml; sleep 2\n"
      "kill -0 $V && sed -i 's/^radius_mm = wrong/radius_mm = 30/' own.toml; sleep 3; xdotool key q",
      "cp \"" + ball_ + "\" own.toml\n");
  EXPECT_EQ(r.code, 0) << r.err;
  EXPECT_THAT(r.out, ContainsRegex("state hash(.|\n)*state hash")) << "two reports";
}

TEST_F(Window, PausesGoesOnAndBeginsAnew) {
  const tests::Result r =
      on_screen("\"" + ball_ + "\"",
                "xdotool key space; sleep 5; xdotool key period; sleep 0.5\n"
                "xdotool key space; sleep 1; xdotool key BackSpace; sleep 2; xdotool key q");
  ASSERT_EQ(r.code, 0) << r.err << r.out;
  // The program ran for two spans of time, with a report each; the pause is in neither.
  EXPECT_THAT(r.out,
              ContainsRegex("time +[0-5]\\.[0-9]+ s simulated(.|\n)*time +[0-5]\\.[0-9]+ s simulated"));
}

TEST_F(Window, ASignalAndALostDisplayAreCleanEnds) {
  const tests::Result term = on_screen("\"" + ball_ + "\" --record a.encrec", "kill -TERM $V");
  EXPECT_EQ(term.code, 143) << term.err;
  EXPECT_EQ(tests::run_program({"replay", file("a.encrec")}).code, 0);
  const tests::Result lost = on_screen("\"" + ball_ + "\" --record b.encrec", "kill $X");
  EXPECT_EQ(lost.code, 3) << lost.out;
  EXPECT_THAT(lost.err, HasSubstr("the display is lost"));
  EXPECT_EQ(tests::run_program({"replay", file("b.encrec")}).code, 0) << "the record is sealed";
}

// Fakes on their real wires: space stops the machine, R resumes, Q ends. Looking back does neither.
TEST_F(Window, SpaceStopsAnArmedMachineAndRResumes) {
  Laboratory there(false, {}, {}, ball_);
  std::string words = "\"" + ball_ + "\" --rig fakes --armed --yes --record m.encrec";
  for (const std::string& set : there.ports) words += " --set " + set;
  const tests::Result r = on_screen(words,
                                    "sleep 2; xdotool key comma comma period; sleep 1\n"
                                    "xdotool key space; sleep 1; xdotool key comma comma comma; sleep 1\n"
                                    "xdotool key r; sleep 2; xdotool key q");
  EXPECT_THAT(r.err, ContainsRegex("stopped by hand(.|\n)*resumed")) << r.out;
  EXPECT_THAT(r.out, HasSubstr("stopped     by a signal or by q")) << r.err;
  EXPECT_GE(stops_in(there.log()).size(), 2U) << "by space, and at the end";
  EXPECT_EQ(tests::run_program({"replay", file("m.encrec")}).code, 0);
  const tests::Result seen = on_screen("m.encrec", "xdotool key n; sleep 1; xdotool key q");
  EXPECT_EQ(seen.code, 0) << seen.err;
}

// The program prints one line, returns exit code 3, and begins no run.
TEST_F(Window, WithoutADisplayItSaysSo) {
  const tests::Result r =
      tests::run_program({"view", ball_, "--record", file("c.encrec")}, {{"DISPLAY", ""}});
  EXPECT_EQ(r.code, 3) << r.out;
  EXPECT_THAT(r.err, HasSubstr("--shot"));
  EXPECT_EQ(std::count(r.err.begin(), r.err.end(), '\n'), 1) << r.err;
}

}  // namespace
}  // namespace enc::test
