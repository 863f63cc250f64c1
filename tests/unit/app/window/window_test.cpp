// The window without a screen: every key and mouse action on its help page, its link to the run, its
// timeline.
#include <cmath>
#include <set>

#include <gtest/gtest.h>

#include "app/window/controls.h"
#include "app/window/history/history.h"
#include "app/window/link.h"

namespace enc::app {
namespace {

using sim::Key, sim::WindowEvent;

class WindowControls : public testing::Test {
 protected:
  // The camera looks along +x of W from 1 m away: y of W is left in the picture, z is up.
  WindowControls() {
    camera_.azimuth = 0.0;
    camera_.elevation = 0.0;
    camera_.distance = 1.0;
    controls_.emplace(camera_);
    around_.width = 1000;
    around_.height = 500;
    around_.tip = {0, 0, 0};
    around_.steerable = true;
    around_.above = [](double x, double) {
      return x < 500 ? std::optional(Point<'W'>(0.1, 0.2, 0.3)) : std::nullopt;
    };
  }
  void key(std::int32_t code, bool shift = false) {
    controls_->see({.kind = WindowEvent::Kind::key, .code = code, .down = true, .shift = shift}, around_);
    controls_->see({.kind = WindowEvent::Kind::key, .code = code, .down = false, .shift = shift}, around_);
  }
  void key(Key code, bool shift = false) { key(static_cast<std::int32_t>(code), shift); }
  void button(std::int32_t code, bool down, double x, double y) {
    controls_->see({.kind = WindowEvent::Kind::button, .code = code, .down = down, .x = x, .y = y}, around_);
  }
  void move(double x, double y, bool shift = false) {
    controls_->see({.kind = WindowEvent::Kind::move, .shift = shift, .x = x, .y = y}, around_);
  }
  void wheel(double clicks, bool shift = false) {
    controls_->see({.kind = WindowEvent::Kind::wheel, .shift = shift, .wheel = clicks}, around_);
  }
  Vec3 hand() { return controls_->take_wishes().hand.value_or(Point<'W'>()).e(); }
  // Size of a pixel at the hand, 1 m away, in m.
  [[nodiscard]] double pixel() const { return 2.0 * std::tan(0.5 * camera_.opening) / 500.0; }

