// The words of a Net F/T, byte by byte.
#include <limits>
#include <random>
#include <string>
#include <vector>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "hw_drivers/netft/fake/box.h"
#include "hw_drivers/netft/wire/configuration.h"
#include "hw_drivers/netft/wire/http.h"
#include "hw_drivers/netft/wire/record.h"
#include "tests/unit/hw_drivers/hex.h"

namespace enc::netft {
namespace {

using tests::hex;

TEST(NetftWire, RequestsAreThoseOfTheManual) {
  EXPECT_EQ(hex(bytes_of(Request{Command::start, 0})), "1234000200000000");
  EXPECT_EQ(hex(bytes_of(Request{Command::start, 1})), "1234000200000001");
  EXPECT_EQ(hex(bytes_of(Request{Command::stop, 0})), "1234000000000000");
  EXPECT_EQ(hex(bytes_of(Request{Command::bias, 0})), "1234004200000000");
  Request request;
  EXPECT_FALSE(read(std::vector<std::byte>(8), request)) << "no mark";
  EXPECT_FALSE(read(std::vector<std::byte>(7), request));
}

TEST(NetftWire, ARecordIs36BytesBigEndian) {
  const Record record{1, 7000, 0x80020000, {1500000, -2000000, 12000000, 1, -1, 0}};
  const std::string golden =
      "00000001"
      "00001b58"
      "80020000"
      "0016e360"
      "ffe17b80"
      "00b71b00"
      "00000001"
      "ffffffff"
      "00000000";
  EXPECT_EQ(hex(bytes_of(record)), golden);
  std::mt19937_64 random(5);
  for (int i = 0; i < 1000; ++i) {
    Record any;
    any.number = static_cast<std::uint32_t>(random());
    any.sample = static_cast<std::uint32_t>(random());
    any.status = static_cast<std::uint32_t>(random());
    for (std::int32_t& count : any.counts) count = static_cast<std::int32_t>(random());
    Record back;
    ASSERT_TRUE(read(bytes_of(any), back));
    EXPECT_EQ(back.number, any.number);
    EXPECT_EQ(back.sample, any.sample);
    EXPECT_EQ(back.status, any.status);
    EXPECT_EQ(back.counts, any.counts);
  }
  Record back;
  for (const std::size_t size : {0U, 35U, 37U, 72U}) EXPECT_FALSE(read(std::vector<std::byte>(size), back));
}

TEST(NetftWire, AStatusIsWellSaturatedOrAFault) {
  EXPECT_EQ(health_of(0), Health::ok);
  EXPECT_EQ(health_of(0x80010000), Health::ok) << "a threshold of the user's";
  EXPECT_EQ(health_of(0x80020000), Health::saturated);
  EXPECT_EQ(health_of(0x80030000), Health::saturated);
  EXPECT_EQ(health_of(0x80000000), Health::fault) << "an error that nobody names";
  for (const unsigned bit : {30U, 28U, 14U, 5U, 1U, 0U})
    EXPECT_EQ(health_of(0x80000000U | 1U << bit), Health::fault) << bit;
  EXPECT_EQ(health_of(0x80020002), Health::fault) << "saturated, and more";
  EXPECT_THAT(status_words(0x80020000), testing::HasSubstr("status 0x80020000: transducer saturated"));
  EXPECT_THAT(status_words(0xd0000000), testing::HasSubstr("CPU or RAM; analog board"));
}

std::string page(const std::string& force, const std::string& torque, const std::string& more = "") {
  return "<?xml version=\"1.0\"?><netft><prodname>Net "
         "F/T</prodname><cfgcpf>1000000</cfgcpf><cfgcpt>1000000</cfgcpt>"
         "<scfgfu>" +
         force + "</scfgfu><scfgtu>" + torque +
         "</scfgtu><comrdtrate>7000</comrdtrate><comrdte>Enabled</comrdte>" + more + "</netft>";
}

TEST(NetftWire, UnitsAreTurnedByTheirFactor) {
  Configuration of;
  EXPECT_EQ(read_xml(page("N", "N-m", "<cfgmr>130;130;400;10;10;10</cfgmr>"), of), "");
  EXPECT_EQ(of.per_newton, 1e6);
  EXPECT_EQ(of.per_newton_metre, 1e6);
  EXPECT_EQ(of.ratings, (std::array<double, 6>{130, 130, 400, 10, 10, 10}));
  EXPECT_EQ(of.rate, 7000);
  EXPECT_EQ(read_xml(page("lbf", "lbf-in", "<cfgmr>30;30;100;100;100;100</cfgmr>"), of), "");
  EXPECT_NEAR(of.ratings[0], 133.4466, 1e-4);  // 30 pounds
  EXPECT_NEAR(of.ratings[3], 11.2985, 1e-4);   // 100 inch pounds
  EXPECT_NEAR(1e6 / of.per_newton, 4.4482216152605, 1e-12);
  for (const char* unit : {"kN", "kgf", "gf", "klbf"})
    EXPECT_EQ(read_xml(page(unit, "N-mm"), of), "") << unit;
  EXPECT_THAT(read_xml(page("stone", "N-m"), of),
              testing::HasSubstr("says force unit 'stone', expected N, lbf"));
  EXPECT_THAT(read_xml(page("N", "ft"), of), testing::HasSubstr("says torque unit 'ft'"));
}

TEST(NetftWire, WhatIsMissingDoubledOrNoNumberIsSaid) {
  Configuration of;
  of.product = "as before";
  EXPECT_THAT(read_xml("", of), testing::HasSubstr("is no XML"));
  EXPECT_THAT(read_xml("<netft><prodname>x", of), testing::HasSubstr("is no XML"));
  EXPECT_EQ(read_xml("<netft/>", of), "has no <prodname>");
  EXPECT_EQ(read_xml(page("N", "N-m", "<cfgcpf>1</cfgcpf>"), of), "has two <cfgcpf>");
  for (const char* bad : {"0", "-1", "nan", "inf", "1e6x", ""}) {
    std::string text = page("N", "N-m");
    text.replace(text.find("<cfgcpf>1000000"), 15, std::string("<cfgcpf>") + bad);
    EXPECT_THAT(read_xml(text, of), testing::HasSubstr("expected a positive number")) << bad;
  }
  EXPECT_THAT(read_xml(std::string(kMostXml + 1, ' '), of), testing::HasSubstr("longer than"));
  EXPECT_EQ(of.product, "as before");
}

TEST(NetftWire, TheFakesPageIsReadAgain) {
  Configuration of;
  EXPECT_EQ(read_xml(xml_of(gamma()), of), "");
  EXPECT_EQ(of.product, "Net F/T");
  EXPECT_EQ(of.ratings, gamma().ratings);
  EXPECT_EQ(of.rate, 1000);
  EXPECT_TRUE(of.streams);
}

TEST(NetftHttp, AnAnswerMayComeInAnyPieces) {
  const std::string whole = http_answer(200, "text/xml", "<netft/>");
  for (std::size_t piece = 1; piece < whole.size(); ++piece) {
    HttpAnswer answer;
    for (std::size_t at = 0; at < whole.size(); at += piece)
      answer.take(std::string_view(whole).substr(at, piece));
    ASSERT_TRUE(answer.complete()) << piece;
    EXPECT_EQ(answer.body(), "<netft/>");
  }
  HttpAnswer until_closed;
  until_closed.take("HTTP/1.0 200 OK\r\n\r\nhalf");
  EXPECT_FALSE(until_closed.complete());
  until_closed.closed();
  EXPECT_EQ(until_closed.body(), "half");
}

TEST(NetftHttp, WhatIsNoWholeAnswerIsSaid) {
  for (const auto& [bytes, words] :
       {std::pair{"HTTP/1.1 404 Not Found\r\n\r\n", "HTTP status 404"},
        {"SSH-2.0-OpenSSH\r\n\r\n", "does not speak HTTP"},
        {"HTTP/1.1 200 OK\r\nContent-Length: x\r\n\r\n", "no number"},
        {"HTTP/1.1 200 OK\r\ntransfer-encoding: chunked\r\n\r\n", "in pieces"},
        {"HTTP/1.1 200 OK\r\nContent-Length: 10\r\n\r\nhalf", "ended its answer after"},
        {"HTTP/1.1 20", "ended its answer after 11 bytes"}}) {
    HttpAnswer answer;
    answer.take(bytes);
    answer.closed();
    EXPECT_THAT(answer.wrong(), testing::HasSubstr(words)) << bytes << ": " << answer.wrong();
  }
  HttpAnswer flood;
  for (int i = 0; i < 100; ++i) flood.take(std::string(1000, 'x'));
  EXPECT_THAT(flood.wrong(), testing::HasSubstr("more than"));
}

TEST(NetftHttp, OnlyAWholeRequestHasAPath) {
  EXPECT_EQ(requested_path(http_request("here", "/netftapi2.xml")), "/netftapi2.xml");
  EXPECT_EQ(requested_path("GET /a HTTP/1.1\r\n"), "");
  EXPECT_EQ(requested_path("POST /a HTTP/1.1\r\n\r\n"), "");
  EXPECT_EQ(requested_path("GET /a\r\n\r\n"), "/a");
}

}  // namespace
}  // namespace enc::netft
