#include "benchmarks/registration/accuracy.h"

#include <algorithm>
#include <cmath>
#include <numeric>

#include "benchmarks/kit/parallel.h"
#include "core/base/error.h"
#include "sim/truth/random.h"

namespace enc::bench::registration {
namespace {

// Results of one seed for every combination.
struct SeedResult {
  std::vector<models::Registration> found;
  std::vector<double> seconds;
};

SeedResult run_seed(const trial::RegistrationRig& rig, const std::vector<trial::TipVisit>& visits,
                    const AccuracyStudy& study, std::uint64_t seed) {
  const std::size_t most_frames = visits.front().frames.size();
  const trial::GuidedRun run = trial::see_visits(visits, rig.X_WC, rig.camera, seed);
  if (run.unseen > 0) throw Error("a place was not seen; expected all in view; see truth.camera");
  SeedResult one;
  for (const std::size_t pairs : study.pairs)
    for (const std::size_t frames : study.frames) {
      const models::PointSet used(run.points.begin(),
                                  run.points.begin() + static_cast<std::ptrdiff_t>(pairs));
      one.found.push_back(models::register_points(models::averages(used, frames)));
      const auto spared = static_cast<double>((pairs - 1) * most_frames);
      one.seconds.push_back(run.seconds[pairs - 1] +
                            (static_cast<double>(pairs * frames) - spared) / rig.camera.rate);
    }
  return one;
}

void judge(const trial::RegistrationRig& rig, const trial::RegistrationPlaces& places,
           const models::Registration& found, Accuracy& to) {
  Vec3 sum = Vec3::Zero();
  for (std::size_t t = 0; t < places.targets.size(); ++t) {
    const Vec3 error = trial::target_error(found.X_WC, rig.X_WC, places.targets[t]);
    sum += error.cwiseAbs() / static_cast<double>(places.targets.size());
    to.square[t] += error.squaredNorm();
  }
  to.residual.push_back(found.mean_error);
  to.held_out.push_back(sum);
  to.position.push_back((found.X_WC.p() - rig.X_WC.p()).cwiseAbs());
  to.turn.push_back(found.X_WC.q().angularDistance(rig.X_WC.q()));
  to.scale.push_back(found.scale);
}

}  // namespace

double Accuracy::rms() const { return rms_at(0, square.size()); }

double Accuracy::rms_at(std::size_t from, std::size_t to) const {
  const auto at = [&](std::size_t i) { return square.begin() + static_cast<std::ptrdiff_t>(i); };
  return std::sqrt(std::accumulate(at(from), at(to), 0.0) / static_cast<double>(to - from));
}

std::vector<Accuracy> run_accuracy(const trial::RegistrationRig& rig, const trial::RegistrationPlaces& places,
                                   const std::vector<trial::TipVisit>& visits, const AccuracyStudy& study,
                                   const std::function<void(double)>& progress) {
  if (visits.size() < *std::max_element(study.pairs.begin(), study.pairs.end()))
    throw Error(
        "the camera sees fewer places of the arm than are wanted; expected its view on the arm; see "
        "frames.W_C");
  std::vector<SeedResult> seeds(study.seeds);
  in_parallel(
      study.seeds, [&](std::size_t i) { seeds[i] = run_seed(rig, visits, study, study.first_seed + i); },
      progress);
  std::vector<Accuracy> all;
  for (const std::size_t pairs : study.pairs)
    for (const std::size_t frames : study.frames) {
      Accuracy one;
      one.pairs = pairs;
      one.frames = frames;
      one.square.assign(places.targets.size(), 0.0);
      const std::size_t index = all.size();
      for (const SeedResult& seed : seeds) judge(rig, places, seed.found[index], one);
      for (double& square : one.square) square /= static_cast<double>(study.seeds);
      one.seconds = seeds.front().seconds[index];
      all.push_back(std::move(one));
    }
  return all;
}

double exact_error(std::size_t count, std::uint64_t seed, double off) {
  sim::Stream random(seed, "registration.exact");
  double worst = 0.0;
  for (std::size_t i = 0; i < count; ++i) {
    const Vec3 v = random.normal3();
    const Pose<'W', 'C'> truth(Quat(random.normal(), v.x(), v.y(), v.z()).normalized(), random.normal3());
    std::vector<models::PointPair> pairs;
    for (std::size_t k = 0; k < 4 + i % 17; ++k) {
      const Point<'C'> p(Vec3(0.1 * random.normal3()));
      pairs.push_back({p, truth * p + Vec<'W'>(off, 0.0, 0.0)});
    }
    const models::Registration found = models::register_points(pairs);
    worst = std::max({worst, (found.X_WC.p() - truth.p()).norm(),
                      (found.X_WC.q().toRotationMatrix() - truth.q().toRotationMatrix()).norm()});
  }
  return worst;
}

}  // namespace enc::bench::registration
