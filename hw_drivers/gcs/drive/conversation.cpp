#include "hw_drivers/gcs/drive/conversation.h"

#include <algorithm>
#include <array>
#include <cmath>

#include "hw_drivers/gcs/wire/error_text.h"
#include "hw_drivers/gcs/wire/text.h"

namespace enc::gcs {
namespace {

constexpr int kMostWaiting = 2;                 // points in the controller's buffer
constexpr Duration kNever{-3'600'000'000'000};  // long ago, so that everything is due

// Health to report to the core for this error number of the controller.
Health health_of(int error) noexcept {
  if (error == kNoError) return Health::ok;
  return error == kOutOfLimits || error == kVelocityOutOfLimits ? Health::out_of_range : Health::fault;
}

}  // namespace

std::string_view words_of(Loss loss) noexcept {
  constexpr std::array<std::string_view, 8> kWords{
      "linked",
      "no answer in time",
      "closed by the controller",
      "an answer that is none",
      "a fault of the machine",
      "a servo is off",
      "it did not take driver.gcs.velocity_mm_s",
      "it did not take driver.gcs.path with driver.gcs.cycle_ms"};
  return kWords[static_cast<std::size_t>(loss)];
}

Conversation::Conversation(const GcsSettings& settings, const Stand& stand, const Coordinates& at,
                           Duration now, double fastest)
    : timeout_(from_seconds(settings.timeout)),
      cycle_(from_seconds(settings.cycle)),
      poll_(from_seconds(settings.poll)),
      watchdog_(from_seconds(settings.watchdog)),
      fastest_(fastest),
      velocity_(settings.velocity),
      by_points_(settings.path == "points"),
      stand_(stand),
      at_(at),
      due_(kNever),
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

std::string_view Conversation::send(Duration now) noexcept {
  out_.clear();
  if (loss_ != Loss::none) return {};
  if (awaiting_ != PendingQuery::nothing && now - asked_ > timeout_) {
    lose(Loss::silent);
    return {};
  }
  add_stop(now);
  if (awaiting_ == PendingQuery::nothing && now - asked_ >= poll_) add_question(now);
  return out_.view();
}

// A stop also goes out while an answer is pending. A stop that may have overtaken a set-point is sent again
// after that set-point's answer.
void Conversation::add_stop(Duration now) noexcept {
  const bool asked = order_.stops != report_.stops;
  const bool silent = moving_ && now - order_.given >= watchdog_;
  const bool again = overtaken_ && awaiting_ == PendingQuery::nothing;
  if (!asked && !silent && !again) return;
  out_.add(kStopByte);
  if (silent && !asked) {
    ++watchdogs_;
    sent_ = order_.number;
  }
  overtaken_ = awaiting_ != PendingQuery::nothing && carries_move_;
  report_.stops = order_.stops;
  moving_ = false;
  stopped_us_ = true;
  after_stop_ = false;
}

// Before the first set-point, set the velocity and the path source and read both back.
void Conversation::add_question(Duration now) noexcept {
  carries_move_ = false;
  if (ask_servos_) return ask("SVO?", PendingQuery::servos, now);
  const bool move =
      order_.number > std::max(sent_, order_.stopped) && now >= due_ && now - order_.given < watchdog_;
  if (move && velocity_ > 0.0) {
    add_velocity(out_, velocity_);
    return ask("VLS?", PendingQuery::velocity, now);
  }
  if (move && !path_told_) {
    by_points_ ? add_points(out_, seconds(cycle_)) : add_own_path(out_);
    return ask("SPA? X 0x19001900", PendingQuery::path, now);
  }
  // Points in the controller's buffer add delay. While some are pending, keep the newest set-point here,
  // where a later one replaces it.
  const bool full = by_points_ && room_ < most_room_ - kMostWaiting;
  if (move && !full) {
    point_ = next_point();
    carries_move_ = add_move(out_, point_);
    moving_ = moving_ || carries_move_;
    sent_ = order_.number;
    // On average one set-point goes each cycle, whatever the query times. Missed cycles are not made up for.
    due_ = now - due_ < cycle_ ? due_ + cycle_ : now + cycle_;
  }
  if (by_points()) out_.add(kRoomByte);
  ask("POS?", by_points() ? PendingQuery::room : PendingQuery::position, now);
}

// The next point towards the set-point, no farther than the speed limit allows in one cycle; without points,
// the set-point itself. The controller executes each point in one cycle, however late it arrives.
Coordinates Conversation::next_point() const noexcept {
  if (!by_points_) return order_.to;
  const Coordinates& from = moving_ ? point_ : at_;
  const double most = fastest_ * seconds(cycle_), way = distance(from, order_.to);
  if (!(way > most)) return order_.to;
  Coordinates to = from;
  for (std::size_t i = 0; i < kAxes; ++i) to[i] += (order_.to[i] - from[i]) * (most / way);
  return to;
}

void Conversation::ask(std::string_view line, PendingQuery what, Duration now) noexcept {
  add_line(out_, line);
  add_line(out_, "ERR?");
  awaiting_ = what;
  asked_ = now;
  after_stop_ = stopped_us_;
}

bool Conversation::take(std::string_view bytes, Duration now) noexcept {
  bool news = false;
  while (!bytes.empty() && loss_ == Loss::none) {
    bytes.remove_prefix(reader_.take(bytes));
    if (reader_.overflown() ||
        awaiting_ == PendingQuery::nothing) {  // too long, or an answer without a query
      lose(Loss::garbled);
      break;
    }
    if (!reader_.complete()) break;
    switch (awaiting_) {
      case PendingQuery::room:
        take_room();
        break;
      case PendingQuery::position:
        take_position(now);
        break;
      case PendingQuery::velocity:
        take_velocity();
        break;
      case PendingQuery::path:
        take_path();
        break;
      case PendingQuery::servos:
        take_servos();
        break;
      default:
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
  at_ = from_wire_units(wire);
  report_.X_RH = pose_of(at_, stand_);
  report_.t = asked_ + (now - asked_) / 2;
  // Measure the velocity over at least one cycle. Between two queries the time itself is too uncertain.
  if (report_.t - from_t_ >= cycle_) {
    report_.velocity = Vec<'R'>(Vec3((report_.X_RH.p() - from_) / seconds(report_.t - from_t_)));
    from_ = report_.X_RH.p();
    from_t_ = report_.t;
  }
  awaiting_ = PendingQuery::error;
}

void Conversation::take_velocity() noexcept {
  constexpr double kShare = 1e-3;  // a controller may round it
  double said = 0.0;
  if (!read_single(reader_.answer(), said)) return lose(Loss::garbled);
  if (!(std::abs(metres(said) - velocity_) <= kShare * velocity_)) return lose(Loss::velocity);
  velocity_ = 0.0;
  awaiting_ = PendingQuery::error;
}

void Conversation::take_room() noexcept {
  if (!read_error(reader_.answer(), room_) || room_ < 0) return lose(Loss::garbled);
  most_room_ = std::max(most_room_, room_);
  awaiting_ = PendingQuery::position;
}

// The answer looks like "X 0x19001900=1".
void Conversation::take_path() noexcept {
  const std::string_view said = reader_.answer();
  double source = kUnset;
  if (!read_single(said.substr(std::min(said.find('=') + 1, said.size())), source))
    return lose(Loss::garbled);
  if (source != (by_points_ ? 1.0 : 0.0)) return lose(Loss::path);
  path_told_ = true;
  awaiting_ = PendingQuery::error;
}

void Conversation::take_servos() noexcept {
  Coordinates on{};
  if (!read_axes(reader_.answer(), kAxisNames, on)) return lose(Loss::garbled);
  if (std::any_of(on.begin(), on.end(), [](double axis) { return axis != 1.0; }))
    return lose(Loss::servo_off);
  ask_servos_ = false;
  awaiting_ = PendingQuery::error;
}

// A stop by somebody else, or a fault of a strut, ends the motion for this run: a person who clears the fault
// may still be within reach. An out-of-range error stays until the controller accepts a set-point again.
void Conversation::take_error() noexcept {
  int error = 0;
  if (!read_error(reader_.answer(), error)) return lose(Loss::garbled);
  awaiting_ = PendingQuery::nothing;
  const bool ours = error == kStopped && stopped_us_;
  if (ours || after_stop_) stopped_us_ = false;
  if (ours) {
    error = kNoError;
    // A fault before our stop would have switched the servos off, and our stop replaced its error number.
    ask_servos_ = true;
  }
  if (error != kNoError) {
    report_.error = error;
    ++report_.errors;
  }
  if (error != kNoError || carries_move_) report_.health = health_of(error);
  if (report_.health == Health::fault) lose(Loss::fault);
}

}  // namespace enc::gcs
