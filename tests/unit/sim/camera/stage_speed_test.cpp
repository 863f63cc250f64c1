// What a pair costs beside MuJoCo's own calls. Printed, never judged: machines differ.
#include <algorithm>
#include <cstdio>
#include <ctime>
#include <vector>

#include <gtest/gtest.h>

#include "sim/camera/context.h"
#include "sim/camera/hand.h"
#include "sim/camera/scenery.h"
#include "sim/camera/stage.h"

namespace enc::sim {
namespace {

// mjv_updateScene, mjr_render twice and mjr_readPixels twice, of the same room and hand.
class Raw {
 public:
  explicit Raw(const StageSpec& spec)
      : context_(drawing_context()), model_(scenery_model(spec)), data_(mj_makeData(model_.get())) {
    mj_kinematics(model_.get(), data_.get());
    mjv_defaultScene(&scene_);
    mjr_defaultContext(&renderer_);
    mjv_makeScene(model_.get(), &scene_, 256);
    mjr_makeContext(model_.get(), &renderer_, mjFONTSCALE_50);
    mjr_resizeOffscreen(640, 480, &renderer_);
    mjr_setBuffer(mjFB_OFFSCREEN, &renderer_);
    mjv_defaultOption(&option_);
    mjv_defaultCamera(&camera_);
    pixels_.resize(3UL * 640 * 480);
  }
  ~Raw() {
    context_->make_current();
    mjr_freeContext(&renderer_);
    mjv_freeScene(&scene_);
  }
  Raw(const Raw&) = delete;
  Raw& operator=(const Raw&) = delete;

  void draw(const HandPose& hand) {
    context_->make_current();
    mjv_updateScene(model_.get(), data_.get(), &option_, nullptr, &camera_, mjCAT_ALL, &scene_);
    HandDrawing(model_.get(), scene_).add(hand, {}, scene_);
    for (mjtRndFlag flag : {mjRND_SHADOW, mjRND_REFLECTION, mjRND_SKYBOX, mjRND_FOG, mjRND_HAZE})
      scene_.flags[flag] = 0;
    scene_.nlight = std::min(scene_.nlight, 2);
    for (int eye = 0; eye < 2; ++eye) {
      mjvGLCamera& c = scene_.camera[0];
      c = {{eye * 0.09F, 0, 0}, {0, 0, 1}, {0, -1, 0}, 0, 0.0222F, -0.01664F, 0.01664F, 0.05F, 6.0F, 0};
      scene_.camera[1] = c;
      mjr_render({0, 0, 640, 480}, &scene_, &renderer_);
      mjr_readPixels(pixels_.data(), nullptr, {0, 0, 640, 480}, &renderer_);
    }
  }

 private:
  std::unique_ptr<DrawingContext> context_;
  ModelPtr model_;
  DataPtr data_;
  mjvScene scene_;
  mjrContext renderer_;
  mjvOption option_;
  mjvCamera camera_;
  std::vector<std::uint8_t> pixels_;
};

template <class Work>
double milliseconds(const Work& work) {  // of CPU
  const std::clock_t before = std::clock();
  work();
  return 1e3 * static_cast<double>(std::clock() - before) / CLOCKS_PER_SEC;
}

TEST(StageSpeed, BesideMuJoCosOwnCalls) {
  StageSpec spec;
  spec.sensor.noise = 0.0;
  Raw raw(spec);
  Stage plain(spec);
  spec.sensor.noise = 1.5;
  Stage noisy(spec);
  spec.camera.left.distortion = spec.camera.right.distortion = {-0.2, 0.05, 0.001, 0.001, 0};
  Stage bent(spec);
  const HandPose hand{{0.01, -0.03, 0.38}, {0.2, -1, 0}, 0.2};
  Image left, right;
  std::array<std::vector<double>, 4> ms;
  for (int i = 0; i < 25; ++i) {
    ms[0].push_back(milliseconds([&] { raw.draw(hand); }));
    Stage* stages[] = {&plain, &noisy, &bent};
    for (std::size_t s = 0; s < 3; ++s)
      ms[s + 1].push_back(milliseconds([&] { stages[s]->draw(&hand, {}, {}, 0, left, right); }));
  }
  for (auto& m : ms) std::nth_element(m.begin(), m.begin() + 12, m.end());
  std::printf(
      "CPU a pair of 640 x 480: MuJoCo's calls %.1f ms, stage %.1f (%.2f), with noise %.1f, bent too %.1f\n",
      ms[0][12], ms[1][12], ms[1][12] / ms[0][12], ms[2][12], ms[3][12]);
  EXPECT_FALSE(left.rgb.empty());
}

}  // namespace
}  // namespace enc::sim
