#include "app/window/controls.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>

namespace enc::app {
namespace {

using sim::Key;
using sim::WindowEvent;

constexpr double kFiner = 0.1;   // factor on each motion, with Shift
constexpr double kStep = 0.002;  // m, for a key or a click of the wheel
constexpr double kStick = 0.1;   // m/s, for a gamepad's stick at its end
constexpr double kTurn = 0.006;  // rad for each px
constexpr double kClick = 4.0;   // px: a press that moves less is a click
constexpr double kSlowest = 0.01, kFastest = 1.0;
constexpr double kNearest = 0.03, kFarthest = 5.0;  // m, range of the camera's distance

bool is(std::int32_t code, Key key) { return code == static_cast<std::int32_t>(key); }

}  // namespace

Mat3 Controls::axes() const {
  const double a = camera_.azimuth, e = camera_.elevation;
  const Vec3 away(std::cos(e) * std::cos(a), std::cos(e) * std::sin(a), std::sin(e));
  const Vec3 right(std::sin(a), -std::cos(a), 0.0);
  Mat3 axes;
  axes << right, right.cross(away), away;
  return axes;
}

double Controls::metres_per_pixel(const Point<'W'>& at, const Surroundings& around) const {
  const Vec3 away = axes().col(2);
  const double depth = std::max(0.01, camera_.distance + away.dot((at - camera_.look_at).e()));
  return 2.0 * depth * std::tan(0.5 * camera_.opening) / std::max(1.0, around.height);
}

void Controls::move_hand(const Vec3& by, const Surroundings& around) {
  if (!around.steerable || !around.tip.finite()) return;
  const Point<'W'> from = wishes_.hand.value_or(around.tip);
  wishes_.hand = from + Vec<'W'>(Vec3(axes() * by));
}

void Controls::see(const WindowEvent& event, const Surroundings& around) {
  switch (event.kind) {
    case WindowEvent::Kind::key:
      if (event.down) see_key(event, around);
      break;
    case WindowEvent::Kind::button:
      see_button(event, around);
      break;
    case WindowEvent::Kind::move:
      see_move(event, around);
      break;
    case WindowEvent::Kind::wheel:
      see_wheel(event, around);
      break;
    case WindowEvent::Kind::stick:
      move_hand(kStick * (event.shift ? kFiner : 1.0) * event.since * Vec3(event.right, event.up, event.away),
                around);
      break;
  }
}

// Seeks on the bar of time. A drag that began on the bar continues beyond it.
bool Controls::seek(const WindowEvent& event, const Surroundings& around) {
  const auto share = sim::bar_share(event.x, event.y, around.width, around.height, on_bar_);
  if (!share) return false;
  wishes_.seek = *share;
  if (!around.real && !around.played) wishes_.paused = true;
  return true;
}

void Controls::see_button(const WindowEvent& event, const Surroundings& around) {
  if (event.code == WindowEvent::kRight) right_ = event.down;
  if (event.code == WindowEvent::kMiddle) middle_ = event.down;
  if (event.code != WindowEvent::kLeft) return;
  const bool was_on_bar = on_bar_;
  on_bar_ = event.down && seek(event, around);
  left_ = event.down && !on_bar_;
  if (event.down) {
    dragged_ = false;
    pressed_x_ = x_ = event.x;
    pressed_y_ = y_ = event.y;
  } else if (!dragged_ && !was_on_bar && around.steerable && around.above) {
    if (const auto place = around.above(event.x, event.y)) wishes_.hand = *place;
  }
}

void Controls::see_move(const WindowEvent& event, const Surroundings& around) {
  const double dx = event.x - x_, dy = event.y - y_;
  x_ = event.x;
  y_ = event.y;
  dragged_ = dragged_ || std::hypot(x_ - pressed_x_, y_ - pressed_y_) > kClick;
  if (on_bar_) {
    (void)seek(event, around);
  } else if (right_) {
    camera_.azimuth -= kTurn * dx;
    camera_.elevation = std::clamp(camera_.elevation - kTurn * dy, -1.5, 1.5);
  } else if (middle_) {
    const double metres = metres_per_pixel(camera_.look_at, around);
    camera_.look_at = camera_.look_at + Vec<'W'>(Vec3(axes() * Vec3(-metres * dx, metres * dy, 0.0)));
    follows_ = false;
  } else if (grabbed_ || (left_ && dragged_)) {
    const double metres =
        metres_per_pixel(wishes_.hand.value_or(around.tip), around) * (event.shift ? kFiner : 1.0);
    move_hand(Vec3(metres * dx, -metres * dy, 0.0), around);
  }
}

void Controls::see_wheel(const WindowEvent& event, const Surroundings& around) {
  if (grabbed_ || left_)
    move_hand(Vec3(0, 0, event.wheel * kStep * (event.shift ? kFiner : 1.0)), around);
  else
    camera_.distance = std::clamp(camera_.distance * std::pow(0.9, event.wheel), kNearest, kFarthest);
}

void Controls::see_time_key(std::int32_t code, const Surroundings& around) {
  switch (code) {
    case ' ':
      wishes_.paused = !wishes_.paused;
      wishes_.to_event = false;
      wishes_.newest = !around.played && !wishes_.paused;
      break;
    case ',':
      wishes_.paused = true;
      --wishes_.stills;
      break;
    case '.':
      wishes_.paused = true;
      ++(around.past || around.played ? wishes_.stills : wishes_.ticks);
      break;
    case 'N':
      wishes_.paused = around.played;
      wishes_.newest = !around.played;
      wishes_.to_event = true;
      break;
    case '[':
      wishes_.speed = std::max(kSlowest, 0.5 * wishes_.speed);
      break;
    case ']':
      wishes_.speed = std::min(kFastest, 2.0 * wishes_.speed);
      break;
    default:
      if (!is(code, Key::backspace)) break;
      if (around.played)
        wishes_.seek = 0.0;
      else if (!around.recording)
        wishes_.restarts = true;
  }
}

// Handles the keys that move the hand, and those for the objects.
void Controls::see_hand_key(const WindowEvent& event, const Surroundings& around) {
  const std::int32_t code = event.code;
  const double step = kStep * (event.shift ? kFiner : 1.0);
  if (is(code, Key::left)) move_hand(Vec3(-step, 0, 0), around);
  if (is(code, Key::right)) move_hand(Vec3(step, 0, 0), around);
  if (is(code, Key::up)) move_hand(Vec3(0, step, 0), around);
  if (is(code, Key::down)) move_hand(Vec3(0, -step, 0), around);
  if (is(code, Key::page_up)) move_hand(Vec3(0, 0, step), around);
  if (is(code, Key::page_down)) move_hand(Vec3(0, 0, -step), around);
  if (!around.steerable) return;
  if (code == 'G') grabbed_ = !grabbed_;
  if (code == 'T') {
    if (!wishes_.hand) wishes_.hand = around.tip;
    wishes_.changes_tool = true;
  }
  if (code == 'O' && around.over)
    if (const auto place = around.over(++object_)) wishes_.hand = *place;
  if (code >= '1' && code <= '4') wishes_.faults ^= static_cast<std::uint8_t>(1U << (code - '1'));
}

void Controls::see_key(const WindowEvent& event, const Surroundings& around) {
  const std::int32_t code = event.code;
  if (is(code, Key::f1) || code == 'H') help_ = !help_;
  if (is(code, Key::escape) || code == 'Q') wishes_.ends = true;
  if (is(code, Key::enter) && !around.played) wishes_.newest = true;
  if (code == 'C') charts_ = !charts_;
  if (code == 'P') ++insets_;
  if (code == 'V') {
    follows_ = !follows_;
    camera_ = home_;
    if (follows_) camera_.distance = 0.3;
  }
  see_hand_key(event, around);
  if (!around.real) return see_time_key(code, around);
  if (code == ' ' || code == 'R') wishes_.newest = true;
  if (code == ' ') wishes_.stops = true;
  if (code == 'R') wishes_.resumes = true;
  if (code == ',') --wishes_.stills;
  if (code == '.') ++wishes_.stills;
}

Controls::Insets Controls::insets(bool camera) const {
  using enum Insets;
  constexpr std::array kPlain{none, contact, sides};
  constexpr std::array kCamera{pair, augmented, none, contact,
                               sides};  // a scene with a camera is about vision
  const auto at = static_cast<std::size_t>(insets_);
  return camera ? kCamera[at % kCamera.size()] : kPlain[at % kPlain.size()];
}

void Controls::follow(const Point<'W'>& tip) {
  if (follows_ && tip.finite()) camera_.look_at = tip;
}

RunRequests Controls::take_wishes() {
  const RunRequests now = wishes_;
  wishes_.ticks = wishes_.stills = 0;
  wishes_.restarts = wishes_.stops = wishes_.resumes = wishes_.changes_tool = wishes_.newest = false;
  wishes_.seek.reset();
  return now;
}

std::vector<Controls::Help> Controls::help_lines(RunKind of) {
  static constexpr std::array kHand{Help{"left drag", "move the tool; Shift: ten times finer"},
                                    Help{"click", "the tool goes above that place"},
                                    Help{"G", "grab: the tool follows the mouse, until G"},
                                    Help{"arrows, page", "move the tool; so do a gamepad's sticks"},
                                    Help{"T", "lay the tool down, take the other"},
                                    Help{"O", "above the next object"},
                                    Help{"1 2", "fault: tracker freezes, loses packets"},
                                    Help{"3 4", "fault: late clock, force sensor saturates"}};
  static constexpr std::array kView{Help{"wheel", "zoom; grabbed: tool away and near"},
                                    Help{"right, middle drag", "turn the view, shift it"},
                                    Help{"V", "follow the tip, or the whole machine"},
                                    Help{"P", "small pictures: contact, sides, the scene's cameras"},
                                    Help{"C", "charts; the cursor reads their values"}};
  static constexpr std::array kReal{Help{"space, R", "stop the machine, resume"},
                                    Help{", . bar", "look back; the machine goes on"},
                                    Help{"enter", "to the present"}};
  static constexpr std::array kSimulated{Help{"space", "pause, go on"},
                                         Help{".", "one tick"},
                                         Help{", bar", "back in time; . forward"},
                                         Help{"enter", "to the present"},
                                         Help{"N", "on to the next change of mode"},
                                         Help{"[ ]", "slower, faster"},
                                         Help{"backspace", "from the beginning"}};
  static constexpr std::array kRecord{Help{"space", "stop, play"}, Help{", . bar", "back and forward"},
                                      Help{"N", "on to the next change of mode"},
                                      Help{"[ ]", "slower, faster"}, Help{"backspace", "to the beginning"}};
  static constexpr std::array kEnd{Help{"H", "this page"}, Help{"Q", "end"}};
  std::vector<Help> lines;
  const auto add = [&](const auto& more) { lines.insert(lines.end(), more.begin(), more.end()); };
  if (of == RunKind::simulated) add(kHand);
  add(kView);
  if (of == RunKind::simulated) add(kSimulated);
  if (of == RunKind::real) add(kReal);
  if (of == RunKind::record) add(kRecord);
  add(kEnd);
  return lines;
}

}  // namespace enc::app
