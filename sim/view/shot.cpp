// The view module's one picture: MuJoCo's classic renderer at three times the size, background and lettering
// on top, then shrunk.
#include <algorithm>
#include <cmath>
#include <memory>
#include <numbers>

#include "core/error.h"
#include "core/module.h"
#include "sim/bodies/mujoco.h"
#include "sim/picture/picture.h"
#include "sim/view/egl.h"
#include "sim/view/labels.h"
#include "sim/view/renderer.h"
#include "sim/view/view.h"

namespace enc::sim {
namespace {

constexpr int kRoom = 1000;  // geoms
constexpr int kFiner = 3;    // smooth edges: drawn so many times larger
constexpr double kBackdrop =
    4.0;  // m from the eye; a white wall, because what is translucent must mix with something

// The model with its picture settings changed; physics never sees the copy.
ModelPtr picture_model(const ViewRequest& request) {
  ModelPtr model(mj_copyModel(nullptr, request.model));
  if (!model) throw Error("not enough memory for a picture", {}, ErrorKind::device);
  model->vis.quality.offsamples = 0;  // the picture is drawn larger instead
  model->vis.quality.shadowsize = 4096;
  model->vis.quality.numslices = 64;
  model->vis.quality.numstacks = 48;
  model->vis.global.fovy = static_cast<float>(request.camera.opening * 180.0 / std::numbers::pi);
  model->vis.map.zfar = 8.0F / static_cast<float>(std::max(1e-3, model->stat.extent));
  model->vis.map.shadowclip = 0.5F / static_cast<float>(std::max(1e-3, model->stat.extent));
  model->vis.map.znear = 0.05F / static_cast<float>(std::max(1e-3, model->stat.extent));
  std::fill_n(model->vis.headlight.ambient, 3, 0.36F);
  std::fill_n(model->vis.headlight.diffuse, 3, 0.34F);
  std::fill_n(model->vis.headlight.specular, 3, 0.10F);
  return model;
}

mjvGeom* new_geom(mjvScene& scene, mjtGeom type, const Colour& colour) {
  if (scene.ngeom >= scene.maxgeom) throw Error("too many things in the picture", {}, ErrorKind::device);
  mjvGeom* geom = scene.geoms + scene.ngeom++;
  mjv_initGeom(geom, type, nullptr, nullptr, nullptr, colour.data());
  geom->category = mjCAT_DECOR;
  return geom;
}

void add_extras(mjvScene& scene, const ViewRequest& request) {
  for (const ViewRod& rod : request.rods) {
    const mjtGeom type = rod.flat ? mjGEOM_CYLINDER : mjGEOM_CAPSULE;
    mjv_connector(new_geom(scene, type, rod.colour), type, rod.radius, rod.from.xyz.data(),
                  rod.to.xyz.data());
  }
  for (const ViewArrow& arrow : request.arrows) {
    const Point<'W'> to = arrow.from + arrow.along;
    mjvGeom* geom = new_geom(scene, mjGEOM_ARROW, arrow.colour);
    mjv_connector(geom, mjGEOM_ARROW, arrow.radius, arrow.from.xyz.data(), to.xyz.data());
    geom->size[2] *= 2.0F;  // an arrow is drawn half as long as mjv_connector makes it
    geom->emission = 0.4F;  // readable on its dark side too
  }
  if (std::isnan(request.floor)) return;
  mjvGeom* table = new_geom(scene, mjGEOM_CYLINDER, {0.66F, 0.68F, 0.71F, 1});
  const double thick = 0.005;
  table->size[0] = table->size[1] = 0.32F;
  table->size[2] = static_cast<float>(thick);
  table->pos[2] = static_cast<float>(request.floor - thick);
  table->specular = 0.0F;
}

// A wall that fills the picture, at right angles to the direction of sight.
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

// One lamp with shadows, over the viewer's left shoulder, besides the headlight. The model's own lights are
// left out.
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

void aim(Renderer& r, const mjModel* model, const ViewRequest& request) {
  mjvOption option;
  mjv_defaultOption(&option);
  mjvCamera camera;
  mjv_defaultCamera(&camera);
  camera.azimuth = request.camera.azimuth * 180.0 / std::numbers::pi;
  camera.elevation = request.camera.elevation * 180.0 / std::numbers::pi;
  camera.distance = request.camera.distance;
  std::copy_n(request.camera.look_at.xyz.begin(), 3, camera.lookat);
  mjv_updateScene(model, request.data, &option, nullptr, &camera, mjCAT_ALL, &r.scene);
  light(r.scene);
  r.scene.flags[mjRND_SHADOW] = 1;
  r.scene.flags[mjRND_REFLECTION] = 0;
}

// Multiplies the white backdrop, and what shines through from it, by a soft gradient.
void tint_backdrop(Image& picture, const std::vector<float>& depth, const mjvGLCamera& eye) {
  // Depth of a plane a little in front of the backdrop, as OpenGL stores it.
  const double from = static_cast<double>(eye.frustum_near);
  const double to = static_cast<double>(eye.frustum_far);
  const double behind = (1.0 / from - 1.0 / (0.9 * kBackdrop)) / (1.0 / from - 1.0 / to);
  for (int y = 0; y < picture.height; ++y) {
    const double share = static_cast<double>(y) / picture.height;
    const double tint[3] = {0.98 - 0.11 * share, 0.985 - 0.09 * share, 0.99 - 0.06 * share};
    const auto row =
        static_cast<std::size_t>(picture.height - 1 - y) * static_cast<std::size_t>(picture.width);
    for (int x = 0; x < picture.width; ++x) {
      if (static_cast<double>(depth[row + static_cast<std::size_t>(x)]) < behind) continue;
      for (int c = 0; c < 3; ++c)
        picture.at(x, y)[c] = static_cast<std::uint8_t>(picture.at(x, y)[c] * tint[c]);
    }
  }
}

Image drawn(Renderer& r, const ViewRequest& request) {
  const mjrRect all{0, 0, kFiner * request.width, kFiner * request.height};
  mjr_render(all, &r.scene, &r.context);
  Image picture(all.width, all.height);
  std::vector<float> depth(static_cast<std::size_t>(all.width) * static_cast<std::size_t>(all.height));
  mjr_readPixels(picture.rgb.data(), depth.data(), all, &r.context);
  flip(picture);
  tint_backdrop(picture, depth, r.scene.camera[0]);
  letter(picture, r.scene, r.context, request, kFiner);
  return shrunk(picture, kFiner);
}

std::string shot(const ViewRequest& request) {
  if (request.width < 64 || request.height < 64 || request.width > 4000 || request.height > 4000)
    throw Error("a picture is 64 to 4000 pixels wide and high");
  const OffscreenContext context;
  const ModelPtr model = picture_model(request);
  Renderer renderer(model.get(), kRoom, mjFONTSCALE_300, kFiner * request.width, kFiner * request.height);
  aim(renderer, model.get(), request);
  add_backdrop(renderer.scene);
  add_extras(renderer.scene, request);
  return png(drawn(renderer, request));
}

constexpr ViewModule kView{shot, png};
constexpr ModuleInfo kInfo{.name = "view", .view = &kView};

}  // namespace
}  // namespace enc::sim

extern "C" __attribute__((visibility("default"))) const enc::ModuleInfo* encounter_module() {
  return &enc::sim::kInfo;
}
