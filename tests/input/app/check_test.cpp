// `encounter check`: what it says of every shipped scene, and the scene file that it prints.
#include <algorithm>
#include <fstream>
#include <string>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "app/built.h"
#include "models/setup/scene_file.h"
#include "tests/support/built.h"
#include "tests/support/run_program.h"
#include "tests/support/temporary_folder.h"

namespace enc::test {
namespace {

using testing::AllOf;
using testing::HasSubstr;
using testing::Not;
using tests::Result;
using tests::run_program;
using tests::shipped_scene;
const std::string kModels = tests::source_dir() + "/models";

Result checked(const std::vector<std::string>& words) {
  std::vector<std::string> command{"check"};
  command.insert(command.end(), words.begin(), words.end());
  // The libraries that draw keep some bytes at exit, which a leak checker would make ours.
  Result r = run_program(command, {{"ASAN_OPTIONS", "detect_leaks=0"}});
  EXPECT_EQ(r.code, 0) << r.err;
  return r;
}
std::string said(const std::vector<std::string>& words) {
  const Result r = checked(words);
  return r.out + r.err;
}

// Of what can be rendered stably it has a table of its own.
TEST(Check, AnswersInAtMost30LinesAndATable) {
  for (const std::string& name : models::files_in(kModels, "scenes")) {
    const std::string answer = said({shipped_scene(name)});
    const auto table = answer.find("\nstability\n");
    const std::string before = answer.substr(0, table);
    EXPECT_LE(std::count(before.begin(), before.end(), '\n'), 30) << name << "\n" << answer;
    EXPECT_LE(std::count(answer.begin(), answer.end(), '\n'), 44) << name << "\n" << answer;
    EXPECT_THAT(answer,
                AllOf(HasSubstr("\nbuilt       "), HasSubstr("\nleft out    "), HasSubstr("\nframes\n"),
                      HasSubstr("every chain closes to"), HasSubstr("\nlimits\n")));
  }
}

// What the scene does not have has no edge and no words.
TEST(Check, NamesNoPartThatIsNotThere) {
  for (const std::string& name : models::files_in(kModels, "scenes")) {
    const SceneSpec s = models::load(shipped_scene(name), "").scene;
    const std::string answer = said({shipped_scene(name)});
    const std::string told = answer.substr(answer.find("\nframes\n"));
    const auto only_with = [&](bool part, const char* words) {
      EXPECT_EQ(told.find(words) != std::string::npos, part) << name << ": " << words << "\n" << told;
    };
    only_with(s.force.has_value(), "X_HF");
    only_with(s.tracker.has_value(), "X_WC");
    only_with(s.tracker.has_value(), "X_CT");
    only_with(s.tracker && !s.arm, "markers");
    only_with(s.display.has_value(), "headset");
    only_with(!s.objects.empty(), "X_WO");
    only_with(s.arm.has_value(), "law: ");
    only_with(s.manipulator && s.force, "softest spring that stands still");
    // The last line lists modules by name; one of them is called so.
    EXPECT_THAT(answer.substr(0, answer.find("\n  process")), Not(HasSubstr("window")));

    const app::SeenParts seen = app::seen_parts(s);
    EXPECT_EQ(!seen.prop.empty(), s.prop.has_value()) << name;
    EXPECT_EQ(!seen.gripper.empty(), s.gripper.has_value()) << name;
    EXPECT_EQ(!seen.force_sensor.empty(), s.force.has_value()) << name;
    EXPECT_EQ(!seen.tool.empty(), s.user.has_value() || s.gripper.has_value()) << name;
  }
}

// Many objects share lines; what somebody asks of one, and what is beyond the arm, has its own.
TEST(Check, SaysWhatIsAskedOfOneOfManyObjects) {
  EXPECT_THAT(
      said({shipped_scene("keypad")}),
      AllOf(HasSubstr("objects 'key_1', 'key_2' and 10 more: click, 0.5 N/mm"),
            HasSubstr("  object 'key_5': force at most 7.06 N"), HasSubstr("it can be held for hours"),
            HasSubstr("the weakest object: up to 7.06 N ('key_5')")));
}

// Whoever sets a number that nothing reads is told; one that is read says nothing.
TEST(Check, SaysWhatNothingReads) {
  const auto warned = [](const std::string& name, const std::string& set) {
    return checked({shipped_scene(name), "--set", set}).err;
  };
  EXPECT_THAT(warned("wall", "truth.camera.noise_of_255=3"),
              HasSubstr("warning: nothing in this scene reads [truth.camera]; leave it out"));
  EXPECT_THAT(warned("camera/wall", "truth.tracker.latency_ms=80"),
              HasSubstr("reads [truth.tracker], as its tracker is vision: see [truth.camera]; leave it out"));
  EXPECT_THAT(warned("wall", "truth.tracker.latency_ms=80"), Not(HasSubstr("warning")));
  EXPECT_THAT(warned("camera/wall", "truth.camera.noise_of_255=3"), Not(HasSubstr("warning")));
}

TEST(CheckResolved, PrintsASceneFileThatRunsWithTheSameHash) {
  const TemporaryFolder folder;
  const auto hash_of = [](const std::string& file, const std::vector<std::string>& more) {
    std::vector<std::string> command{"run", file, "--for-s", "3"};
    command.insert(command.end(), more.begin(), more.end());
    const Result r = run_program(command);
    EXPECT_EQ(r.code, 0) << r.err;
    const auto at = r.out.find("state hash");
    EXPECT_NE(at, std::string::npos) << r.out;
    return r.out.substr(at, r.out.find('\n', at) - at);
  };
  for (const char* name : {"tennis_ball", "hare", "keypad", "tracking", "rig_A", "stiffness"}) {
    const std::string path = folder.file(std::string(name) + "_alone.toml");
    const std::string text =
        checked({shipped_scene(name), "--resolved", "--set", "rig.tracker.lost_age_ms=350"}).out;
    std::ofstream(path) << text;
    EXPECT_EQ(hash_of(path, {}), hash_of(shipped_scene(name), {"--set", "rig.tracker.lost_age_ms=350"}))
        << name;
    // But for where it comes from, which is its first line.
    const auto scene_of = [](const std::string& file) { return file.substr(file.find('\n')); };
    EXPECT_THAT(text, testing::StartsWith("# Encounter "));
    EXPECT_THAT(text.substr(0, text.find('\n')), HasSubstr("--set 'rig.tracker.lost_age_ms=350'"));
    EXPECT_EQ(scene_of(said({path, "--resolved"})), scene_of(text)) << name;
    const auto untimed = [](const std::string& out) { return out.substr(0, out.find("\ncosts ")); };
    EXPECT_EQ(untimed(checked({path}).out),
              untimed(checked({shipped_scene(name), "--set", "rig.tracker.lost_age_ms=350"}).out))
        << name;
  }
}

TEST(CheckResolved, RefusesWhatIsWrongInIt) {
  const TemporaryFolder folder;
  const std::string path = folder.file("alone.toml");
  std::string text = said({shipped_scene("wall"), "--resolved"});
  text.replace(text.find("filter_hz = 60"), 14, "filter_hz = -6");
  std::ofstream(path) << text;
  const Result r = run_program({"check", path});
  EXPECT_EQ(r.code, 2);
  const auto line =
      1 + std::count(text.begin(), text.begin() + static_cast<std::ptrdiff_t>(text.find("filter_hz")), '\n');
  EXPECT_THAT(r.err, AllOf(HasSubstr(path + ":" + std::to_string(line) + ":"),
                           HasSubstr("'filter_hz' is -6; expected a positive number in Hz")));
}

TEST(Check, AdviceAsksForAnErrorAndAHand) {
  const auto refused = [](const std::string& name, const std::vector<std::string>& words) {
    std::vector<std::string> command{"check", shipped_scene(name), "--advise"};
    command.insert(command.end(), words.begin(), words.end());
    const Result r = run_program(command);
    EXPECT_EQ(r.code, 2) << r.err;
    return r.err;
  };
  EXPECT_THAT(refused("plane", {}), HasSubstr("such as --advise --error-N 0.05"));
  for (const char* error : {"0", "-1", "nan", "inf"})
    EXPECT_THAT(refused("plane", {"--error-N", error}), HasSubstr("expected a force in N above 0")) << error;
  EXPECT_THAT(refused("plane", {"--error-N", "0.05", "--error-um", "0"}),
              HasSubstr("expected a length in um above 0"));
  EXPECT_THAT(refused("tracking", {"--error-N", "0.05"}), HasSubstr("no hand touches anything"));
  EXPECT_THAT(refused("plane", {"--error-N", "0.05", "--set", "truth.world.timestep_us=300"}),
              HasSubstr("does not divide the haptic period"));
}

// What is there at run time is asked of the kernel and of the physics, in a short run.
TEST(CheckCosts, SaysWhatASceneIsMadeOf) {
  const std::string plane = said({shipped_scene("plane")});
  EXPECT_THAT(plane, AllOf(HasSubstr("costs       ready after "), HasSubstr(" x real time"),
                           HasSubstr("MuJoCo elements: "), HasSubstr("  process   1 thread, "),
                           HasSubstr("modules none; not loaded "), Not(HasSubstr("not looked for"))));
#if !defined(__SANITIZE_ADDRESS__)
  EXPECT_THAT(plane, HasSubstr("OpenGL not loaded"));
#endif
  EXPECT_THAT(said({shipped_scene("tracking")}), HasSubstr("not looked for: contacts, constraints"));
  EXPECT_THAT(said({shipped_scene("wall")}), HasSubstr("not looked for: islands"));
  EXPECT_THAT(said({shipped_scene("rig_A"), "--set", "rig.force.driver=sample"}),
              HasSubstr("costs       not measured: not all devices of this rig are simulated"));
}

TEST(CheckAdvise, IsNoPartOfTheResolvedScene) {
  const Result r =
      run_program({"check", shipped_scene("plane"), "--resolved", "--advise", "--error-N", "0.05"});
  EXPECT_EQ(r.code, 2);
  EXPECT_THAT(r.err, HasSubstr("--resolved"));
}

}  // namespace
}  // namespace enc::test
