// The stereo camera of the twin: a stage that is exposed at the rate of its rig.
#pragma once

#include <functional>
#include <limits>

#include "core/devices/device.h"
#include "sim/camera/stage.h"

namespace enc::sim {

class TwinCamera final : public StereoCamera {
 public:
  // Throws Error as Stage does.
  explicit TwinCamera(const TwinCameraSpec& spec, Show show);

  // Draws the scene from `show` once for each due exposure, stamped `now`, because that is the time it shows;
  // missed exposures are never drawn. The tracker handles the latency of the fingertip. After kSilent periods
  // without an exposure, it returns the last pair once more with a fault, and linked() is false until the
  // next exposure.
  bool poll(Time now, Measurement<StereoFrame>& newest) noexcept override;
  [[nodiscard]] bool linked() const noexcept override { return linked_; }
  [[nodiscard]] ImageSize size() const override { return spec_.stage.camera.size(); }
  [[nodiscard]] std::string describe() const override;
  [[nodiscard]] std::vector<std::string> remarks() const override;
  [[nodiscard]] std::uint64_t drawn() const { return drawn_; }  // number of pairs

  static constexpr double kSilent = 3.0;

 private:
  bool silent(Time now, Measurement<StereoFrame>& newest) noexcept;

  TwinCameraSpec spec_;
  Show show_;
  Stage stage_;
  DueTimes exposures_;
  Image left_, right_;
  Time exposed_{};
  std::uint64_t drawn_ = 0;
  bool linked_ = true;
  std::string failure_;  // reason why it stopped drawing
};

}  // namespace enc::sim
