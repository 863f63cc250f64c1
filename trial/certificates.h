// Which objects of a scene the machine renders stably: a certificate for each, known before anything moves
// (docs/reference/stability.md). In simulation what is beyond is said and runs; a real machine that is armed
// refuses it (sources/choices 15).
#pragma once

#include <string>
#include <vector>

#include "core/control/safety/certificate/certificate.h"
#include "core/control/scene/scene.h"
#include "models/setup/scene_file.h"

namespace enc::trial {

struct Certified {
  std::string object;  // empty: the tip of an arm that nobody touches
  double asked =
      kUnset;  // N/m, along the normal: of an arm the stiffest that it renders there, else the softest
  certificate::Certificate certificate;
  // Of a machine that measures force: pushed so deep within so long it swings so far, peak to peak, m, s, m;
  // 0: it stands still.
  double depth = 0.0, ramp = kUnset, swing = 0.0;

  // Of an arm: the place that it is of, the worst of a few (arm_certificates.cpp).
  Point<'W'> place{};
  bool pressed = false;  // the user's plan presses it there and nowhere else
  // The object whose bounds these are: as stiff, of the same class, and nearer to them. Empty: its own.
  std::string like{};

  // Of an arm. It has no hand on it.
  [[nodiscard]] bool free_tip() const { return object.empty(); }
  // Not stable under the hand that the rig expects.
  [[nodiscard]] bool beyond() const;
  [[nodiscard]] bool unknown() const { return certificate.verdict == certificate::Class::unknown; }
};

// `whole`: with the rows that take longer than the class, the bounds of a machine that measures force.
[[nodiscard]] std::vector<Certified> certificates_of(const models::Setup& setup, const Scene& scene,
                                                     bool whole = false);

// Of an arm; certificates_of() takes them.
[[nodiscard]] std::vector<Certified> arm_certificates(const models::Setup& setup, const Scene& scene);

// "object 'wall'", or what else it is of.
[[nodiscard]] std::string name_of(const Certified& certified);
// The class and what it is of, in one line without an end.
[[nodiscard]] std::string class_text(const Certified& certified);
// What is wrong and what to do, likewise; empty: it is stable.
[[nodiscard]] std::string refusal_text(const models::Setup& setup, const Certified& certified);
// The key of the setup that it hangs on.
[[nodiscard]] std::string key_of(const Certified& certified);

}  // namespace enc::trial
