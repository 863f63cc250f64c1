#include "sim/plants/display_plant.h"

#include "core/base/error.h"
#include "core/shape/deformation/dent.h"

namespace enc::sim {

DisplayPlant::DisplayPlant(const DisplayTruth& truth, const Scene& scene, std::uint64_t seed)
    : truth_(truth), scene_(scene) {
  if (truth.latency * truth.rate > 60.0)
    throw Error("at most 60 frames can be on their way at once", "truth.display.latency");
  Stream phase(seed, "display");
  state_.frame = {truth.rate, 0, from_seconds(phase.uniform() / truth.rate)};
}

DentSample DisplayPlant::draw() const {
  const View& view = state_.view;
  if (view.object < 0 || view.tool < 0 || !view.X_WT.valid()) return {};
  const Object& object = scene_.objects[static_cast<std::size_t>(view.object)];
  return dent_of(object.surface, view.object,
                 object.X_WO.inverse() * (view.X_WT * scene_.tools[static_cast<std::size_t>(view.tool)].tip));
}

void DisplayPlant::advance(Time t) {
  for (Time at = state_.frame.next(); state_.frame.due(t); at = state_.frame.next()) {
    state_.on_wire[state_.head] = {{draw(), at, Health::ok}, at + from_seconds(truth_.latency), true};
    state_.head = (state_.head + 1) % state_.on_wire.size();
  }
  for (Packet& packet : state_.on_wire) {
    if (!packet.waiting || packet.due > t) continue;
    packet.waiting = false;
    if (state_.arrived.health == Health::absent || packet.sample.t > state_.arrived.t) {
      state_.arrived = packet.sample;
      state_.news = true;
    }
  }
}

bool DisplayPlant::poll(Stamped<DentSample>& newest) noexcept {
  if (!state_.news) return false;
  newest = state_.arrived;
  state_.news = false;
  return true;
}

}  // namespace enc::sim
