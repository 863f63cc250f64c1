// What is drawn of a simulated world, and the view module, which draws it off screen, as the bytes of a PNG.
// The window module draws the same (window.h). Both are shared objects of their own, so that nothing but
// `encounter view` maps OpenGL.
#pragma once

#include <array>
#include <functional>
#include <optional>
#include <string>
#include <vector>

#include "core/frames.h"
#include "core/vision/image.h"

struct mjModel_;
struct mjData_;

namespace enc::sim {

using Colour = std::array<float, 4>;  // red, green, blue, opacity; 0 to 1

// What is drawn besides the model's own bodies.
struct ViewRod {  // a leg, a strut
  Point<'W'> from, to;
  double radius = 0.002;  // m
  Colour colour{0.7F, 0.7F, 0.7F, 1.0F};
  bool flat = false;  // its ends; else round
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

// A strip chart in the corner of a window.
struct ViewLine {
  std::string name;
  std::vector<float> xy;  // x, y, x, y...; at most 1000 points are drawn
};
struct ViewChart {
  std::string title;
  std::vector<ViewLine> lines;
  std::array<float, 2> across{0, 1};  // of x
  std::array<float, 2> up{0, 0};      // of y, at least
  std::optional<float> cursor{};      // x of a vertical line
};

// A bar along the bottom of a window: time, the moment that is shown, marks. Positions are shares, 0 to 1.
struct ViewBar {
  struct Mark {
    float from = 0.0F, to = 0.0F;
    Colour colour{};
  };
  bool shown = false;
  float at = 0.0F;
  std::vector<Mark> marks;
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
  double floor = kUnset;  // m, height of the floor in W; unset: none
  std::vector<ViewRod> rods;
  std::vector<ViewArrow> arrows;
  std::vector<ViewLabel> labels;
  std::string title;  // top left; may be empty
  // Dents a mesh of the picture's own copy of the model; gives its index, -1: none is dented.
  std::function<int(mjModel_*)> dent;
  // In a window alone: names and what they are, a line each; the same of a help page, else empty; charts.
  std::string names, values, help_keys, help;
  std::string message;  // a mistake, in the middle of the bottom
  std::vector<ViewChart> charts;
  ViewBar bar;
  std::vector<ViewInset> insets;
};

struct ViewModule {
  // The PNG. Throws Error of the kind device where there is no EGL or Mesa.
  std::string (*shot)(const ViewRequest& request) = nullptr;
  std::string (*png)(const Image& picture) = nullptr;  // of an image that is there
};

}  // namespace enc::sim
