// The meaning of mouse and keys in the window: camera, requested position of the hand, time. Controls uses
// neither window nor run, so tests can press every key.
#pragma once

#include <functional>
#include <optional>
#include <string_view>
#include <vector>

#include "sim/window/window.h"

namespace enc::app {

// Requests to the run. Pausing, stepping and speed apply to simulated runs only.
struct RunRequests {
  // Requested position of the tool's tip; unset: the scene's own hand moves.
  std::optional<Point<'W'>> hand{};
  bool paused = false;
  double speed = 1.0;     // experiment time per wall time
  int ticks = 0;          // single ticks to run while paused
  bool to_event = false;  // runs to the next change of mode, then pauses
  bool ends = false, restarts = false;
  bool stops = false, resumes = false;  // for the machine
  bool changes_tool = false;
  std::uint8_t faults = 0;       // bits of trial::Fault
  std::optional<double> seek{};  // share of the bar of time
  int stills = 0;                // pictures to go forward; negative: back
  bool newest = false;           // go to the present
};

struct Surroundings {
  double width = 1.0, height = 1.0;  // px, size of the window
  Point<'W'> tip;                    // tip of the tool; NaN: no tool
  bool steerable = false;            // the twin's hand holds a tool
  bool recording = false;            // a restart would replace the record
  bool real = false;                 // a real device keeps the time, or moves
  bool played = false;               // a record; there is no present
  bool past = false;                 // an earlier moment than the present is shown
  // A position for the tip above the object shown at (x, y); unset: no object there.
  std::function<std::optional<Point<'W'>>(double x, double y)> above{};
  // A position for the tip above an object of the scene, index from 0; taken modulo their number.
  std::function<std::optional<Point<'W'>>(int object)> over{};
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
  // Small pictures besides the large one; the last two only with a camera in the scene.
  enum class Insets : std::uint8_t { none, contact, sides, pair, augmented };
  [[nodiscard]] Insets insets(bool camera) const;
  [[nodiscard]] double x() const { return x_; }  // px, mouse
  [[nodiscard]] double y() const { return y_; }
  [[nodiscard]] bool follows() const { return follows_; }
  // The lasting requests, and the single requests since the last call.
  [[nodiscard]] RunRequests take_wishes();
  void paused_at_event() {
    wishes_.paused = true;
    wishes_.to_event = false;
  }

  struct Help {
    std::string_view key, what;
  };
  enum class RunKind : std::uint8_t { simulated, real, record };
  [[nodiscard]] static std::vector<Help> help_lines(RunKind of);

 private:
  void see_key(const sim::WindowEvent& event, const Surroundings& around);
  void see_time_key(std::int32_t code, const Surroundings& around);
  void see_hand_key(const sim::WindowEvent& event, const Surroundings& around);
  [[nodiscard]] bool seek(const sim::WindowEvent& event, const Surroundings& around);
  void see_button(const sim::WindowEvent& event, const Surroundings& around);
  void see_move(const sim::WindowEvent& event, const Surroundings& around);
  void see_wheel(const sim::WindowEvent& event, const Surroundings& around);
  // `by`: right, up and away in the picture, m.
  void move_hand(const Vec3& by, const Surroundings& around);
  [[nodiscard]] double metres_per_pixel(const Point<'W'>& at, const Surroundings& around) const;
  [[nodiscard]] Mat3 axes() const;  // columns in W: right, up and away

  sim::Camera home_, camera_;
  RunRequests wishes_;
  bool grabbed_ = false, help_ = false, charts_ = true, follows_ = false;
  bool on_bar_ = false;  // the left button was pressed there
  int insets_ = 0;       // number of requests for another set
  int object_ = -1;      // last object that the tool was sent above
  bool left_ = false, right_ = false, middle_ = false, dragged_ = false;
  double x_ = 0.0, y_ = 0.0, pressed_x_ = 0.0, pressed_y_ = 0.0;  // px
};

}  // namespace enc::app
