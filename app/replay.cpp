#include "core/record/replay.h"

#include <algorithm>
#include <bit>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include <fmt/format.h>

#include "app/common/options.h"
#include "app/modules/modules.h"
#include "core/base/error.h"
#include "core/base/words.h"
#include "core/record/record.h"
#include "models/schema/wording.h"
#include "models/setup/scene_file.h"
#include "trial/assemble/assemble.h"
#include "trial/assemble/vision.h"
#include "trial/camera/kept_frames.h"
#include "trial/devices/device_log.h"

namespace enc::app {
namespace {

struct SeenAgain {
  std::int64_t told = 0;               // poses and "no finger" results of vision
  std::int64_t first_difference = -1;  // index of the tick; -1: no difference
  std::string what;
  std::vector<std::string> said;  // messages of the driver that plays the folder, if there is a difference
};

// Gives the record's rig a driver that plays the folder.
void play(models::Setup& setup, const std::string& folder) {
  setup.rig.camera.driver = "images";
  const DriverTable table{"images",
                          {{"path", models::quoted_toml(folder), "", ""},
                           {"rate_hz", fmt::format("{}", trial::KeptCamera::kRate), "", ""}}};
  std::erase_if(setup.rig.drivers, [](const DriverTable& t) { return t.name == "images"; });
  std::erase_if(setup.places, [](const auto& p) { return p.first.starts_with("rig.driver.images"); });
  for (const DriverValue& value : table.values)
    setup.places["rig.driver.images." + value.key] = "--frames " + folder;
  setup.rig.drivers.push_back(table);
}

template <std::size_t N>
bool same(const std::array<double, N>& a, const std::array<double, N>& b) {
  using Bits = std::array<std::uint64_t, N>;
  return std::bit_cast<Bits>(a) == std::bit_cast<Bits>(b);
}

// A link lost during the run does not count as a difference: the record then reports a fault, whatever vision
// reported.
std::string difference(const Measurement<TrackedTool>& recorded, const Measurement<TrackedTool>& seen) {
  if (recorded.value.tool != seen.value.tool)
    return fmt::format("the tool: recorded {}, seen {}", recorded.value.tool, seen.value.tool);
  if (recorded.t != seen.t)
    return fmt::format("its exposure: recorded {} ns, seen {} ns", recorded.t.time_since_epoch().count(),
                       seen.t.time_since_epoch().count());
  const Pose<'C', 'T'>&a = recorded.value.X_CT, &b = seen.value.X_CT;
  if (!same(a.xyz, b.xyz) || !same(a.xyzw, b.xyzw))
    return fmt::format("its place in C: recorded [{}, {}, {}] m, seen [{}, {}, {}] m", a.xyz[0], a.xyz[1],
                       a.xyz[2], b.xyz[0], b.xyz[1], b.xyz[2]);
  const std::array noise{recorded.value.along, recorded.value.across};
  if (!same(noise, {seen.value.along, seen.value.across})) return "how well its place is known";
  if (recorded.health != seen.health && recorded.health != Health::fault) return "its health";
  return {};
}

// Compares vision's results for the frames of `folder` (run --frames) with those in the record: equal bits at
// equal ticks. Throws Error if the scene has no camera or the folder no frames.
SeenAgain see_again(models::Setup setup, RecordReader& record, const std::string& folder) {
  if (!setup.scene.camera)
    throw Error("--frames: the recorded scene has no [camera], and vision told nothing; leave it out");
  play(setup, folder);
  trial::DeviceLog heard;
  std::unique_ptr<PoseTracker> vision = [&] {
    try {
      return trial::make_vision(setup, load_module, {.log = heard, .waits = true, .kept = folder});
    } catch (const Error& e) {  // the error is in the given folder, not in a device
      throw Error(fmt::format("--frames: {}", e.what()), e.key());
    }
  }();
  SeenAgain result;
  Measurement<TrackedTool> seen;
  RecordedTick frame;
  for (record.rewind(); record.next(frame);) {
    result.told += vision->poll(frame.tick.t, seen) ? 1 : 0;
    result.what = difference(frame.in.tool, seen);
    if (result.what.empty()) continue;
    result.first_difference = frame.tick.index;
    break;
  }
  vision.reset();  // ends its threads, so that all messages are complete
  if (result.first_difference >= 0) result.said = heard.lines();
  return result;
}

}  // namespace

int replay(const ReplayOptions& options) {
  RecordReader record(options.record, options.partial ? PartialRead::yes : PartialRead::no);
  const models::Setup setup = models::setup_of(record.texts(), options.record);
  const Scene scene = trial::prepare_setup(setup);
  if (record.ticks() == 0)
    throw Error(fmt::format("{}: holds no whole tick{}; there is nothing to run again; record it again",
                            options.record, record.damage().empty() ? "" : " (" + record.damage() + ")"));
  std::optional<SeenAgain> again;  // first, so that a refused input prints no result
  if (!options.frames.empty()) again = see_again(setup, record, options.frames);
  const ReplayResult result = enc::replay(scene, record);
  if (result.first_difference >= 0) {
    fmt::print("differs from tick {} on: {}\n", result.first_difference, result.what);
    return 1;
  }
  fmt::print("{} run again, equal to the bit; state hash {:016x}{}\n", counted(result.ticks, "tick"),
             result.hash,
             record.sealed()           ? ""
             : record.damage().empty() ? " (record not sealed: it was cut off)"
                                       : "; damaged behind that, and not read: " + record.damage());
  if (const auto ledger = record.end_texts().find("ledger"); ledger != record.end_texts().end()) {
    const auto contacts = std::count(ledger->second.begin(), ledger->second.end(), '\n') - 1;
    fmt::print("energy ledger of {}, as the run had it: export --ledger\n", counted(contacts, "contact"));
  }
  if (again && again->first_difference >= 0) {
    fmt::print("vision differs from tick {} on: {}\n", again->first_difference, again->what);
    for (const std::string& line : again->said) fmt::print(stderr, "{}\n", line);
    return 1;
  }
  if (again) fmt::print("vision told {} what it told then, equal to the bit\n", counted(again->told, "time"));
  return record.damage().empty() ? 0 : 1;
}

}  // namespace enc::app
