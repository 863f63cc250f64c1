// `encounter shadow RECORD`: compares a record of the laboratory with its twin, channel by channel, and
// describes the differences in words.
#include "trial/identify/shadow/shadow.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <filesystem>

#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include "app/common/words.h"
#include "app/fit/commands.h"
#include "core/base/error.h"
#include "core/base/units.h"
#include "models/schema/wording.h"

namespace enc::app {
namespace {

using trial::Divergence;
using trial::Quantity;
using trial::Shadow;
using OrderedJson = nlohmann::ordered_json;  // prints NaN as null

struct Unit {
  const char* name;
  const char* key;  // key in JSON
  double scale;     // factor from SI
  int digits;
};
constexpr Unit kTime{"ms", "ms", 1e3, 2}, kLength{"mm", "mm", 1e3, 4}, kLengthRms{"mm rms", "mm", 1e3, 4},
    kForceRms{"N rms", "N", 1.0, 4}, kShare{"%", "percent", 1e2, 2}, kForce{"N", "N", 1.0, 3},
    kAngle{"deg", "deg", kDegPerRad, 2};

// Text for a quantity: its name, and the meaning if the record is ahead of the twin or behind it.
struct Meaning {
  const char* name;
  Unit unit;
  const char* more;  // {}: amount of the difference
  const char* less;
};

// The order is that of Quantity.
constexpr std::array<Meaning, 16> kMeanings{{
    {"time", kTime, "the machine answers {} later than the twin's",
     "the machine answers {} earlier than the twin's"},
    {"place", kLength, "the machine stands {} farther than the twin's, towards +",
     "the machine stands {} farther than the twin's, towards -"},
    {"rest", kLengthRms,
     "the machine moves otherwise than the twin's by {}, which neither a time nor a place explains", ""},
    {"registration", kLength,
     "registration: the tool is seen {} farther than by the twin's tracker, towards +",
     "registration: the tool is seen {} farther than by the twin's tracker, towards -"},
    {"latency", kTime, "latency: what is seen of the tool comes {} later than from the twin's tracker",
     "latency: what is seen of the tool comes {} earlier than from the twin's tracker"},
    {"stamps", kTime, "the tracker's stamps are {} later than the twin's, beside what they are of",
     "the tracker's stamps are {} earlier than the twin's, beside what they are of"},
    {"stiffness", kShare, "stiffness: the object is {} stiffer than the twin's",
     "stiffness: the object is {} softer than the twin's"},
    {"place", kLength,
     "the object, or the machine, stands elsewhere: {} nearer to each other than the twin's",
     "the object, or the machine, stands elsewhere: {} farther from each other than the twin's"},
    {"time", kTime, "the force comes {} later than the twin's", "the force comes {} earlier than the twin's"},
    {"rest", kForceRms,
     "the force differs from the twin's by {} that no stiffness, place or time explains: the object has "
     "another law, or the sensor is worse, and what else is said of the force is to be doubted",
     "the force differs from the twin's by {} less than expected: the sensor is better"},
    {"stiffness", kShare, "stiffness: the rendered object is {} stiffer than the twin's",
     "stiffness: the rendered object is {} softer than the twin's"},
    {"noise", kShare, "noise: the poses of the tool scatter by {} more than those of the twin's tracker",
     "noise: the poses of the tool scatter by {} less than those of the twin's tracker"},
    {"loss", kShare, "loss: {} of the poses that the twin's tracker sends are missing",
     "loss: the tracker sends {} more poses than the twin's"},
    {"noise", kShare, "noise: the force scatters by {} more than that of the twin's sensor",
     "noise: the force scatters by {} less than that of the twin's sensor"},
    {"zero", kForce,
     "zero: without a touch the force is {} farther from the weight than the twin's allows, towards +",
     "zero: without a touch the force is {} farther from the weight than the twin's allows, towards -"},
    {"turned", kAngle,
     "the sensor is turned: the force of a press points {} away from the line between both tips", ""},
}};
constexpr Meaning kRegistrationAway{
    "registration", kLength,
    "registration: the tool is seen {} farther from the tip that it presses than by the twin's tracker",
    "registration: the tool is seen {} nearer to the tip that it presses than by the twin's tracker"};

const Meaning& meaning_of(const Divergence& one) {
  if (one.quantity == Quantity::registration && one.axis == "away") return kRegistrationAway;
  return kMeanings.at(static_cast<std::size_t>(one.quantity));
}

std::string size_text(const models::Interval& off, const Unit& as, double sign) {
  double value = sign * off.value * as.scale;
  if (std::abs(value) < 0.5 * std::pow(10.0, -as.digits)) value = 0.0;  // avoids -0.00
  if (std::isnan(value)) return "not known";
  const std::string half =
      std::isnan(off.half) ? "?" : fmt::format("{:.{}f}", off.half * as.scale, as.digits);
  return fmt::format("{:.{}f} +- {}", value, as.digits, half);
}

// Looks like "stiffness: the object is 5.00 +- 0.27 % stiffer than the twin's".
std::string sentence(const Divergence& one) {
  const Meaning& as = meaning_of(one);
  const bool more = one.off.value >= 0.0;
  const std::string size = fmt::format("{} {}", size_text(one.off, as.unit, more ? 1.0 : -1.0), as.unit.name);
  const std::string text = fmt::format(fmt::runtime(more ? as.more : as.less), size);
  return text + (one.axis == "away" ? "" : one.axis);
}

const char* verdict_of(const Divergence& one) {
  if (one.diverges()) return "DIVERGES";
  return one.vague() ? "not told" : "agrees";
}

std::string row(const Divergence& one) {
  const Meaning& as = meaning_of(one);
  const std::string name = one.axis.empty() ? as.name : fmt::format("{} {}", as.name, one.axis);
  return fmt::format("{:<12}{:<20}{:>22} {:<7}{:>8.3g} {:<7} {}\n", word_of(one.channel), name,
                     size_text(one.off, as.unit, 1.0), as.unit.name, one.bound * as.unit.scale, as.unit.name,
                     verdict_of(one));
}

std::string report(const std::string& record, const std::vector<std::string>& set, const std::string& title,
                   const Shadow& shadow) {
  std::string text = fmt::format("record      {}: {:.2f} s, {} ticks of '{}'\n", record, shadow.seconds,
                                 shadow.ticks, title);
  text += "twin        the set-up of the record";
  for (const std::string& one : set) text += (&one == &set.front() ? ", with " : ", ") + one;
  text +=
      fmt::format("\n{:<12}{:<20}{:>22} {:<7}{:>8}\n", "channel", "record less twin", "95 %", "", "bound");
  for (const Divergence& one : shadow.found) text += row(one);
  for (const trial::Remark& one : shadow.unjudged)
    text += fmt::format("not judged  {}: {}\n", word_of(one.channel), one.text);
  for (const trial::Remark& one : shadow.facts)
    text += fmt::format("note        {}: {}\n", word_of(one.channel), one.text);
  if (std::any_of(shadow.found.begin(), shadow.found.end(), [](const Divergence& x) { return x.vague(); }))
    text +=
        "note        not told: this record, or the phase of the tracker's clocks that nobody knows, leaves "
        "it "
        "less well known than its bound is\n";
  for (const Divergence& one : shadow.found)
    if (one.diverges()) text += fmt::format("diverges    {}: {}\n", word_of(one.channel), sentence(one));
  for (const trial::Remark& one : shadow.gross)
    text += fmt::format("diverges    {}: {}\n", word_of(one.channel), one.text);
  if (shadow.diverges()) return text;
  if (shadow.found.empty()) return text + "verdict     nothing in this record can be held against a twin\n";
  const auto vague =
      std::count_if(shadow.found.begin(), shadow.found.end(), [](const Divergence& x) { return x.vague(); });
  return text + fmt::format("verdict     no channel diverges; {} agree, {} not told, {} not judged\n",
                            shadow.found.size() - static_cast<std::size_t>(vague), vague,
                            shadow.unjudged.size());
}

std::string json_of(const Shadow& shadow, const std::string& lack) {
  OrderedJson json;
  if (!lack.empty()) json["lack"] = lack;
  json["ticks"] = shadow.ticks;
  json["seconds_s"] = shadow.seconds;
  json["diverges"] = shadow.diverges();
  json["channels"] = OrderedJson::array();
  for (const Divergence& one : shadow.found) {
    const Unit& as = meaning_of(one).unit;
    OrderedJson entry;
    entry["channel"] = word_of(one.channel);
    entry["quantity"] = word_of(one.quantity);
    if (!one.axis.empty()) entry["axis"] = one.axis;
    entry[fmt::format("off_{}", as.key)] = one.off.value * as.scale;
    entry[fmt::format("half_{}", as.key)] = one.off.half * as.scale;
    entry[fmt::format("bound_{}", as.key)] = one.bound * as.scale;
    entry["verdict"] = one.diverges() ? "diverges" : one.vague() ? "not told" : "agrees";
    if (one.diverges()) entry["words"] = sentence(one);
    json["channels"].push_back(entry);
  }
  const auto remarks = [](const std::vector<trial::Remark>& all) {
    OrderedJson list = OrderedJson::array();
    for (const trial::Remark& one : all)
      list.push_back({{"channel", word_of(one.channel)}, {"text", one.text}});
    return list;
  };
  json["gross"] = remarks(shadow.gross);
  json["not_judged"] = remarks(shadow.unjudged);
  json["notes"] = remarks(shadow.facts);
  return json.dump(2);
}

}  // namespace

int shadow_command(const ShadowOptions& options) {
  std::error_code none;
  if (std::filesystem::is_regular_file(options.record, none) && !is_record(options.record))
    throw Error(fmt::format(
        "{}:1:1: is no record; expected a file that `encounter run SCENE --record FILE` has written; {}",
        options.record,
        options.record.ends_with(".toml") ? "run that scene with --record" : "give the name of one"));
  RecordReader record(options.record, options.partial ? PartialRead::yes : PartialRead::no);
  const models::Setup twin = trial::twin_of(record, options.record, options.set);
  for (const std::string& note : twin.notes) fmt::print(stderr, "{}\n", models::printable(note));
  const Shadow shadow = trial::shadow(record, options.record, twin);
  const std::string lack = lack_of(record, "comparison");
  fmt::print("{}", options.json ? json_of(shadow, lack) + "\n"
                                : report(options.record, options.set, twin.scene.title, shadow));
  if (!lack.empty()) fmt::print(stderr, "encounter: {}: {}\n", options.record, lack);
  return shadow.diverges() || !record.damage().empty() ? 1 : 0;
}

}  // namespace enc::app
