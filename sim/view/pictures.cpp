// The view module: MuJoCo's classic renderer at twice or three times the size of the picture, background and
// lettering on top, then shrunk.
#include <algorithm>
#include <cmath>
#include <memory>

#include "core/base/error.h"
#include "core/devices/module.h"
#include "sim/bodies/mujoco.h"
#include "sim/picture/picture.h"
#include "sim/view/drawing.h"
#include "sim/view/egl.h"
#include "sim/view/labels.h"
#include "sim/view/painter.h"
#include "sim/view/view.h"

namespace enc::sim {
namespace {

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

// Settings of each Finish.
struct Fineness {
  int finer;  // drawn so many times larger and shrunk: smooth edges
  int shadow_size;
  int stacks;                           // of a round body
  mjtFontScale letters, small_letters;  // small: of a picture that is less than kLow high
};
constexpr Fineness kStill{3, 4096, 48, mjFONTSCALE_300, mjFONTSCALE_200};
constexpr Fineness kFilm{2, 2048, 16, mjFONTSCALE_200, mjFONTSCALE_150};
constexpr int kLow = 500;  // px

class OffscreenPictures final : public Pictures {
 public:
  OffscreenPictures(const ViewRequest& first, const Fineness& fineness)
      : finer_(fineness.finer),
        all_{0, 0, finer_ * first.width, finer_ * first.height},
        painter_(first,
                 {fineness.shadow_size, fineness.stacks, PaintSettings{}.slices,
                  first.height < kLow ? fineness.small_letters : fineness.letters, all_.width, all_.height}),
        depth_(static_cast<std::size_t>(all_.width) * static_cast<std::size_t>(all_.height)) {}

  Image draw(const ViewRequest& request) override {
    context_.make_current();
    painter_.paint(request, all_);
    Image picture(all_.width, all_.height);
    mjr_readPixels(picture.rgb.data(), depth_.data(), all_, &painter_.context());
    flip(picture);
    tint_backdrop(picture, depth_, painter_.scene().camera[0]);
    letter(picture, painter_.scene(), painter_.context(), request, finer_);
    return shrunk(picture, finer_);
  }

 private:
  OffscreenContext context_;  // before the painter, which is made and destroyed in it
  int finer_;
  mjrRect all_;
  Painter painter_;
  std::vector<float> depth_;
};

std::unique_ptr<Pictures> open(const ViewRequest& first, Finish finish) {
  if (first.width < 64 || first.height < 64 || first.width > 4000 || first.height > 4000)
    throw Error("a picture is 64 to 4000 pixels wide and high");
  return std::make_unique<OffscreenPictures>(first, finish == Finish::still ? kStill : kFilm);
}

constexpr ViewModule kView{open, png};
constexpr ModuleInfo kInfo{.name = "view", .view = &kView};

}  // namespace
}  // namespace enc::sim

extern "C" __attribute__((visibility("default"))) const enc::ModuleInfo* encounter_module() {
  return &enc::sim::kInfo;
}
