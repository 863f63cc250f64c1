// Every reader of files with damaged bytes: mutated files of models/ and small ones made here. A reader
// accepts them or refuses them with an Error of one line. It does not crash, hang, leak, or hold more heap
// than its bound (docs/reference/fuzz.md).
//
// ENCOUNTER_FUZZ_INPUTS and ENCOUNTER_FUZZ_SEED lengthen and vary the test: the full form is a million
// inputs.
#include <cstdlib>
#include <string>

#include <fmt/format.h>
#include <gtest/gtest.h>

#include "tests/fuzz/machine/fuzzing.h"

namespace enc::fuzz {
namespace {

// s of CPU time for one input: readers of files limit their work. Only the long form checks this, because the
// short one runs beside other programs.
constexpr double kSlowest = 5.0;

std::size_t number_of(const char* variable, std::size_t otherwise) {
  const char* text = std::getenv(variable);
  return text != nullptr && *text != '\0' ? std::strtoull(text, nullptr, 10) : otherwise;
}

// True if heap remains after each of three more readings of the input.
bool leaks(const Target& target, const std::string& input) {
  for (int i = 0; i < 3; ++i) {
    const std::size_t before = live_bytes();
    static_cast<void>(judge(target, input));
    if (live_bytes() <= before) return false;
  }
  return true;
}

class Parsers : public testing::TestWithParam<std::string> {};

TEST_P(Parsers, TakeOrRefuseWhateverComes) {
  const Target& target = fuzz::target(GetParam());
  const std::size_t inputs = number_of("ENCOUNTER_FUZZ_INPUTS", target.inputs);
  const bool long_form = std::getenv("ENCOUNTER_FUZZ_INPUTS") != nullptr;
  const std::size_t seed = number_of("ENCOUNTER_FUZZ_SEED", 1);
  const std::string words = fmt::format("{} (ENCOUNTER_FUZZ_SEED={})", target.name, seed);
  watch(words);
  std::size_t accepted = 0, most_heap = 0;
  double most_per_byte = 0.0, slowest = 0.0;
  for (const std::string& input : target.seeds) {
    const Verdict verdict = judge(target, input);
    ASSERT_EQ(verdict.wrong, "") << "seed of " << words << ": " << kept_input(target, input);
  }
  Mutator mutator(seed, target.seeds, target.tokens);
  for (std::size_t i = 0; i < inputs; ++i) {
    std::string input = mutator.next();
    if (target.mend && mutator.of(4) != 0) target.mend(input);
    const std::size_t before = live_bytes();
    const Verdict verdict = judge(target, input);
    ASSERT_EQ(verdict.wrong, "") << "input " << i << " of " << words << ": " << kept_input(target, input);
    const bool stays = live_bytes() > before && leaks(target, input);
    ASSERT_FALSE(stays) << "heap stays after input " << i << " of " << words << ": "
                        << kept_input(target, input);
    if (verdict.accepted) {
      ++accepted;
      mutator.keep(input);
    }
    if (long_form) {
      EXPECT_LE(verdict.seconds, kSlowest)
          << "input " << i << " of " << words << ": " << kept_input(target, input);
    }
    slowest = std::max(slowest, verdict.seconds);
    most_heap = std::max(most_heap, verdict.most_heap);
    most_per_byte = std::max(
        most_per_byte, static_cast<double>(verdict.most_heap) / static_cast<double>(input.size() + 1024));
  }
  fmt::print(
      "{:12} {:>8} inputs, {:5.1f} % accepted; at most {:.0f} kB of heap, {:.0f} bytes for one of input (and "
      "1 kB); slowest {:.3f} s\n",
      target.name, inputs, 100.0 * static_cast<double>(accepted) / static_cast<double>(inputs),
      static_cast<double>(most_heap) * 1e-3, most_per_byte, slowest);
  // A target that refuses every input only tests the first mistake.
  EXPECT_GT(accepted, 0U) << words;
}

INSTANTIATE_TEST_SUITE_P(Each, Parsers, testing::ValuesIn(names()),
                         [](const auto& one) { return one.param; });

}  // namespace
}  // namespace enc::fuzz
