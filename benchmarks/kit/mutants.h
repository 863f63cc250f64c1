// Mutants: changes of the twin or of a benchmark, each of which must turn bounds red (`bench --mutate`).
#pragma once

#include <cstdint>
#include <span>
#include <string>
#include <string_view>
#include <vector>

namespace enc::bench {

// The cheapest form of a run that judges the bounds: --quick, the default, --full.
enum class Form : std::uint8_t { quick, usual, full };

// A benchmark has its mutants in one table, beside its Entry or in benchmarks/NAME/mutants.cpp:
//   const Mutants kMutants{"deformation",
//                          {{.what = "dent of the seen ball half as wide",
//                            .changes = {"narrow_dent"},
//                            .kills = {"contour.*.rms_mm", "dent.*.iou"}}}};
struct Mutant {
  std::string what;                    // shown beside each bound that it turns red
  std::vector<std::string> set{};      // as --set: "truth.tracker.noise_mm=[1,1,1]"
  std::vector<std::string> changes{};  // that the benchmark asks for: context.mutated("narrow_dent")
  std::vector<std::string> kills{};    // ids without the benchmark's name; "*" is one token
  Form form = Form::quick;
};

class Mutants {
 public:
  Mutants(const char* benchmark, std::vector<Mutant> mutants);
};

[[nodiscard]] std::span<const Mutant> mutants_of(std::string_view benchmark);
// True if the id matches a pattern of `kills`: both without the benchmark's name.
[[nodiscard]] bool fits_id(std::string_view pattern, std::string_view id);

}  // namespace enc::bench
