// What receives messages on channels: an MCAP file, or the clients of a live run.
#pragma once

#include <cstdint>
#include <map>
#include <string>
#include <string_view>

namespace enc::trial {

class MessageSink {
 public:
  MessageSink() = default;
  MessageSink(const MessageSink&) = delete;
  MessageSink& operator=(const MessageSink&) = delete;
  virtual ~MessageSink() = default;

  // Adds a schema or a channel; returns the number by which others refer to it.
  [[nodiscard]] virtual std::uint16_t add_schema(std::string_view name, std::string_view encoding,
                                                 std::string_view data) = 0;
  [[nodiscard]] virtual std::uint16_t add_channel(std::string_view topic, std::uint16_t schema,
                                                  std::string_view message_encoding) = 0;
  // Times in ns.
  virtual void message(std::uint16_t channel, std::uint64_t log_time, std::uint64_t publish_time,
                       std::string_view data) = 0;
  virtual void attach(std::string_view name, std::string_view media_type, std::string_view data) = 0;
  virtual void metadata(std::string_view name, const std::map<std::string, std::string>& texts) = 0;
  virtual void close() = 0;  // nothing follows
};

}  // namespace enc::trial
