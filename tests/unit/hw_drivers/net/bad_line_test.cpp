// What a bad line does to messages, and that a good one does nothing.
#include "hw_drivers/net/bad_line.h"

#include <cmath>
#include <set>
#include <string>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

namespace enc::net {
namespace {

using Kind = Trouble::Kind;
using Wire = BadLine::Wire;

Time ms_at(int ms) { return Time(Duration(1'000'000) * ms); }

std::span<const std::byte> raw(const std::string& text) { return std::as_bytes(std::span(text)); }

// All that leaves by then.
std::vector<std::string> left(BadLine& line, Time now) {
  std::vector<std::string> all;
  for (auto next = line.take(now); next; next = line.take(now)) {
    std::string text;
    for (const std::byte byte : *next) text.push_back(static_cast<char>(byte));
    all.push_back(text);
  }
  return all;
}

// A number each millisecond, and which of them came when.
std::vector<std::pair<int, int>> sent(BadLine& line, int count) {
  std::vector<std::pair<int, int>> came;
  for (int ms = 0; ms < count + 100; ++ms) {
    if (ms < count) line.put(ms_at(ms), raw(std::to_string(ms)));
    for (const std::string& text : left(line, ms_at(ms))) came.emplace_back(std::stoi(text), ms);
  }
  return came;
}

TEST(BadLine, WithoutTroubleEachMessageLeavesAsItCame) {
  for (const Wire wire : {Wire::datagrams, Wire::stream}) {
    BadLine line(wire, 1);
    const auto came = sent(line, 1000);
    ASSERT_EQ(came.size(), 1000U);
    for (int i = 0; i < 1000; ++i) EXPECT_EQ(came[static_cast<std::size_t>(i)], std::pair(i, i));
  }
}

TEST(BadLine, LossAndDuplicatesAreSoManyOfThem) {
  constexpr int kSent = 20'000;
  const double sigma = std::sqrt(0.2 * 0.8 / kSent);
  BadLine lossy(Wire::datagrams, 2);
  lossy.suffer({Kind::loss, 0.2});
  EXPECT_NEAR(static_cast<double>(sent(lossy, kSent).size()) / kSent, 0.8, 5.0 * sigma);
  BadLine twice(Wire::datagrams, 3);
  twice.suffer({Kind::duplicate, 0.2});
  EXPECT_NEAR(static_cast<double>(sent(twice, kSent).size()) / kSent, 1.2, 5.0 * sigma);
}

TEST(BadLine, WhatIsReorderedComesBehindTheNext) {
  BadLine line(Wire::datagrams, 4);
  line.suffer({Kind::reorder, 0.3});
  const auto came = sent(line, 10'000);
  EXPECT_GE(came.size(), 9'990U);  // the last may still wait
  int swapped = 0;
  for (std::size_t i = 1; i < came.size(); ++i) swapped += came[i].first < came[i - 1].first ? 1 : 0;
  EXPECT_NEAR(swapped / 10'000.0, 0.3, 0.1) << "two that are held one after another are one swap";
  std::set<int> all;
  for (const auto& [number, at] : came) {
    EXPECT_LE(at - number, 20);
    EXPECT_TRUE(all.insert(number).second);
  }
}

TEST(BadLine, JitterIsUpToSoLongAndAStreamKeepsItsOrder) {
  for (const Wire wire : {Wire::datagrams, Wire::stream}) {
    BadLine line(wire, 5);
    line.suffer({Kind::jitter, 0.020});
    const auto came = sent(line, 5'000);
    ASSERT_EQ(came.size(), 5'000U);
    int backward = 0, latest = 0;
    for (std::size_t i = 0; i < came.size(); ++i) {
      latest = std::max(latest, came[i].second - came[i].first);
      backward += i > 0 && came[i].first < came[i - 1].first ? 1 : 0;
    }
    EXPECT_GE(latest, 18);
    EXPECT_LE(latest, 21);
    EXPECT_EQ(backward > 0, wire == Wire::datagrams);
  }
}

TEST(BadLine, GarbageAndHalfMessages) {
  BadLine line(Wire::stream, 6);
  line.suffer({Kind::garbage, 1.0});
  const std::string text = "X=1.5 \nY=2\n";
  line.put(ms_at(0), raw(text));
  std::vector<std::string> came = left(line, ms_at(0));
  ASSERT_EQ(came.size(), 1U);
  EXPECT_EQ(came[0].size(), text.size());
  EXPECT_NE(came[0], text);
  EXPECT_EQ(came[0].back(), '\n');
  line.heal(Kind::garbage);
  line.suffer({Kind::half_message, 1.0});
  line.put(ms_at(1), raw("123456"));
  EXPECT_EQ(left(line, ms_at(1)), std::vector<std::string>{"123"});
  line.heal(Kind::half_message);
  line.put(ms_at(2), raw("123456"));
  EXPECT_EQ(left(line, ms_at(2)), std::vector<std::string>{"123456"});
}

TEST(BadLine, WhereAllComeBehindTheNextEachStillComes) {
  BadLine line(Wire::datagrams, 7);
  line.suffer({Kind::reorder, 1.0});
  std::vector<std::string> came;
  for (int i = 0; i < 10; ++i) {
    line.put(ms_at(i), raw(std::to_string(i)));
    for (std::string& one : left(line, ms_at(i))) came.push_back(std::move(one));
  }
  EXPECT_EQ(came, (std::vector<std::string>{"1", "0", "3", "2", "5", "4", "7", "6", "9", "8"}));
}

TEST(BadLine, ASlowStartKeepsAStreamAndDropsDatagrams) {
  for (const Wire wire : {Wire::datagrams, Wire::stream}) {
    BadLine line(wire, 7);
    line.suffer({Kind::slow_start, 0.050});
    line.begin(ms_at(100));
    line.put(ms_at(110), raw("a"));
    line.put(ms_at(120), raw("b"));
    EXPECT_TRUE(left(line, ms_at(149)).empty());
    EXPECT_EQ(left(line, ms_at(150)).size(), wire == Wire::stream ? 2U : 0U);
    line.put(ms_at(151), raw("c"));
    EXPECT_EQ(left(line, ms_at(151)), std::vector<std::string>{"c"});
  }
}

TEST(BadLine, GoesOnWhereTimeBeginsAnew) {
  BadLine line(Wire::stream, 10);
  line.put(ms_at(3000), raw("a"));
  EXPECT_EQ(left(line, ms_at(3000)).size(), 1U);
  line.put(ms_at(1), raw("b"));
  EXPECT_EQ(left(line, ms_at(1)), std::vector<std::string>{"b"});
}

TEST(BadLine, ADeadOneSaysNothingUntilItIsHealed) {
  for (const Kind kind : {Kind::stall, Kind::disconnect}) {
    BadLine line(Wire::datagrams, 8);
    line.suffer({kind, 0.0});
    EXPECT_TRUE(line.dead());
    line.put(ms_at(0), raw("a"));
    EXPECT_TRUE(left(line, ms_at(1)).empty());
    line.heal(kind);
    line.put(ms_at(2), raw("b"));
    EXPECT_EQ(left(line, ms_at(2)), std::vector<std::string>{"b"});
  }
}

TEST(BadLine, AStreamNeitherLosesNorSwaps) {
  const BadLine stream(Wire::stream, 9), datagrams(Wire::datagrams, 9);
  for (const Kind kind : {Kind::loss, Kind::reorder, Kind::duplicate}) {
    EXPECT_FALSE(stream.knows(kind));
    EXPECT_TRUE(datagrams.knows(kind));
  }
  for (const Kind kind : {Kind::saturate, Kind::error_code}) EXPECT_FALSE(datagrams.knows(kind));
  for (const Kind kind :
       {Kind::jitter, Kind::stall, Kind::disconnect, Kind::garbage, Kind::half_message, Kind::slow_start})
    EXPECT_TRUE(stream.knows(kind));
}

}  // namespace
}  // namespace enc::net
