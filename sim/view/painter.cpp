#include "sim/view/painter.h"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <cstring>
#include <numbers>

#include "core/base/error.h"

namespace enc::sim {
namespace {

mjvGeom* new_geom(mjvScene& scene, mjtGeom type, const Colour& colour) {
  if (scene.ngeom >= scene.maxgeom) throw Error("too many things in the picture", {}, ErrorKind::device);
  mjvGeom* geom = scene.geoms + scene.ngeom++;
  mjv_initGeom(geom, type, nullptr, nullptr, nullptr, colour.data());
  geom->category = mjCAT_DECOR;
  return geom;
}

// One lamp with shadows over the viewer's left shoulder, besides the headlight. The model's own lights are
// removed.
void light(mjvScene& scene) {
  const auto own = std::remove_if(scene.lights, scene.lights + scene.nlight,
                                  [](const mjvLight& l) { return l.headlight == 0; });
  scene.nlight = static_cast<int>(own - scene.lights);
  if (scene.nlight >= mjMAXLIGHT) return;
  mjvLight& lamp = scene.lights[scene.nlight++];
  lamp = mjvLight{};
  lamp.id = -1;
  lamp.type = mjLIGHT_DIRECTIONAL;
  const Vec3 direction = Vec3(0.45, 0.50, -1.0).normalized();
  for (int i = 0; i < 3; ++i) {
    lamp.dir[i] = static_cast<float>(direction(i));
    lamp.pos[i] = static_cast<float>(-1.0 * direction(i));
    lamp.diffuse[i] = 0.70F;
    lamp.specular[i] = 0.25F;
  }
  lamp.attenuation[0] = 1.0F;
  lamp.castshadow = 1;
}

}  // namespace

ModelPtr picture_model(const ViewRequest& request, int shadow_size, int stacks, int slices) {
  ModelPtr model(mj_copyModel(nullptr, request.model));
  if (!model) throw Error("not enough memory for a picture", {}, ErrorKind::device);
  model->vis.quality.offsamples = 0;  // a larger drawing replaces multisampling
  model->vis.quality.shadowsize = shadow_size;
  model->vis.quality.numslices = slices;
  model->vis.quality.numstacks = stacks;
  model->vis.global.fovy = static_cast<float>(request.camera.opening * 180.0 / std::numbers::pi);
  model->vis.map.zfar = 8.0F / static_cast<float>(std::max(1e-3, model->stat.extent));
  model->vis.map.shadowclip = 0.5F / static_cast<float>(std::max(1e-3, model->stat.extent));
  model->vis.map.znear = 0.05F / static_cast<float>(std::max(1e-3, model->stat.extent));
  std::fill_n(model->vis.headlight.ambient, 3, 0.36F);
  std::fill_n(model->vis.headlight.diffuse, 3, 0.34F);
  std::fill_n(model->vis.headlight.specular, 3, 0.10F);
  return model;
}

void add_extras(mjvScene& scene, const ViewRequest& request) {
  for (const ViewRod& rod : request.rods) {
    const mjtGeom type = rod.flat ? mjGEOM_CYLINDER : mjGEOM_CAPSULE;
    mjv_connector(new_geom(scene, type, rod.colour), type, rod.radius, rod.from.xyz.data(),
                  rod.to.xyz.data());
  }
  for (const ViewBox& box : request.boxes) {
    mjvGeom* geom = new_geom(scene, mjGEOM_BOX, box.colour);
    const Mat3 axes = box.q.toRotationMatrix();
    for (int i = 0; i < 3; ++i) {
      geom->pos[i] = static_cast<float>(box.middle.xyz[static_cast<std::size_t>(i)]);
      geom->size[i] = static_cast<float>(box.half(i));
      for (int j = 0; j < 3; ++j) geom->mat[3 * i + j] = static_cast<float>(axes(i, j));
    }
  }
  for (const ViewArrow& arrow : request.arrows) {
    const Point<'W'> to = arrow.from + arrow.along;
    mjvGeom* geom = new_geom(scene, mjGEOM_ARROW, arrow.colour);
    mjv_connector(geom, mjGEOM_ARROW, arrow.radius, arrow.from.xyz.data(), to.xyz.data());
    geom->size[2] *= 2.0F;  // mjv_connector draws an arrow twice as long
    geom->emission = 0.4F;  // keeps the dark side readable
    geom->castshadow = 0;
  }
  for (const ViewLabel& sign : request.signs) {
    mjvGeom* geom = new_geom(scene, mjGEOM_LABEL, {0, 0, 0, 1});
    for (int i = 0; i < 3; ++i) geom->pos[i] = static_cast<float>(sign.at.xyz[static_cast<std::size_t>(i)]);
    std::strncpy(geom->label, sign.text.c_str(), sizeof(geom->label) - 1);
  }
  if (!request.floor.finite()) return;
  mjvGeom* table = new_geom(scene, mjGEOM_CYLINDER, {0.66F, 0.68F, 0.71F, 1});
  const double thick = 0.005;
  table->size[0] = table->size[1] = 0.27F;
  table->size[2] = static_cast<float>(thick);
  for (int i = 0; i < 3; ++i)
    table->pos[i] = static_cast<float>(request.floor.xyz[static_cast<std::size_t>(i)]);
  table->pos[2] -= table->size[2];
  table->specular = 0.0F;
}

void add_backdrop(mjvScene& scene) {
  const mjvGLCamera& eye = scene.camera[0];
  mjvGeom* wall = new_geom(scene, mjGEOM_BOX, {1, 1, 1, 1});
  const Vec3 z = Vec3(eye.forward[0], eye.forward[1], eye.forward[2]).normalized();
  const Vec3 y = Vec3(eye.up[0], eye.up[1], eye.up[2]).normalized();
  const Vec3 x = y.cross(z);
  for (int i = 0; i < 3; ++i) {
    wall->pos[i] = eye.pos[i] + static_cast<float>(kBackdrop * z(i));
    wall->size[i] = i < 2 ? 10.0F : 0.01F;
    wall->mat[3 * i] = static_cast<float>(x(i));
    wall->mat[3 * i + 1] = static_cast<float>(y(i));
    wall->mat[3 * i + 2] = static_cast<float>(z(i));
  }
  wall->emission = 1.0F;
  wall->castshadow = 0;
}

void aim(mjvScene& scene, const mjModel* model, const ViewRequest& request, bool shadows) {
  mjvOption option;
  mjv_defaultOption(&option);
  mjvCamera camera;
  mjv_defaultCamera(&camera);
  camera.azimuth = request.camera.azimuth * 180.0 / std::numbers::pi;
  camera.elevation = request.camera.elevation * 180.0 / std::numbers::pi;
  camera.distance = request.camera.distance;
  std::copy_n(request.camera.look_at.xyz.begin(), 3, camera.lookat);
  mjv_updateScene(model, request.data, &option, nullptr, &camera, mjCAT_ALL, &scene);
  light(scene);
  // A translucent geom is virtual and casts no shadow.
  for (int i = 0; i < scene.ngeom; ++i)
    if (scene.geoms[i].rgba[3] < 1.0F) scene.geoms[i].castshadow = 0;
  scene.flags[mjRND_SHADOW] = shadows ? 1 : 0;
  scene.flags[mjRND_REFLECTION] = 0;
}

namespace {

constexpr int kNoShadows = 256;  // px: MuJoCo allocates a shadow map even if it is unused

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

// The renderer has its own copy of each mesh. Only a mesh that is or was deformed is uploaded again.
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
