// Elements over or beside the picture in a window: charts, the bar of time, images, tiles. Positions are px
// of the framebuffer, from below.
#pragma once

#include "sim/bodies/mujoco.h"
#include "sim/view/renderer.h"
#include "sim/view/view.h"
#include "sim/window/window.h"

namespace enc::sim {

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

// Leaves the chart's axes in `figure`.
void draw_chart(const ViewChart& chart, const mjrRect& where, mjvFigure& figure, const mjrContext& context);
void draw_bar(const ViewBar& bar, const mjrRect& all);
void draw_image(const Image& picture, int left, int bottom, const mjrContext& context);
[[nodiscard]] Image resized(const Image& from, int width, int height);  // scaled by the nearest pixel
// The first half of a text's lines, and the rest.
[[nodiscard]] std::pair<std::string, std::string> halves(const std::string& text);
void draw_tiles(const ViewPage& page, const mjrRect& all, const mjrContext& context);

}  // namespace enc::sim
