// A GLFW window, drawn by MuJoCo's classic renderer without shadows.
#include "core/module.h"

#include <algorithm>
#include <atomic>
#include <cctype>
#include <cstring>
#include <memory>

#include <GLFW/glfw3.h>
#include <X11/Xlib.h>
#include <unistd.h>

#include "core/error.h"
#include "sim/bodies/mujoco.h"
#include "sim/view/painter.h"
#include "sim/window/window.h"

// Declared in glfw3native.h, which would include more X headers than are installed.
extern "C" Display* glfwGetX11Display(void);

namespace enc::sim {
namespace {

constexpr int kSmallest = 2;  // px: a smaller window is not drawn

[[noreturn]] void no_window(const char* why) {
  throw Error(
      std::string("no window can be opened: ") + why +
          "; expected a display with OpenGL; set DISPLAY, or draw into a file with --shot picture.png",
      {}, ErrorKind::device);
}

// The newest error message of GLFW.
std::string& said() {
  static std::string why = "no reason given";
  return why;
}

// Set by an error of X, such as a window that another program destroyed.
std::atomic<bool>& failed() {
  static std::atomic<bool> is = false;
  return is;
}

// Initialises GLFW; it stays until the process ends.
void look() {
  glfwSetErrorCallback([](int, const char* why) {
    said() = why;
    while (said().ends_with(' ')) said().pop_back();
  });
  if (glfwInit() == GLFW_FALSE) no_window(said().c_str());
}

struct WindowDelete {
  void operator()(GLFWwindow* window) const { glfwDestroyWindow(window); }
};

constexpr float kLineColours[][3] = {
    {0.85F, 0.10F, 0.15F}, {0.16F, 0.42F, 0.72F}, {0.10F, 0.55F, 0.35F}, {0.90F, 0.55F, 0.20F}};

void draw_chart(const ViewChart& chart, const mjrRect& where, mjvFigure& figure, const mjrContext& context) {
  mjv_defaultFigure(&figure);
  std::strncpy(figure.title, chart.title.c_str(), sizeof(figure.title) - 1);
  figure.flg_legend = 1;
  figure.flg_extend = 1;
  figure.flg_ticklabel[0] = figure.flg_ticklabel[1] = 1;
  figure.linewidth = 1.5F;
  figure.gridsize[0] = 6;
  figure.gridsize[1] = 5;
  std::strncpy(figure.xformat, "%.0f", sizeof(figure.xformat) - 1);
  std::strncpy(figure.yformat, "%.1f", sizeof(figure.yformat) - 1);
  for (int i = 0; i < 2; ++i) {
    const auto at = static_cast<std::size_t>(i);
    figure.range[0][i] = chart.across[at];
    figure.range[1][i] = chart.up[at];
  }
  figure.figurergba[0] = figure.figurergba[1] = figure.figurergba[2] = 0.12F;
  figure.figurergba[3] = 0.75F;
  for (std::size_t l = 0; l < std::min(chart.lines.size(), std::size(kLineColours)); ++l) {
    const ViewLine& line = chart.lines[l];
    std::strncpy(figure.linename[l], line.name.c_str(), sizeof(figure.linename[l]) - 1);
    std::copy_n(kLineColours[l], 3, figure.linergb[l]);
    const std::size_t count = std::min<std::size_t>(line.xy.size() / 2, mjMAXLINEPNT - 1);
    figure.linepnt[l] = static_cast<int>(count);
    std::copy_n(line.xy.begin(), 2 * count, figure.linedata[l]);
  }
  mjr_figure(where, &figure, &context);
}

class GlfwWindow final : public ViewWindow {
 public:
  GlfwWindow(const std::string& title, int width, int height, std::function<void()> lost)
      : lost_(std::move(lost)) {
    look();
    glfwWindowHint(GLFW_SAMPLES, 4);
    glfwWindowHint(GLFW_FOCUSED, GLFW_TRUE);
    window_.reset(glfwCreateWindow(width, height, title.c_str(), nullptr, nullptr));
    if (!window_) no_window(said().c_str());
    glfwSetWindowUserPointer(window_.get(), this);
    glfwMakeContextCurrent(window_.get());
    glfwSwapInterval(0);  // the caller sets the pace
    if (const auto name = get_string(GL_RENDERER); name != nullptr) renderer_ = name;
    listen();
    // Xlib would exit at once, without sealing a record. A Wayland session gives no X display.
    XSetIOErrorHandler([](::Display*) { return 0; });
    XSetErrorHandler([](::Display*, XErrorEvent*) {
      failed() = true;
      return 0;
    });
    if (::Display* display = glfwGetX11Display(); display != nullptr)
      XSetIOErrorExitHandler(
          display,
          [](::Display*, void* window) {
            static_cast<GlfwWindow*>(window)->lost_();
            _exit(3);
          },
          this);
  }
  bool poll(std::vector<WindowEvent>& events) override {
    events_.clear();
    glfwPollEvents();
    events = events_;
    return glfwWindowShouldClose(window_.get()) == GLFW_FALSE && !failed();
  }
  void draw(const ViewRequest& request) override {
    mjrRect all{0, 0, 0, 0};
    glfwGetFramebufferSize(window_.get(), &all.width, &all.height);
    if (all.width < kSmallest || all.height < kSmallest) return;
    if (!painter_ || !painter_->is_of(request.model)) {
      painter_.reset();
      painter_ = std::make_unique<Painter>(request, PaintSettings{});
    }
    painter_->paint(request, all);
    letter(request, all);
    glfwSwapBuffers(window_.get());
  }
  std::optional<Point<'W'>> seen_at(double x, double y, const mjData* data) override {
    const double w = std::max(1, width()), h = std::max(1, height());
    return painter_ ? painter_->seen_at(x / w, 1.0 - y / h, w / h, data) : std::nullopt;
  }
  void forget() override { painter_.reset(); }
  [[nodiscard]] int width() const override { return size().first; }
  [[nodiscard]] int height() const override { return size().second; }
  [[nodiscard]] std::string renderer() const override { return renderer_; }

