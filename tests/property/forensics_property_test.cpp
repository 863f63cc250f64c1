// `encounter calibrate` on seeded logs: what was put in comes out, and its intervals say how well.
#include <cstdio>
#include "benchmarks/forensics.h"

#include <gtest/gtest.h>

namespace enc::bench {
namespace {

TEST(Forensics, FindsWhatWasPutIn) {
  BenchContext context;
  context.models = ENCOUNTER_SOURCE_DIR "/models";
  BenchResult result;
  add_forensics(context, result);
  for (const Figure& f : result.figures) {
    EXPECT_TRUE(f.ok()) << f.id << " " << f.twin;
    std::printf("%s %g %s\n", f.id.c_str(), f.twin, f.note.c_str());
  }
  for (const auto& t : result.tables) for (const auto& r : t.rows) { for (const auto& c : r) std::printf("%s ", c.c_str()); std::puts(""); }
}

}  // namespace
}  // namespace enc::bench
