// Messages of a stream, in whatever pieces it comes.
#include "hw_drivers/igtl/wire/stream.h"

#include <algorithm>
#include <random>
#include <string>
#include <vector>

#include <gtest/gtest.h>

#include "hw_drivers/igtl/wire/content.h"
#include "hw_drivers/net/big_endian.h"

namespace enc::igtl {
namespace {

using Bytes = std::vector<std::byte>;

Bytes bytes_of(const Written& message) { return {message.bytes().begin(), message.bytes().end()}; }
Bytes pose(std::int64_t stamp_ns) {
  return bytes_of({"TRANSFORM", "stylusToTracker", stamp_ns, transform(Pose<'C', 'T'>::shift(0, 0, 1))});
}
// A message whose body is so long, of zeros.
Bytes picture(std::uint64_t body) {
  Bytes bytes = bytes_of({"IMAGE", "ultrasound", 7, {}});
  net::put(std::span(bytes), 42, body);
  bytes.resize(kHeader + static_cast<std::size_t>(body));
  return bytes;
}
Bytes operator+(Bytes a, const Bytes& b) {
  a.insert(a.end(), b.begin(), b.end());
  return a;
}

// The stamps of what it gives, where `bytes` come in pieces of at most so many.
std::vector<std::int64_t> stamps(Stream& stream, std::span<const std::byte> bytes, std::size_t most,
                                 std::uint64_t seed) {
  std::mt19937_64 random(seed);
  std::vector<std::int64_t> all;
  while (!bytes.empty() && !stream.lost()) {
    const std::span<std::byte> room = stream.room();
    EXPECT_FALSE(room.empty());
    const std::size_t piece =
        std::min({bytes.size(), room.size(), 1 + static_cast<std::size_t>(random() % most)});
    std::copy_n(bytes.begin(), piece, room.begin());
    stream.came(piece);
    bytes = bytes.subspan(piece);
    for (auto next = stream.next(); !next.empty(); next = stream.next()) {
      Message message;
      EXPECT_EQ(read(next, message), Wrong::nothing);
      all.push_back(message.stamp_ns);
    }
  }
  return all;
}

TEST(IgtlStream, GivesEachMessageOnceInWhateverPiecesItComes) {
  Bytes bytes;
  std::vector<std::int64_t> expected;
  for (std::int64_t i = 1; i <= 2000; ++i) {
    bytes = std::move(bytes) + pose(i);
    expected.push_back(i);
  }
  ASSERT_GT(bytes.size(), 3 * Stream::kMost) << "it goes round";
  for (const std::size_t most : {1U, 7U, 106U, 5000U, 200000U}) {
    Stream stream;
    EXPECT_EQ(stamps(stream, bytes, most, most), expected) << most;
    EXPECT_FALSE(stream.lost());
  }
}

TEST(IgtlStream, PassesOverWhatIsTooLong) {
  Stream stream;
  const Bytes bytes =
      pose(1) + picture(3 * Stream::kMost) + pose(2) + picture(Stream::kMost - kHeader + 1) + pose(3);
  EXPECT_EQ(stamps(stream, bytes, 3000, 1), (std::vector<std::int64_t>{1, 2, 3}));
  EXPECT_EQ(stream.skipped(), 2);
  Stream longest;
  Bytes fits = picture(Stream::kMost - kHeader);
  net::put(std::span(fits), 50, crc64(std::span(fits).subspan(kHeader)));
  EXPECT_EQ(stamps(longest, pose(1) + fits + pose(2), 40000, 2), (std::vector<std::int64_t>{1, 7, 2}));
}

TEST(IgtlStream, WhatIsNoHeaderEndsIt) {
  for (const auto& [at, byte] : {std::pair{0, 0x30}, {2, 0x00}, {4, 0x0a}, {5, 0x80}}) {
    Bytes wrong = pose(2);
    wrong[static_cast<std::size_t>(at)] = static_cast<std::byte>(byte);
    Stream stream;
    EXPECT_EQ(stamps(stream, pose(1) + wrong + pose(3), 500, 3), (std::vector<std::int64_t>{1})) << at;
    EXPECT_TRUE(stream.lost()) << at;
    stream.begin();
    EXPECT_EQ(stamps(stream, pose(4), 50, 4), (std::vector<std::int64_t>{4})) << "another one";
  }
}

}  // namespace
}  // namespace enc::igtl
