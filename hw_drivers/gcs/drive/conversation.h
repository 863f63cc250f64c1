// The talk with a controller that was inspected: which bytes go when, and what those that come mean. It knows
// neither sockets nor clocks. Positions are asked for again and again, one question at a time; set-points go
// along, where there is a new one; the machine is stopped where none comes any more.
#pragma once

#include <cstdint>
#include <limits>
#include <string_view>

#include "core/base/sample.h"
#include "hw_drivers/gcs/drive/settings.h"
#include "hw_drivers/gcs/wire/answer.h"
#include "hw_drivers/gcs/wire/coordinates.h"

namespace enc::gcs {

// The newest that the loop said. Numbers only grow, so that whoever comes late still sees all that counts.
struct Order {
  std::int64_t number = 0;   // of set-points
  std::int64_t stops = 0;    // of stops
  std::int64_t stopped = 0;  // the number at the last stop: what is not beyond it is void
  Coordinates to{};
  Duration given{};  // of the drivers' clock, when the loop gave it: not when this side saw it
};

enum class Loss : std::uint8_t { none, silent, closed, garbled, fault, servo_off, velocity, path };
[[nodiscard]] std::string_view words_of(Loss loss) noexcept;

// The newest that the machine said.
struct Report {
  Pose<'R', 'H'> X_RH;
  Vec<'R'> velocity;  // of the tip, m/s
  Duration t{};       // of the drivers' clock, when the position was true: between question and answer
  Health health = Health::ok;
  int error = 0;            // the last that was no zero
  std::int64_t errors = 0;  // how many were not
  std::int64_t stops = 0;   // of Order, which were sent
};

class Conversation {
 public:
  // `fastest`: of the platform, m/s. No point is farther from the last one than that, however the loop leaps.
  Conversation(const GcsSettings& settings, const Stand& stand, const Coordinates& at, Duration now,
               double fastest = std::numeric_limits<double>::infinity());

  void told(const Order& order) noexcept { order_ = order; }
  // What is to be sent now; often nothing. It stays until the next call.
  [[nodiscard]] std::string_view send(Duration now) noexcept;
  // True where the report is new.
  bool take(std::string_view bytes, Duration now) noexcept;
  void closed() noexcept { lose(Loss::closed); }

  [[nodiscard]] const Report& report() const noexcept { return report_; }
  [[nodiscard]] Loss loss() const noexcept { return loss_; }
  [[nodiscard]] bool moving() const noexcept { return moving_; }  // told to, and not stopped since
  // The controller was told that its path is made of points.
  [[nodiscard]] bool by_points() const noexcept { return by_points_ && path_told_; }
  [[nodiscard]] Duration longest_answer() const noexcept { return longest_; }
  [[nodiscard]] std::int64_t answers() const noexcept { return answers_; }
  [[nodiscard]] std::int64_t watchdogs() const noexcept { return watchdogs_; }
  // No stop is to go once more: none was asked for, or what might have come behind it was answered.
  [[nodiscard]] bool stopped() const noexcept {
    return order_.stops == report_.stops && !overtaken_ && awaiting_ == Awaiting::nothing;
  }

 private:
  // What the question under way asks for; each is followed by ERR?.
  enum class Awaiting : std::uint8_t { nothing, room, position, velocity, path, servos, error };

  void lose(Loss loss) noexcept;
  void add_stop(Duration now) noexcept;
  void add_question(Duration now) noexcept;
  [[nodiscard]] Coordinates next_point() const noexcept;
  void ask(std::string_view line, Awaiting what, Duration now) noexcept;
  void take_position(Duration now) noexcept;
  void take_room() noexcept;
  void take_velocity() noexcept;
  void take_path() noexcept;
  void take_servos() noexcept;
  void take_error() noexcept;

  Duration timeout_, cycle_, poll_, watchdog_;
  double fastest_;   // m/s
  double velocity_;  // to be told once, m/s; 0: not, or no more
  bool by_points_;
  bool path_told_ = false;          // and read back
  int room_ = -1, most_room_ = -1;  // of the buffer of points, when it was asked last; with none in it
  Stand stand_;
  AnswerReader reader_;
  Text out_;
  Order order_;
  Coordinates at_{}, point_{};  // where it was said to be, and the last point that was sent
  std::int64_t sent_ = 0;       // number of the set-point that was sent last
  Duration due_, asked_;        // when the next set-point may go, and the last question went
  bool moving_ = false;
  bool stopped_us_ = false;    // our own stop is the reason of an error 10 that is still to come
  bool carries_move_ = false;  // the question under way
  bool overtaken_ = false;     // a stop went after it: it may be carried out after that
  bool after_stop_ = false;    // the question under way went after that stop
  bool ask_servos_ = false;    // our stop took the place of whatever error was there
  Awaiting awaiting_ = Awaiting::nothing;
  Report report_;
  Vec3 from_;  // where and when velocity is counted from
  Duration from_t_;
  Loss loss_ = Loss::none;
  Duration longest_{};
  std::int64_t answers_ = 0, watchdogs_ = 0;
};

}  // namespace enc::gcs
