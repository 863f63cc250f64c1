// The meaning of mouse and keys in the window: camera, wanted place of the hand, time. Controls knows neither
// window nor run, so tests can press every key.
#pragma once

#include <functional>
#include <optional>
#include <string_view>
#include <vector>

#include "sim/window/window.h"

namespace enc::app {

// Requests to the run. Pausing, stepping and speed apply to simulated runs only.
struct Wishes {
  std::optional<Point<'W'>> hand{};  // wanted place of the tool's tip; unset: the scene's own hand moves
  bool paused = false;
  double speed = 1.0;     // experiment time per wall time
  int ticks = 0;          // single ticks to run while paused
  bool to_event = false;  // runs to the next change of mode, then pauses
  bool ends = false, restarts = false;
  bool stops = false, resumes = false;  // the machine
};

struct Surroundings {
  double width = 1.0, height = 1.0;  // px, size of the window
  Point<'W'> tip;                    // tip of the tool; NaN: no tool
  bool steerable = false;            // the twin's hand holds a tool
  bool recording = false;            // a restart would replace the record
  bool real = false;                 // a real device keeps the time, or moves
  // A place for the tip above the object seen at (x, y); unset: no object there.
  std::function<std::optional<Point<'W'>>(double x, double y)> above{};
};

class Controls {
 public:
  explicit Controls(const sim::Camera& camera) : home_(camera), camera_(camera) {}

  void see(const sim::WindowEvent& event, const Surroundings& around);
  // Called once per picture; moves a camera that follows the tip.
  void follow(const Point<'W'>& tip);

  [[nodiscard]] const sim::Camera& camera() const { return camera_; }
  [[nodiscard]] bool grabbed() const { return grabbed_; }
  [[nodiscard]] bool help() const { return help_; }
  [[nodiscard]] bool charts() const { return charts_; }
  [[nodiscard]] bool frozen() const { return frozen_; }  // the charts
  [[nodiscard]] bool follows() const { return follows_; }
  // Lasting wishes, and the single requests since the last call.
  [[nodiscard]] Wishes take_wishes();
  void paused_at_event() {
    wishes_.paused = true;
    wishes_.to_event = false;
  }

  struct Help {
    std::string_view key, what;
  };
  [[nodiscard]] static std::vector<Help> help_lines(bool real);

 private:
  void see_key(const sim::WindowEvent& event, const Surroundings& around);
  void see_time_key(std::int32_t code, bool recording);
  void see_button(const sim::WindowEvent& event, const Surroundings& around);
  void see_move(const sim::WindowEvent& event, const Surroundings& around);
  void see_wheel(const sim::WindowEvent& event, const Surroundings& around);
  // `by`: right, up and away in the picture, m.
  void move_hand(const Vec3& by, const Surroundings& around);
  [[nodiscard]] double metres_per_pixel(const Point<'W'>& at, const Surroundings& around) const;
  [[nodiscard]] Mat3 axes() const;  // columns in W: right, up and away

  sim::Camera home_, camera_;
  Wishes wishes_;
  bool grabbed_ = false, help_ = false, charts_ = true, frozen_ = false, follows_ = false;
  bool left_ = false, right_ = false, middle_ = false, dragged_ = false;
  double x_ = 0.0, y_ = 0.0, pressed_x_ = 0.0, pressed_y_ = 0.0;  // px
};

}  // namespace enc::app
