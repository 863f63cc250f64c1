#include "tests/unit/trial/identify/shadow/shadow_runs.h"

#include "tests/support/files.h"
#include "tests/unit/trial/runs.h"
#include "trial/assemble/assemble.h"
#include "trial/trial.h"

namespace enc::test {
namespace {

void record_run(const models::Setup& setup, std::uint64_t seed, const std::string& file) {
  RecordWriter writer(file, models::record_texts(setup), layout_hash(trial::prepare_setup(setup)));
  trial::TrialOptions options{.seed = seed};
  trial::Trial trial(setup, options);
  trial.record_to(&writer);
  trial.run();
  writer.close();
}

}  // namespace

const ShadowedScene& probing() {
  static const ShadowedScene kScene{"rig_identify", {"probe.repeats=2", "probe.dwell_s=1", "probe.rest_s=1"}};
  return kScene;
}
const ShadowedScene& carrying() {
  static const ShadowedScene kScene{
      "tracking", {"travel.dwell_s=0.5", "travel.ways=both_ways", "travel.stops_mm=[0,20]"}};
  return kScene;
}
const ShadowedScene& pressing() {
  static const ShadowedScene kScene{"plane", {"user.press_s=1.5", "user.release_s=1.5"}};
  return kScene;
}

models::Setup set_up(const ShadowedScene& scene, const std::string& rig,
                     const std::vector<std::string>& more) {
  std::vector<std::string> set = scene.set;
  set.insert(set.end(), more.begin(), more.end());
  return test::shipped(scene.name, set, rig);
}

trial::Shadow shadowed(const ShadowedScene& scene, std::uint64_t seed,
                       const std::vector<std::string>& altered, const std::vector<std::string>& twin) {
  const TemporaryFolder folder;
  const std::string file = folder.file("r.encrec");
  record_run(set_up(scene, "sim", altered), seed, file);
  RecordReader record(file);
  return trial::shadow(record, file, trial::twin_of(record, file, twin));
}

trial::Shadow shadowed_frames(const ShadowedScene& scene, std::uint64_t seed, const AlterFrame& alter,
                              const std::vector<std::string>& twin) {
  const TemporaryFolder folder;
  const std::string run = folder.file("r.encrec"), file = folder.file("altered.encrec");
  record_run(set_up(scene), seed, run);
  RecordReader from(run);
  RecordWriter to(file, from.texts(), from.layout());
  RecordedTick frame;
  for (std::int64_t i = 0; from.next(frame); ++i) {
    alter(frame, static_cast<double>(i) / static_cast<double>(from.ticks()));
    to.write(frame.tick, frame.in, frame.out, frame.hash);
  }
  to.close();
  RecordReader record(file);
  return trial::shadow(record, file, trial::twin_of(record, file, twin));
}

trial::Shadow shadowed_beside(const models::Setup& recorded, std::uint64_t seed, const models::Setup& twin) {
  const TemporaryFolder folder;
  const std::string file = folder.file("r.encrec");
  record_run(recorded, seed, file);
  RecordReader record(file);
  return trial::shadow(record, file, twin);
}

std::vector<std::string> named(const trial::Shadow& shadow) {
  std::vector<std::string> names;
  for (const trial::Divergence& one : shadow.found)
    if (one.diverges())
      names.push_back(std::string(word_of(one.channel)) + " " + std::string(word_of(one.quantity)) +
                      (one.axis.empty() ? "" : " " + one.axis));
  for (const trial::Remark& one : shadow.gross) names.push_back(std::string(word_of(one.channel)) + " gross");
  return names;
}

const trial::Divergence* found(const trial::Shadow& shadow, trial::Quantity quantity,
                               const std::string& axis) {
  for (const trial::Divergence& one : shadow.found)
    if (one.quantity == quantity && one.axis == axis) return &one;
  return nullptr;
}

}  // namespace enc::test
