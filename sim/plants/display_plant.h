// The headset as the core sees it: it draws the newest view at its own rate and deforms the shown object by
// the tracked tool. It sends the drawn surface back over UDP [VHMR 3.5, 4.3].
#pragma once

#include <array>

#include "core/base/sample.h"
#include "core/control/scene/scene.h"
#include "core/devices/view.h"
#include "sim/spec/twin_spec.h"
#include "sim/truth/random.h"

namespace enc::sim {

class DisplayPlant {
 public:
  struct Packet {
    Stamped<DentSample> sample;
    Time due{};
    bool waiting = false;
  };
  struct State {
    Every frame;
    View view;  // newest shown
    std::array<Packet, 64> on_wire;
    std::size_t head = 0;
    Stamped<DentSample> arrived;
    bool news = false;
  };
  DisplayPlant(const DisplayTruth& truth, const Scene& scene, std::uint64_t seed);

  [[nodiscard]] const State& state() const { return state_; }
  void restore(const State& state) { state_ = state; }
  void show(const View& view) noexcept { state_.view = view; }
  void advance(Time t);
  bool poll(Stamped<DentSample>& newest) noexcept;

 private:
  [[nodiscard]] DentSample draw() const;

  DisplayTruth truth_;
  const Scene& scene_;
  State state_;
};

}  // namespace enc::sim
