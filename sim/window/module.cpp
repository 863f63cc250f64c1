// A GLFW window, drawn by MuJoCo's classic renderer without shadows.
#include "core/devices/module.h"

#include <algorithm>
#include <array>
#include <atomic>
#include <cctype>
#include <cmath>
#include <cstring>
#include <iterator>
#include <memory>

#include <GLFW/glfw3.h>
#include <X11/Xlib.h>
#include <unistd.h>

#include "core/base/error.h"
#include "sim/bodies/mujoco.h"
#include "sim/picture/picture.h"
#include "sim/view/painter.h"
#include "sim/view/view.h"
#include "sim/window/window.h"

// Declared in glfw3native.h, which would include more X headers than are installed.
extern "C" Display* glfwGetX11Display(void);

namespace enc::sim {
namespace {

// ---- Elements over or beside the picture: charts, the bar of time, images, tiles. Positions are px of the
// framebuffer, from below.

// MuJoCo draws text only with a model's context: this one has an empty model.
class Letters {
 public:
  Letters()
      : spec_(mj_makeSpec()),
        model_(mj_compile(spec_.get(), nullptr)),
        renderer_(model_.get(), 1, mjFONTSCALE_100, 0, 0) {}
  [[nodiscard]] const mjrContext& context() const { return renderer_.context; }

