// An object of a scene made ready: its surface where it stands, and how it answers.
#pragma once

#include <cstdint>
#include <string>
#include <variant>
#include <vector>

#include "core/base/frames.h"
#include "core/control/world/contact_limits.h"
#include "core/shape/response/response.h"
#include "core/shape/surface/surface.h"
#include "core/spec/object_spec.h"

namespace enc {

struct Object {
  Surface surface;
  Pose<'W', 'O'> X_WO;
  Response response;      // none where the object is real: then only a probe touches it
  double limit = kUnset;  // deflection, m: what is rendered; with `limits` the largest of them
  double wanted =
      kUnset;  // what object, behaviour and response ask for; more only where the machine is too weak
  Tangential tangential = Tangential::stick;
  double tangential_stiffness = kUnset;  // N/m
  Pose<'O', 'W'> X_OW = X_WO.inverse();
  Point<'W'> centre = X_WO * surface.bound().centre;  // of a ball that holds the object
  double radius = surface.bound().radius;             // m; infinite for a half space
  ContactLimits limits{};                             // of contacts that have their own
  InteractionSpec interaction{};
  double stiffness = kUnset;  // of the interaction, N/m
  std::int32_t moving = -1;   // place in Pushing::moved; -1: it stands

  [[nodiscard]] double limit_at(std::int32_t contact) const { return limits.at(contact, limit); }  // m

  // A real thing stands where it is, and so does what stands for it; of a button the middle of its face is
  // met.
  [[nodiscard]] bool met_in_its_middle() const {
    const bool button = std::holds_alternative<Button>(surface.shape());
    return interaction.kind == Interaction::click || (button && interaction.kind == Interaction::passive);
  }

  // At which the object's own surface runs along `way`, m/s.
  [[nodiscard]] double prop_speed() const {
    return interaction.kind == Interaction::spin ? interaction.speed : 0.0;
  }

  // No surface point of the object is nearer to p than this, m; negative where p may be inside.
  [[nodiscard]] double least_distance(const Point<'W'>& p) const { return (p - centre).norm() - radius; }
};

// Which part of which object was nearest: makes the next search faster, and changes no result (surface.h).
struct ObjectHint {
  std::int32_t object = -1, feature = -1;
};
// What is wrong with the deflection limits that an object asks for. The one rule: files are checked by it
// where they are read, with the place and in their units, and scenes made in code where they are prepared.
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
  std::size_t index = 0;  // of ObjectSpec::limits
};
// `most`: where its behaviour ends, m; 0 while that is not known.
[[nodiscard]] LimitCheck check_limits(const ObjectSpec& object, double most);

// Parts of prepare(). Throw Error with the key in the file.
[[nodiscard]] Mesh scaled_mesh(const ObjectSpec& spec);
[[nodiscard]] Surface surface_of(const ObjectSpec& spec);
[[nodiscard]] Pose<'W', 'O'> place_of(const ObjectSpec& spec);
[[nodiscard]] const BehaviourSpec& behaviour_of(const std::vector<BehaviourSpec>& behaviours,
                                                const ObjectSpec& object);
// Which object is pressed by `who` ("user", "pusher"): the named one, or the first.
[[nodiscard]] std::size_t pressed_object(const std::vector<ObjectSpec>& objects, const std::string& name,
                                         const std::string& who);

}  // namespace enc
