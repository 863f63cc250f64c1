#include "hw_drivers/gcs/drive/lockstep_manipulator.h"

#include <utility>

#include "core/base/error.h"
#include "hw_drivers/gcs/wire/command.h"
#include "hw_drivers/gcs/wire/error_text.h"

namespace enc::gcs {

LockstepManipulator::LockstepManipulator(const Offer& offer, const GcsSettings& settings,
                                         std::unique_ptr<Link> link)
    : machine_(offer, settings, std::move(link)), period_(seconds(offer.period)) {
  if (!machine_.found().lockstep)
    throw Error(
        machine_.describe() + ": its time goes on by itself; leave out --lockstep, or begin the fake with it",
        {}, ErrorKind::device);
  sample_ = {machine_.at_first(), Vec<'R'>::zero(), Vec<'R'>::zero()};
}

Stamped<TipSample> LockstepManipulator::read(Time now) noexcept {
  send("POS?\n");
  Coordinates at{};
  if (linked_ && !read_axes(hear(), kAxisNames, at)) lose(": no position in time");
  if (linked_) {
    const Pose<'R', 'H'> before = sample_.X_RH;
    sample_.X_RH = pose_of(from_wire_units(at), machine_.found().stand);
    sample_.velocity = Vec<'R'>(Vec3((sample_.X_RH.p() - before.p()) / period_));
    sample_.acceleration = machine_.acceleration();
  }
  const Health health = machine_.aim().health == Health::ok ? said_ : machine_.aim().health;
  return {sample_, now, linked_ ? health : Health::fault};
}

// What is no pose is not sent: the last aim is told again, so that time goes on.
void LockstepManipulator::command(const Pose<'R', 'H'>& X_RH) noexcept {
  Text text;
  if (!add_move(text, machine_.aim(X_RH).to)) return;
  add_line(text, "ERR?");
  told_ = true;
  send(text.view());
  int error = kNoError;
  if (linked_ && !read_error(hear(), error)) lose(": no answer in time");
  said_ = error == kOutOfLimits ? Health::out_of_range : Health::ok;
  if (error != kNoError && error != kOutOfLimits) lose(" met " + error_words(error));
}

void LockstepManipulator::stop() noexcept {
  if (told_) send({&kStopByte, 1});
  machine_.stand();
}

void LockstepManipulator::lose(const std::string& why) noexcept {
  if (linked_) machine_.say(why);
  linked_ = false;
}

void LockstepManipulator::send(std::string_view bytes) noexcept {
  Link& link = machine_.link();
  if (!linked_) return;
  for (const Duration until = link.now() + from_seconds(machine_.settings().timeout); !bytes.empty();) {
    bytes.remove_prefix(link.send(bytes));
    if (!bytes.empty() && (link.closed() || link.now() > until)) return lose(": takes nothing more");
  }
}

std::string_view LockstepManipulator::hear() noexcept {
  Link& link = machine_.link();
  const Duration until = link.now() + from_seconds(machine_.settings().timeout);
  for (reader_.next();;) {
    heard_.remove_prefix(reader_.take(heard_));
    if (reader_.complete()) return reader_.answer();
    if (reader_.overflown() || link.closed() || link.now() > until) return {};
    constexpr Duration kTurn{1'000'000};
    link.wait(kTurn);
    heard_ = {bytes_.data(), link.receive(bytes_)};
  }
}

}  // namespace enc::gcs