 private:
  [[nodiscard]] std::pair<int, int> size() const {
    std::pair<int, int> size;
    glfwGetWindowSize(window_.get(), &size.first, &size.second);
    return size;
  }
  static const char* get_string(GLenum name) {
    using GetString = const GLubyte* (*)(GLenum);
    const auto get = reinterpret_cast<GetString>(glfwGetProcAddress("glGetString"));
    return get == nullptr ? nullptr : reinterpret_cast<const char*>(get(name));
  }
  void letter(const ViewRequest& request, const mjrRect& all) {
    const mjrContext& context = painter_->context();
    const int w = std::min(all.width / 3, 420), h = std::min(all.height / 4, 190);
    int y = 10;
    for (const ViewChart& chart : request.charts) {
      if (y + h > all.height) break;
      draw_chart(chart, {all.width - w - 10, y, w, h}, figure_, context);
      y += h + 8;
    }
    if (!request.names.empty())
      mjr_overlay(mjFONT_NORMAL, mjGRID_TOPLEFT, all, request.names.c_str(), request.values.c_str(),
                  &context);
    if (!request.help.empty())
      mjr_overlay(mjFONT_NORMAL, mjGRID_TOPRIGHT, all, request.help_keys.c_str(), request.help.c_str(),
                  &context);
    if (!request.title.empty())
      mjr_overlay(mjFONT_NORMAL, mjGRID_BOTTOMLEFT, all, request.title.c_str(), nullptr, &context);
  }
  void tell(WindowEvent event) {
    glfwGetCursorPos(window_.get(), &event.x, &event.y);
    const auto held = [&](int key) { return glfwGetKey(window_.get(), key) == GLFW_PRESS; };
    event.shift = held(GLFW_KEY_LEFT_SHIFT) || held(GLFW_KEY_RIGHT_SHIFT);
    events_.push_back(event);
  }
  static GlfwWindow& of(GLFWwindow* window) {
    return *static_cast<GlfwWindow*>(glfwGetWindowUserPointer(window));
  }
  void listen() {
    using Kind = WindowEvent::Kind;
    glfwSetCursorPosCallback(window_.get(),
                             [](GLFWwindow* w, double, double) { of(w).tell({.kind = Kind::move}); });
    glfwSetMouseButtonCallback(window_.get(), [](GLFWwindow* w, int button, int action, int) {
      of(w).tell({.kind = Kind::button, .code = button, .down = action == GLFW_PRESS});
    });
    glfwSetScrollCallback(window_.get(), [](GLFWwindow* w, double, double clicks) {
      of(w).tell({.kind = Kind::wheel, .wheel = clicks});
    });
    glfwSetKeyCallback(window_.get(), [](GLFWwindow* w, int key, int scan, int action, int) {
      const bool moves = key >= GLFW_KEY_RIGHT && key <= GLFW_KEY_PAGE_DOWN;
      if (action == GLFW_REPEAT && !moves) return;  // a key that is held asks for one thing
      // Letters follow the user's keyboard layout.
      const char* name = key < GLFW_KEY_ESCAPE ? glfwGetKeyName(key, scan) : nullptr;
      const bool letter = name != nullptr && name[0] != '\0' && name[1] == '\0';
      const int code = letter ? std::toupper(static_cast<unsigned char>(name[0])) : key;
      of(w).tell({.kind = Kind::key, .code = code, .down = action != GLFW_RELEASE});
    });
  }

  std::function<void()> lost_;
  std::unique_ptr<GLFWwindow, WindowDelete> window_;
  std::string renderer_ = "unknown";
  std::vector<WindowEvent> events_;
  std::unique_ptr<Painter> painter_;  // destroyed before the window: it uses its context
  mjvFigure figure_{};
};

std::unique_ptr<ViewWindow> open(const std::string& title, int width, int height,
                                 std::function<void()> lost) {
  return std::make_unique<GlfwWindow>(title, width, height, std::move(lost));
}

constexpr WindowModule kWindow{look, open};
constexpr ModuleInfo kInfo{.name = "window", .window = &kWindow};

}  // namespace
}  // namespace enc::sim

extern "C" __attribute__((visibility("default"))) const enc::ModuleInfo* encounter_module() {
  return &enc::sim::kInfo;
}
