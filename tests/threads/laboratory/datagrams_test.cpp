// The drivers that read datagrams within the loop, beside a thread that sends them and suffers faults.
#include <memory>
#include <vector>

#include <gtest/gtest.h>

#include "tests/threads/laboratory/faulty_fakes.h"
#include "tests/threads/laboratory/loop_thread.h"
#include "tests/threads/laboratory/watches.h"

namespace enc::test {
namespace {

using Kind = Trouble::Kind;

struct NetftKit {
  using Place = FaultyNetft;
  using Watched = SensorWatch;
};
struct IgtlKit {
  using Place = FaultyIgtl;
  using Watched = TrackerWatch;
};

template <class Kit>
struct ThreadedDatagrams : testing::Test {
  using Place = typename Kit::Place;
  using Watched = typename Kit::Watched;

  // Suffers one after the other, each for some ticks, for half a second.
  static void suffer(Place& there, FaultyFakes& fakes, const LoopThread<Watched>& loop,
                     const std::vector<Trouble>& all) {
    for (std::size_t i = 0; i < 25; ++i) {
      const Trouble& trouble = all[i % all.size()];
      if (!there.server->knows(trouble)) continue;
      fakes.suffer(*there.server, trouble);
      loop.pass(15);
      if (i % 4 != 0) fakes.heal(*there.server, trouble.kind);  // else it lasts
      loop.pass(5);
    }
    fakes.heal(*there.server);
  }
  // News come again, what was seen is whole, and the link is there. Gives how often a number was smaller than
  // the one before.
  static int expect_to_go_on_after(const std::vector<Trouble>& all) {
    Place there(kPatient);
    FaultyFakes fakes({there.server.get()});
    const auto driver = there.driver();
    Watched watch(*driver);
    LoopThread loop(watch);
    suffer(there, fakes, loop, all);
    const std::int64_t before = watch.news();
    EXPECT_TRUE(comes_true([&] { return watch.news() > before + 20; }));
    loop.end();
    watch.expect_whole();
    EXPECT_TRUE(driver->linked());
    return watch.smaller;
  }
};
using Kits = testing::Types<NetftKit, IgtlKit>;
TYPED_TEST_SUITE(ThreadedDatagrams, Kits);

TYPED_TEST(ThreadedDatagrams, GoForwardThroughWhatHeals) {
  const int smaller = this->expect_to_go_on_after({{Kind::loss, 0.3},
                                                   {Kind::reorder, 0.3},
                                                   {Kind::duplicate, 0.3},
                                                   {Kind::jitter, 0.004},
                                                   {Kind::slow_start, 0.05},
                                                   {Kind::half_message, 0.3},
                                                   {Kind::stall}});
  EXPECT_EQ(smaller, 0);
}

TYPED_TEST(ThreadedDatagrams, WhatIsNoiseIsNotTakenForGood) {
  this->expect_to_go_on_after({{Kind::garbage, 0.3},
                               {Kind::half_message, 0.3},
                               {Kind::reorder, 0.3},
                               {Kind::error_code, 13},
                               {Kind::saturate}});
}

TYPED_TEST(ThreadedDatagrams, SilenceIsTheEndOfTheLink) {
  for (const Trouble& trouble : {Trouble{Kind::stall}, Trouble{Kind::disconnect}, Trouble{Kind::loss, 1.0}}) {
    typename TestFixture::Place there(kImpatient);
    FaultyFakes fakes({there.server.get()});
    const auto driver = there.driver();
    typename TestFixture::Watched watch(*driver);
    LoopThread loop(watch);
    loop.pass(20);
    fakes.suffer(*there.server, trouble);
    EXPECT_TRUE(comes_true([&] { return watch.lost(); })) << static_cast<int>(trouble.kind);
    fakes.heal(*there.server);
    loop.pass(20);
    loop.end();
    watch.expect_whole();
    EXPECT_FALSE(driver->linked());
  }
}

TYPED_TEST(ThreadedDatagrams, EndInEveryState) {
  enum class At { once, reading, stall, left_alone, gone };
  for (const At at : {At::once, At::reading, At::stall, At::left_alone, At::gone}) {
    typename TestFixture::Place there(kPatient);
    FaultyFakes fakes({there.server.get()});
    auto driver = there.driver();
    typename TestFixture::Watched watch(*driver);
    if (at == At::once) continue;
    LoopThread loop(watch);
    loop.pass(15);
    if (at == At::stall) fakes.suffer(*there.server, {Kind::stall});
    if (at == At::left_alone || at == At::gone) fakes.end();
    if (at == At::gone) there.server.reset();
    loop.pass(5);
    loop.end();
    driver.reset();
    watch.expect_whole();
  }
}

}  // namespace
}  // namespace enc::test
