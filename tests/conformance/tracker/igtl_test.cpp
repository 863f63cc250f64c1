// Tool data over loopback: the driver and the server that stands in for the laboratory's.
#include <chrono>
#include <thread>
#include <tuple>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "core/base/error.h"
#include "tests/conformance/tracker/igtl_bench.h"

namespace enc::test {
namespace {

using testing::HasSubstr;

// By datagrams, and by a stream in each form that is asked for.
TEST(IgtlDriver, TakesThePosesOfAServerUntilItIsSilent) {
  using igtl::Transport;
  for (const auto& [transport, message, words] :
       {std::tuple{Transport::udp, "TRANSFORM", "tool data of 127.0.0.1:"},
        {Transport::tcp, "TRANSFORM", "tracker's server at 127.0.0.1:"},
        {Transport::tcp, "TDATA", "tracker's server at 127.0.0.1:"}}) {
    SCOPED_TRACE(testing::Message() << words << message);
    IgtlPort there(transport);
    there.table.message = message;
    auto served = std::make_unique<Served>(there.server);
    const auto driver = igtl::subscribed(there.offer());
    EXPECT_THAT(driver->describe(), HasSubstr(words));
    EXPECT_TRUE(driver->is_fake());
    const IgtlBench::Watched seen = there.watch(*driver, 300);
    EXPECT_GT(seen.news, 10);
    EXPECT_EQ(there.newest.health, Health::ok);
    EXPECT_EQ(there.newest.value.tool, 0);
    EXPECT_LT((there.newest.value.X_CT.p() - Vec3(0.1, 0.2, 0.9)).norm(), 1e-12)
        << "the pose to the last bit";
    EXPECT_GE(seen.oldest, 0.003);
    there.tracker.in_view = false;
    there.watch(*driver, 30);
    EXPECT_EQ(there.watch(*driver, 400).news, 0);
    EXPECT_TRUE(driver->linked()) << "it says that it is there";
    served.reset();
    there.watch(*driver, 300);
    EXPECT_FALSE(driver->linked());
    there.tracker.in_view = true;
    served = std::make_unique<Served>(there.server);
    EXPECT_EQ(there.watch(*driver, 100).news, 0);
    EXPECT_FALSE(driver->linked()) << "only another run connects again";
  }
}

// The process is stopped within a tick: what it reads then came later than the tick began.
TEST(IgtlDriver, AfterATickThatWasHeldUpPosesAreAsFreshAsBefore) {
  IgtlPort there;
  const Served served(there.server);
  const auto driver = igtl::subscribed(there.offer());
  ASSERT_GT(there.watch(*driver, 300).news, 10);
  const Time began(net::steady_now() - there.begun);
  constexpr double kHeldUp = 0.15;  // s: less than it may be silent
  std::this_thread::sleep_for(std::chrono::duration<double>(kHeldUp));
  EXPECT_TRUE(driver->poll(began, there.newest));
  EXPECT_LE(there.newest.t, began);
  double freshest = kHeldUp;
  for (int i = 0; i < 30; ++i) {
    const IgtlPort::Watched one = there.watch(*driver, 10);
    if (one.news > 0) freshest = std::min(freshest, one.oldest);
  }
  EXPECT_LT(freshest, 0.3 * kHeldUp);
}

TEST(IgtlDriver, AnErrorOfTheServerWithoutACodeIsAStatusOfIts) {
  IgtlPort there;
  EXPECT_FALSE(there.server.knows({Trouble::Kind::error_code, 65536.0}));
  ASSERT_TRUE(there.server.knows({Trouble::Kind::error_code}));
  there.server.suffer({Trouble::Kind::error_code});
  const Served served(there.server);
  const auto driver = igtl::subscribed(there.offer());
  EXPECT_EQ(there.watch(*driver, 100).news, 0);
  EXPECT_THAT(driver->remarks().at(0), HasSubstr("it reported status 18"));
}

TEST(IgtlDriver, WhoDoesNotAnswerIsNamed) {
  IgtlPort there;
  try {
    static_cast<void>(igtl::subscribed(there.offer()));
    FAIL();
  } catch (const Error& e) {
    EXPECT_EQ(e.kind(), ErrorKind::device);
    EXPECT_THAT(e.what(), HasSubstr("no tool data within 300 ms; see that its server runs"));
  }
}

}  // namespace
}  // namespace enc::test
