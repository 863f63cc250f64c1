// The description of a picture of a simulated world, and the view module, which draws it off the screen. The
// window module draws the same descriptions (window.h). Both are separate shared objects, so that only
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

// Things drawn besides the model's own bodies.
struct ViewRod {  // a leg, a strut
  Point<'W'> from, to;
  double radius = 0.002;  // m
  Colour colour{0.7F, 0.7F, 0.7F, 1.0F};
  bool flat = false;  // flat ends, else round
};
struct ViewBox {
  Point<'W'> middle;
  Quat q;     // its axes in W
  Vec3 half;  // half sizes along them, m
  Colour colour{0.7F, 0.7F, 0.7F, 1.0F};
};
struct ViewArrow {
  Point<'W'> from;
  Vec<'W'> along;         // vector to its point, m
  double radius = 0.002;  // m
  Colour colour{0.9F, 0.1F, 0.1F, 1.0F};
};
struct ViewLabel {  // text in the margin, with a line to its object
  std::string text;
  Point<'W'> at;
  bool left = false;  // left margin, else right
};

struct Camera {
  double azimuth = 2.0;     // rad; direction of sight about z of W, 0 looks along +x
  double elevation = -0.2;  // rad; negative looks down
  double distance = 1.0;    // m, from look_at
  double opening = 0.6;     // rad, vertical
  Point<'W'> look_at{0, 0, 0};
};

// A small picture in a window: an image, or this world by another camera.
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
  Point<'W'> floor;  // middle of a round floor; unset: no floor
  std::vector<ViewRod> rods;
  std::vector<ViewBox> boxes;
  std::vector<ViewArrow> arrows;
  std::vector<ViewLabel> labels;
  std::vector<ViewLabel> signs;  // written at their own places
  std::string title;             // top left, one or more lines; may be empty
  // Deforms a mesh of the picture's own copy of the model; returns its index, -1: no mesh.
  std::function<int(mjModel_*)> dent;
  // Only in a window: names and values, a line each; the same for a help page, else empty; charts.
  std::string names, values, help_keys, help;
  std::string message;  // an error, at the bottom centre
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

// A still picture is drawn at three times its size and shrunk; a frame of a film, one of hundreds, at twice
// its size.
enum class Finish { still, film };

struct ViewModule {
  // Throws Error of the kind device if EGL or Mesa is missing.
  std::unique_ptr<Pictures> (*open)(const ViewRequest& first, Finish finish) = nullptr;
  std::string (*png)(const Image& picture) = nullptr;  // bytes of a PNG
};

}  // namespace enc::sim
