// step() allocates nothing.
#include <atomic>
#include <cmath>
#include <cstdlib>
#include <new>

#include <gtest/gtest.h>

#include "core/control/step.h"
#include "tests/support/by_hand.h"
#include "trial/trackers/threaded_tracker.h"

// This test program counts its allocations.
#pragma GCC diagnostic ignored \
    "-Wmismatched-new-delete"  // inlined, free() is seen to take what our own new gave
namespace {
std::atomic<std::int64_t> allocations{0};
void* counted(std::size_t size, std::size_t alignment = 0) {
  ++allocations;
  void* p = alignment > 0 ? std::aligned_alloc(alignment, (size + alignment - 1) / alignment * alignment)
                          : std::malloc(size);
  if (p == nullptr) throw std::bad_alloc();
  return p;
}
}  // namespace
void* operator new(std::size_t size) { return counted(size); }
void* operator new[](std::size_t size) { return counted(size); }
void* operator new(std::size_t size, std::align_val_t a) {
  return counted(size, static_cast<std::size_t>(a));
}
void* operator new[](std::size_t size, std::align_val_t a) {
  return counted(size, static_cast<std::size_t>(a));
}
// Buffers that the library's algorithms allocate.
void* operator new(std::size_t size, const std::nothrow_t&) noexcept {
  ++allocations;
  return std::malloc(size);
}
void operator delete(void* p) noexcept { std::free(p); }
void operator delete[](void* p) noexcept { std::free(p); }
void operator delete(void* p, std::size_t) noexcept { std::free(p); }
void operator delete[](void* p, std::size_t) noexcept { std::free(p); }
void operator delete(void* p, std::align_val_t) noexcept { std::free(p); }
void operator delete[](void* p, std::align_val_t) noexcept { std::free(p); }
void operator delete(void* p, std::size_t, std::align_val_t) noexcept { std::free(p); }
void operator delete[](void* p, std::size_t, std::align_val_t) noexcept { std::free(p); }

namespace enc {
namespace {

using test::draw, test::kToolRadius, test::kTop, test::Loop, test::make, test::with_display;

TEST(Loop, AllocatesNothingAsATestRig) {
  Loop loop(prepare(test::rig_scene(), RigSpec{}));
  Outputs out;
  std::int64_t taken = 0;
  for (int i = 0; i < 9000; ++i) {  // up to the rest after the first push
    State copy = loop.state;
    loop.tick();
    const Inputs in = loop.in;
    const std::int64_t before = allocations;
    step(loop.scene, loop.k, in, copy, out);
    taken += allocations - before;
  }
  EXPECT_EQ(taken, 0);
  EXPECT_EQ(out.contacts, 1);
}

TEST(Loop, AllocatesNothing) {
  Loop loop = make(with_display());
  Inputs in;
  Outputs out;
  std::int64_t taken = 0, modes = 0;
  loop.spoil = [&](Inputs& i) { draw(i, loop); };
  for (int i = 0; i < 4000; ++i) {
    loop.tool_tip = Point<'W'>(0, 0, kTop + kToolRadius + 0.02 * std::cos(i * 2e-3));
    loop.force = Vec<'W'>(0, 0, std::min(0.0, 3 * std::cos(i * 2e-3)));
    if (i % 500 == 499) loop.tool_seen = !loop.tool_seen;
    State copy = loop.state;
    loop.tick();
    in = loop.in;
    const std::int64_t before = allocations;
    step(loop.scene, loop.k, in, copy, out);
    taken += allocations - before;
    modes |= 1 << static_cast<int>(out.mode);
  }
  EXPECT_EQ(taken, 0);
  EXPECT_GT(allocations.load(), 0);  // the counter counts
  EXPECT_EQ(modes & (1 << static_cast<int>(Mode::contact)), 1 << static_cast<int>(Mode::contact));
}

// A query of a tracker in its own thread allocates nothing, nor does that thread.
TEST(Loop, ATrackerInAThreadAllocatesNothing) {
  class StillTracker final : public PoseTracker {
    bool poll(Time now, Measurement<TrackedTool>& newest) noexcept override {
      newest = {{}, now, Health::ok};
      return true;
    }
  };
  trial::ThreadedTracker tracker(std::make_unique<StillTracker>());
  Measurement<TrackedTool> newest;
  std::int64_t news = 0, now = 0;
  const std::int64_t before = allocations;
  while (news < 100) news += tracker.poll(Time(Duration(++now)), newest) ? 1 : 0;
  const std::int64_t taken = allocations - before;
  EXPECT_EQ(taken, 0);
}

}  // namespace
}  // namespace enc
