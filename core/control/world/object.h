// A prepared object of a scene: its surface, pose, response and deflection limits.
#pragma once

#include <algorithm>
#include <array>
#include <cstddef>
#include <cstdint>
#include <span>
#include <string>
#include <variant>
#include <vector>

#include "core/base/frames.h"
#include "core/shape/response/response.h"
#include "core/shape/surface/surface.h"
#include "core/spec/object_spec.h"

namespace enc {

// Deflection limits that change from contact to contact [VHMR 4.3: 6, 4 and 2 mm]: contact k of an experiment
// takes limit k; the last limit stays.
class ContactLimits {
 public:
  static constexpr std::size_t kMost = 16;

  ContactLimits() = default;
  // Uses the first kMost of `limits`, m. An empty list gives no contact a limit of its own.
  explicit ContactLimits(std::span<const double> limits) : count_(std::min(limits.size(), kMost)) {
    std::copy_n(limits.begin(), count_, limits_.begin());
  }
  // Limit of a contact, m, counted from 1 as State::contacts is; `otherwise` if the contact has no limit of
  // its own.
  [[nodiscard]] double at(std::int32_t contact, double otherwise) const {
    if (count_ == 0) return otherwise;
    const auto index = static_cast<std::size_t>(std::max(contact, 1) - 1);
    return limits_[std::min(index, count_ - 1)];
  }

 private:
  std::array<double, kMost> limits_{};
  std::size_t count_ = 0;
};

struct Object {
  Surface surface;
  Pose<'W', 'O'> X_WO;
  Response response;      // Empty for a real object, which only a probe touches.
  double limit = kUnset;  // Rendered deflection limit, m; with `limits`, the largest of them.
  // Limit that object, behaviour and response ask for; larger than `limit` only if the machine is too weak.
  double wanted = kUnset;
  TangentialMode tangential = TangentialMode::stick;
  double tangential_stiffness = kUnset;  // N/m
  Pose<'O', 'W'> X_OW = X_WO.inverse();
  Point<'W'> centre = X_WO * surface.bound().centre;  // centre of a ball that contains the object
  double radius = surface.bound().radius;             // m; infinite for a half space
  ContactLimits limits{};                             // limits of single contacts
  InteractionSpec interaction{};
  double stiffness = kUnset;  // N/m, stiffness of the interaction
  std::int32_t moving = -1;   // index in DynamicObjectState::moved; -1: fixed

  [[nodiscard]] double limit_at(std::int32_t contact) const { return limits.at(contact, limit); }  // m

  // True if the prop meets the middle of the object's face: a click, or a passive button. A real thing stays
  // in place, and so does its stand-in.
  [[nodiscard]] bool met_in_its_middle() const {
    const bool button = std::holds_alternative<Button>(surface.shape());
    return interaction.kind == Interaction::click || (button && interaction.kind == Interaction::passive);
  }

  // Speed at which the object's own surface runs along `way`, m/s.
  [[nodiscard]] double prop_speed() const {
    return interaction.kind == Interaction::spin ? interaction.speed : 0.0;
  }

  // Lower bound of the distance from p to the surface, m; negative if p may be inside.
  [[nodiscard]] double least_distance(const Point<'W'>& p) const { return (p - centre).norm() - radius; }
};

// The nearest object and feature of the last search. It speeds up the next search and never changes its
// result (surface.h).
struct ObjectHint {
  std::int32_t object = -1, feature = -1;
};
// The fault in an object's deflection limits. Both the reader of files (which adds place and units) and
// prepare() (for scenes made in code) apply this one rule.
enum class LimitFault : std::uint8_t {
  none,
  two_keys,
  too_many,
  not_positive,
  beyond_radius,
  beyond_behaviour
};
struct LimitCheck {
  LimitFault fault = LimitFault::none;
  std::size_t index = 0;  // in ObjectSpec::limits
};
// `most`: end of the behaviour, m; 0 if not known yet.
[[nodiscard]] LimitCheck check_limits(const ObjectSpec& object, double most);

// Parts of prepare(). They throw Error with the key in the file.
[[nodiscard]] Mesh scaled_mesh(const ObjectSpec& spec);
[[nodiscard]] Surface surface_of(const ObjectSpec& spec);
[[nodiscard]] Pose<'W', 'O'> place_of(const ObjectSpec& spec);
[[nodiscard]] const BehaviourSpec& behaviour_of(const std::vector<BehaviourSpec>& behaviours,
                                                const ObjectSpec& object);
// The object that `who` ("user", "pusher") presses: the named one, or the first.
[[nodiscard]] std::size_t pressed_object(const std::vector<ObjectSpec>& objects, const std::string& name,
                                         const std::string& who);

}  // namespace enc
