#include "hw_drivers/gcs/drive/controller_driver.h"

#include <array>
#include <utility>

#include <fmt/format.h>

#include "core/base/error.h"
#include "hw_drivers/gcs/wire/error_text.h"
#include "hw_drivers/gcs/wire/text.h"

namespace enc::gcs {
namespace {

// Answer time before the run: the controller is slow with some queries.
constexpr Duration kAnswer{1'000'000'000};
constexpr Duration kPause{1'000'000};

ServoLaw law_of(const ManipulatorRig& rig) {
  return {rig.servo, rig.servo_damping, rig.speed, rig.acceleration};
}

}  // namespace

ControllerDriver::ControllerDriver(const Offer& offer, const GcsSettings& settings,
                                   std::unique_ptr<Link> link)
    : settings_(settings),
      log_(offer.log),
      link_(std::move(link)),
      found_(inspect([this](std::string_view line) { return ask(*link_, settings_, line); }, settings_,
                     offer.reach)),
      reach_(offer.reach),
      at_first_(pose_of(found_.at, found_.stand)),
      aim_{at_first_, found_.at, Health::ok},
      servo_(law_of(offer.rig.manipulator), offer.rig.manipulator.delay, seconds(offer.period),
             settings_.step, offer.reach.machine.zero().p()) {
  reach_.speed = found_.velocity;
  stand();
  // Each run ends with a stop, which leaves error 10 until the next ERR?. This is not worth a message.
  if (found_.left_over != kNoError && found_.left_over != kStopped)
    say(fmt::format(": an error of before this run: {}", error_words(found_.left_over)));
}

std::string ControllerDriver::describe() const {
  return fmt::format("{} at {}, firmware {}, referenced", found_.identity, settings_.place(),
                     found_.firmware.empty() ? "unknown" : found_.firmware);
}

const Aim& ControllerDriver::aim(const Pose<'R', 'H'>& X_RH) noexcept {
  Coordinates to{};
  const bool within = X_RH.valid() && reach_.contains(X_RH);
  if (!X_RH.valid() || !coordinates_of(within ? X_RH : clamped(reach_, aim_.X_RH, X_RH), found_.stand, to)) {
    aim_.health = Health::fault;
    stand();
    return aim_;
  }
  const bool beyond = found_.travel.clamp(to);
  aim_ = {pose_of(to, found_.stand), to, !beyond && within ? Health::ok : Health::out_of_range};
  servo_.next(aim_.X_RH.p());
  return aim_;
}

std::string ask(Link& link, const GcsSettings& settings, std::string_view line) {
  const auto failed = [&](const std::string& what) {
    return Error(fmt::format("{}: {}", settings.place(), what), {}, ErrorKind::device);
  };
  Text text;
  const bool byte = line.size() == 1 && line[0] < ' ';  // a question of one byte has no end of line
  byte ? void(text.add(line)) : add_line(text, line);
  const std::string shown = byte ? fmt::format("#{}", static_cast<int>(line[0])) : std::string(line);
  std::string_view unsent = text.view();
  AnswerReader reader;
  std::array<char, kMostText> bytes{};
  for (const Duration until = link.now() + kAnswer; !reader.complete(); link.wait(kPause)) {
    unsent.remove_prefix(link.send(unsent));
    const std::string_view more(bytes.data(), link.receive(bytes));
    if (reader.take(more) != more.size() || reader.overflown())
      throw failed(fmt::format("said more than an answer to {}; see that it is a C-887", shown));
    if (reader.complete()) break;
    if (link.closed()) throw failed("closed the connection; close other clients (PIMikroMove) and try again");
    if (link.now() > until)
      throw failed(fmt::format("no answer to {} within {:.0f} ms; see that it is a C-887, and ready", shown,
                               1e3 * seconds(kAnswer)));
  }
  return std::string(reader.answer());
}

}  // namespace enc::gcs
