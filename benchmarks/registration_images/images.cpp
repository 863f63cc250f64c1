#include "benchmarks/registration_images/images.h"

#include <cmath>

#include "benchmarks/kit/cost.h"
#include "benchmarks/staged/staged.h"
#include "core/control/scene/scene.h"
#include "trial/assemble/vision.h"

namespace enc::bench::registration_images {
namespace {

Pose<'W', 'C'> camera_pose(const models::Setup& setup) { return pose_of<'W', 'C'>(setup.twin.frames.W_C); }

// Nothing moves at a place: it is drawn once, and each frame of it is exposed with noise of its own.
class StillEyes final : public trial::TipEyes {
 public:
  explicit StillEyes(const Asked& asked)
      : things_(trial::ball_at_tip(camera_pose(*asked.setup), asked.setup->twin.camera)),
        X_CW_(camera_pose(*asked.setup).inverse()),
        pair_(Rectifier(asked.setup->rig.camera).pair()),
        finder_(asked.setup->rig.camera, asked.setup->rig.vision.ball) {
    sim::StageSpec spec = trial::stage_of(asked.setup->twin.camera, asked.seed);
    spec.finish.samples = asked.samples;
    stage_ = asked.camera->stage(spec);
    if (asked.rod > 0.0) add_rod(trial::base_of(Arm(asked.setup->rig.arm.machine)).p(), asked.rod);
  }
  void move() override {
    finish();
    drawn_ = false;
  }
  std::optional<Point<'C'>> see(const trial::TipStand& tip) override {
    expose(tip);
    const double start = thread_seconds();
    last = finder_.find({pair.left.view(), pair.right.view()});
    seen.seconds.push_back(thread_seconds() - start);
    ++seen.frames;
    if (!last.found()) return {};
    ++seen.found;
    const Point<'C'> truth = X_CW_ * tip.truth;
    seen.other += (last.centre - truth).norm() > 5e-3 ? 1U : 0U;
    depth_ = truth.e().z();
    px_.push_back(last.at.e() - seen_at(pair_, truth).e());
    off_.push_back(last.centre.e() - truth.e());
    return last.centre;
  }
  // What was seen at the place.
  void finish() {
    if (px_.size() > 1) {
      PlaceSeen place{depth_};
      spread(px_, place.bias_px, place.scatter_px);
      spread(off_, place.bias, place.scatter);
      seen.places.push_back(place);
    }
    px_.clear();
    off_.clear();
  }
  Seen seen;
  staged::Pair pair;
  FoundBall last;

 private:
  void expose(const trial::TipStand& tip) {
    if (drawn_) {
      stage_->again(frame_++, pair.left, pair.right);
      return;
    }
    sim::Shown shown;
    shown.things = things_(tip);
    stage_->draw(shown, frame_++, pair.left, pair.right);
    drawn_ = true;
  }
  void add_rod(const Vec3& base, double radius) {
    things_ = [ball = things_, base, radius, X_CW = X_CW_](const trial::TipStand& tip) {
      std::vector<sim::Thing> things = ball(tip);
      const Vec3 to = base - tip.truth.e();
      sim::Thing rod;
      rod.shape = sim::ThingShape::capsule;
      rod.at = X_CW * Point<'W'>(Vec3(tip.truth.e() + 0.5 * to));
      rod.axes = (X_CW.q() * Quat::FromTwoVectors(Vec3::UnitZ(), to)).toRotationMatrix();
      rod.half = {radius, radius, 0.5 * to.norm()};
      things.push_back(rod);
      return things;
    };
  }
  static void spread(const std::vector<Vec3>& values, Vec3& mean, Vec3& rms) {
    const auto count = static_cast<double>(values.size());
    mean = rms = Vec3::Zero();
    for (const Vec3& v : values) mean += v / count;
    for (const Vec3& v : values) rms += (v - mean).cwiseAbs2() / (count - 1.0);
    rms = rms.cwiseSqrt();
  }

  std::unique_ptr<sim::Stage> stage_;
  trial::TipThings things_;
  Pose<'C', 'W'> X_CW_;
  RectifiedPair pair_;
  BallFinder finder_;
  std::uint64_t frame_ = 0;
  bool drawn_ = false;
  double depth_ = kUnset;
  std::vector<Vec3> px_, off_;
};

}  // namespace

Seen registered(const Asked& asked) {
  StillEyes eyes(asked);
  const trial::GuidedRun run = trial::see_visits(*asked.visits, eyes, 0.5);
  eyes.finish();
  Seen seen = std::move(eyes.seen);
  if (run.points.size() < models::kFewestPairs) return seen;
  const models::Registration found = models::register_points(models::averages(run.points));
  seen.left_over = found.mean_error;
  seen.elsewhere = Vec3::Zero();
  for (const Point<'W'>& place : *asked.targets)
    seen.elsewhere += trial::target_error(found.X_WC, camera_pose(*asked.setup), place).cwiseAbs() /
                      static_cast<double>(asked.targets->size());
  return seen;
}

std::string marked_pair(const Asked& asked) {
  StillEyes eyes(asked);
  eyes.see(asked.visits->front().frames.front());
  for (std::size_t side = 0; side < 2; ++side) {
    Image& image = side == 0 ? eyes.pair.left : eyes.pair.right;
    for (const Pixel& edge : eyes.last.edges[side])
      if (!std::isnan(edge.column)) staged::mark(image, edge.column, edge.row, {255, 40, 200}, 0);
    const Pixel& centre = eyes.last.outline[side].centre;
    if (!std::isnan(centre.column)) staged::mark(image, centre.column, centre.row, {255, 255, 255}, 3);
  }
  return staged::png({eyes.pair.left, eyes.pair.right});
}

}  // namespace enc::bench::registration_images
