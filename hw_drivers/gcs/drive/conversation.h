// The dialogue with an inspected controller: which bytes to send when, and the meaning of received bytes. It
// uses neither sockets nor clocks. It queries positions continuously, one query at a time, and sends each new
// set-point along with a query. It stops the machine when no further set-point comes.
#pragma once

#include <cstdint>
#include <limits>
#include <string_view>

#include "core/base/sample.h"
#include "hw_drivers/gcs/drive/settings.h"
#include "hw_drivers/gcs/wire/coordinates.h"
#include "hw_drivers/gcs/wire/text.h"

namespace enc::gcs {

// The loop's newest order. Its numbers only grow, so that a late reader still sees every relevant change.
struct Order {
  std::int64_t number = 0;   // number of set-points
  std::int64_t stops = 0;    // number of stops
  std::int64_t stopped = 0;  // number of set-points at the last stop; those up to it are void
  Coordinates to{};
  Duration given{};  // drivers' clock when the loop gave it, not when this side read it
};

enum class Loss : std::uint8_t { none, silent, closed, garbled, fault, servo_off, velocity, path };
[[nodiscard]] std::string_view words_of(Loss loss) noexcept;

// The machine's newest report.
struct Report {
  Pose<'R', 'H'> X_RH;
  Vec<'R'> velocity;  // tip velocity, m/s
  Duration t{};       // drivers' clock at the position's time: between query and answer
  Health health = Health::ok;
  int error = 0;            // last nonzero error
  std::int64_t errors = 0;  // number of nonzero errors
  std::int64_t stops = 0;   // stops of Order that were sent
};

class Conversation {
 public:
  // `fastest`: speed limit of the platform, m/s. It limits the distance between two points, however far the
  // loop's set-points jump.
  Conversation(const GcsSettings& settings, const Stand& stand, const Coordinates& at, Duration now,
               double fastest = std::numeric_limits<double>::infinity());

  void told(const Order& order) noexcept { order_ = order; }
  // The bytes to send now; often empty. Valid until the next call.
  [[nodiscard]] std::string_view send(Duration now) noexcept;
  // Returns true if the report is new.
  bool take(std::string_view bytes, Duration now) noexcept;
  void closed() noexcept { lose(Loss::closed); }

  [[nodiscard]] const Report& report() const noexcept { return report_; }
  [[nodiscard]] Loss loss() const noexcept { return loss_; }
  [[nodiscard]] bool moving() const noexcept { return moving_; }  // commanded, and not stopped since
  // True once the controller has been set to a path made of points.
  [[nodiscard]] bool by_points() const noexcept { return by_points_ && path_told_; }
  [[nodiscard]] Duration longest_answer() const noexcept { return longest_; }
  [[nodiscard]] std::int64_t answers() const noexcept { return answers_; }
  [[nodiscard]] std::int64_t watchdogs() const noexcept { return watchdogs_; }
  // True if all stops are sent and none needs repeating: the controller has answered every command that a
  // stop may have overtaken.
  [[nodiscard]] bool stopped() const noexcept {
    return order_.stops == report_.stops && !overtaken_ && awaiting_ == PendingQuery::nothing;
  }

 private:
  // The pending query; each is followed by ERR?.
  enum class PendingQuery : std::uint8_t { nothing, room, position, velocity, path, servos, error };

  void lose(Loss loss) noexcept;
  void add_stop(Duration now) noexcept;
  void add_question(Duration now) noexcept;
  [[nodiscard]] Coordinates next_point() const noexcept;
  void ask(std::string_view line, PendingQuery what, Duration now) noexcept;
  void take_position(Duration now) noexcept;
  void take_room() noexcept;
  void take_velocity() noexcept;
  void take_path() noexcept;
  void take_servos() noexcept;
  void take_error() noexcept;

  Duration timeout_, cycle_, poll_, watchdog_;
  double fastest_;   // m/s
  double velocity_;  // velocity to command once, m/s; 0: not set, or done
  bool by_points_;
  bool path_told_ = false;  // commanded and read back
  // Free places in the point buffer at the last query; its capacity.
  int room_ = -1, most_room_ = -1;
  Stand stand_;
  AnswerReader reader_;
  Text out_;
  Order order_;
  Coordinates at_{}, point_{};  // last reported position, and last point sent
  std::int64_t sent_ = 0;       // number of the last set-point sent
  Duration due_, asked_;        // due time of the next set-point, and time of the last query
  bool moving_ = false;
  // Our own stop will cause an error 10 that has not come yet.
  bool stopped_us_ = false;
  bool carries_move_ = false;  // the pending query carries a move
  bool overtaken_ = false;     // a stop was sent during that query: the move may be executed after it
  bool after_stop_ = false;    // the pending query was sent after our stop
  bool ask_servos_ = false;    // our stop replaced the error number of an earlier fault: query the servos
  PendingQuery awaiting_ = PendingQuery::nothing;
  Report report_;
  Vec3 from_;  // start of the velocity's measurement: position and time
  Duration from_t_;
  Loss loss_ = Loss::none;
  Duration longest_{};
  std::int64_t answers_ = 0, watchdogs_ = 0;
};

}  // namespace enc::gcs
