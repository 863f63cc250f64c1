// `view` shows a record as its run was: the twin beside the replayed core is in the same places.
#include <filesystem>
#include <vector>

#include <gmock/gmock.h>

#include "app/view/recorded/source.h"
#include "tests/support/built.h"
#include "tests/support/files.h"
#include "tests/support/run_program.h"

namespace enc::app {
namespace {

class Recorded : public testing::Test {
 protected:
  // A steered run of 4 s with a change of tools, and the ground truth at every 400th tick.
  void SetUp() override {
    const std::string scene = tests::source_dir() + "/models/scenes/session.toml";
    const models::Setup setup = models::load(scene, {}, {});
    trial::TrialOptions options{.seconds = 4.0};
    trial::SteeringLog log;
    options.steer = [&](std::int64_t tick) -> std::optional<trial::HandWord> {
      std::optional<trial::HandWord> word;
      if (tick == 100) word.emplace(trial::HandWord{Point<'W'>(0, 0, 0.03)});
      if (tick == 1000) word.emplace(trial::HandWord{Point<'W'>(0, 0, 0.005)});
      if (tick == 2500) word.emplace(trial::HandWord{{}, false, 1});
      if (word) log.add(tick, *word);
      return word;
    };
    trial::Trial trial(setup, options);
    RecordTexts texts = models::record_texts(setup);
    texts["seed"] = "1";
    RecordWriter writer(record_, texts, layout_hash(trial.scene()));
    trial.record_to(&writer);
    while (trial.tick())
      if (trial.result().ticks % 400 == 0) true_.push_back(trial.truth());
    writer.end_with({{"hand", log.text()}});
    writer.close();
    ASSERT_EQ(true_.size(), 10U);
    ASSERT_GT(true_[4].contact_force.norm(), 0.5) << "it is pressed";
  }
  [[nodiscard]] double difference(const std::string& record) {
    Playback playback(record);
    double most = 0.0;
    std::int64_t ticks = 0;
    while (playback.next([&](const trial::Glance& glance) {
      if (++ticks % 400 != 0 || ticks / 400 > 10) return;
      const sim::Truth& truth = true_[static_cast<std::size_t>(ticks / 400 - 1)];
      most = std::max({most, (glance.truth.tip - truth.tip).norm(),
                       (glance.truth.tool_tip - truth.tool_tip).norm(),
                       1e-3 * (glance.truth.contact_force - truth.contact_force).norm()});
    })) {
    }
    simulated_ = playback.simulated();
    doubt_ = playback.doubt();
    return most;
  }

  const test::TemporaryFolder folder_;
  std::string record_ = folder_.file("r.encrec"), doubt_;
  bool simulated_ = false;
  std::vector<sim::Truth> true_;
};

TEST_F(Recorded, TheTwinIsWhereItWas) {
  EXPECT_EQ(difference(record_), 0.0);
  EXPECT_TRUE(simulated_);
  EXPECT_EQ(doubt_, "");
}

// The end part, which holds the steering of the hand, is lost. The view must not show the twin's own hand
// instead.
TEST_F(Recorded, WithoutItsEndTheDevicesSayWhereThingsAre) {
  std::filesystem::resize_file(record_, std::filesystem::file_size(record_) * 3 / 4);
  EXPECT_GT(difference(record_), 1e-3) << "the scene's own hand does something else";
  EXPECT_FALSE(simulated_);
  EXPECT_THAT(doubt_, testing::HasSubstr("cut off"));
  ViewOptions options;
  options.scene = record_;
  Source source(options, {});
  for (int i = 0; i < 1500; ++i) ASSERT_TRUE(source.tick());
  const Moment moment = source.moment();
  EXPECT_LT((moment.truth.tool_tip - true_[3].tool_tip).norm(), 0.01) << "where the tracker saw it";
}

TEST_F(Recorded, ItsDeepestMomentIsInThePress) {
  const double at = deepest_moment(record_);
  EXPECT_GT(at, 1.0);
  EXPECT_LT(at, 2.6);
}

}  // namespace
}  // namespace enc::app
