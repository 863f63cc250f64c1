// An MCAP file taken apart from front to back, for tests: its records as they stand, those of its chunks in
// their place.
#pragma once

#include <cstdint>
#include <string>
#include <string_view>
#include <vector>

#include <gtest/gtest.h>

namespace enc::test {

inline constexpr std::string_view kMcapMagic("\x89MCAP0\r\n", 8);

struct McapRecord {
  int op = 0;
  std::string content;
  std::size_t at = 0;  // in the file; of what is in a chunk: in its data
  bool in_chunk = false;
};

// Little-endian numbers and texts, one after the other.
class McapCursor {
 public:
  explicit McapCursor(std::string_view bytes) : bytes_(bytes) {}
  [[nodiscard]] bool more() const { return at_ < bytes_.size(); }
  [[nodiscard]] std::size_t at() const { return at_; }
  std::string_view take(std::size_t n) {
    if (n > bytes_.size() - at_) {
      ADD_FAILURE() << n << " bytes are wanted at " << at_ << " of " << bytes_.size();
      n = bytes_.size() - at_;
    }
    at_ += n;
    return bytes_.substr(at_ - n, n);
  }
  std::uint64_t number(std::size_t size) {
    std::uint64_t x = 0;
    const std::string_view bytes = take(size);
    for (std::size_t i = 0; i < bytes.size(); ++i)
      x |= std::uint64_t{static_cast<unsigned char>(bytes[i])} << (8 * i);
    return x;
  }
  std::string text() { return std::string(take(number(4))); }

 private:
  std::string_view bytes_;
  std::size_t at_ = 0;
};

inline void walk_mcap(std::string_view bytes, bool in_chunk, std::vector<McapRecord>& records) {
  for (McapCursor cursor(bytes); cursor.more();) {
    const std::size_t at = cursor.at() + (in_chunk ? 0 : kMcapMagic.size());
    const int op = static_cast<int>(cursor.number(1));
    const std::string content(cursor.take(cursor.number(8)));
    records.push_back({op, content, at, in_chunk});
    if (op != 6) continue;
    McapCursor chunk(content);
    chunk.take(28);  // times, size and CRC
    EXPECT_EQ(chunk.text(), "") << "compressed";
    walk_mcap(chunk.take(chunk.number(8)), true, records);
  }
}
[[nodiscard]] inline std::vector<McapRecord> walked_mcap(std::string_view file) {
  std::vector<McapRecord> records;
  EXPECT_TRUE(file.starts_with(kMcapMagic) && file.ends_with(kMcapMagic));
  if (file.size() > 16) walk_mcap(file.substr(8, file.size() - 16), false, records);
  return records;
}

}  // namespace enc::test
