// Writes an MCAP file (https://mcap.dev/spec) from front to back: only the container, independent of its
// content. Only the chunk being filled is in memory.
#pragma once

#include <cstddef>
#include <cstdint>
#include <functional>
#include <map>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "trial/mcap/message_sink.h"

namespace enc::trial {

// CRC-32 as in zip, continued from `before`, the CRC of the preceding bytes.
[[nodiscard]] std::uint32_t crc32(std::string_view bytes, std::uint32_t before = 0);

enum class ChunkCompression : std::uint8_t { none, zstd };

class McapWriter final : public MessageSink {
 public:
  using Sink = std::function<void(std::string_view)>;  // receives the bytes of the file, in order

  static constexpr std::size_t kChunk = std::size_t{1} << 20U;
  struct Form {
    ChunkCompression compression = ChunkCompression::none;
    std::string_view profile{};  // "ros2", or empty
    std::size_t chunk = kChunk;  // bytes at which a chunk is closed
  };
  // library: the writing program, "encounter 0.1.0".
  McapWriter(Sink sink, std::string_view library, const Form& form);
  McapWriter(Sink sink, std::string_view library) : McapWriter(std::move(sink), library, Form{}) {}

  [[nodiscard]] std::uint16_t add_schema(std::string_view name, std::string_view encoding,
                                         std::string_view data) override;
  [[nodiscard]] std::uint16_t add_channel(std::string_view topic, std::uint16_t schema,
                                          std::string_view message_encoding) override;
  void message(std::uint16_t channel, std::uint64_t log_time, std::uint64_t publish_time,
               std::string_view data) override;
  void attach(std::string_view name, std::string_view media_type, std::string_view data) override;
  void metadata(std::string_view name, const std::map<std::string, std::string>& texts) override;
  // Writes the rest and the summary, without which the file is invalid.
  void close() override;

 private:
  struct Entry {
    std::uint64_t time = 0, offset = 0;  // position of a message in the uncompressed chunk
  };
  struct Channel {
    std::vector<Entry> entries;  // chunk being filled
    std::uint64_t messages = 0;  // since the start
  };
  struct Times {  // range of message times; 0 and 0 without messages
    bool any = false;
    std::uint64_t first = 0, last = 0;
    void add(std::uint64_t time);
  };

  void put(std::string_view bytes);
  void flush_chunk();
  [[nodiscard]] std::string write_message_indexes();
  void write_summary();
  [[nodiscard]] std::string statistics() const;

  Sink sink_;
  std::size_t chunk_size_;
  ChunkCompression compression_;
  std::uint64_t at_ = 0;   // bytes so far
  std::uint32_t crc_ = 0;  // CRC of these bytes
  std::string chunk_;      // records
  Times chunk_times_, times_;
  std::vector<Channel> channels_;
  std::uint64_t messages_ = 0;
  std::uint16_t schemas_ = 0;
  std::uint32_t chunks_ = 0, attachments_ = 0, metadatas_ = 0;
  // Records repeated in the summary, and their positions.
  std::string schema_records_, channel_records_, chunk_indexes_, attachment_indexes_, metadata_indexes_;
};

}  // namespace enc::trial
