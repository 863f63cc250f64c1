#include <cmath>

#include <fmt/format.h>

#include "app/built.h"
#include "app/options.h"
#include "benchmarks/trial.h"

namespace enc::app {

int check(const SceneOptions& options) {
  const models::Setup setup = models::load(options.scene, options.rig, options.set);
  print_notes(setup.notes);
  const Scene scene = bench::prepare_setup(setup);
  fmt::print("{}\n{}{}\nframes\n{}  every chain closes to {:.1e} m\n\nlimits\n", setup.scene.title,
             parts_text(setup), questionnaire_text(setup), frame_graph(scene), chain_residual(scene));
  for (std::size_t i = 0; i < scene.objects.size(); ++i) {
    if (std::isnan(scene.objects[i].limit)) {
      fmt::print("  object '{}': real, pressed by the machine and not rendered\n",
                 setup.scene.objects[i].name);
      continue;
    }
    fmt::print(
        "  object '{}': deflection up to {:g} mm, at most {:.2f} N; softest stable slope {:.3f} N/mm\n",
        setup.scene.objects[i].name, scene.objects[i].limit * 1e3,
        scene.objects[i].response.press(scene.objects[i].limit), scene.lowest_slope * 1e-3);
  }
  fmt::print("{}", weak_text(setup, scene));
  fmt::print("  commands up to {:g} mm/s and {:g} mm/s^2\n\nresolved scene\n{}", scene.reach.speed * 1e3,
             scene.reach.acceleration * 1e3, models::resolved(setup));
  return 0;
}

}  // namespace enc::app
