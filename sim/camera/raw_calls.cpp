#include "sim/camera/raw_calls.h"

#include <algorithm>
#include <memory>
#include <vector>

#include "sim/camera/context.h"
#include "sim/camera/hand.h"
#include "sim/camera/scenery.h"
#include "sim/view/renderer.h"

namespace enc::sim {
namespace {

constexpr float kNear = 0.05F, kFar = 6.0F;  // m, as of a stage
constexpr int kRoom = 256;                   // geoms

class RawCalls {
 public:
  explicit RawCalls(const StageSpec& spec)
      : rig_(spec.camera),
        context_(drawing_context()),
        model_(scenery_model(spec)),
        data_(mj_makeData(model_.get())),
        all_{0, 0, static_cast<int>(rig_.width), static_cast<int>(rig_.height)},
        renderer_(model_.get(), kRoom, mjFONTSCALE_50, all_.width, all_.height),
        pixels_(3 * static_cast<std::size_t>(rig_.width) * static_cast<std::size_t>(rig_.height)) {
    mj_kinematics(model_.get(), data_.get());
    mjv_defaultOption(&option_);
    mjv_defaultCamera(&camera_);
  }
  ~RawCalls() { context_->make_current(); }
  RawCalls(const RawCalls&) = delete;
  RawCalls& operator=(const RawCalls&) = delete;

  void draw(const HandPose& hand) {
    context_->make_current();
    mjvScene& scene = renderer_.scene;
    mjv_updateScene(model_.get(), data_.get(), &option_, nullptr, &camera_, mjCAT_ALL, &scene);
    HandDrawing(model_.get(), scene).add(hand, {}, scene);
    for (const mjtRndFlag flag : {mjRND_SHADOW, mjRND_REFLECTION, mjRND_SKYBOX, mjRND_FOG, mjRND_HAZE})
      scene.flags[flag] = 0;
    scene.nlight = std::min(scene.nlight, 2);
    const auto half_width = static_cast<float>(0.5 * all_.width / rig_.left.focal_x) * kNear;
    const auto half_height = static_cast<float>(0.5 * all_.height / rig_.left.focal_y) * kNear;
    for (const double x : {0.0, rig_.X_CD.p().x()}) {
      scene.camera[0] = {{static_cast<float>(x), 0, 0},
                         {0, 0, 1},
                         {0, -1, 0},
                         0,
                         half_width,
                         -half_height,
                         half_height,
                         kNear,
                         kFar,
                         0};
      scene.camera[1] = scene.camera[0];
      mjr_render(all_, &scene, &renderer_.context);
      mjr_readPixels(pixels_.data(), nullptr, all_, &renderer_.context);
    }
  }

 private:
  StereoRig rig_;
  std::unique_ptr<DrawingContext> context_;
  ModelPtr model_;
  DataPtr data_;
  mjrRect all_;
  Renderer renderer_;
  mjvOption option_{};
  mjvCamera camera_{};
  std::vector<std::uint8_t> pixels_;
};

}  // namespace

std::function<void(const HandPose&)> raw_calls(const StageSpec& spec) {
  return [raw = std::make_shared<RawCalls>(spec)](const HandPose& hand) { raw->draw(hand); };
}

}  // namespace enc::sim
