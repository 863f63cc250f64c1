// The fuzz targets, guided by coverage: libFuzzer's entry (preset `fuzz`). ENCOUNTER_FUZZ_TARGET names the
// target; inputs grow out of its seeds, so that no corpus is needed.
#include <algorithm>
#include <csignal>
#include <cstdint>
#include <cstdio>
#include <cstdlib>
#include <cstring>

#include "tests/fuzz/machine/fuzzing.h"

namespace {

using enc::fuzz::Mutator;
using enc::fuzz::Target;

const Target& chosen() {
  static const Target& the = [&]() -> const Target& {
    const char* name = std::getenv("ENCOUNTER_FUZZ_TARGET");
    for (const std::string& one : enc::fuzz::names()) {
      if (name != nullptr && one == name) return enc::fuzz::target(one);
      if (name == nullptr) std::fprintf(stderr, "ENCOUNTER_FUZZ_TARGET=%s\n", one.c_str());
    }
    std::exit(2);
  }();
  return the;
}

}  // namespace

extern "C" std::size_t LLVMFuzzerMutate(std::uint8_t* data, std::size_t size, std::size_t most);

extern "C" int LLVMFuzzerInitialize(int*, char***) {
  static_cast<void>(chosen());
  std::signal(SIGPROF, SIG_IGN);  // libFuzzer has a -timeout of its own
  return 0;
}

extern "C" std::size_t LLVMFuzzerCustomMutator(std::uint8_t* data, std::size_t size, std::size_t most,
                                               unsigned seed) {
  const Target& target = chosen();
  std::string input(reinterpret_cast<const char*>(data), size);
  if (size < 2 || seed % 256 == 0) {
    input = target.seeds[seed / 256 % target.seeds.size()];
  } else if (seed % 4 < 2) {
    input = Mutator(seed, {input}, target.tokens).next();
  } else {
    size = LLVMFuzzerMutate(data, size, most);
    input.assign(reinterpret_cast<const char*>(data), size);
  }
  if (target.mend && seed % 16 < 12) target.mend(input);
  size = std::min(input.size(), most);
  std::memcpy(data, input.data(), size);
  return size;
}

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  const enc::fuzz::Verdict verdict =
      enc::fuzz::judge(chosen(), std::string(reinterpret_cast<const char*>(data), size));
  if (verdict.wrong.empty()) return 0;
  std::fprintf(stderr, "%s: %s\n", chosen().name.c_str(), verdict.wrong.c_str());
  std::abort();
}
