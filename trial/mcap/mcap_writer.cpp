#include "trial/mcap/mcap_writer.h"

#include <algorithm>
#include <array>
#include <utility>

namespace enc::trial {
namespace {

constexpr std::string_view kMcapMagic("\x89MCAP0\r\n", 8);

enum class Op : std::uint8_t {
  header = 0x01,
  footer,
  schema,
  channel,
  message,
  chunk,
  message_index,
  chunk_index,
  attachment,
  attachment_index,
  statistics,
  metadata,
  metadata_index,
  summary_offset,
  data_end
};

// Of a byte, and of that byte with 1 to 7 zero bytes behind it: eight bytes at once take a third of the time.
using CrcTables = std::array<std::array<std::uint32_t, 256>, 8>;
constexpr CrcTables crc_tables() {
  CrcTables tables{};
  for (std::uint32_t i = 0; i < 256; ++i) {
    std::uint32_t c = i;
    for (int bit = 0; bit < 8; ++bit) c = (c & 1U) != 0 ? 0xEDB88320U ^ (c >> 1U) : c >> 1U;
    tables[0][i] = c;
  }
  for (std::size_t n = 1; n < tables.size(); ++n)
    for (std::size_t i = 0; i < 256; ++i)
      tables[n][i] = tables[0][tables[n - 1][i] & 0xFFU] ^ (tables[n - 1][i] >> 8U);
  return tables;
}

// Little-endian; a text has its size in front.
template <class T>
void put_number(std::string& out, T x) {
  for (std::size_t i = 0; i < sizeof(T); ++i) out += static_cast<char>((x >> (8 * i)) & 0xFFU);
}
void put_text(std::string& out, std::string_view text) {
  put_number(out, static_cast<std::uint32_t>(text.size()));
  out += text;
}
void begin_record(std::string& out, Op op, std::size_t size) {
  out += static_cast<char>(op);
  put_number(out, std::uint64_t{size});
}
std::string as_record(Op op, std::string_view content) {
  std::string out;
  out.reserve(content.size() + 9);
  begin_record(out, op, content.size());
  out += content;
  return out;
}

// Of a channel: from 1, as the numbers of schemas, of which 0 means none.
std::uint16_t number_of(std::size_t channel) { return static_cast<std::uint16_t>(channel + 1); }

}  // namespace

std::uint32_t crc32(std::string_view bytes, std::uint32_t before) {
  static constexpr CrcTables kTables = crc_tables();
  const auto byte = [&](std::size_t i) { return std::uint32_t{static_cast<std::uint8_t>(bytes[i])}; };
  std::uint32_t c = ~before;
  for (; bytes.size() >= 8; bytes.remove_prefix(8)) {
    c ^= byte(0) | byte(1) << 8U | byte(2) << 16U | byte(3) << 24U;
    c = kTables[7][c & 0xFFU] ^ kTables[6][(c >> 8U) & 0xFFU] ^ kTables[5][(c >> 16U) & 0xFFU] ^
        kTables[4][c >> 24U] ^ kTables[3][byte(4)] ^ kTables[2][byte(5)] ^ kTables[1][byte(6)] ^
        kTables[0][byte(7)];
  }
  for (std::size_t i = 0; i < bytes.size(); ++i) c = kTables[0][(c ^ byte(i)) & 0xFFU] ^ (c >> 8U);
  return ~c;
}

void McapWriter::Times::add(std::uint64_t time) {
  first = any ? std::min(first, time) : time;
  last = any ? std::max(last, time) : time;
  any = true;
}

McapWriter::McapWriter(Sink sink, std::string_view library, std::size_t chunk)
    : sink_(std::move(sink)), chunk_size_(chunk) {
  put(kMcapMagic);
  std::string header;
  put_text(header, "");  // no profile
  put_text(header, library);
  put(as_record(Op::header, header));
}

void McapWriter::put(std::string_view bytes) {
  crc_ = crc32(bytes, crc_);
  at_ += bytes.size();
  sink_(bytes);
}

std::uint16_t McapWriter::add_schema(std::string_view name, std::string_view encoding,
                                     std::string_view data) {
  std::string schema;
  put_number(schema, ++schemas_);
  put_text(schema, name);
  put_text(schema, encoding);
  put_text(schema, data);
  schema = as_record(Op::schema, schema);
  chunk_ += schema;
  schema_records_ += schema;
  return schemas_;
}

std::uint16_t McapWriter::add_channel(std::string_view topic, std::uint16_t schema,
                                      std::string_view message_encoding) {
  channels_.emplace_back();
  const std::uint16_t number = number_of(channels_.size() - 1);
  std::string channel;
  put_number(channel, number);
  put_number(channel, schema);
  put_text(channel, topic);
  put_text(channel, message_encoding);
  put_number(channel, std::uint32_t{0});  // no metadata
  channel = as_record(Op::channel, channel);
  chunk_ += channel;
  channel_records_ += channel;
  return number;
}

void McapWriter::message(std::uint16_t channel, std::uint64_t log_time, std::uint64_t publish_time,
                         std::string_view data) {
  Channel& of = channels_.at(channel - 1U);
  of.entries.push_back({log_time, chunk_.size()});
  begin_record(chunk_, Op::message, 2 + 4 + 8 + 8 + data.size());
  put_number(chunk_, channel);
  put_number(chunk_, static_cast<std::uint32_t>(of.messages++));
  put_number(chunk_, log_time);
  put_number(chunk_, publish_time);
  chunk_ += data;
  chunk_times_.add(log_time);
  times_.add(log_time);
  ++messages_;
  if (chunk_.size() >= chunk_size_) flush_chunk();
}

// Where the messages of the chunk are, channel by channel; and where each of these lists is.
std::string McapWriter::write_message_indexes() {
  std::string offsets;
  for (std::size_t i = 0; i < channels_.size(); ++i) {
    std::vector<Entry>& entries = channels_[i].entries;
    if (entries.empty()) continue;
    put_number(offsets, number_of(i));
    put_number(offsets, at_);
    std::string index;
    put_number(index, number_of(i));
    put_number(index, static_cast<std::uint32_t>(16 * entries.size()));
    for (const Entry& entry : entries) {
      put_number(index, entry.time);
      put_number(index, entry.offset);
    }
    put(as_record(Op::message_index, index));
    entries.clear();
  }
  return offsets;
}

// The chunk, where its messages are, and for the summary where both are.
void McapWriter::flush_chunk() {
  if (chunk_.empty()) return;
  std::string head;
  put_number(head, chunk_times_.first);
  put_number(head, chunk_times_.last);
  put_number(head, std::uint64_t{chunk_.size()});
  put_number(head, crc32(chunk_));
  put_text(head, "");  // not compressed
  put_number(head, std::uint64_t{chunk_.size()});
  const std::uint64_t begins = at_;
  std::string begin;
  begin_record(begin, Op::chunk, head.size() + chunk_.size());
  put(begin + head);
  put(chunk_);

  const std::uint64_t ends = at_;
  const std::string offsets = write_message_indexes();

  std::string index;
  put_number(index, chunk_times_.first);
  put_number(index, chunk_times_.last);
  put_number(index, begins);
  put_number(index, ends - begins);
  put_text(index, offsets);
  put_number(index, at_ - ends);
  put_text(index, "");
  put_number(index, std::uint64_t{chunk_.size()});
  put_number(index, std::uint64_t{chunk_.size()});
  chunk_indexes_ += as_record(Op::chunk_index, index);
  ++chunks_;
  chunk_.clear();
  chunk_times_ = {};
}

void McapWriter::attach(std::string_view name, std::string_view media_type, std::string_view data) {
  std::string about;
  put_text(about, name);
  put_text(about, media_type);
  std::string attachment;
  put_number(attachment, std::uint64_t{0});  // when it came and when it was made: before all messages
  put_number(attachment, std::uint64_t{0});
  attachment += about;
  put_number(attachment, std::uint64_t{data.size()});
  attachment += data;
  put_number(attachment, crc32(attachment));
  attachment = as_record(Op::attachment, attachment);

  std::string index;
  put_number(index, at_);
  put_number(index, std::uint64_t{attachment.size()});
  put_number(index, std::uint64_t{0});
  put_number(index, std::uint64_t{0});
  put_number(index, std::uint64_t{data.size()});
  attachment_indexes_ += as_record(Op::attachment_index, index + about);
  ++attachments_;
  put(attachment);
}

void McapWriter::metadata(std::string_view name, const std::map<std::string, std::string>& texts) {
  std::string pairs;
  for (const auto& [key, text] : texts) {
    put_text(pairs, key);
    put_text(pairs, text);
  }
  std::string metadata;
  put_text(metadata, name);
  put_text(metadata, pairs);
  metadata = as_record(Op::metadata, metadata);

  std::string index;
  put_number(index, at_);
  put_number(index, std::uint64_t{metadata.size()});
  put_text(index, name);
  metadata_indexes_ += as_record(Op::metadata_index, index);
  ++metadatas_;
  put(metadata);
}

std::string McapWriter::statistics() const {
  std::string counts;
  for (std::size_t i = 0; i < channels_.size(); ++i) {
    put_number(counts, number_of(i));
    put_number(counts, channels_[i].messages);
  }
  std::string all;
  put_number(all, messages_);
  put_number(all, schemas_);
  put_number(all, static_cast<std::uint32_t>(channels_.size()));
  put_number(all, attachments_);
  put_number(all, metadatas_);
  put_number(all, chunks_);
  put_number(all, times_.first);
  put_number(all, times_.last);
  put_text(all, counts);
  return as_record(Op::statistics, all);
}

// All of a kind together, then where each kind begins.
void McapWriter::write_summary() {
  const std::uint64_t begins = at_;
  const std::string said = statistics();
  std::string offsets;
  crc_ = 0;  // of the summary, from here on
  for (const auto& [op, records] : {std::pair<Op, const std::string&>{Op::schema, schema_records_},
                                    {Op::channel, channel_records_},
                                    {Op::statistics, said},
                                    {Op::chunk_index, chunk_indexes_},
                                    {Op::attachment_index, attachment_indexes_},
                                    {Op::metadata_index, metadata_indexes_}}) {
    if (records.empty()) continue;
    std::string offset(1, static_cast<char>(op));
    put_number(offset, at_);
    put_number(offset, std::uint64_t{records.size()});
    offsets += as_record(Op::summary_offset, offset);
    put(records);
  }
  const std::uint64_t offsets_begin = at_;
  put(offsets);
  std::string footer;
  begin_record(footer, Op::footer, 8 + 8 + 4);
  put_number(footer, begins);
  put_number(footer, offsets_begin);
  put(footer);
  std::string crc;
  put_number(crc, crc_);
  put(crc);
}

void McapWriter::close() {
  flush_chunk();
  std::string crc;
  put_number(crc, crc_);
  put(as_record(Op::data_end, crc));
  write_summary();
  put(kMcapMagic);
}

}  // namespace enc::trial
