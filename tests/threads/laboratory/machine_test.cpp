// The driver of the C-887, whose link is a thread's, between the loop and a controller that suffers faults.
#include <functional>
#include <memory>

#include <gmock/gmock.h>

#include "tests/threads/laboratory/faulty_fakes.h"
#include "tests/threads/laboratory/loop_thread.h"
#include "tests/threads/laboratory/watches.h"

namespace enc::test {
namespace {

using testing::Contains;
using testing::ElementsAre;
using testing::HasSubstr;
using testing::IsEmpty;

using Kind = Trouble::Kind;

TEST(ThreadedMachine, KeepsItsLinkThroughWhatHealsAndTearsNoNumber) {
  FaultyGcs there(kPatient);
  FaultyFakes fakes({there.server.get()});
  fakes.suffer(*there.server, {Kind::slow_start, 0.05});
  const auto driver = there.driver();
  fakes.heal(*there.server, Kind::slow_start);
  MachineWatch watch(*driver);
  LoopThread loop(watch);
  for (int i = 0; i < 25; ++i) {
    const Trouble trouble = i % 2 == 0 ? Trouble{Kind::jitter, 0.003} : Trouble{Kind::stall};
    fakes.suffer(*there.server, trouble);
    loop.pass(15);
    fakes.heal(*there.server, trouble.kind);
    loop.pass(5);
  }
  const std::int64_t before = watch.news();
  EXPECT_TRUE(comes_true([&] { return watch.news() > before + 20; }));
  loop.end();
  watch.expect_whole();
  EXPECT_TRUE(driver->linked());
  EXPECT_GT(watch.farthest, 1e-4) << "it moves";
  EXPECT_THAT(there.log.lines(), IsEmpty());
}

struct LastFault {
  Trouble trouble;
  double patience;    // s
  const char* words;  // of why the link is lost
};
void expect_end_by(const LastFault& fault) {
  FaultyGcs there(fault.patience);
  FaultyFakes fakes({there.server.get()});
  auto driver = there.driver();
  MachineWatch watch(*driver);
  LoopThread loop(watch);
  loop.pass(20);
  fakes.suffer(*there.server, fault.trouble);
  EXPECT_TRUE(comes_true([&] { return watch.lost(); }));
  fakes.heal(*there.server);
  loop.pass(20);
  loop.end();
  watch.expect_whole();
  EXPECT_FALSE(driver->linked());
  EXPECT_NE(driver->read(Time{}).health, Health::ok);
  driver.reset();  // what its thread had to tell it has told then
  EXPECT_THAT(there.log.lines(), Contains(HasSubstr(fault.words)));
}

// What may leave an answer without its end is met by one that waits for it no longer than need be.
TEST(ThreadedMachine, AFaultThatEndsTheLinkIsSeenByTheLoopAndIsForGood) {
  constexpr int kFailure = 504;
  for (const LastFault& fault :
       {LastFault{{Kind::stall}, kImpatient, "lost: no answer in time"},
        LastFault{{Kind::disconnect}, kPatient, "lost: closed by the controller"},
        LastFault{{Kind::error_code, kFailure}, kPatient, "lost: a fault of the machine"},
        LastFault{{Kind::half_message, 1.0}, kImpatient, "lost: "},
        LastFault{{Kind::garbage, 1.0}, kImpatient, "lost: "}}) {
    SCOPED_TRACE(static_cast<int>(fault.trouble.kind));
    expect_end_by(fault);
  }
}

// Ends the driver while its controller is as `meets` leaves it, which the driver may not have seen yet.
using Meets = std::function<void(FaultyGcs& there, FaultyFakes& fakes)>;
void end_after(const Meets& meets, bool told) {
  FaultyGcs there(kPatient);
  FaultyFakes fakes({there.server.get()});
  auto driver = there.driver();
  MachineWatch watch(*driver, told);
  LoopThread loop(watch);
  loop.pass(15);
  meets(there, fakes);
  loop.end();
  driver.reset();
  watch.expect_whole();
}
Meets suffering(const Trouble& trouble) {
  return [=](FaultyGcs& there, FaultyFakes& fakes) { fakes.suffer(*there.server, trouble); };
}
void nothing(FaultyGcs&, FaultyFakes&) {}
void left_alone(FaultyGcs&, FaultyFakes& fakes) { fakes.end(); }
void gone(FaultyGcs& there, FaultyFakes& fakes) {
  fakes.end();
  there.server.reset();
}

TEST(ThreadedMachine, EndsInEveryState) {
  for (const bool told : {false, true}) {
    end_after(nothing, told);
    end_after(suffering({Kind::jitter, 0.1}), told);
    end_after(suffering({Kind::stall}), told);
    end_after(suffering({Kind::disconnect}), told);
    end_after(suffering({Kind::garbage, 1.0}), told);
    end_after(gone, told);
  }
  end_after(left_alone, true);
}

// The thread may not have had its first turn.
TEST(ThreadedMachine, EndsAsSoonAsItHasBegun) {
  FaultyGcs there(kPatient);
  FaultyFakes fakes({there.server.get()});
  static_cast<void>(there.driver());
  const auto driver = there.driver();
  driver->stop();
  MachineWatch watch(*driver);
  watch.tick(Time{});
  fakes.suffer(*there.server, {Kind::disconnect});
  EXPECT_THAT(there.log_of_fake.lines(),
              ElementsAre(HasSubstr("the client is gone"), HasSubstr("the client is gone")));
}

}  // namespace
}  // namespace enc::test
