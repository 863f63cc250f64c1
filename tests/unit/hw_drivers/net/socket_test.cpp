#include "hw_drivers/net/socket.h"

#include <array>
#include <chrono>
#include <string>
#include <string_view>
#include <thread>
#include <utility>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "core/base/error.h"
#include "hw_drivers/net/steady.h"

namespace enc::net {
namespace {

constexpr Duration kSoon{2'000'000'000};  // for what comes at once, on a busy machine too

std::span<const std::byte> bytes_of(std::string_view text) {
  return std::as_bytes(std::span(text.data(), text.size()));
}
std::string received(Socket& socket, std::size_t most = 64) {
  std::array<std::byte, 64> bytes{};
  socket.wait(kSoon);
  const std::size_t size = socket.receive(std::span(bytes).first(most));
  return {reinterpret_cast<const char*>(bytes.data()), size};
}
Socket accepted(Socket& server) {
  server.wait(kSoon);
  return server.accept();
}
// Some containers have none.
bool has_ipv6() {
  try {
    return listen_tcp("::1", 0).is_open();
  } catch (const Error&) {
    return false;
  }
}
template <class Call>
std::string error_of(Call call) {
  try {
    call();
  } catch (const Error& e) {
    return e.what();
  }
  return "no error";
}

// Whoever reads late is told when it came, by datagrams and in a stream.
TEST(Socket, SaysWhenWhatItGaveHadCome) {
  Socket there = bind_udp("127.0.0.1", 0);
  Socket here = connect_udp("127.0.0.1", there.port());
  Socket server = listen_tcp("127.0.0.1", 0);
  Socket caller = connect_tcp("127.0.0.1", server.port(), kSoon);
  Socket called = accepted(server);
  for (const auto& [from, to] : {std::pair{&here, &there}, {&called, &caller}}) {
    const Duration sent = steady_now();
    from->send(bytes_of("x"));
    std::this_thread::sleep_for(std::chrono::milliseconds(50));
    EXPECT_EQ(received(*to), "x");
    EXPECT_GE(to->came(), sent - Duration(1'000'000));
    EXPECT_LE(to->came(), steady_now() - Duration(40'000'000)) << "the kernel's word, not when it was read";
  }
}

TEST(Socket, CarriesBytesBothWays) {
  for (const char* address : {"127.0.0.1", "::1", "localhost"}) {
    if (address == std::string("::1") && !has_ipv6()) continue;
    Socket server = listen_tcp(address, 0);
    Socket client = connect_tcp(address, server.port(), kSoon);
    Socket other = accepted(server);
    ASSERT_TRUE(other.is_open()) << address;
    EXPECT_EQ(client.send(bytes_of("POS?\n")), 5U);
    EXPECT_EQ(received(other, 2), "PO") << "what does not fit is for the next time";
    EXPECT_EQ(received(other), "S?\n");
    EXPECT_EQ(other.send(bytes_of("X=1\n")), 4U);
    EXPECT_EQ(received(client), "X=1\n");
  }
}

TEST(Socket, DoesNotWait) {
  Socket server = listen_tcp("127.0.0.1", 0);
  EXPECT_FALSE(server.accept().is_open());
  Socket client = connect_tcp("127.0.0.1", server.port(), kSoon);
  std::array<std::byte, 8> bytes{};
  EXPECT_EQ(client.receive(bytes), 0U);
  EXPECT_FALSE(client.closed()) << "nothing came, and that is all";
  const Duration before = steady_now();
  EXPECT_FALSE(client.wait(Duration(2'000'000)));
  EXPECT_GE(steady_now() - before, Duration(2'000'000));
}

TEST(Socket, SaysThatTheOtherEndHasGone) {
  Socket server = listen_tcp("127.0.0.1", 0);
  Socket client = connect_tcp("127.0.0.1", server.port(), kSoon);
  { const Socket gone = accepted(server); }
  EXPECT_EQ(received(client), "");
  EXPECT_TRUE(client.closed());
  EXPECT_EQ(client.send(bytes_of("x")), 0U) << "and no signal ends the program";
}

// A client that sends and nobody who reads: in the end the system takes no more, and says so.
TEST(Socket, TakesNoMoreThanTheSystemDoes) {
  Socket server = listen_tcp("127.0.0.1", 0);
  Socket client = connect_tcp("127.0.0.1", server.port(), kSoon);
  const std::string much(1 << 20, 'x');
  std::size_t taken = much.size();
  for (int i = 0; i < 100 && taken == much.size(); ++i) taken = client.send(bytes_of(much));
  EXPECT_LT(taken, much.size());
  EXPECT_FALSE(client.closed());
}

TEST(Socket, Datagrams) {
  Socket server = bind_udp("127.0.0.1", 0);
  Socket client = connect_udp("127.0.0.1", server.port());
  EXPECT_EQ(server.reply(bytes_of("nobody")), 0U) << "nobody has asked yet";
  EXPECT_EQ(client.send(bytes_of("one")), 3U);
  EXPECT_EQ(client.send(bytes_of("two")), 3U);
  EXPECT_EQ(received(server, 2), "on") << "cut, and the rest is gone";
  EXPECT_EQ(received(server), "two");
  EXPECT_EQ(server.reply(bytes_of("nobody")), 0U) << "who sent is not answered before that is wanted";
  server.answer_sender();
  Socket stranger = connect_udp("127.0.0.1", server.port());
  EXPECT_EQ(stranger.send(bytes_of("?")), 1U);
  EXPECT_EQ(received(server), "?");
  EXPECT_EQ(server.reply(bytes_of("three")), 5U);
  EXPECT_EQ(received(client), "three");
  { const Socket gone = std::move(server); }
  client.send(bytes_of("four"));
  std::array<std::byte, 8> bytes{};
  client.wait(Duration(50'000'000));
  EXPECT_EQ(client.receive(bytes), 0U);
  EXPECT_FALSE(client.closed()) << "it may come back";
}

TEST(Socket, RefusesInClearWords) {
  using testing::HasSubstr;
  std::uint16_t port = 0;
  { port = listen_tcp("127.0.0.1", 0).port(); }
  EXPECT_THAT(error_of([&] { return connect_tcp("127.0.0.1", port, kSoon); }),
              testing::AllOf(HasSubstr(place("127.0.0.1", port)), HasSubstr("nobody listens there")));
  EXPECT_THAT(error_of([&] { return connect_tcp("no.such.host.invalid", port, kSoon); }),
              HasSubstr("'no.such.host.invalid' is no address and no name that is known"));
  const Socket taken = listen_tcp("127.0.0.1", 0);
  EXPECT_THAT(error_of([&] { return listen_tcp("127.0.0.1", taken.port()); }),
              HasSubstr("the port is taken"));
  for (const auto& listen : {listen_tcp, bind_udp})  // an address of documentation, which nobody has
    EXPECT_THAT(
        error_of([&] { return listen("192.0.2.1", 0); }),
        testing::AllOf(HasSubstr("192.0.2.1:0: "), HasSubstr("an address of this machine is needed")));
  EXPECT_EQ(place("::1", 80), "[::1]:80");
}

}  // namespace
}  // namespace enc::net
