// The window module: one window that draws a ViewRequest and reports mouse and keys. Being a shared object of
// its own, it is the only part that maps GLFW.
#pragma once

#include <cstdint>
#include <functional>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "core/frames.h"
#include "sim/view/view.h"

namespace enc::sim {

// Keys without a character. Others have the code of their character, in upper case.
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
  enum class Kind : std::uint8_t { key, button, move, wheel };
  enum Button : std::int32_t { kLeft, kRight, kMiddle };
  Kind kind = Kind::move;
  std::int32_t code = 0;  // key or button
  bool down = false;      // false: released
  bool shift = false;
  double x = 0.0, y = 0.0;  // px from the window's upper left corner
  double wheel = 0.0;       // clicks; positive: away from the user
};

class ViewWindow {
 public:
  virtual ~ViewWindow() = default;
  // Events since the last call, in order. False: the window was closed.
  virtual bool poll(std::vector<WindowEvent>& events) = 0;
  virtual void draw(const ViewRequest& request) = 0;
  // The point of the model at (x, y), with these data and the last picture's camera; unset: background.
  [[nodiscard]] virtual std::optional<Point<'W'>> seen_at(double x, double y, const mjData_* data) = 0;
  virtual void forget() = 0;                    // the model and all that was drawn of it, before another run
  [[nodiscard]] virtual int width() const = 0;  // px
  [[nodiscard]] virtual int height() const = 0;
  [[nodiscard]] virtual std::string renderer() const = 0;  // OpenGL's name for it
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
