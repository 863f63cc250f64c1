// The container of MCAP: its bytes, and that what its indexes name is there.
#include "trial/mcap/mcap_writer.h"

#include <algorithm>
#include <string>
#include <vector>

#include <gtest/gtest.h>

#include "tests/unit/trial/mcap/walked_mcap.h"

namespace enc::trial {
namespace {

using test::McapCursor;
using test::McapRecord;

std::string hex_of(std::string_view bytes) {
  constexpr std::string_view kDigits = "0123456789abcdef";
  std::string hex;
  for (const char c : bytes) {
    hex += kDigits[static_cast<unsigned char>(c) >> 4U];
    hex += kDigits[static_cast<unsigned char>(c) & 0xFU];
  }
  return hex;
}

// The check value of CRC-32 that its catalogues have; and that it goes on over pieces, wherever they are cut.
TEST(McapWriter, TheCrcIsThatOfZip) {
  EXPECT_EQ(crc32(""), 0U);
  EXPECT_EQ(crc32("123456789"), 0xCBF43926U);
  std::string bytes;
  for (int i = 0; i < 300; ++i) bytes += static_cast<char>(i * i);
  std::uint32_t one_by_one = 0;
  for (const char c : bytes) one_by_one = crc32({&c, 1}, one_by_one);
  for (std::size_t cut = 0; cut <= bytes.size(); ++cut)
    EXPECT_EQ(crc32(bytes.substr(cut), crc32(bytes.substr(0, cut))), one_by_one);
}

// Each field as https://mcap.dev/spec has it, so that no two mistakes of writer and reader meet.
TEST(McapWriter, TheBytesOfATinyFile) {
  std::string file;
  McapWriter writer([&](std::string_view bytes) { file += bytes; }, "L");
  const std::uint16_t schema = writer.add_schema("S", "jsonschema", "{}");
  const std::uint16_t channel = writer.add_channel("/t", schema, "json");
  writer.message(channel, 5, 3, "{}");
  writer.attach("a", "t", "xyz");
  writer.metadata("m", {{"k", "v"}});
  writer.close();
  const std::string magic = "894d434150300d0a";
  const std::string schema_record =
      "031b00000000000000 0100 0100000053 0a0000006a736f6e736368656d61 020000007b7d";
  const std::string channel_record = "041600000000000000 0100 0100 020000002f74 040000006a736f6e 00000000";
  const std::vector<std::string> parts{
      magic,
      "010900000000000000 00000000 010000004c",  // header: no profile, library
      // attachment: times, name, kind, data, CRC
      "092900000000000000 0000000000000000 0000000000000000 0100000061 0100000074 030000000000000078797a "
      "d94e414b",
      "0c1300000000000000 010000006d 0a000000 010000006b 0100000076",  // metadata
      // chunk: first and last time, size, CRC, no compression, size
      "068c00000000000000 0500000000000000 0500000000000000 6400000000000000 ff4b03b8 00000000 "
      "6400000000000000",
      schema_record, channel_record,
      // message: channel, number, times, data
      "051800000000000000 0100 00000000 0500000000000000 0300000000000000 7b7d",
      "071600000000000000 0100 10000000 0500000000000000 4300000000000000",  // its place in the chunk
      "0f0400000000000000 7bf9c6ab",                                         // end of data, CRC
      schema_record, channel_record,
      // statistics: messages, schemas, channels, attachments, metadata, chunks, times, messages of each
      // channel
      "0b3800000000000000 0100000000000000 0100 01000000 01000000 01000000 01000000 0500000000000000 "
      "0500000000000000 0a000000 0100 0100000000000000",
      // chunk index: times, place, size, indexes of messages and their size, no compression, sizes
      "084a00000000000000 0500000000000000 0500000000000000 6800000000000000 9500000000000000 0a000000 0100 "
      "fd00000000000000 1f00000000000000 00000000 6400000000000000 6400000000000000",
      // attachment index: place, size, times, size of the data, name, kind
      "0a3200000000000000 1a00000000000000 3200000000000000 0000000000000000 0000000000000000 "
      "0300000000000000 0100000061 0100000074",
      "0d1500000000000000 4c00000000000000 1c00000000000000 010000006d",  // metadata index
      // where each kind of these begins, and its size
      "0e1100000000000000 03 2901000000000000 2400000000000000",
      "0e1100000000000000 04 4d01000000000000 1f00000000000000",
      "0e1100000000000000 0b 6c01000000000000 4100000000000000",
      "0e1100000000000000 08 ad01000000000000 5300000000000000",
      "0e1100000000000000 0a 0002000000000000 3b00000000000000",
      "0e1100000000000000 0d 3b02000000000000 1e00000000000000",
      "021400000000000000 2901000000000000 5902000000000000 3df64af0",  // footer: summary, offsets, CRC
      magic};
  std::string expected;
  for (const std::string& part : parts) expected += part;
  std::erase(expected, ' ');
  EXPECT_EQ(hex_of(file), expected);
}

// A chunk is full with the message that reaches its size; every place that an index names has what it says.
TEST(McapWriter, ChunksAreOfTheirSizeAndIndexesNameWhatIsThere) {
  constexpr std::size_t kSize = 500;
  std::string file;
  McapWriter writer([&](std::string_view bytes) { file += bytes; }, "L", kSize);
  const std::uint16_t schema = writer.add_schema("S", "jsonschema", "{}");
  const std::uint16_t often = writer.add_channel("/often", schema, "json");
  const std::uint16_t seldom = writer.add_channel("/seldom", schema, "json");
  const std::uint16_t never = writer.add_channel("/never", schema, "json");
  for (std::uint64_t i = 0; i < 100; ++i) {
    writer.message(often, 10 * i, 10 * i, std::to_string(i));
    if (i % 40 == 39) writer.message(seldom, 10 * i, 10 * i - 7, "s");
  }
  writer.close();
  const std::vector<McapRecord> records = test::walked_mcap(file);
  std::size_t chunks = 0, messages = 0, entries = 0, indexes = 0;
  std::string chunk;
  for (const McapRecord& record : records) {
    McapCursor cursor(record.content);
    if (record.op == 6) {
      ++chunks;
      cursor.take(16);
      const std::size_t size = cursor.number(8);
      const auto crc = static_cast<std::uint32_t>(cursor.number(4));
      EXPECT_EQ(cursor.text(), "");
      chunk = std::string(cursor.take(cursor.number(8)));
      EXPECT_EQ(chunk.size(), size);
      EXPECT_EQ(crc32(chunk), crc);
      EXPECT_LT(chunk.size(), kSize + 40);  // a message more than it holds
    } else if (record.op == 5) {
      ++messages;
      EXPECT_TRUE(record.in_chunk);
    } else if (record.op == 7) {  // behind its chunk
      const std::uint64_t channel = cursor.number(2);
      EXPECT_NE(channel, never);
      cursor.take(4);
      while (cursor.more()) {
        ++entries;
        const std::uint64_t time = cursor.number(8), at = cursor.number(8);
        McapCursor message(std::string_view(chunk).substr(at));
        EXPECT_EQ(message.number(1), 5U);
        message.take(8);
        EXPECT_EQ(message.number(2), channel);
        message.take(4);
        EXPECT_EQ(message.number(8), time);
      }
    } else if (record.op == 8) {
      ++indexes;
      cursor.take(16);
      const std::size_t at = cursor.number(8), size = cursor.number(8);
      EXPECT_EQ(file.at(at), 6);
      EXPECT_EQ(McapCursor(std::string_view(file).substr(at + 1)).number(8) + 9, size);
      for (McapCursor offsets(cursor.take(cursor.number(4))); offsets.more();) {
        const std::uint64_t channel = offsets.number(2), index = offsets.number(8);
        EXPECT_EQ(file.at(index), 7);
        EXPECT_EQ(McapCursor(std::string_view(file).substr(index + 9)).number(2), channel);
      }
    } else if (record.op == 14) {
      const std::uint64_t op = cursor.number(1), at = cursor.number(8), size = cursor.number(8);
      for (std::size_t i = at; i < at + size;) {
        EXPECT_EQ(static_cast<unsigned char>(file.at(i)), op);
        i += 9 + McapCursor(std::string_view(file).substr(i + 1)).number(8);
      }
    }
  }
  EXPECT_EQ(messages, 102U);
  EXPECT_EQ(entries, messages);
  EXPECT_GT(chunks, 5U);
  EXPECT_EQ(indexes, chunks);
}

// A record without a tick gives a file without a message; it is still one, with its schemas.
TEST(McapWriter, AFileWithoutMessagesIsAFile) {
  std::string file;
  McapWriter writer([&](std::string_view bytes) { file += bytes; }, "L");
  EXPECT_EQ(writer.add_channel("/t", writer.add_schema("S", "jsonschema", "{}"), "json"), 1);
  writer.close();
  std::string ops;
  for (const McapRecord& record : test::walked_mcap(file)) ops += std::to_string(record.op) + " ";
  EXPECT_EQ(ops, "1 6 3 4 15 3 4 11 8 14 14 14 14 2 ");
}

// A long record is never in memory as a whole: what is full has left before the end.
TEST(McapWriter, BytesLeaveAsChunksAreFull) {
  std::size_t bytes = 0, most = 0;
  McapWriter writer(
      [&](std::string_view piece) {
        bytes += piece.size();
        most = std::max(most, piece.size());
      },
      "L", 1000);
  const std::uint16_t channel = writer.add_channel("/t", writer.add_schema("S", "jsonschema", "{}"), "json");
  for (std::uint64_t i = 0; i < 1000; ++i) writer.message(channel, i, i, std::string(100, 'x'));
  EXPECT_GT(bytes, 120'000U);
  EXPECT_LT(most, 1200U);
  writer.close();
}

}  // namespace
}  // namespace enc::trial
