// A Net F/T, byte by byte: its words, commands, session and rates.
#include <algorithm>
#include <cmath>
#include <random>
#include <string>
#include <vector>

#include <gmock/gmock.h>

#include "core/base/error.h"
#include "hw_drivers/netft/drive/netft_sensor.h"
#include "hw_drivers/netft/drive/session.h"
#include "hw_drivers/netft/fake/server.h"
#include "hw_drivers/netft/wire/messages.h"
#include "hw_drivers/netft/wire/page.h"
#include "tests/support/refusal.h"
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

// The command interface: the bytes of the manual, and back; its units.

using tests::from_hex, tests::hex;

TEST(NetftCommand, QuestionsAreTwentyBytes) {
  const std::string zeros(30, '0');
  EXPECT_EQ(hex(bytes_of(Ask{})), "00" + zeros + "00000000");
  EXPECT_EQ(hex(bytes_of(Ask{.question = Question::calibration})), "01" + zeros + "00000000");
  EXPECT_EQ(hex(bytes_of(Ask{.monitor = 0x1234, .bias = true, .clear_latch = true})),
            "00" + zeros + "12340003");
  Ask ask;
  ASSERT_TRUE(read(from_hex("00" + zeros + "00010002"), ask));
  EXPECT_EQ(ask.question, Question::reading);
  EXPECT_EQ(ask.monitor, 1);
  EXPECT_FALSE(ask.bias);
  EXPECT_TRUE(ask.clear_latch);
  EXPECT_FALSE(read(from_hex("02" + zeros + "00000000"), ask));  // WRITETRANSFORM
  EXPECT_FALSE(read(from_hex("01" + zeros + "000000"), ask));
}

