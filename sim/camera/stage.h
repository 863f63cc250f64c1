// What stands before the stereo head of the twin, drawn off screen: a background, a hand, light, lenses and
// sensors. Truth per pixel is for benchmarks and tests alone.
#pragma once

#include <array>
#include <cstdint>
#include <functional>
#include <memory>
#include <string>
#include <vector>

#include "core/base/frames.h"
#include "core/base/image.h"
#include "core/base/time.h"
#include "core/devices/stereo_camera.h"
#include "core/spec/vision/stereo_rig.h"
#include "sim/camera/shown.h"
#include "sim/spec/picture_spec.h"

namespace enc::sim {

struct SensorLook {
  double noise = 1.5;     // of 255, rms
  double exposure = 1.0;  // times the light
  Rgb white{1, 1, 1};     // gains of the channels
};

// What costs time and is off: a pair takes 19 to 40 ms of CPU without.
struct Finish {
  int samples = 0;  // of each pixel, for smooth edges; 0 or a power of two to 16
  bool shadows = false, reflections = false;
};

struct StageSpec {
  StereoRig camera;  // the true one
  Scenery scenery = Scenery::office;
  std::uint64_t seed = 1;  // of the scenery's things and colours, and of noise
  SensorLook sensor;
  Finish finish;
};

struct PixelTruth {
  Mask skin;                             // of the left image
  Mask things;                           // likewise: where one of Shown::things is what is seen
  std::vector<float> depth;              // m along z of C, of the left image; infinite where nothing is
  double column = kUnset, row = kUnset;  // of the centre of the cap, px, in the left image
  double radius = kUnset;                // of the circle of its outline's area, px
};

// Draws on the thread that made it: an OpenGL context belongs to one thread at a time.
class Stage {
 public:
  // Throws Error (kind device) where neither EGL nor OSMesa can draw.
  explicit Stage(const StageSpec& spec);
  virtual ~Stage();
  Stage(const Stage&) = delete;
  Stage& operator=(const Stage&) = delete;

  // `frame` seeds the noise. Truth where asked for. Throws Error where there are too many things.
  virtual void draw(const Shown& shown, std::uint64_t frame, Image& left, Image& right,
                    PixelTruth* truth = nullptr);
  // What was drawn last, exposed once more: the same picture with the noise of another frame. Nothing where
  // nothing was drawn.
  virtual void again(std::uint64_t frame, Image& left, Image& right);
  // A hand and nothing else; null: the background alone.
  void draw(const HandPose* hand, const HandLook& look, const Light& light, std::uint64_t frame, Image& left,
            Image& right, PixelTruth* truth = nullptr) {
    draw({hand != nullptr, hand != nullptr ? *hand : HandPose{}, look, light, {}}, frame, left, right, truth);
  }
  // The same picture by MuJoCo's own calls alone, mjr_render and mjr_readPixels for each eye, without lens,
  // sensor and images. For benchmarks.
  virtual void draw_only(const HandPose& hand, const HandLook& look);
  [[nodiscard]] virtual const char* renderer() const;  // "EGL", "OSMesa"

 private:
  struct Parts;
  std::unique_ptr<Parts> parts_;
};

using Show = std::function<Shown(Time exposed)>;

struct TwinCameraSpec {
  StageSpec stage;
  Time stalls = Time::max();  // no exposure from then on
  Time back = Time::max();    // until then
  Time swaps = Time::max();   // left and right are exchanged from then on
};

// The module encounter_camera. Whoever asks draws on the thread that asked.
struct CameraModule {
  std::unique_ptr<Stage> (*stage)(const StageSpec& spec) = nullptr;
  std::unique_ptr<StereoCamera> (*camera)(const TwinCameraSpec& spec, Show show) = nullptr;
  // Why EGL ("egl") or OSMesa ("osmesa") cannot draw; empty where it can.
  std::string (*renderer_problem)(const char* kind) = nullptr;
  std::string (*renderer_name)(const char* kind) = nullptr;  // OpenGL's; empty where it cannot draw
};

}  // namespace enc::sim
