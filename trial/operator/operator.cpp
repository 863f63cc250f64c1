#include "trial/operator/operator.h"

#include <algorithm>
#include <array>
#include <cerrno>
#include <csignal>
#include <cstdio>
#include <span>

#include <fmt/format.h>
#include <poll.h>
#include <termios.h>
#include <unistd.h>

#include "core/base/error.h"

namespace enc::trial {
namespace {

// m: reach of the machine from its zero along a direction of R, straight and without rotation.
double reach_along(const Reach& reach, const Vec3& direction) {
  const Pose<'R', 'H'> zero = reach.machine.zero();
  double reached = 0.0, beyond = 0.5;
  for (int i = 0; i < 24; ++i) {
    const double middle = 0.5 * (reached + beyond);
    const bool inside = reach.contains(Pose<'R', 'H'>(zero.q(), Vec3(zero.p() + middle * direction)));
    (inside ? reached : beyond) = middle;
  }
  return reached;
}

std::string manipulator_text(const Reach& reach) {
  std::array<std::string, 3> ways;
  for (int axis = 0; axis < 3; ++axis) {
    const Vec3 direction = Vec3::Unit(axis);
    ways[static_cast<std::size_t>(axis)] = fmt::format(
        "{:.0f} to {:.0f}", -1e3 * reach_along(reach, -direction), 1e3 * reach_along(reach, direction));
  }
  return fmt::format(
      "moves {}, {}, {} mm along x, y, z from its zero, at most at {:.0f} mm/s and {:.2f} m/s2", ways[0],
      ways[1], ways[2], 1e3 * reach.speed, reach.acceleration);
}

std::string arm_text(const ArmRig& rig) {
  return fmt::format("pushes with at most {:.1f} N; its target moves at most at {:.0f} mm/s", rig.peak,
                     1e3 * rig.speed);
}

}  // namespace

bool moves_device(const models::Setup& setup) {
  const std::vector<DrivenRole> roles = driven_roles(setup);
  return std::any_of(roles.begin(), roles.end(), [](const DrivenRole& role) { return role.moves; });
}

std::string motion_text(const models::Setup& setup, const Scene& scene,
                        const std::vector<DeviceWords>& devices) {
  std::string text;
  for (const DrivenRole& role : driven_roles(setup)) {
    if (!role.moves) continue;
    const std::string table = role.key.substr(4, role.key.find('.', 4) - 4);  // "rig.force.driver"
    const auto device =
        std::find_if(devices.begin(), devices.end(), [&](const auto& one) { return one.role == table; });
    text +=
        fmt::format("{:12}{}\n{:12}{}\n", table, device == devices.end() ? role.driver : device->words, "",
                    table == "manipulator" ? manipulator_text(scene.reach)
                    : table == "arm"       ? arm_text(setup.rig.arm)
                                           : fmt::format("clamps with {:.0f} N", setup.rig.gripper.force));
  }
  return text;
}

std::string motion_question(const models::Setup& setup, const Scene& scene,
                            const std::vector<DeviceWords>& devices) {
  return "armed: this run moves\n" + motion_text(setup, scene, devices) +
         "Clear its way. Enter begins, Ctrl-C leaves (--yes begins without this question): ";
}

Answer ask(const std::string& question, const std::function<bool()>& stopped) {
  tcflush(STDIN_FILENO, TCIFLUSH);
  fmt::print(stderr, "{}", question);
  std::fflush(stderr);
  std::string line;
  while (!stopped()) {
    char c = 0;
    pollfd ready{STDIN_FILENO, POLLIN, 0};
    if (poll(&ready, 1, 100) <= 0) continue;  // the signal may have come before poll() waited
    const ssize_t got = read(STDIN_FILENO, &c, 1);
    if (got < 0 && errno == EINTR) continue;
    if (got <= 0) return Answer::no;
    if (c == '\n') return line.empty() ? Answer::yes : Answer::no;
    line += c;
  }
  return Answer::stopped;
}

void refuse_unasked() {
  const bool hears = isatty(STDIN_FILENO) != 0, shows = isatty(STDERR_FILENO) != 0;
  if (hears && shows) return;
  throw Error(fmt::format(
      "--armed: an armed run asks before the first motion, and standard {} is no terminal; expected a person "
      "who reads the question and answers; clear the machine's way and add --yes",
      hears ? "error" : "input"));
}

int Operator::signal() const noexcept {
  if (const int caught = Signals::caught(); caught != 0) return caught;
  return stops_ && keys_.lost() ? SIGHUP : 0;  // the operator can no longer stop the motion
}

bool Operator::stop() noexcept {
  // A clock in a long wait calls only this function. Nothing moves before the keys are read.
  const bool at_rest = !stops_ || !listens_;
  if (at_rest && Signals::take_suspension()) suspend();
  return signal() != 0 || quits_;
}

void Operator::suspend() noexcept {
  if (pauses) pauses();
  keys_.release();
  signals_.suspend();
  keys_.take();
  static_cast<void>(Signals::take_continued());
}

Hand Operator::next() noexcept {
  // The tick before has stopped all motion.
  if (suspending_) suspend();
  suspending_ = false;
  if (Signals::take_continued()) keys_.renew();
  bool halt = Signals::take_halt(), resume = Signals::take_resume();
  std::array<char, 64> keys{};
  const std::size_t pressed = keys_.read(keys);
  for (const char key : std::span(keys).first(pressed)) {
    halt = halt || key == ' ';
    resume = resume || key == 'r';
    quits_ = quits_ || key == 'q';
  }
  if (stops_ && Signals::take_suspension()) suspending_ = halt = true;
  const Hand hand = halt ? Hand::halt : resume ? Hand::resume : Hand::none;
  if (hand != Hand::none && acts) acts(hand, suspending_);
  return hand;
}

Answer Operator::confirm(const std::string& question) {
  return ask(question, [this] { return stop(); });
}

}  // namespace enc::trial
