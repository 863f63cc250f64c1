#include "sim/view/painter.h"

#include <algorithm>
#include <cstddef>

#include "sim/view/drawing.h"

namespace enc::sim {
namespace {

constexpr int kNoShadows = 256;  // px: MuJoCo makes a shadow map whether or not it is used

}  // namespace

Painter::Painter(const ViewRequest& request, const PaintSettings& settings)
    : of_(request.model),
      model_(picture_model(request, settings.shadow_size > 0 ? settings.shadow_size : kNoShadows,
                           settings.stacks, settings.slices)),
      shadows_(settings.shadow_size > 0),
      renderer_(model_.get(), kRoom, settings.letters, settings.width, settings.height) {}

void Painter::paint(const ViewRequest& request, const mjrRect& where) {
  dent(request);
  paint_again(request, where);
}

void Painter::look(const ViewRequest& request) { aim(renderer_.scene, model_.get(), request, shadows_); }

void Painter::paint_again(const ViewRequest& request, const mjrRect& where) {
  look(request);
  add_backdrop(renderer_.scene);
  add_extras(renderer_.scene, request);
  mjr_render(where, &renderer_.scene, &renderer_.context);
}

std::optional<Point<'W'>> Painter::seen_at(double across, double up, double aspect,
                                           const mjData* data) const {
  mjvOption option;
  mjv_defaultOption(&option);
  mjtNum at[3];
  int geom = -1, flex = -1, skin = -1;
  if (mjv_select(model_.get(), data, &option, aspect, across, up, &renderer_.scene, at, &geom, &flex, &skin) <
      0)
    return {};
  return Point<'W'>(at[0], at[1], at[2]);
}

// The renderer has its own copy of each mesh. Only a mesh that is dented, or was, is given to it again.
void Painter::dent(const ViewRequest& request) {
  const int before = dented_;
  restore();
  if (request.dent) {
    if (whole_vertices_.empty()) {
      const mjModel& m = *model_;
      whole_vertices_.assign(m.mesh_vert, m.mesh_vert + std::ptrdiff_t{3} * m.nmeshvert);
      whole_normals_.assign(m.mesh_normal, m.mesh_normal + std::ptrdiff_t{3} * m.nmeshnormal);
    }
    dented_ = request.dent(model_.get());
  }
  if (before >= 0 && before != dented_) mjr_uploadMesh(model_.get(), &renderer_.context, before);
  if (dented_ >= 0) mjr_uploadMesh(model_.get(), &renderer_.context, dented_);
}

void Painter::restore() {
  if (dented_ < 0) return;
  std::copy(whole_vertices_.begin(), whole_vertices_.end(), model_->mesh_vert);
  std::copy(whole_normals_.begin(), whole_normals_.end(), model_->mesh_normal);
  dented_ = -1;
}

}  // namespace enc::sim
