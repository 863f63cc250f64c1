// Fake cameras for a driver in another process: a local socket for each device of the rig, whose pictures
// come from the twin's stereo camera (wire/relay.h).
#pragma once

#include <cstdint>
#include <deque>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "core/devices/fake.h"
#include "hw_drivers/net/active_troubles.h"
#include "hw_drivers/v4l2/fake/encode.h"
#include "hw_drivers/v4l2/fake/node.h"
#include "hw_drivers/v4l2/wire/relay.h"

namespace enc::v4l2 {

// One device at its socket, with its clients.
class Door {
 public:
  // Throws Error (kind device) if it cannot listen there.
  Door(const std::string& name, NodeSpec spec);
  ~Door();
  Door(const Door&) = delete;
  Door& operator=(const Door&) = delete;

  [[nodiscard]] Node& node() { return node_; }
  [[nodiscard]] const std::string& name() const { return name_; }
  void serve();  // answers every waiting call
  void wait_on(std::vector<int>& descriptors) const;
  void plug(bool in);  // false: every client loses the device, and a new one finds none

 private:
  [[nodiscard]] bool answer(int client);  // false: the client is gone
  void let_in();

  std::string name_;
  Node node_;
  int socket_;
  std::vector<int> clients_;
  bool plugged_ = true;
};

struct ServerSettings {
  std::string left, right;  // names of sockets; right empty: side by side
  Pixels pixels = Pixels::yuyv;
  ImageSize each;
  double rate = 20.0;  // Hz
  std::uint64_t seed = 1;
  // The world waits for its client: frames are exposed when the client asks, and stamped with the world's
  // time.
  bool lockstep = false;
};

class Server final : public Fake {
 public:
  // `camera` outlives the server. Throws Error (kind device) if it cannot listen.
  Server(StereoCamera& camera, const ServerSettings& settings);

  [[nodiscard]] std::string describe() const override;
  void serve(Time now) override;
  void publish(Time now) override;
  void wait_on(std::vector<int>& descriptors) const override;
  [[nodiscard]] bool knows(const Trouble& trouble) const override;
  void suffer(const Trouble& trouble) override;
  void heal(Trouble::Kind kind) override;

 private:
  // A frame on its way, late by the jitter.
  struct Frame {
    Time due;
    std::size_t door = 0;
    std::uint32_t sequence = 0;
    Duration stamp{};
    std::vector<std::uint8_t> bytes;
    bool damaged = false;
  };
  void look(Time now);  // takes a due frame from the camera, and sends those that are due
  void expose(Time now, const Measurement<StereoFrame>& frame);
  void leave(Time now);
  [[nodiscard]] Duration steady_at(Time t) const;  // by CLOCK_MONOTONIC

  StereoCamera& camera_;
  ServerSettings settings_;
  std::vector<std::unique_ptr<Door>> doors_;
  Encoder encoder_;
  net::ActiveTroubles troubles_;
  std::deque<Frame> on_the_way_;
  std::deque<std::pair<Time, Duration>>
      instants_;  // the world's time and CLOCK_MONOTONIC, of the last second
  std::optional<Time> streams_since_;
};

// The fake of a rig's [driver.v4l2], in front of the twin's camera.
[[nodiscard]] std::unique_ptr<Fake> served(const FakeOffer& offer);

}  // namespace enc::v4l2
