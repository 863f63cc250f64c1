// Checks of a machine and a scene's objects before anything moves: whether the machine renders each object
// stably (docs/reference/stability.md), and whether an arm is strong enough. A simulation reports exceeded
// limits and runs. An armed real machine refuses them (sources/choices 15).
#pragma once

#include <string>
#include <vector>

#include "core/control/safety/certificate/certificate.h"
#include "core/control/scene/scene.h"
#include "models/setup/scene_file.h"

namespace enc::trial {

struct ObjectCertificate {
  std::string object;  // empty: the free tip of an arm
  // N/m, along the normal. Arm: the highest stiffness that it renders there; other machines: the lowest.
  double asked = kUnset;
  certificate::Certificate certificate;
  // Force-measuring machine only: a push to this depth (m) with this ramp (s) causes this oscillation, peak
  // to peak (m); 0: stable.
  double depth = 0.0, ramp = kUnset, swing = 0.0;

  // Arm only: the place of the certificate, the worst of a few.
  Point<'W'> place{};
  bool pressed = false;  // the user's plan presses only there
  // The object that supplies these bounds: equally stiff, of an equal class, and nearer to them. Empty: its
  // own.
  std::string like{};

  // Arm only: the tip without a hand.
  [[nodiscard]] bool free_tip() const { return object.empty(); }
  // True if not stable with the rig's operator model.
  [[nodiscard]] bool beyond() const;
  [[nodiscard]] bool unknown() const { return certificate.verdict == certificate::Class::unknown; }
};

// `whole`: includes the rows that take longer than the class, the bounds of a force-measuring machine.
[[nodiscard]] std::vector<ObjectCertificate> certificates_of(const models::Setup& setup, const Scene& scene,
                                                             bool whole = false);

// The certificates of each family of machines (family.h). An arm's are always whole.
[[nodiscard]] std::vector<ObjectCertificate> hexapod_certificates(const models::Setup& setup,
                                                                  const Scene& scene, bool whole);
[[nodiscard]] std::vector<ObjectCertificate> arm_certificates(const models::Setup& setup, const Scene& scene,
                                                              bool whole);

// "object 'wall'", or the other thing that the certificate is for.
[[nodiscard]] std::string name_of(const ObjectCertificate& certified);
// The class and its subject, in one line without a full stop.
[[nodiscard]] std::string class_text(const ObjectCertificate& certified);
// The problem and the remedy, in one line without a full stop; empty: stable.
[[nodiscard]] std::string refusal_text(const models::Setup& setup, const ObjectCertificate& certified);
// The key of the set-up that decides the class.
[[nodiscard]] std::string key_of(const ObjectCertificate& certified);

// Law of an arm; only for the scene of an arm.
[[nodiscard]] inline const Impedance& impedance_of(const Scene& scene) { return *scene.impedance(); }

// Strength of an arm at an object, at the user's press or nearest to home, and the scene's demand.
struct ArmStrength {
  std::string object;
  double peak = 0.0, lasting = 0.0;  // N, along the normal: brief and continuous, by the rig's model
  double asked = kUnset;             // N, user's press; unset: no press to a depth
  double asked_for = 0.0;            // s, requested duration
  double holds_for = 0.0;            // s, for that force, until cold motors give less; infinite: for hours
  std::int64_t presses = 1;          // number of the user's presses
  std::int64_t gives_way_in = 0;     // the press in which warm motors give less; 0: no press
};
// The part of the demand beyond a limit; empty: within limits.
[[nodiscard]] std::string beyond_text(const ArmStrength& at);

// One entry for each object; empty for a machine that is not an arm.
[[nodiscard]] std::vector<ArmStrength> strengths_of(const models::Setup& setup, const Scene& scene);
[[nodiscard]] std::vector<ArmStrength> arm_strengths(const models::Setup& setup, const Scene& scene);

}  // namespace enc::trial