  sim::Camera camera_;
  std::optional<Controls> controls_;
  Surroundings around_;
};

TEST_F(WindowControls, ALeftDragMovesTheToolAsFarAsTheMouse) {
  EXPECT_FALSE(controls_->take_wishes().hand) << "the scene's own hand moves until somebody takes it";
  button(WindowEvent::kLeft, true, 500, 250);
  move(510, 240);
  EXPECT_NEAR((hand() - Vec3(0, -10 * pixel(), 10 * pixel())).norm(), 0.0, 1e-12);
  move(510, 230, true);  // ten times finer
  EXPECT_NEAR((hand() - Vec3(0, -10 * pixel(), 11 * pixel())).norm(), 0.0, 1e-12);
  wheel(1);  // away
  EXPECT_NEAR(hand().x(), 0.002, 1e-12);
  button(WindowEvent::kLeft, false, 510, 230);
  const Vec3 let_go = hand();
  move(700, 100);
  EXPECT_EQ(hand(), let_go);
}

TEST_F(WindowControls, AClickPutsTheToolAboveWhatIsThere) {
  button(WindowEvent::kLeft, true, 100, 100);
  button(WindowEvent::kLeft, false, 101, 100);
  EXPECT_EQ(hand(), Vec3(0.1, 0.2, 0.3));
  button(WindowEvent::kLeft, true, 900, 100);  // the background
  button(WindowEvent::kLeft, false, 900, 100);
  EXPECT_EQ(hand(), Vec3(0.1, 0.2, 0.3));
}

TEST_F(WindowControls, AGrabbedToolFollowsTheMouseUntilG) {
  move(500, 250);
  key('G');
  EXPECT_TRUE(controls_->grabbed());
  move(500, 240);
  EXPECT_NEAR(hand().z(), 10 * pixel(), 1e-12);
  wheel(-2, true);
  EXPECT_NEAR(hand().x(), -0.0004, 1e-12);
  key('G');
  move(500, 100);
  EXPECT_NEAR(hand().z(), 10 * pixel(), 1e-12);
}

TEST_F(WindowControls, ArrowsAndPagesMoveTheTool) {
  key(Key::up);
  EXPECT_NEAR(hand().z(), 0.002, 1e-12);
  key(Key::down);
  EXPECT_NEAR(hand().z(), 0.0, 1e-12);
  key(Key::left);
  EXPECT_NEAR(hand().y(), 0.002, 1e-12);
  key(Key::right, true);
  EXPECT_NEAR(hand().y(), 0.0018, 1e-12);
  key(Key::page_up);
  EXPECT_NEAR(hand().x(), 0.002, 1e-12);
  key(Key::page_down);
  EXPECT_NEAR(hand().x(), 0.0, 1e-12);
}

TEST_F(WindowControls, AGamepadMovesTheToolAsFastAsItsStickIsPushed) {
  const auto stick = [&](double right, double up, double away, bool finer) {
    controls_->see({.kind = WindowEvent::Kind::stick,
                    .shift = finer,
                    .right = right,
                    .up = up,
                    .away = away,
                    .since = 0.02},
                   around_);
  };
  stick(0, 0.5, 0, false);
  EXPECT_NEAR(hand().z(), 0.001, 1e-12);
  stick(-1, 0, 1, true);
  EXPECT_NEAR((hand() - Vec3(0.0002, 0.0002, 0.001)).norm(), 0.0, 1e-12);
}

TEST_F(WindowControls, NothingIsSteeredWhereNoHandIs) {
  around_.steerable = false;
  key(Key::up);
  key('G');
  button(WindowEvent::kLeft, true, 100, 100);
  button(WindowEvent::kLeft, false, 100, 100);
  move(300, 300);
  EXPECT_FALSE(controls_->take_wishes().hand);
  EXPECT_FALSE(controls_->grabbed());
}

TEST_F(WindowControls, TheOtherButtonsTurnAndShiftTheView) {
  move(0, 0);
  button(WindowEvent::kRight, true, 0, 0);
  move(100, 0);
  button(WindowEvent::kRight, false, 100, 0);
  EXPECT_NEAR(controls_->camera().azimuth, -0.6, 1e-12);
  move(0, 10'000);  // the camera stops at the top
  button(WindowEvent::kRight, true, 0, 10'000);
  move(0, -10'000);
  EXPECT_LE(std::abs(controls_->camera().elevation), 1.5);
  button(WindowEvent::kRight, false, 0, -10'000);
  key('V');
  key('V');  // home
  EXPECT_EQ(controls_->camera().azimuth, 0.0);
  button(WindowEvent::kMiddle, true, 0, -10'000);
  move(100, -10'000);
  EXPECT_NEAR(controls_->camera().look_at.xyz[1], 100 * pixel(), 1e-12);
  EXPECT_FALSE(controls_->take_wishes().hand);
}

TEST_F(WindowControls, TheWheelZoomsAndVFollowsTheTip) {
  wheel(1);
  EXPECT_NEAR(controls_->camera().distance, 0.9, 1e-12);
  for (int i = 0; i < 100; ++i) wheel(1);
  EXPECT_GT(controls_->camera().distance, 0.02);
  key('V');
  EXPECT_TRUE(controls_->follows());
  controls_->follow({1, 2, 3});
  EXPECT_EQ(controls_->camera().look_at.e(), Vec3(1, 2, 3));
  key('V');
  EXPECT_FALSE(controls_->follows());
}

TEST_F(WindowControls, TimeOfASimulatedRunIsTheUsers) {
  key(' ');
  EXPECT_TRUE(controls_->take_wishes().paused);
  key(' ');
  EXPECT_FALSE(controls_->take_wishes().paused);
  key('.');
  key('.');
  RunRequests wishes = controls_->take_wishes();
  EXPECT_TRUE(wishes.paused);
  EXPECT_EQ(wishes.ticks, 2);
  EXPECT_EQ(controls_->take_wishes().ticks, 0) << "asked for once";
  key('N');
  wishes = controls_->take_wishes();
  EXPECT_TRUE(wishes.to_event && !wishes.paused);
  controls_->paused_at_event();
  wishes = controls_->take_wishes();
  EXPECT_TRUE(!wishes.to_event && wishes.paused);
  key('[');
  EXPECT_EQ(controls_->take_wishes().speed, 0.5);
  for (int i = 0; i < 20; ++i) key('[');
  EXPECT_EQ(controls_->take_wishes().speed, 0.01);
  for (int i = 0; i < 20; ++i) key(']');
  EXPECT_EQ(controls_->take_wishes().speed, 1.0);
  key(Key::backspace);
  EXPECT_TRUE(controls_->take_wishes().restarts);
  EXPECT_FALSE(controls_->take_wishes().restarts);
  around_.recording = true;
  key(Key::backspace);
  EXPECT_FALSE(controls_->take_wishes().restarts) << "it would replace the record";
}

// Space stops a real machine instead of pausing time.
TEST_F(WindowControls, ARealMachineIsStoppedAndResumed) {
  around_.real = true;
  key(' ');
  RunRequests wishes = controls_->take_wishes();
  EXPECT_TRUE(wishes.stops && !wishes.paused && !wishes.resumes);
  key('R');
  wishes = controls_->take_wishes();
  EXPECT_TRUE(wishes.resumes && !wishes.stops);
  for (const char c : {'.', 'N', '[', ']'}) key(c);
  key(Key::backspace);
  wishes = controls_->take_wishes();
  EXPECT_TRUE(!wishes.paused && !wishes.to_event && wishes.speed == 1.0 && wishes.ticks == 0 &&
              !wishes.restarts);
}

// A key, or the mouse on the bar at the bottom, goes back in time. Space returns to the present.
TEST_F(WindowControls, EarlierMomentsOfARun) {
  key(',');
  key(',');
  RunRequests wishes = controls_->take_wishes();
  EXPECT_TRUE(wishes.paused);
  EXPECT_EQ(wishes.stills, -2);
  EXPECT_EQ(controls_->take_wishes().stills, 0) << "asked for once";
  around_.past = true;
  key('.');
  wishes = controls_->take_wishes();
  EXPECT_EQ(wishes.stills, 1);
  EXPECT_EQ(wishes.ticks, 0);
  key(' ');
  wishes = controls_->take_wishes();
  EXPECT_TRUE(wishes.newest && !wishes.paused);
  around_.past = false;
  button(WindowEvent::kLeft, true, 500, 495);
  wishes = controls_->take_wishes();
  EXPECT_NEAR(*wishes.seek, 0.5, 1e-9);
  EXPECT_TRUE(wishes.paused);
  move(745, 100);  // the drag goes on above the bar
  wishes = controls_->take_wishes();
  EXPECT_NEAR(*wishes.seek, 0.75, 1e-9);
  button(WindowEvent::kLeft, false, 100, 100);
  wishes = controls_->take_wishes();
  EXPECT_FALSE(wishes.hand) << "that is no click on the ball";
  EXPECT_FALSE(wishes.seek);
  move(300, 495);
  EXPECT_FALSE(controls_->take_wishes().seek);
  around_.real = true;
  key(' ');
  (void)controls_->take_wishes();
  key(',');
  button(WindowEvent::kLeft, true, 500, 495);
  wishes = controls_->take_wishes();
  EXPECT_EQ(wishes.stills, -1);
  EXPECT_TRUE(wishes.seek && !wishes.stops && !wishes.resumes) << "looking back does not touch the machine";
}

TEST_F(WindowControls, EnterAndTheStopOfAMachineReturnToThePresent) {
  key(Key::enter);
  EXPECT_TRUE(controls_->take_wishes().newest);
  EXPECT_FALSE(controls_->take_wishes().newest);
  around_.real = true;
  for (const char c : {' ', 'R'}) {
    key(c);
    EXPECT_TRUE(controls_->take_wishes().newest);
  }
}

TEST_F(WindowControls, ARecordIsPlayed) {
  around_.played = true;
  around_.steerable = false;
  key('.');
  RunRequests wishes = controls_->take_wishes();
  EXPECT_TRUE(wishes.paused && wishes.stills == 1 && wishes.ticks == 0);
  key(' ');
  wishes = controls_->take_wishes();
  EXPECT_TRUE(!wishes.paused && !wishes.newest);
  key('N');
  EXPECT_TRUE(controls_->take_wishes().to_event);
  controls_->paused_at_event();
  key(Key::backspace);
  wishes = controls_->take_wishes();
  EXPECT_TRUE(!wishes.restarts && wishes.seek && *wishes.seek == 0.0);
  key('1');
  key('T');
  wishes = controls_->take_wishes();
  EXPECT_TRUE(wishes.faults == 0 && !wishes.changes_tool);
}

TEST_F(WindowControls, ToolObjectAndFaults) {
  around_.over = [](int object) { return std::optional(Point<'W'>(object, 0, 0)); };
  key('T');
  EXPECT_TRUE(controls_->take_wishes().changes_tool);
  EXPECT_FALSE(controls_->take_wishes().changes_tool) << "asked for once";
  key('O');
  EXPECT_EQ(hand(), Vec3(0, 0, 0));
  key('O');
  EXPECT_EQ(hand(), Vec3(1, 0, 0));
  for (const char c : {'1', '2', '3', '4'}) key(c);
  EXPECT_EQ(controls_->take_wishes().faults, 15);
  key('2');
  EXPECT_EQ(controls_->take_wishes().faults, 13);
}

TEST_F(WindowControls, ChartsHelpAndEnd) {
  using Insets = Controls::Insets;
  EXPECT_EQ(controls_->insets(false), Insets::none);
  EXPECT_EQ(controls_->insets(true), Insets::pair);
  key('P');
  EXPECT_EQ(controls_->insets(false), Insets::contact);
  EXPECT_EQ(controls_->insets(true), Insets::augmented);
  key('P');
  EXPECT_EQ(controls_->insets(false), Insets::sides);
  key('P');
  EXPECT_EQ(controls_->insets(false), Insets::none);
  EXPECT_TRUE(controls_->charts());
  key('C');
  EXPECT_FALSE(controls_->charts());
  key('H');
  EXPECT_TRUE(controls_->help());
  key(Key::f1);
  EXPECT_FALSE(controls_->help());
  key('Q');
  EXPECT_TRUE(controls_->take_wishes().ends);
  Controls other(camera_);
  other.see({.kind = WindowEvent::Kind::key, .code = 256, .down = true}, around_);
  EXPECT_TRUE(other.take_wishes().ends) << "escape";
}

// MuJoCo writes at most 500 characters at once, so the page is written in two halves.
TEST_F(WindowControls, TheHelpPageFits) {
  for (const Controls::RunKind of :
       {Controls::RunKind::simulated, Controls::RunKind::real, Controls::RunKind::record}) {
    const auto lines = Controls::help_lines(of);
    std::size_t first = 0, second = 0;
    for (std::size_t i = 0; i < lines.size(); ++i)
      (i < (lines.size() + 1) / 2 ? first : second) += lines[i].what.size() + 1;
    EXPECT_LT(first, 500U);
    EXPECT_LT(second, 500U);
  }
}

// A new key on the page also needs a test above and an entry in this list.
TEST_F(WindowControls, TheHelpPageNamesWhatIsTestedHere) {
  const std::set<std::string_view> tested{
      "left drag", "click", "G", "wheel", "arrows, page", "right, middle drag", "V",     "C",       "H", "Q",
      "space",     ".",     "N", "[ ]",   "backspace",    "space, R",           ", bar", ", . bar", "T", "O",
      "1 2",       "3 4",   "P", "enter"};
  for (const Controls::RunKind of :
       {Controls::RunKind::simulated, Controls::RunKind::real, Controls::RunKind::record})
    for (const Controls::Help& line : Controls::help_lines(of))
      EXPECT_TRUE(tested.contains(line.key)) << line.key;
}

// The run's side of a window: a change of mode that the run waits for stops time, whatever the user wishes.

constexpr double kTick = 1e-3;  // s

class WindowLink : public testing::Test {
 protected:
  // Return true if the run advances by a tick within 20 calls.
  bool goes_on() {
    for (int i = 0; i < 20; ++i)
      if (!link_.waits(kTick)) return true;
    return false;
  }
  void tick(Mode mode) {
    out_.mode = mode;
    link_.see({scene_, now_, truth_, in_, out_});
  }
  Link link_;
  Scene scene_;
  Tick now_;
  sim::Truth truth_;
  Inputs in_;
  Outputs out_;
};

TEST_F(WindowLink, PausesAndGoesTickByTick) {
  EXPECT_TRUE(goes_on());
  link_.wish({.paused = true});
  EXPECT_FALSE(goes_on());
  link_.wish({.paused = true, .ticks = 2});
  EXPECT_TRUE(goes_on());
  EXPECT_TRUE(goes_on());
  EXPECT_FALSE(goes_on());
  link_.wish({});
  EXPECT_TRUE(goes_on());
}

TEST_F(WindowLink, StandsAtTheEventUntilTheWindowKnows) {
  link_.wish({.to_event = true});
  tick(Mode::away);
  EXPECT_TRUE(goes_on());
  tick(Mode::follow);
  EXPECT_FALSE(goes_on());
  link_.wish({.to_event = true});  // a picture that was begun earlier
  EXPECT_FALSE(goes_on());
  EXPECT_TRUE(link_.take_event());
  EXPECT_FALSE(link_.take_event());
  EXPECT_FALSE(goes_on()) << "paused, until the window says otherwise";
  link_.wish({});
  EXPECT_TRUE(goes_on());
}

TEST_F(WindowLink, ARunOnTheWallClockNeverWaits) {
  link_.let_go();
  EXPECT_TRUE(link_.begin(true));
  link_.wish({.paused = true, .speed = 0.01});
  for (int i = 0; i < 100; ++i) EXPECT_FALSE(link_.waits(kTick));
}

TEST_F(WindowLink, ThePlaceOfTheHandIsNewsOnce) {
  EXPECT_FALSE(link_.hand());
  link_.wish({.hand = Point<'W'>(1, 2, 3)});
  link_.wish({.hand = Point<'W'>(1, 2, 3)});
  EXPECT_EQ(link_.hand()->place->xyz, (std::array{1.0, 2.0, 3.0}));
  EXPECT_FALSE(link_.hand());
}

// The window requests a change of tool once, also if the run missed the first wish. Faults come last.
TEST_F(WindowLink, ToolAndFaultsReachTheRun) {
  link_.wish({.changes_tool = true, .faults = 2});
  link_.wish({.faults = 2});
  const auto word = link_.hand();
  ASSERT_TRUE(word);
  EXPECT_TRUE(word->changes_tool && word->faults == 2 && !word->place);
  EXPECT_FALSE(link_.hand());
  link_.wish({});
  EXPECT_EQ(link_.hand()->faults, 0);
}

TEST_F(WindowLink, AStopComesBeforeAResume) {
  link_.wish({.stops = true, .resumes = true});
  EXPECT_EQ(link_.machine(), trial::Hand::halt);
  link_.wish({.resumes = true});
  link_.wish({.stops = true});
  EXPECT_EQ(link_.machine(), trial::Hand::halt);
  link_.wish({.stops = true});
  link_.wish({.resumes = true});
  EXPECT_EQ(link_.machine(), trial::Hand::halt) << "not taken yet";
  EXPECT_EQ(link_.machine(), trial::Hand::none);
}

TEST_F(WindowLink, ARunWithoutItsWindowIsRefused) {
  link_.refuse();
  EXPECT_FALSE(link_.begin(false));
}

// Earlier moments of a run: the window keeps a limited number and shows them until the user returns to the
// present.

class WindowTimeline : public testing::Test {
 protected:
  void add(int count, Mode mode = Mode::follow) {
    for (int i = 0; i < count; ++i) {
      RunSnapshot still;
      still.now.t = Time{} + from_seconds(0.01 * added_++);
      still.out.mode = mode;
      timeline_.add(still);
    }
  }
  [[nodiscard]] int shown() const {
    return static_cast<int>(std::lround(100.0 * seconds_of(timeline_.shown())));
  }
  Timeline timeline_{100};
  int added_ = 0;
};

TEST_F(WindowTimeline, ShowsTheNewestUntilSomebodyLooksBack) {
  add(50);
  EXPECT_EQ(shown(), 49);
  EXPECT_FALSE(timeline_.past());
  timeline_.step(-10);
  EXPECT_TRUE(timeline_.past());
  add(30);
  EXPECT_EQ(shown(), 39) << "what is looked at stays";
  timeline_.seek(1.0);
  add(1);
  EXPECT_EQ(shown(), 80) << "from the present on it goes on";
}

TEST_F(WindowTimeline, TheOldestGoFirst) {
  add(250);
  timeline_.seek(0.0);
  EXPECT_EQ(shown(), 150);
  add(20);
  EXPECT_EQ(shown(), 170) << "the one that was looked at is gone";
  timeline_.step(-5);
  EXPECT_EQ(shown(), 170);
  timeline_.step(1000);
  EXPECT_EQ(shown(), 269);
}

TEST_F(WindowTimeline, PlaysInTime) {
  add(100);
  timeline_.seek(0.0);
  for (int i = 0; i < 30; ++i) timeline_.go_on(0.0034);
  EXPECT_EQ(shown(), 10);
  timeline_.go_on(5.0);
  EXPECT_EQ(shown(), 99);
  EXPECT_FALSE(timeline_.past());
}

TEST_F(WindowTimeline, StopsAtAChangeOfMode) {
  add(20);
  add(30, Mode::contact);
  add(20);
  timeline_.seek(0.0);
  timeline_.to_change();
  EXPECT_EQ(shown(), 20);
  timeline_.to_change();
  EXPECT_EQ(shown(), 50);
  timeline_.to_change();
  EXPECT_EQ(shown(), 69);
}

TEST_F(WindowTimeline, TheBarMarksContacts) {
  EXPECT_FALSE(timeline_.bar().shown);
  add(20);
  add(30, Mode::contact);
  add(51);
  const sim::ViewBar bar = timeline_.bar();
  EXPECT_TRUE(bar.shown);
  EXPECT_FLOAT_EQ(bar.at, 1.0F);
  ASSERT_EQ(bar.marks.size(), 1U);
  EXPECT_NEAR(bar.marks[0].from, 19.0 / 99.0, 1e-6);  // the first of 101 is gone
  EXPECT_NEAR(bar.marks[0].to, 49.0 / 99.0, 1e-6);
}

}  // namespace
}  // namespace enc::app
