// The stereo camera of the twin: a stage that is exposed at the rate of its rig.
#pragma once

#include <functional>
#include <limits>

#include "core/devices/stereo_camera.h"
#include "sim/camera/stage.h"

namespace enc::sim {

class TwinCamera final : public StereoCamera {
 public:
  // Throws Error as Stage does.
  explicit TwinCamera(const TwinCameraSpec& spec, Show show);

  // Draws where an exposure is due: once, as `show` tells it, and stamped `now`, for that is what it shows;
  // those that were missed are never drawn. How late the fingertip is told is the tracker's business. After
  // kSilent periods without an exposure: once the last pair again, with fault, and linked() is false until
  // there is one again.
  bool poll(Time now, Stamped<StereoFrame>& newest) noexcept override;
  [[nodiscard]] bool linked() const noexcept override { return linked_; }
  [[nodiscard]] ImageSize size() const override { return spec_.stage.camera.size(); }
  [[nodiscard]] std::string describe() const override;
  [[nodiscard]] std::vector<std::string> remarks() const override;
  [[nodiscard]] std::uint64_t drawn() const { return drawn_; }  // pairs

  static constexpr double kSilent = 3.0;

 private:
  bool silent(Time now, Stamped<StereoFrame>& newest) noexcept;

  TwinCameraSpec spec_;
  Show show_;
  Stage stage_;
  Every exposures_;
  Image left_, right_;
  Time exposed_{};
  std::uint64_t drawn_ = 0;
  bool linked_ = true;
  std::string failure_;  // why it draws no more
};

}  // namespace enc::sim
