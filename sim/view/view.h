// The description of a picture of a simulated world, and the view module, which draws it off the screen.
// The window module draws the same (window.h). Both are shared objects of their own, so that nothing but
// `encounter view` maps OpenGL.
#pragma once

#include <array>
#include <functional>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "core/base/frames.h"
#include "core/base/image.h"
#include "sim/view/chart.h"

struct mjModel_;
struct mjData_;

namespace enc::sim {

// Things that are drawn besides the model's own bodies.
struct ViewRod {  // a leg, a strut
  Point<'W'> from, to;
  double radius = 0.002;  // m
  Colour colour{0.7F, 0.7F, 0.7F, 1.0F};
  bool flat = false;  // its ends; else round
};
struct ViewBox {
  Point<'W'> middle;
  Quat q;     // of its axes in W
  Vec3 half;  // sizes along them, m
  Colour colour{0.7F, 0.7F, 0.7F, 1.0F};
};
struct ViewArrow {
  Point<'W'> from;
  Vec<'W'> along;         // to its point, m
  double radius = 0.002;  // m
  Colour colour{0.9F, 0.1F, 0.1F, 1.0F};
};
struct ViewLabel {  // written in the margin, with a line to what it names
  std::string text;
  Point<'W'> at;
  bool left = false;  // margin
};

struct Camera {
  double azimuth = 2.0;     // rad; direction of sight about z of W, 0 looks along +x
  double elevation = -0.2;  // rad; negative looks down
  double distance = 1.0;    // m, from look_at
  double opening = 0.6;     // rad, vertical
  Point<'W'> look_at{0, 0, 0};
};

// A small picture in a window: an image, or the same world by another camera.
struct ViewInset {
  std::string name;
  const Image* image = nullptr;
  Camera camera{};
};

struct ViewRequest {
  const mjModel_* model = nullptr;
  mjData_* data = nullptr;
  int width = 1000, height = 700;  // pixels
  Camera camera;
  Point<'W'> floor;  // the middle of a round floor; unset: none
  std::vector<ViewRod> rods;
  std::vector<ViewBox> boxes;
  std::vector<ViewArrow> arrows;
  std::vector<ViewLabel> labels;
  std::vector<ViewLabel> signs;  // written at their places themselves
  std::string title;             // top left, one or more lines; may be empty
  // Dents a mesh of the picture's own copy of the model; gives its index, -1: none is dented.
  std::function<int(mjModel_*)> dent;
  // In a window alone: names and what they are, a line each; the same of a help page, else empty; charts.
  std::string names, values, help_keys, help;
  std::string message;  // a mistake, in the middle of the bottom
  std::vector<ViewChart> charts;
  ViewBar bar;
  std::vector<ViewInset> insets;
};

// Draws pictures off the screen, all with one OpenGL context and one copy of the model.
class Pictures {
 public:
  virtual ~Pictures() = default;
  // `request` has the model and the size of the first one.
  virtual Image draw(const ViewRequest& request) = 0;
};

// A still picture is drawn at three times its size and shrunk; a frame of a film, of which there are
// hundreds, is drawn at twice its size.
enum class Finish { still, film };

struct ViewModule {
  // Throws Error of the kind device where there is no EGL or Mesa.
  std::unique_ptr<Pictures> (*open)(const ViewRequest& first, Finish finish) = nullptr;
  std::string (*png)(const Image& picture) = nullptr;  // the bytes of a PNG
};

}  // namespace enc::sim
