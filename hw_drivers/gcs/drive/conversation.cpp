#include "hw_drivers/gcs/drive/conversation.h"

#include <algorithm>
#include <array>

#include "hw_drivers/gcs/wire/command.h"
#include "hw_drivers/gcs/wire/error_text.h"

namespace enc::gcs {
namespace {

constexpr Duration kNever{-3'600'000'000'000};  // so long ago that everything is due

// What the core is to believe of a machine that answered with this number.
Health health_of(int error) noexcept {
  if (error == kNoError) return Health::ok;
  return error == kOutOfLimits || error == kVelocityOutOfLimits ? Health::out_of_range : Health::fault;
}

}  // namespace

std::string_view words_of(Loss loss) noexcept {
  constexpr std::array<std::string_view, 5> kWords{"linked", "no answer in time", "closed by the controller",
                                                   "an answer that is none", "a fault of the machine"};
  return kWords[static_cast<std::size_t>(loss)];
}

Conversation::Conversation(const GcsSettings& settings, const Stand& stand, const Coordinates& at,
                           Duration now)
    : timeout_(from_seconds(settings.timeout)),
      cycle_(from_seconds(settings.cycle)),
      poll_(from_seconds(settings.poll)),
      watchdog_(from_seconds(settings.watchdog)),
      velocity_(settings.velocity),
      stand_(stand),
      moved_(kNever),
      asked_(kNever),
      from_t_(now) {
  report_.X_RH = pose_of(at, stand);
  report_.velocity = Vec<'R'>::zero();
  report_.t = now;
  from_ = report_.X_RH.p();
}

void Conversation::lose(Loss loss) noexcept {
  if (loss_ == Loss::none) loss_ = loss;
}

void Conversation::told(const Order& order) noexcept {
  fresh_ = order.given;
  order_ = order;
}

std::string_view Conversation::send(Duration now) noexcept {
  out_.clear();
  if (loss_ != Loss::none) return {};
  if (awaiting_ != Awaiting::nothing && now - asked_ > timeout_) {
    lose(Loss::silent);
    return {};
  }
  add_stop(now);
  if (awaiting_ == Awaiting::nothing && now - asked_ >= poll_) add_question(now);
  return out_.view();
}

// Also while an answer is awaited: a stop waits for nobody.
void Conversation::add_stop(Duration now) noexcept {
  const bool asked = order_.stops != report_.stops;
  const bool silent = moving_ && now - fresh_ >= watchdog_;
  if (!asked && !silent) return;
  out_.add(kStopByte);
  if (silent && !asked) {
    ++watchdogs_;
    sent_ = order_.number;
  }
  report_.stops = order_.stops;
  moving_ = false;
  stopped_us_ = true;
  after_stop_ = false;
}

void Conversation::add_question(Duration now) noexcept {
  carries_velocity_ = false;
  carries_move_ =
      order_.number > std::max(sent_, order_.stopped) && now - moved_ >= cycle_ && now - fresh_ < watchdog_;
  if (carries_move_) {
    carries_velocity_ = velocity_ > 0.0;
    if (carries_velocity_) add_velocity(out_, velocity_);
    velocity_ = 0.0;
    carries_move_ = add_move(out_, order_.to);
    moving_ = moving_ || carries_move_;
    sent_ = order_.number;
    moved_ = now;
  }
  add_line(out_, "POS?");
  add_line(out_, "ERR?");
  awaiting_ = Awaiting::position;
  asked_ = now;
  after_stop_ = stopped_us_;
}

bool Conversation::take(std::string_view bytes, Duration now) noexcept {
  bool news = false;
  while (!bytes.empty() && loss_ == Loss::none) {
    bytes.remove_prefix(reader_.take(bytes));
    if (reader_.overflown() || awaiting_ == Awaiting::nothing) {  // too long, or to no question
      lose(Loss::garbled);
      break;
    }
    if (!reader_.complete()) break;
    if (awaiting_ == Awaiting::position) {
      take_position(now);
    } else {
      take_error();
      longest_ = std::max(longest_, now - asked_);
      ++answers_;
    }
    reader_.next();
    news = true;
  }
  return news;
}

void Conversation::take_position(Duration now) noexcept {
  Coordinates wire{};
  if (!read_axes(reader_.answer(), kAxisNames, wire)) return lose(Loss::garbled);
  report_.X_RH = pose_of(from_wire_units(wire), stand_);
  report_.t = asked_ + (now - asked_) / 2;
  // Over a cycle at least: between two questions the time itself is not known well enough.
  if (report_.t - from_t_ >= cycle_) {
    report_.velocity = Vec<'R'>(Vec3((report_.X_RH.p() - from_) / seconds(report_.t - from_t_)));
    from_ = report_.X_RH.p();
    from_t_ = report_.t;
  }
  awaiting_ = Awaiting::error;
}

// Who was stopped by another hand, or by a strut, moves no more in this run: what is cured meanwhile is cured
// by a person, who may still be within reach. What is out of range stays so until a set-point is taken again.
void Conversation::take_error() noexcept {
  int error = 0;
  if (!read_error(reader_.answer(), error)) return lose(Loss::garbled);
  awaiting_ = Awaiting::nothing;
  const bool ours = error == kStopped && stopped_us_;
  if (ours || after_stop_) stopped_us_ = false;
  if (ours) error = kNoError;
  if (error != kNoError) {
    report_.error = error;
    ++report_.errors;
  }
  if (error != kNoError || carries_move_) report_.health = health_of(error);
  // Nor does one that would not take the velocity: it would go with another one.
  if (report_.health == Health::fault || (error != kNoError && carries_velocity_)) lose(Loss::fault);
}

}  // namespace enc::gcs
