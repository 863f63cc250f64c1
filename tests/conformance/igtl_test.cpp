// The driver of tool data over TCP and UDP: against our server, and against bytes that no server should send.
#include <chrono>
#include <string>
#include <thread>
#include <tuple>
#include <vector>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "core/base/error.h"
#include "tests/conformance/igtl_bench.h"
#include "tests/support/error_of.h"

namespace enc::test {
namespace {

using igtl::OutgoingMessage;
using ::testing::HasSubstr;

// ---- Tool data over loopback: the driver, and the server in place of the laboratory's.

// Datagrams, and a stream in each form of request.
TEST(IgtlDriver, TakesThePosesOfAServerUntilItIsSilent) {
  using igtl::Transport;
  for (const auto& [transport, message, words] :
       {std::tuple{Transport::udp, "TRANSFORM", "tool data of 127.0.0.1:"},
        {Transport::tcp, "TRANSFORM", "tracker's server at 127.0.0.1:"},
        {Transport::tcp, "TDATA", "tracker's server at 127.0.0.1:"}}) {
    SCOPED_TRACE(testing::Message() << words << message);
    IgtlPort there(transport);
    there.table.message = message;
    auto served = std::make_unique<FakeServer>(there.server);
    const auto driver = igtl::subscribed(there.offer());
    EXPECT_THAT(driver->describe(), HasSubstr(words));
    EXPECT_TRUE(driver->is_fake());
    const IgtlBench::PollCount seen = there.watch(*driver, 300);
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
    served = std::make_unique<FakeServer>(there.server);
    EXPECT_EQ(there.watch(*driver, 100).news, 0);
    EXPECT_FALSE(driver->linked()) << "only another run connects again";
  }
}

// The process stops within a tick: the samples that it then reads arrived after the tick began.
TEST(IgtlDriver, AfterATickThatWasHeldUpPosesAreAsFreshAsBefore) {
  IgtlPort there;
  const FakeServer served(there.server);
  const auto driver = igtl::subscribed(there.offer());
  ASSERT_GT(there.watch(*driver, 300).news, 10);
  const Time began(net::steady_now() - there.begun);
  constexpr double kHeldUp = 0.15;  // s: shorter than the allowed silence
  std::this_thread::sleep_for(std::chrono::duration<double>(kHeldUp));
  EXPECT_TRUE(driver->poll(began, there.newest));
  EXPECT_LE(there.newest.t, began);
  double freshest = kHeldUp;
  for (int i = 0; i < 30; ++i) {
    const IgtlPort::PollCount one = there.watch(*driver, 10);
    if (one.news > 0) freshest = std::min(freshest, one.oldest);
  }
  EXPECT_LT(freshest, 0.3 * kHeldUp);
}

TEST(IgtlDriver, AnErrorOfTheServerWithoutACodeIsAStatusOfIts) {
  IgtlPort there;
  EXPECT_FALSE(there.server.knows({Trouble::Kind::error_code, 65536.0}));
  ASSERT_TRUE(there.server.knows({Trouble::Kind::error_code}));
  there.server.suffer({Trouble::Kind::error_code});
  const FakeServer served(there.server);
  const auto driver = igtl::subscribed(there.offer());
  EXPECT_EQ(there.watch(*driver, 100).news, 0);
  EXPECT_THAT(driver->remarks().at(0), HasSubstr("it reported status 18"));
}

TEST(IgtlDriver, WhoDoesNotAnswerIsNamed) {
  IgtlPort there;
  EXPECT_THAT(error_of([&] { static_cast<void>(igtl::subscribed(there.offer())); }, ErrorKind::device),
              HasSubstr("no tool data within 300 ms; see that its server runs"));
}

// ---- The driver of a tracker's own server: OpenIGTLink over TCP, against our fake and against bytes that no
// server should send.

// A server that sends given bytes to one client.
struct RawServer {
  explicit RawServer(IgtlTable& table) { table.port = listener.port(); }
  void accept() {
    listener.wait(Duration(1'000'000'000));
    client = listener.accept();
  }
  void send(std::span<const std::byte> bytes) { EXPECT_EQ(client.send(bytes), bytes.size()); }
  // The types of all messages from the driver so far.
  std::vector<std::string> heard() {
    std::vector<std::string> types;
    igtl::Message message;
    client.wait(Duration(100'000'000));
    stream.came(client.receive(stream.room()));
    for (auto bytes = stream.next(); !bytes.empty(); bytes = stream.next()) {
      EXPECT_EQ(igtl::read(bytes, message), igtl::MessageFault::nothing);
      types.emplace_back(message.type.view());
    }
    return types;
  }
  net::Socket listener = net::listen_tcp("127.0.0.1", 0);
  net::Socket client;
  igtl::Stream stream;
};

OutgoingMessage pose(std::int64_t ms, double x = 0.1, const char* device = "stylusToTracker") {
  return {"TRANSFORM", device, ms * 1'000'000, igtl::transform(Pose<'C', 'T'>::shift(x, 0, 1))};
}

// Passes messages to the driver, each in a poll of its own.
struct RawBench : IgtlBench {
  explicit RawBench(const std::string& message = "TRANSFORM") {
    table.transport = "tcp";
    table.message = message;
    std::thread accepting([&] {
      server.accept();
      server.send(OutgoingMessage("STATUS", "Server", 0, igtl::status(1)).bytes());
    });
    driver = igtl::subscribed(offer());
    accepting.join();
    settle(*driver, now);
  }
  bool takes(std::span<const std::byte> bytes) {
    server.send(bytes);
    now += Duration(1'000'000);
    return driver->poll(now, newest);
  }
  std::string remark() { return driver->remarks().at(0); }
  RawServer server{table};
  std::unique_ptr<PoseTracker> driver;
  Time now{Duration(1'000'000'000)};
};

// The driver requests TDATA only if its table says so, and ends the request when it closes.
TEST(IgtlStreamDriver, AsksForTdataWhereItIsToldToAndForNothingElse) {
  RawBench bench("TDATA");
  EXPECT_THAT(bench.server.heard(), testing::ElementsAre("STT_TDATA", "GET_STATUS"));
  const auto element = igtl::element("stylusToTracker", Pose<'C', 'T'>::shift(0.1, 0, 1));
  EXPECT_TRUE(bench.takes(OutgoingMessage("TDATA", "Tracker", 1'000'000, element).bytes()));
  EXPECT_NEAR(bench.newest.value.X_CT.p().x(), 0.1, 1e-8);
  bench.driver.reset();
  EXPECT_THAT(bench.server.heard(), testing::ElementsAre("STP_TDATA"));
  RawBench plain;
  EXPECT_THAT(plain.server.heard(), testing::ElementsAre("GET_STATUS"));
  plain.driver.reset();
  EXPECT_THAT(plain.server.heard(), testing::IsEmpty());
}

// The server continues between the start of the driver and the run: its poses from that time are old, and no
// tick accepts one as current.
TEST(IgtlStreamDriver, WhatCameBeforeTheRunIsPassedOver) {
  IgtlBench bench;
  bench.table.transport = "tcp";
  RawServer server(bench.table);
  std::thread accepting([&] {
    server.accept();
    server.send(OutgoingMessage("STATUS", "Server", 0, igtl::status(1)).bytes());
  });
  const auto driver = igtl::subscribed(bench.offer());
  accepting.join();
  std::int64_t stamp = 0;  // ms
  for (int i = 0; i < 1000; ++i) server.send(pose(++stamp).bytes());
  Time now{Duration(1'000'000'000)};
  for (int tick = 0; tick < 20; ++tick) {
    for (int i = 0; tick < 5 && i < 100; ++i)
      server.send(pose(++stamp).bytes());  // poses that it could not send before
    now += Duration(1'000'000);
    EXPECT_FALSE(driver->poll(now, bench.newest)) << tick;
  }
  server.send(pose(++stamp, 0.7).bytes());
  now += Duration(1'000'000);
  EXPECT_TRUE(driver->poll(now, bench.newest));
  EXPECT_NEAR(bench.newest.value.X_CT.p().x(), 0.7, 1e-6);
}

// The driver asks a silent server for its status four times in silent_ms while no tool is in view.
TEST(IgtlStreamDriver, AsksAServerThatSaysNothingWhetherItIsThere) {
  RawBench bench;
  EXPECT_THAT(bench.server.heard(), testing::ElementsAre("GET_STATUS"));
  for (int i = 0; i < 190; ++i) {
    bench.now += Duration(1'000'000);
    EXPECT_FALSE(bench.driver->poll(bench.now, bench.newest));
  }
  EXPECT_TRUE(bench.driver->linked());
  EXPECT_THAT(bench.server.heard(), testing::ElementsAre("GET_STATUS", "GET_STATUS", "GET_STATUS"));
  bench.now += Duration(20'000'000);
  static_cast<void>(bench.driver->poll(bench.now, bench.newest));
  EXPECT_FALSE(bench.driver->linked()) << "no answer for 0.2 s";
}

TEST(IgtlStreamDriver, WhatTheServerClosesIsLostAtOnce) {
  RawBench bench;
  EXPECT_TRUE(bench.takes(pose(1).bytes()));
  bench.server.client = {};
  bench.now += Duration(1'000'000);
  EXPECT_FALSE(bench.driver->poll(bench.now, bench.newest));
  EXPECT_FALSE(bench.driver->linked());
  EXPECT_THAT(bench.remark(), HasSubstr("then it hung up"));
}

TEST(IgtlStreamDriver, AMessageWithAWrongSumIsNotTakenAndTheNextIs) {
  RawBench bench;
  const OutgoingMessage good = pose(1);
  std::vector<std::byte> wrong(good.bytes().begin(), good.bytes().end());
  wrong.back() ^= std::byte{1};
  EXPECT_FALSE(bench.takes(wrong));
  EXPECT_TRUE(bench.takes(pose(2).bytes()));
  EXPECT_TRUE(bench.driver->linked());
  EXPECT_THAT(bench.remark(), HasSubstr("1 poses"));
  EXPECT_THAT(bench.remark(), HasSubstr("0 wrong; 1 with a wrong CRC"));
}

TEST(IgtlStreamDriver, HalfAMessageIsTakenWhenTheOtherHalfIsThere) {
  RawBench bench;
  for (const std::size_t cut : {1U, 57U, 58U, 59U, 105U}) {
    const OutgoingMessage one = pose(static_cast<std::int64_t>(cut));
    EXPECT_FALSE(bench.takes(one.bytes().first(cut))) << cut;
    EXPECT_TRUE(bench.takes(one.bytes().subspan(cut))) << cut;
  }
}

TEST(IgtlStreamDriver, WhatIsNoOpenIGTLinkEndsTheLink) {
  RawBench bench;
  EXPECT_TRUE(bench.takes(pose(1).bytes()));
  const std::string page = "HTTP/1.1 400 Bad Request\r\nContent-Type: text/html\r\nConnection: close\r\n\r\n";
  EXPECT_FALSE(bench.takes(std::as_bytes(std::span(page))));
  EXPECT_FALSE(bench.driver->linked());
  EXPECT_THAT(bench.remark(), HasSubstr("then what came was no OpenIGTLink"));
}

TEST(IgtlStreamDriver, AToolThatNobodyNamedIsNamedInTheReport) {
  RawBench bench;
  EXPECT_FALSE(bench.takes(pose(1, 0.1, "hammerToTracker").bytes()));
  EXPECT_TRUE(bench.takes(pose(1).bytes()));
  EXPECT_THAT(bench.remark(),
              HasSubstr("1 of tools that the scene does not name, such as 'hammerToTracker'"));
}

TEST(IgtlStreamDriver, VersionTwoWithMetadataIsReadAndWhatItCallsInvalidIsNot) {
  RawBench bench;
  const auto content = igtl::transform(Pose<'C', 'T'>::shift(0.2, 0, 1));
  EXPECT_TRUE(bench.takes(
      OutgoingMessage("TRANSFORM", "stylusToTracker", 1'000'000, 1, content, "TransformStatus", "OK")
          .bytes()));
  EXPECT_NEAR(bench.newest.value.X_CT.p().x(), 0.2, 1e-8);
  EXPECT_FALSE(bench.takes(
      OutgoingMessage("TRANSFORM", "stylusToTracker", 2'000'000, 1, content, "TransformStatus", "OUT_OF_VIEW")
          .bytes()));
  EXPECT_THAT(bench.remark(), HasSubstr("1 of tools out of view"));
}

// The error of each server, in a line with a remedy.
TEST(IgtlStreamDriver, WhoIsNoTrackerIsNamed) {
  IgtlBench bench;
  bench.table.transport = "tcp";
  const auto refused = [&] {
    try {
      static_cast<void>(igtl::subscribed(bench.offer()));
    } catch (const Error& e) {
      EXPECT_EQ(e.kind(), ErrorKind::device);
      EXPECT_EQ(std::string(e.what()).find('\n'), std::string::npos);
      return std::string(e.what());
    }
    return std::string("taken");
  };
  RawServer silent(bench.table);
  EXPECT_THAT(refused(), HasSubstr("let us in and said nothing within 300 ms; see that the server runs"));
  silent.listener = {};
  EXPECT_THAT(refused(), HasSubstr("nobody listens there"));
  RawServer other(bench.table);
  std::thread web([&] {
    other.accept();
    const std::string page(100, 'x');
    other.send(std::as_bytes(std::span(page)));
  });
  EXPECT_THAT(refused(), HasSubstr("does not speak OpenIGTLink; see that this is the port"));
  web.join();
  IgtlPort there(igtl::Transport::tcp);
  const FakeServer served(there.server);
  const auto first = igtl::subscribed(there.offer());
  bench.table.port = there.table.port;
  EXPECT_THAT(refused(), HasSubstr("let us in and hung up; see that it takes another client"));
  EXPECT_GT(there.watch(*first, 100).news, 3) << "the first stays";
}

}  // namespace
}  // namespace enc::test