 private:
  SpecPtr spec_;
  ModelPtr model_;
  Renderer renderer_;
};

constexpr float kLineColours[][3] = {
    {0.85F, 0.10F, 0.15F}, {0.16F, 0.42F, 0.72F}, {0.10F, 0.55F, 0.35F}, {0.90F, 0.55F, 0.20F}};

// Leaves the chart's axes in `figure`.
void draw_chart(const ViewChart& chart, const mjrRect& where, mjvFigure& figure, const mjrContext& context) {
  mjv_defaultFigure(&figure);
  std::strncpy(figure.title, chart.title.c_str(), sizeof(figure.title) - 1);
  figure.flg_legend = 1;
  figure.flg_extend = 1;
  figure.flg_ticklabel[0] = figure.flg_ticklabel[1] = 1;
  figure.linewidth = 1.0F;
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
  if (chart.cursor) {
    figure.flg_selection = 1;
    figure.selection = *chart.cursor;
  }
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

void draw_bar(const ViewBar& bar, const mjrRect& all) {
  const int side = static_cast<int>(kBarSide), height = static_cast<int>(kBarHeight);
  const mjrRect where{side, side, std::max(1, all.width - 2 * side), height};
  mjr_rectangle(where, 0.12F, 0.12F, 0.12F, 0.55F);
  const auto along = [&](float share) { return static_cast<int>(share * static_cast<float>(where.width)); };
  for (const ViewBar::Mark& mark : bar.marks) {
    const int from = along(mark.from), to = std::max(from + 2, along(mark.to));
    mjr_rectangle({where.left + from, where.bottom, to - from, height}, mark.colour[0], mark.colour[1],
                  mark.colour[2], 0.9F);
  }
  mjr_rectangle({where.left + along(bar.at) - 2, where.bottom - 3, 5, height + 6}, 0.16F, 0.42F, 0.72F, 1.0F);
}

void draw_image(const Image& picture, int left, int bottom, const mjrContext& context) {
  Image turned = picture;  // OpenGL's first row is the lowest
  flip(turned);
  const mjrRect where{left, bottom, turned.width, turned.height};
  mjr_drawPixels(turned.rgb.data(), nullptr, where, &context);
}

// Scales to the nearest pixel.
Image resized(const Image& from, int width, int height) {
  Image to(std::max(1, width), std::max(1, height));
  for (int y = 0; y < to.height; ++y)
    for (int x = 0; x < to.width; ++x)
      std::copy_n(from.view().at(x * from.width / to.width, y * from.height / to.height), 3, to.at(x, y));
  return to;
}

// Splits a text at half of its lines.
std::pair<std::string, std::string> halves(const std::string& text) {
  const auto lines = std::count(text.begin(), text.end(), '\n') + 1;
  std::size_t at = 0;
  for (std::ptrdiff_t i = 0; i < (lines + 1) / 2; ++i) {
    at = text.find('\n', at);
    if (at == std::string::npos) return {text, ""};
    ++at;
  }
  return {text.substr(0, at - 1), text.substr(at)};
}

void draw_tiles(const ViewPage& page, const mjrRect& all, const mjrContext& context) {
  const TileGrid grid(page.tiles.size(), all.width, all.height);
  mjr_rectangle(all, 0.96F, 0.965F, 0.97F, 1.0F);
  const int gap = static_cast<int>(TileGrid::kGap), name = static_cast<int>(TileGrid::kName);
  for (std::size_t i = 0; i < page.tiles.size(); ++i) {
    const ViewTile& tile = page.tiles[i];
    const mjrRect where{static_cast<int>(grid.left(i)),
                        all.height - static_cast<int>(grid.top(i) + grid.height),
                        static_cast<int>(grid.width), static_cast<int>(grid.height)};
    if (i == page.chosen) mjr_rectangle(where, 0.16F, 0.42F, 0.72F, 1.0F);
    const int x = where.left + gap / 2, y = where.bottom + gap / 2;
    if (tile.picture.width > 0)
      draw_image(resized(tile.picture, grid.picture_width(), grid.picture_height()), x, y + name, context);
    else
      mjr_rectangle({x, y + name, grid.picture_width(), grid.picture_height()}, 1, 1, 1, 1);
    mjr_overlay(mjFONT_NORMAL, mjGRID_BOTTOMLEFT, {x, y, where.width - gap, name}, tile.name.c_str(), nullptr,
                &context);
  }
  mjr_overlay(mjFONT_NORMAL, mjGRID_TOPLEFT, all, page.title.c_str(), nullptr, &context);
  mjr_overlay(mjFONT_NORMAL, mjGRID_BOTTOMLEFT, all, page.line.c_str(), nullptr, &context);
}

// ---- the window

// A window is drawn many times a second, often in software.
constexpr PaintSettings kQuick{.stacks = 16, .slices = 32};
constexpr int kSamples = 4;   // samples of a pixel, with a graphics card
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

// The renderer of the current context.
std::string renderer_name() {
  using GetString = const GLubyte* (*)(GLenum);
  const auto get = reinterpret_cast<GetString>(glfwGetProcAddress("glGetString"));
  const GLubyte* name = get == nullptr ? nullptr : get(GL_RENDERER);
  return name == nullptr ? "unknown" : reinterpret_cast<const char*>(name);
}

struct WindowDelete {
  void operator()(GLFWwindow* window) const { glfwDestroyWindow(window); }
};

// A software renderer needs three times as long with several samples a pixel.
bool in_software() {
  glfwWindowHint(GLFW_VISIBLE, GLFW_FALSE);
  const std::unique_ptr<GLFWwindow, WindowDelete> probe(glfwCreateWindow(1, 1, "", nullptr, nullptr));
  glfwWindowHint(GLFW_VISIBLE, GLFW_TRUE);
  if (!probe) no_window(said().c_str());
  glfwMakeContextCurrent(probe.get());
  const std::string name = renderer_name();
  glfwMakeContextCurrent(nullptr);
  return name.find("llvmpipe") != std::string::npos || name.find("softpipe") != std::string::npos;
}

class GlfwWindow final : public ViewWindow {
 public:
  GlfwWindow(const std::string& title, int width, int height, std::function<void()> lost)
      : lost_(std::move(lost)) {
    look();
    glfwWindowHint(GLFW_SAMPLES, in_software() ? 0 : kSamples);
    glfwWindowHint(GLFW_FOCUSED, GLFW_TRUE);
    window_.reset(glfwCreateWindow(width, height, title.c_str(), nullptr, nullptr));
    if (!window_) no_window(said().c_str());
    glfwSetWindowUserPointer(window_.get(), this);
    glfwMakeContextCurrent(window_.get());
    glfwSwapInterval(0);  // the caller sets the pace
    renderer_ = renderer_name();
    listen();
    // Xlib would exit at once, without sealing a record. A Wayland session has no X display.
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
    read_gamepad();
    events = events_;
    return glfwWindowShouldClose(window_.get()) == GLFW_FALSE && !failed();
  }
  void draw(const ViewRequest& request) override {
    mjrRect all{0, 0, 0, 0};
    glfwGetFramebufferSize(window_.get(), &all.width, &all.height);
    if (all.width < kSmallest || all.height < kSmallest) return;
    if (!painter_ || !painter_->is_of(request.model)) {
      painter_.reset();
      painter_ = std::make_unique<Painter>(request, kQuick);
    }
    painter_->paint(request, all);
    inset(request, all);
    letter(request, all);
    glfwSwapBuffers(window_.get());
  }
  void draw_page(const ViewPage& page) override {
    mjrRect all{0, 0, 0, 0};
    glfwGetFramebufferSize(window_.get(), &all.width, &all.height);
    if (all.width < kSmallest || all.height < kSmallest) return;
    if (!letters_) letters_ = std::make_unique<Letters>();
    draw_tiles(page, all, letters_->context());
    glfwSwapBuffers(window_.get());
  }
  Image snap(const ViewRequest& request, int width, int height) override {
    Image picture(width, height);
    const mjrRect all{0, 0, width, height};
    Painter painter(request, kQuick);
    painter.paint(request, all);
    mjr_readPixels(picture.rgb.data(), nullptr, all, &painter.context());
    flip(picture);
    return picture;
  }
  void set_title(const std::string& title) override { glfwSetWindowTitle(window_.get(), title.c_str()); }
  std::optional<Point<'W'>> seen_at(double x, double y, const mjData* data) override {
    const double w = std::max(1, width()), h = std::max(1, height());
    return painter_ ? painter_->seen_at(x / w, 1.0 - y / h, w / h, data) : std::nullopt;
  }
  std::optional<double> chart_at(double x, double y) const override {
    std::pair<int, int> pixels;  // size of the framebuffer, which may be finer than the window
    glfwGetFramebufferSize(window_.get(), &pixels.first, &pixels.second);
    const double px = x * pixels.first / std::max(1, width());
    const double py = (height() - y) * pixels.second / std::max(1, height());
    for (const Plot& plot : plots_) {
      const mjrRect& r = plot.where;
      if (px < r.left || px > r.left + r.width || py < r.bottom || py > r.bottom + r.height) continue;
      const double share = (px - r.left - static_cast<double>(plot.from)) /
                           std::max(1.0, static_cast<double>(plot.to) - static_cast<double>(plot.from));
      return static_cast<double>(plot.across[0]) +
             std::clamp(share, 0.0, 1.0) * static_cast<double>(plot.across[1] - plot.across[0]);
    }
    return {};
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
  // Images side by side above the bar.
  void inset(const ViewRequest& request, const mjrRect& all) {
    const mjrContext& context = painter_->context();
    const int gap = 6, w = all.width / 4, up = static_cast<int>(kBarHeight + 2.0 * kBarSide);
    if (w < 64) return;  // no room
    int x = gap;
    for (const ViewInset& one : request.insets) {
      mjrRect where{x, up, w, (5 * w) / 8};
      if (one.image != nullptr) where.height = w * one.image->height / std::max(1, one.image->width);
      mjr_rectangle({x - 2, up - 2, w + 4, where.height + 4}, 0.12F, 0.12F, 0.12F, 1.0F);
      if (one.image != nullptr) {
        draw_image(resized(*one.image, where.width, where.height), where.left, where.bottom, context);
      } else {
        ViewRequest other = request;
        other.camera = one.camera;
        painter_->paint_again(other, where);
      }
      mjr_overlay(mjFONT_NORMAL, mjGRID_TOPLEFT, where, one.name.c_str(), nullptr, &context);
      x += w + gap;
    }
    if (!request.insets.empty()) painter_->look(request);  // for seen_at()
  }
  void letter(const ViewRequest& request, const mjrRect& all) {
    const mjrContext& context = painter_->context();
    const int w = std::min(all.width / 3, 420), h = std::min(all.height / 4, 190);
    int y = 10 + (request.bar.shown ? static_cast<int>(kBarHeight + kBarSide) : 0);
    plots_.clear();
    for (const ViewChart& chart : request.charts) {
      if (y + h > all.height) break;
      const mjrRect where{all.width - w - 10, y, w, h};
      draw_chart(chart, where, figure_, context);
      plots_.push_back({where, figure_.xaxispixel[0], figure_.xaxispixel[1], chart.across});
      y += h + 8;
    }
    if (request.bar.shown) draw_bar(request.bar, all);
    if (!request.message.empty())
      mjr_overlay(mjFONT_NORMAL, mjGRID_BOTTOM, all, request.message.c_str(), nullptr, &context);
    if (!request.names.empty())
      mjr_overlay(mjFONT_NORMAL, mjGRID_TOPLEFT, all, request.names.c_str(), request.values.c_str(),
                  &context);
    if (!request.help.empty()) {  // two columns: MuJoCo writes at most 500 characters at once
      const auto [keys, more_keys] = halves(request.help_keys);
      const auto [help, more_help] = halves(request.help);
      const mjrRect middle{all.width / 4, 0, all.width / 2, all.height};
      mjr_overlay(mjFONT_NORMAL, mjGRID_TOPLEFT, middle, keys.c_str(), help.c_str(), &context);
      mjr_overlay(mjFONT_NORMAL, mjGRID_TOPRIGHT, all, more_keys.c_str(), more_help.c_str(), &context);
    }
    if (!request.title.empty())
      mjr_overlay(mjFONT_NORMAL, mjGRID_TOP, all, request.title.c_str(), nullptr, &context);
  }
  // The left stick moves right and up, the right one away. The left bumper makes the motion finer, like
  // Shift.
  void read_gamepad() {
    constexpr double kStill = 0.15, kLongest = 0.1;  // deflection of a stick at rest; s
    const double now = glfwGetTime(), since = std::min(kLongest, now - sticks_read_);
    sticks_read_ = now;
    GLFWgamepadstate pad;
    if (glfwGetGamepadState(GLFW_JOYSTICK_1, &pad) == GLFW_FALSE) return;
    const auto axis = [&](int which) {
      const auto value = static_cast<double>(pad.axes[which]);
      return std::abs(value) < kStill ? 0.0 : value;
    };
    const double right = axis(GLFW_GAMEPAD_AXIS_LEFT_X), up = -axis(GLFW_GAMEPAD_AXIS_LEFT_Y);
    const double away = -axis(GLFW_GAMEPAD_AXIS_RIGHT_Y);
    if (right == 0.0 && up == 0.0 && away == 0.0) return;
    events_.push_back({.kind = WindowEvent::Kind::stick,
                       .shift = pad.buttons[GLFW_GAMEPAD_BUTTON_LEFT_BUMPER] == GLFW_PRESS,
                       .right = right,
                       .up = up,
                       .away = away,
                       .since = since});
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
      if (action == GLFW_REPEAT && !moves) return;  // a held key triggers once
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
  double sticks_read_ = 0.0;          // s of GLFW
  std::unique_ptr<Painter> painter_;  // destroyed before the window: it uses its context
  std::unique_ptr<Letters> letters_;  // destroyed before the window
  mjvFigure figure_{};
  struct Plot {  // a chart as last drawn
    mjrRect where;
    int from, to;  // px, ends of the axis of x
    std::array<float, 2> across;
  };
  std::vector<Plot> plots_;
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
