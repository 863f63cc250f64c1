// The view module's one picture: MuJoCo's classic renderer at three times the size, background and lettering
// on top, then shrunk.
#include <algorithm>
#include <cmath>
#include <memory>

#include "core/error.h"
#include "core/module.h"
#include "sim/bodies/mujoco.h"
#include "sim/picture/picture.h"
#include "sim/view/drawing.h"
#include "sim/view/egl.h"
#include "sim/view/labels.h"
#include "sim/view/renderer.h"
#include "sim/view/view.h"

namespace enc::sim {
namespace {

constexpr int kFiner = 3;       // smooth edges: drawn so many times larger
constexpr int kShadows = 4096;  // px of the shadow map

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
  const ModelPtr model = picture_model(request, kShadows);
  if (request.dent) request.dent(model.get());
  Renderer renderer(model.get(), kRoom, mjFONTSCALE_300, kFiner * request.width, kFiner * request.height);
  aim(renderer.scene, model.get(), request, true);
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
