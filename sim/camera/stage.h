// The scene in front of the twin's stereo head, drawn off screen: a background, a hand, light, lenses and
// sensors. Ground truth for each pixel is only for benchmarks and tests.
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
#include "core/devices/device.h"
#include "core/spec/optics_rig.h"
#include "sim/camera/camera_scene.h"
#include "sim/spec/sensor_spec.h"

namespace enc::sim {

struct SensorLook {
  double noise = 1.5;     // out of 255, rms
  double exposure = 1.0;  // factor on the light
  Rgb white{1, 1, 1};     // gains of the channels
};

// Options that cost time and are off by default. With any of them all is drawn anew for each picture.
struct Finish {
  int samples = 0;  // samples of each pixel, for smooth edges; 0 or a power of two to 16
  bool shadows = false, reflections = false;
};

struct StageSpec {
  StereoRig camera;  // true camera
  Scenery scenery = Scenery::office;
  std::uint64_t seed = 1;  // seeds the scenery's things and colours, and the noise
  SensorLook sensor;
  Finish finish;
};

struct PixelTruth {
  Mask skin;                             // left image
  Mask things;                           // left image: pixels that show one of CameraScene::things
  std::vector<float> depth;              // m along z of C, left image; infinite: no surface
  double column = kUnset, row = kUnset;  // centre of the cap, px, in the left image
  double radius = kUnset;                // radius of the circle with its outline's area, px
};

// Draws on the thread that made it: an OpenGL context belongs to one thread at a time.
class Stage {
 public:
  // Throws Error (kind device) if neither EGL nor OSMesa can draw.
  explicit Stage(const StageSpec& spec);
  virtual ~Stage();
  Stage(const Stage&) = delete;
  Stage& operator=(const Stage&) = delete;

  // Draws a pair; `frame` seeds the noise. Writes `truth` unless it is null. Throws Error if there are too
  // many things.
  virtual void draw(const CameraScene& shown, std::uint64_t frame, Image& left, Image& right,
                    PixelTruth* truth = nullptr);
  // Exposes the last drawing once more: the same picture with the noise of another frame. Does nothing before
  // the first drawing.
  virtual void again(std::uint64_t frame, Image& left, Image& right);
  // Draws a hand without things; null: only the background.
  void draw(const HandPose* hand, const HandLook& look, const Light& light, std::uint64_t frame, Image& left,
            Image& right, PixelTruth* truth = nullptr) {
    draw({hand != nullptr, hand != nullptr ? *hand : HandPose{}, look, light, {}}, frame, left, right, truth);
  }
  // Draws background and all in front of it at once, with only MuJoCo's own calls, mjr_render and
  // mjr_readPixels for each eye, without lens and noise; lowest row first. For benchmarks and tests.
  virtual void draw_at_once(const CameraScene& shown, Image& left, Image& right);
  [[nodiscard]] virtual const char* renderer() const;  // "EGL", "OSMesa"

 private:
  struct Parts;
  std::unique_ptr<Parts> parts_;
};

using Show = std::function<CameraScene(Time exposed)>;

struct TwinCameraSpec {
  StageSpec stage;
  Time stalls = Time::max();  // no exposure from then on
  Time back = Time::max();    // exposures resume then
  Time swaps = Time::max();   // left and right are exchanged from then on
};

// The module encounter_camera. It draws on the thread of the caller.
struct CameraModule {
  std::unique_ptr<Stage> (*stage)(const StageSpec& spec) = nullptr;
  std::unique_ptr<StereoCamera> (*camera)(const TwinCameraSpec& spec, Show show) = nullptr;
  // Reason why EGL ("egl") or OSMesa ("osmesa") cannot draw; empty if it can.
  std::string (*renderer_problem)(const char* kind) = nullptr;
  std::string (*renderer_name)(const char* kind) = nullptr;  // OpenGL's name; empty if it cannot draw
};

}  // namespace enc::sim
