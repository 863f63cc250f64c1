// A force/torque sensor on an ATI Net Box [VHMR 2]. The loop reads its records: received data are already in
// the socket, and it never waits. The readings are raw: the core handles zero and weight.
#pragma once

#include <array>
#include <cstddef>
#include <memory>
#include <span>
#include <string>
#include <vector>

#include "core/base/time.h"
#include "core/devices/driver.h"
#include "core/devices/fake.h"
#include "hw_drivers/net/clocks.h"
#include "hw_drivers/net/socket.h"
#include "hw_drivers/netft/drive/session.h"
#include "hw_drivers/netft/drive/settings.h"
#include "hw_drivers/netft/wire/page.h"

namespace enc::netft {

// ---- the inspection of a box, before it is asked to send

// The raw HTTP page; throws Error (kind device) if no page comes.
[[nodiscard]] std::string fetch(const NetftSettings& settings, const std::string& path);

// The answer of the command interface to READCALINFO; empty: no server listens there. Throws Error (kind
// device) if a server accepts and does not answer.
[[nodiscard]] std::vector<std::byte> ask_calibration(const NetftSettings& settings);
// Throws Error (kind device) if the answer is invalid, or if its units differ from the page's.
void agree(std::span<const std::byte> answer, const Configuration& page, const NetftSettings& settings);

// The content of the page. Throws Error (kind device): another device, unknown units, no records, fewer of
// them than the loop needs, or less range than the rig states.
[[nodiscard]] Configuration inspect(const std::string& xml, const NetftSettings& settings, Duration period);

// ---- the device
class NetftSensor final : public ForceSensor {
 public:
  // Fetches its page and a first record. Throws Error (kind device).
  NetftSensor(const Offer& offer, const NetftSettings& settings);
  NetftSensor(const NetftSensor&) = delete;
  NetftSensor& operator=(const NetftSensor&) = delete;
  ~NetftSensor() override;  // asks the box to stop

  [[nodiscard]] std::string describe() const override;
  [[nodiscard]] bool is_fake() const override { return found_.serial.find(kFakeName) != std::string::npos; }
  [[nodiscard]] bool linked() const noexcept override { return linked_; }
  [[nodiscard]] std::vector<std::string> remarks() const override;
  Measurement<Wrench> read(Time now) noexcept override;

 private:
  void ask(Command command) noexcept;
  void first_record();
  void find_counter_rate();
  bool receive() noexcept;  // receives into datagram_
  // s, from the last record to the last read; always 0 in lockstep.
  [[nodiscard]] double silence() const noexcept;

  NetftSettings settings_;
  Configuration found_;
  double counter_rate_ = kNetBoxRate;  // Hz
  Session session_;
  net::Socket socket_;
  net::Arrival arrival_;
  Duration period_;                        // period of the loop
  std::array<std::byte, 256> datagram_{};  // longer datagrams are not records
  std::size_t size_ = 0;
  Time begun_{}, heard_{}, read_{};
  // A run without a wall clock always uses Encounter's own fake.
  bool lockstep_, wall_clock_;
  bool reading_ = false, linked_ = true;
  bool agreed_ = false;  // the command interface was queried too
};

[[nodiscard]] std::unique_ptr<ForceSensor> streaming(const Offer& offer);

}  // namespace enc::netft
