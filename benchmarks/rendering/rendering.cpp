// Cost of a pair of the twin's images beside MuJoCo's own calls for the same room and hand.
#include <fmt/format.h>

#include "benchmarks/kit/cost.h"
#include "benchmarks/kit/entry.h"
#include "benchmarks/staged/staged.h"

namespace enc::bench::rendering {
namespace {

using namespace staged;

sim::StageSpec look(std::uint64_t seed, double noise, bool bent) {
  sim::StageSpec spec;
  spec.camera = head(640);
  spec.seed = seed;
  spec.sensor.noise = noise;
  if (bent) spec.camera.left.distortion = spec.camera.right.distortion = {-0.2, 0.05, 0.001, 0.001, 0};
  return spec;
}

void run(Bench& bench) {
  const sim::CameraModule& module = camera(bench.context);
  const std::uint64_t seed = test_seed(bench.context) + 700;
  const double noise = sim::SensorLook{}.noise;
  const auto raw = module.stage(look(seed, 0.0, false));
  const auto plain = module.stage(look(seed, 0.0, false)), noisy = module.stage(look(seed, noise, false)),
             bent = module.stage(look(seed, noise, true));
  const sim::HandPose hand{{0.01, -0.03, 0.38}, {0.2, -1, 0}, 0.2};
  Pair pair;
  std::uint64_t frame = 0;
  const auto draw = [&](sim::Stage& stage) { stage.draw(&hand, {}, {}, frame++, pair.left, pair.right); };
  const Race race(bench.context.quick ? 9 : 41,
                  {[&] {
                     raw->draw_at_once({true, hand, {}, {}, {}}, pair.left, pair.right);
                   },
                   [&] { draw(*plain); }, [&] { draw(*noisy); }, [&] { draw(*bent); }},
                  3);
  bench.cost("ratio_to_raw.median", race.ratio(1, 0), "x",
             fmt::format("a pair of 640 x 480 without the sensor's noise, {:.1f} ms of CPU, over MuJoCo's "
                         "own calls for the same picture, {:.1f} ms; interleaved",
                         race.seconds(1) * 1e3, race.seconds(0) * 1e3));
  bench.cost("noise.ratio_to_raw.median", race.ratio(2, 0), "x", "with the sensor's noise");
  bench.cost("noise.time.median", race.seconds(2) * 1e3, "ms", "CPU time of that pair");
  bench.cost("lens.time.median", race.seconds(3) * 1e3, "ms", "the same through lenses that distort");
  bench.picture({"pair", "A pair", "What the left and the right camera see, through lenses that distort.",
                 png({pair.left, pair.right})});
}

const Entry kEntry{"rendering", "camera", "what a pair of the twin's images costs beside MuJoCo's own calls",
                   run};

}  // namespace
}  // namespace enc::bench::rendering
