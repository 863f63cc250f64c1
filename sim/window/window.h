// The window module: one window that draws a ViewRequest and reports mouse and keys. It is a separate shared
// object, and the only part that maps GLFW.
#pragma once

#include <algorithm>
#include <cstdint>
#include <functional>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "core/base/frames.h"
#include "sim/view/view.h"
#include "sim/window/page.h"

namespace enc::sim {

// Keys without a character. Other keys have the code of their character, in upper case.
enum class Key : std::int32_t {
  escape = 256,
  enter = 257,
  tab = 258,
  backspace = 259,
  right = 262,
  left = 263,
  down = 264,
  up = 265,
  page_up = 266,
  page_down = 267,
  f1 = 290
};

struct WindowEvent {
  enum class Kind : std::uint8_t { key, button, move, wheel, stick };
  enum Button : std::int32_t { kLeft, kRight, kMiddle };
  Kind kind = Kind::move;
  std::int32_t code = 0;  // key or button
  bool down = false;      // false: released
  bool shift = false;
  double x = 0.0, y = 0.0;  // px from the window's upper left corner
  double wheel = 0.0;       // clicks; positive: away from the user
  // A gamepad's sticks, while one is off its middle: -1 to 1, and s since the last reading.
  double right = 0.0, up = 0.0, away = 0.0, since = 0.0;
};

// Layout of the bar of time (ViewBar), px from the window's edges.
inline constexpr double kBarSide = 10.0, kBarHeight = 14.0;
// The share of the bar at (x, y) of a window of this size; unset: above it. `held`: the drag began on the
// bar.
[[nodiscard]] inline std::optional<double> bar_share(double x, double y, double width, double height,
                                                     bool held = false) {
  if (!held && y < height - kBarHeight - kBarSide) return {};
  return std::clamp((x - kBarSide) / std::max(1.0, width - 2.0 * kBarSide), 0.0, 1.0);
}

class ViewWindow {
 public:
  virtual ~ViewWindow() = default;
  // Events since the last call, in order. False: the window was closed.
  virtual bool poll(std::vector<WindowEvent>& events) = 0;
  virtual void draw(const ViewRequest& request) = 0;
  virtual void draw_page(const ViewPage& page) = 0;
  // A separate picture, px; the window does not show it.
  [[nodiscard]] virtual Image snap(const ViewRequest& request, int width, int height) = 0;
  virtual void set_title(const std::string& title) = 0;
  // The point of the model at (x, y), with these data and the last picture's camera; unset: background.
  [[nodiscard]] virtual std::optional<Point<'W'>> seen_at(double x, double y, const mjData_* data) = 0;
  // x of the chart under (x, y), as last drawn; unset: no chart there.
  [[nodiscard]] virtual std::optional<double> chart_at(double x, double y) const = 0;
  virtual void forget() = 0;                    // drops the model and its drawings, before another run
  [[nodiscard]] virtual int width() const = 0;  // px
  [[nodiscard]] virtual int height() const = 0;
  [[nodiscard]] virtual std::string renderer() const = 0;  // OpenGL's name
};

struct WindowModule {
  // Throws Error (kind device) without a display. Call it on the thread that opens the window.
  void (*look)() = nullptr;
  // Throws Error (kind device) without OpenGL. `lost` is called once if the display goes away; the process
  // ends with exit code 3 after it returns.
  std::unique_ptr<ViewWindow> (*open)(const std::string& title, int width, int height,
                                      std::function<void()> lost) = nullptr;
};

}  // namespace enc::sim
