// The certificate of every scene that ships, and what it costs (trial/certificates.h).
#include <algorithm>
#include <string>

#include <fmt/format.h>

#include "benchmarks/kit/statistics.h"
#include "benchmarks/stability/stability.h"
#include "models/setup/scene_file.h"
#include "trial/assemble/prepare.h"
#include "trial/certificates.h"

namespace enc::bench::stability {
namespace {

std::string in_mm(double per_metre) {
  return std::isfinite(per_metre) ? fmt::format("{:.4g}", 1e-3 * per_metre) : std::string();
}

// N/mm; nothing where the certificate has no such row.
std::string told(const trial::Certified& one, const char* name, double certificate::Row::*of) {
  for (const certificate::Row& row : one.certificate.rows)
    if (row.name == name) return sign_of(row.side) + in_mm(row.*of);
  return {};
}

}  // namespace

void add_scenes(Bench& bench) {
  Table table{"stability_scenes",
              "What the shipped scenes render, as `check` certifies it",
              {"scene", "object", "class", "asks for (N/mm)", "passive to", "stable alone to",
               "with the hand to", "admittance from", "large signal from"}};
  double beyond = 0.0, unknown = 0.0, objects = 0.0, most = 0.0;
  const std::string& models = bench.context.models;
  for (const std::string& name : models::files_in(models, "scenes")) {
    const models::Setup setup = models::load(models + "/scenes/" + name + ".toml", {});
    const Scene scene = trial::prepare_setup(setup);
    const double start = thread_seconds();
    const std::vector<trial::Certified> found = trial::certificates_of(setup, scene, true);
    most = std::max(most, thread_seconds() - start);
    for (const trial::Certified& one : found) {
      using certificate::Row;
      ++objects;
      beyond += one.beyond() ? 1.0 : 0.0;
      unknown += one.unknown() ? 1.0 : 0.0;
      table.add(name, one.object.empty() ? "(none)" : one.object, word_of(one.certificate.verdict),
                in_mm(one.asked), told(one, "colgate_schenkel", &Row::bound),
                told(one, "exact_alone", &Row::bound), told(one, "exact_with_hand", &Row::bound),
                told(one, "admittance", &Row::low), told(one, "large_signal", &Row::low));
    }
  }
  table.note =
      "Of an arm: (none) is the tip that nobody touches. Of a machine that measures force the object asks "
      "for its "
      "softest slope.";
  bench.result.tables.push_back(std::move(table));
  bench.figure("scenes.objects.value", objects, "", "objects of shipped scenes that have a certificate");
  bench.figure("scenes.beyond.value", beyond, "", at_most(0.0),
               "of them, that are not stable under the hand that the rig expects");
  bench.figure("scenes.unknown.value", unknown, "", at_most(0.0), "of them, of which it is not known");
  bench.cost("scenes.time.max", 1e3 * most, "ms", "CPU time of all certificates of a scene, at most");
}

}  // namespace enc::bench::stability
