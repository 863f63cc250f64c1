// The one description of every parameter: key with its unit, range, meaning, source and confidence. Reading,
// writing, --set, the list of `encounter params` and "did you mean" are visitors that walk it. Structs are in
// SI, keys carry the file's unit.
#pragma once

#include <cstdint>
#include <limits>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <variant>
#include <vector>

#include "core/base/words.h"
#include "core/spec/rig_spec.h"
#include "core/spec/scene_spec.h"
#include "models/response_file.h"
#include "sim/spec/twin_spec.h"

namespace enc::models {

// `chosen`: by the author of the file.
enum class Confidence : std::uint8_t { published, derived, assumed, chosen };
constexpr auto words(Confidence) { return enum_words("published", "derived", "assumed", "chosen"); }
enum class Presence : std::uint8_t { defaulted, needed, optional };  // optional: may also be unset

// Given in the file's unit; applies to every number of an array.
struct Range {
  double low = -std::numeric_limits<double>::infinity();
  double high = std::numeric_limits<double>::infinity();
  bool above_low = false;  // `low` itself is not allowed
  bool whole = false;      // no fractions
};
inline constexpr Range kAny{}, kNotNegative{0.0},
    kPositive{0.0, std::numeric_limits<double>::infinity(), true};

using Words = std::span<const std::string_view>;

struct Key {
  std::string_view name;  // "radius_mm"
  std::string_view meaning, source;
  Confidence confidence = Confidence::assumed;
  Range range = kAny;
  Presence presence = Presence::defaulted;
  Words words{};       // text only: allowed values; empty: any
  bool fixed = false;  // not for --set: names, formats and computed values
};

// A word from the list of an enum (core/base/words.h), as its index.
struct Choice {
  Words words;
  std::uint8_t* index;
};
// A span: exactly that many numbers.
using Target = std::variant<double*, std::int64_t*, std::string*, Choice, Vec3*, std::vector<double>*,
                            std::vector<Vec3>*, std::span<double>>;

class Visitor {
 public:
  virtual ~Visitor() = default;
  virtual void value(const Key& key, const Target& target) = 0;
  // Opens a table. `present`: whether the struct has it; returns whether the visitor has it. If so, it is
  // walked and closed.
  virtual bool open(std::string_view table, bool present) = 0;
  // Opens a list of named tables, of which the struct has `size`; returns the new number. Each is walked and
  // closed.
  virtual std::size_t open_list(std::string_view list, std::size_t size) = 0;
  virtual void open_entry(std::string_view list, std::size_t index, std::string_view name) = 0;
  virtual void close() = 0;
  // Tables of drivers, which declare their own keys.
  virtual void drivers(std::string_view name, std::vector<DriverTable>& tables) = 0;
};

void describe(Visitor&, SceneSpec&);  // without its behaviours, which have their own file
void describe(Visitor&, BehaviourSpec&, bool with_curves);
void describe_behaviours(Visitor&, std::vector<BehaviourSpec>&, bool with_curves);
void describe(Visitor&, ResponseSpec&);
void describe(Visitor&, ResponseFile&);
void describe(Visitor&, RigSpec&);
void describe(Visitor&, HexapodGeometry&);
void describe(Visitor&, ArmRig&);
void describe(Visitor&, PropSpec&);
void describe(Visitor&, UserSpec&);
void describe(Visitor&, InteractionSpec&);
void describe(Visitor&, StereoRig&);
// The part that a calibration determines; a calibration file writes it in the form of a rig.
struct HeadKeys {
  std::string_view source;
  Presence presence = Presence::defaulted;
};
void describe_size(Visitor&, StereoRig&, const HeadKeys&);
void describe_lenses(Visitor&, StereoRig&, const HeadKeys&);  // tables [left], [right]
void describe(Visitor&, VisionRig&);
void describe(Visitor&, sim::ArmTruth&);
void describe(Visitor&, std::string_view table, PoseSpec&);
void describe(Visitor&, sim::TwinSpec&);
// All parameters, under the names that --set takes: the scene at the root, then behaviour, rig and truth.
void describe_all(Visitor&, SceneSpec&, RigSpec&, sim::TwinSpec&);

}  // namespace enc::models