TEST(NetftCommand, AnswersAreTheBytesOfTheManual) {
  const Calibration calibration{2, 3, 1'000'000, 1'000'000, {4000, 4000, 12'000, 400, 400, 400}};
  const std::string wire =
      "1234"
      "02"
      "03"
      "000f4240"
      "000f4240"
      "0fa0"
      "0fa0"
      "2ee0"
      "0190"
      "0190"
      "0190";
  EXPECT_EQ(hex(bytes_of(calibration)), wire);
  Calibration back;
  ASSERT_TRUE(read(from_hex(wire), back));
  EXPECT_EQ(back.per_force, 1'000'000U);
  EXPECT_EQ(back.scale, calibration.scale);
  const Reading reading{0x8001, {1, -1, 32'767, -32'768, 0, 256}};
  EXPECT_EQ(hex(bytes_of(reading)),
            "1234"
            "8001"
            "0001"
            "ffff"
            "7fff"
            "8000"
            "0000"
            "0100");
  Reading again;
  EXPECT_FALSE(read(from_hex("1235"
                             "8001"
                             "0001"
                             "ffff"
                             "7fff"
                             "8000"
                             "0000"
                             "0100"),
                    again));
  EXPECT_FALSE(read(from_hex(wire), again));
  EXPECT_FALSE(read(from_hex("1234"), back));
}

TEST(NetftCommand, WhatIsWrittenIsRead) {
  std::mt19937 random(2);  // NOLINT: identical at each run
  const auto any = [&] { return static_cast<std::uint16_t>(random()); };
  for (int i = 0; i < 1000; ++i) {
    Reading reading{any(), {}};
    Calibration calibration{static_cast<std::uint8_t>(any()),
                            static_cast<std::uint8_t>(any()),
                            static_cast<std::uint32_t>(random()),
                            static_cast<std::uint32_t>(random()),
                            {}};
    for (std::size_t axis = 0; axis < kAxes; ++axis) {
      reading.coarse[axis] = static_cast<std::int16_t>(any());
      calibration.scale[axis] = any();
    }
    Reading read_back;
    Calibration calibration_back;
    ASSERT_TRUE(read(bytes_of(reading), read_back));
    ASSERT_TRUE(read(bytes_of(calibration), calibration_back));
    ASSERT_EQ(bytes_of(read_back), bytes_of(reading));
    ASSERT_EQ(bytes_of(calibration_back), bytes_of(calibration));
  }
}

TEST(NetftCommand, CodesAreUnitsWhoseFactorIsExact) {
  EXPECT_EQ(force_of_code(2), 1.0);
  EXPECT_EQ(force_of_code(1), 4.4482216152605);
  EXPECT_EQ(torque_of_code(3), 1.0);
  EXPECT_NEAR(torque_of_code(1), 0.1129848290276167, 1e-15);
  for (const int none : {-1, 0, 7, 255}) {
    EXPECT_TRUE(std::isnan(force_of_code(none)));
    EXPECT_TRUE(std::isnan(torque_of_code(none)));
  }
}

// Records that are lost, late, doubled, old or faulty; and the required state of a box before a run.

constexpr Duration ms(double n) { return from_seconds(1e-3 * n); }

Record record(std::uint32_t number, std::uint32_t sample, std::int32_t fx = 0, std::uint32_t status = 0) {
  return {number, sample, status, {fx, 0, 0, 0, 0, 0}};
}

struct Bench {
  Session session{gamma(), Duration{}, false};
  void take(const Record& one, double now_ms) { session.take(bytes_of(one), Time(ms(now_ms))); }
  [[nodiscard]] double fx() const { return session.newest().value.force.xyz[0]; }
};

TEST(NetftSession, SaysNothingBeforeTheFirstRecord) {
  const Bench bench;
  EXPECT_EQ(bench.session.newest().health, Health::absent);
}

TEST(NetftSession, CountsAreNewtonsAndNewtonMetres) {
  Bench bench;
  bench.session.take(bytes_of(Record{1, 7, 0, {1500000, -2000000, 12000000, 100000, -200000, 300000}}),
                     Time{});
  const Wrench& wrench = bench.session.newest().value;
  EXPECT_EQ(bench.session.newest().health, Health::ok);
  EXPECT_EQ(wrench.force.xyz, (std::array<double, 3>{1.5, -2.0, 12.0}));
  EXPECT_EQ(wrench.torque.xyz, (std::array<double, 3>{0.1, -0.2, 0.3}));
}

// A page in pounds and inches, as on a box from an American factory: the output is SI.
TEST(NetftSession, CountsOfPoundsAndInchPoundsAreNewtonsAndNewtonMetres) {
  Configuration of;
  ASSERT_EQ(read_xml("<netft><prodname>Net F/T</prodname><cfgcpf>1000000</cfgcpf><cfgcpt>2000000</cfgcpt>"
                     "<scfgfu>lbf</scfgfu><scfgtu>lbf-in</scfgtu></netft>",
                     of),
            "");
  Session session(of, Duration{}, false);
  session.take(bytes_of(Record{1, 7, 0, {1000000, -2000000, 0, 2000000, -1000000, 0}}), Time{});
  const Wrench& wrench = session.newest().value;
  EXPECT_NEAR(wrench.force.xyz[0], 4.4482216152605, 1e-12);       // a pound
  EXPECT_NEAR(wrench.force.xyz[1], -2 * 4.4482216152605, 1e-12);  // two
  EXPECT_NEAR(wrench.torque.xyz[0], 0.1129848290276167, 1e-15);   // an inch pound
  EXPECT_NEAR(wrench.torque.xyz[1], -0.5 * 0.1129848290276167, 1e-15);
}

// The counter advances by 6.986 each millisecond: 0.2 % less than its nominal rate.
TEST(NetftSession, MeasuresTheRateOfItsCounterInHalfAMinute) {
  Bench bench;
  const auto record_of = [](std::uint32_t n) { return record(n, n * 6986U / 1000U); };
  for (std::uint32_t n = 1; n < 29'000; ++n) bench.take(record_of(n), n);
  EXPECT_TRUE(std::isnan(bench.session.counted()));
  for (std::uint32_t n = 29'000; n < 40'000; ++n) bench.take(record_of(n), n);
  EXPECT_NEAR(bench.session.counted(), 6986.0, 1.0);
  // The box starts again.
  for (std::uint32_t n = 1; n < 40'000; ++n) bench.take(record(n, 7 * n - 2'000'000'000U), 60'000 + n);
  EXPECT_NEAR(bench.session.counted(), 7000.0, 1.0);
}

TEST(NetftSession, OldAndDoubledRecordsChangeNothing) {
  Bench bench;
  bench.take(record(1, 70, 1), 10);
  bench.take(record(3, 84, 3), 12);
  bench.take(record(2, 77, 2), 12);
  bench.take(record(3, 84, 9), 12);
  EXPECT_EQ(bench.fx(), 3e-6);
  EXPECT_EQ(bench.session.counts().records, 2);
  EXPECT_EQ(bench.session.counts().missing, 1);
  EXPECT_EQ(bench.session.counts().old, 2);
  bench.session.take(std::vector<std::byte>(35), Time(ms(13)));
  EXPECT_EQ(bench.session.counts().wrong, 1);
}

// A record has no checksum.
TEST(NetftSession, NoiseOfTheRightLengthIsNoRecord) {
  Bench bench;
  for (std::uint32_t n = 1; n <= 50; ++n) bench.take(record(n, 7 * n, static_cast<std::int32_t>(n)), n);
  bench.take(record(0x9e3779b9, 0x7f4a7c15, 1'000'000'000), 51);
  bench.take(record(0x85ebca6b, 0xc2b2ae35, -1'000'000'000), 52);
  EXPECT_EQ(bench.fx(), 50e-6);
  EXPECT_EQ(bench.session.counts().wrong, 2);
  bench.take(record(53, 7 * 53, 53), 53);
  EXPECT_EQ(bench.fx(), 53e-6);
  EXPECT_EQ(bench.session.counts().missing, 2);
  EXPECT_EQ(bench.session.counts().old, 0);
}

TEST(NetftSession, ABoxThatBeganAnewIsBelievedFromItsSecondRecordOn) {
  Bench bench;
  for (std::uint32_t n = 1; n <= 50; ++n) bench.take(record(n, 100'000'000 + 7 * n, 1), n);
  bench.take(record(1, 7, 2), 1000);
  EXPECT_EQ(bench.fx(), 1e-6);
  bench.take(record(2, 14, 3), 1001);
  EXPECT_EQ(bench.fx(), 3e-6);
  bench.take(record(3, 21, 4), 1002);
  EXPECT_EQ(bench.fx(), 4e-6);
  EXPECT_LT(age(Time(ms(1002)), bench.session.newest().t), 0.002);
}

TEST(NetftSession, CountersGoRound) {
  Bench bench;
  bench.take(record(0xffffffff, 0xfffffffa, 1), 1);
  bench.take(record(1, 1, 2), 2);  // seven samples on
  EXPECT_EQ(bench.fx(), 2e-6);
  EXPECT_EQ(bench.session.newest().t, Time(ms(2)));
  bench.take(record(1, 0xfffffffb, 3), 3);
  EXPECT_EQ(bench.fx(), 2e-6);
}

// After a pause of the process the socket is full of old records.
TEST(NetftSession, WhatWaitedInTheSocketIsAsOldAsItIs) {
  Bench bench;
  std::uint32_t n = 0;
  for (; n < 100; ++n) bench.take(record(n + 1, 7 * n), n);
  EXPECT_EQ(bench.session.newest().t, Time(ms(99)));
  for (const std::uint32_t until = n + 50; n < until; ++n) bench.take(record(n + 1, 7 * n), 2100);
  EXPECT_EQ(bench.session.newest().t, Time(ms(149))) << "came at 2,100";
  bench.take(record(2200, 7 * 2100), 2100);
  EXPECT_EQ(bench.session.newest().t, Time(ms(2100)));
}

TEST(NetftSession, AnyNetworkGivesTimesThatOnlyGrow) {
  for (std::uint64_t seed = 1; seed <= 20; ++seed) {
    std::mt19937_64 random(seed);
    std::vector<std::pair<double, std::uint32_t>> way;  // arrival in ms, number
    std::exponential_distribution<double> late(1.0);
    for (std::uint32_t n = 1; n <= 2000; ++n)
      if (random() % 20 != 0) way.emplace_back(n + 0.2 + late(random), n);
    std::sort(way.begin(), way.end());
    Bench bench;
    Time last{};
    double worst = 0.0;
    for (const auto& [arrives, n] : way) {
      bench.take(record(n, 7 * n, static_cast<std::int32_t>(n)), arrives);
      EXPECT_GE(bench.session.newest().t, last) << "seed " << seed;
      last = bench.session.newest().t;
      EXPECT_LE(last, Time(ms(arrives)));
      const double truly = 1e6 * bench.fx();  // ms
      if (n > 200) worst = std::max(worst, std::abs(1e3 * seconds(last.time_since_epoch()) - truly));
    }
    EXPECT_LT(worst, 0.35) << "ms; the way that nobody can know is 0.2. Seed " << seed;
  }
}

TEST(NetftSession, AStatusIsSaidAndRemembered) {
  Bench bench;
  bench.take(record(1, 7, 1, kError | kSaturated), 1);
  EXPECT_EQ(bench.session.newest().health, Health::saturated);
  bench.take(record(2, 14, 1, 0x90000000), 2);
  EXPECT_EQ(bench.session.newest().health, Health::fault);
  bench.take(record(3, 21, 1, 0), 3);
  EXPECT_EQ(bench.session.newest().health, Health::ok);
  EXPECT_EQ(bench.session.counts().status, 0x90000000U);
}

// cfgmr of a Gamma: 130 N across, 400 N along z, 10 N m about each axis.
TEST(NetftSession, AForceBeyondTheRatingOfItsAxisIsSaturated) {
  const auto health = [](std::array<std::int32_t, 6> counts, std::uint32_t status = 0) {
    Bench bench;
    bench.session.take(bytes_of(Record{1, 7, status, counts}), Time(ms(1)));
    EXPECT_EQ(bench.session.counts().beyond, bench.session.newest().health == Health::ok ? 0 : 1);
    return bench.session.newest().health;
  };
  EXPECT_EQ(health({129'999'999, -130'000'000, 399'999'999, 0, 0, -10'000'000}), Health::ok);
  EXPECT_EQ(health({130'000'001, 0, 0, 0, 0, 0}), Health::saturated);
  EXPECT_EQ(health({0, 0, -400'000'001, 0, 0, 0}), Health::saturated);
  EXPECT_EQ(health({0, 0, 0, 0, 0, 10'000'001}), Health::saturated);
  EXPECT_EQ(health({130'000'001, 0, 0, 0, 0, 0}, 0x90000000), Health::fault) << "a fault stays one";
}

std::string refused(const Configuration& of, const NetftSettings& settings = {}) {
  return test::refusal(ErrorKind::device, [&] { (void)inspect(xml_of(of), settings, Duration(1'000'000)); });
}

TEST(NetftInspect, WhatIsNotAsItMustBeIsRefusedWithAWayOut) {
  EXPECT_EQ(refused(gamma()), "");
  Configuration other = gamma();
  other.product = "Ethernet Axia";
  EXPECT_THAT(refused(other),
              testing::HasSubstr("is another device: it says 'Ethernet Axia', expected 'F/T'"));
  Configuration slow = gamma();
  slow.rate = 500;
  EXPECT_THAT(
      refused(slow),
      testing::HasSubstr("sends 500 records a second, and the loop makes 1000; set the RDT output rate"));
  slow.rate = kUnset;
  EXPECT_THAT(refused(slow), testing::HasSubstr("sends nan records"));
  Configuration off = gamma();
  off.streams = false;
  EXPECT_THAT(refused(off), testing::HasSubstr("RDT is switched off; enable it"));
  Configuration weak = gamma();
  weak.ratings[2] = 65;
  EXPECT_THAT(
      refused(weak),
      testing::HasSubstr("can do less than the rig file promises: Fz to 65 of 130 N; choose another"));
  weak.ratings[2] = kUnset;
  EXPECT_THAT(refused(weak), testing::HasSubstr("Fz to nan of 130 N"));
  NetftSettings settings{.torque_range = 20};
  EXPECT_THAT(refused(gamma(), settings),
              testing::HasSubstr("Tx to 10 of 20 N m; choose another configuration on its page, or lower "
                                 "driver.netft.torque_range_Nm"));
  EXPECT_THAT(test::refusal([] { (void)inspect("<html>\n</html>", {}, Duration(1'000'000)); }),
              testing::HasSubstr("its netftapi2.xml has no <prodname>; see that it is a Net F/T"));
}

// The rate of a box's counter, from records that come late, twice or in bursts.

// Records for 0.4 s, one a millisecond; each comes up to `late` s later than it is sent, and in order.
CounterRate watched(double rate, double late, double set = 0.0, std::uint64_t seed = 1) {
  std::mt19937_64 random(seed);
  std::uniform_real_distribution<double> delay(0.0, late);
  CounterRate of(set);
  double before = 0.0;
  for (int n = 0; n < 400; ++n) {
    const double sent = 1e-3 * n;
    before = std::max(before, sent + delay(random));
    of.take(0xfffff000U + static_cast<std::uint32_t>(rate * sent), from_seconds(10.0 + before));
  }
  return of;
}

TEST(NetftCounterRate, EachKnownBoxIsKnownWhateverTheNetwork) {
  for (const double rate : {7000.0, 488.28125, 976.5625, 1953.125, 3906.25, 7812.5})
    for (const double late : {0.0, 1e-3, 5e-3}) {
      EXPECT_EQ(watched(rate, late).known(), rate) << late;
      EXPECT_NEAR(watched(rate, late).measured(), rate, 0.01 * rate) << late;
    }
}

// Sampled at 1 kHz in bursts of 50 ms, as on a busy processor.
TEST(NetftCounterRate, BurstsDoNotChangeIt) {
  CounterRate of;
  for (int n = 0; n < 400; ++n)
    of.take(static_cast<std::uint32_t>(3.90625 * n), from_seconds(1e-3 * (n + 49 - n % 50)));
  EXPECT_EQ(of.known(), 3906.25);
}

TEST(NetftCounterRate, AnUnknownOneIsMeasuredAndIsKnownWhereItIsSet) {
  for (const double rate : {1000.0, 4000.0, 5000.0, 8000.0}) {
    EXPECT_TRUE(std::isnan(watched(rate, 1e-3).known())) << rate;
    EXPECT_NEAR(watched(rate, 1e-3).measured(), rate, 0.01 * rate);
    EXPECT_EQ(watched(rate, 1e-3, rate).known(), rate);
  }
  EXPECT_TRUE(std::isnan(watched(3906.25, 1e-3, 7000.0).known())) << "not what the rig file has";
}

// The records of a box that is 0.7 % slow grow older by 7 ms each second.
TEST(NetftCounterRate, AlmostAKnownOneIsNotKnown) {
  for (const double rate : {6950.0, 7050.0, 3880.0})
    EXPECT_TRUE(std::isnan(watched(rate, 1e-3).known())) << rate;
  EXPECT_TRUE(std::isnan(watched(6950.0, 1e-3, 7000.0).known()));
  EXPECT_EQ(watched(6950.0, 1e-3, 6950.0).known(), 6950.0);
  EXPECT_EQ(watched(7000.7, 5e-3).known(), 7000.0) << "a quartz";
}

TEST(NetftCounterRate, WithoutRecordsOrWithACounterThatStandsThereIsNone) {
  EXPECT_TRUE(std::isnan(CounterRate().known()));
  EXPECT_EQ(CounterRate().watched(), 0.0);
  EXPECT_TRUE(std::isnan(watched(0.0, 1e-3).known()));
}

TEST(NetftCounterRate, IsPrintedInGroups) {
  EXPECT_EQ(grouped(7000.0), "7,000");
  EXPECT_EQ(grouped(3906.25), "3,906");
  EXPECT_EQ(grouped(488.28125), "488");
  EXPECT_EQ(grouped(1234567.0), "1,234,567");
  EXPECT_EQ(grouped(kUnset), "0");
}

}  // namespace
}  // namespace enc::netft
