#include "trial/mcap/mcap_writer.h"

#include <algorithm>
#include <array>
#include <concepts>
#include <new>
#include <utility>

#include <zstd.h>

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

// Tables for a byte, and for that byte followed by 1 to 7 zero bytes. Eight bytes at once take a third of the
// time.
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

// Little-endian; a text begins with its size.
template <std::integral T>
void put_field(std::string& out, T x) {
  for (std::size_t i = 0; i < sizeof(T); ++i) out += static_cast<char>((x >> (8 * i)) & 0xFFU);
}
void put_field(std::string& out, std::string_view text) {
  put_field(out, static_cast<std::uint32_t>(text.size()));
  out += text;
}
template <class... Fields>
void put_fields(std::string& out, const Fields&... fields) {
  (put_field(out, fields), ...);
}
template <class... Fields>
std::string fields_of(const Fields&... fields) {
  std::string out;
  put_fields(out, fields...);
  return out;
}
void begin_record(std::string& out, Op op, std::size_t size) {
  out += static_cast<char>(op);
  put_field(out, std::uint64_t{size});
}
std::string as_record(Op op, std::string_view content) {
  std::string out;
  out.reserve(content.size() + 9);
  begin_record(out, op, content.size());
  out += content;
  return out;
}

// zstd's fastest level: the next ones take twice the time for a few percent.
std::string compressed(std::string_view bytes) {
  constexpr int kLevel = 1;
  std::string out(ZSTD_compressBound(bytes.size()), '\0');
  const std::size_t size = ZSTD_compress(out.data(), out.size(), bytes.data(), bytes.size(), kLevel);
  if (ZSTD_isError(size) != 0) throw std::bad_alloc();  // nothing else can fail with room for the bound
  out.resize(size);
  return out;
}

// Number of a channel or schema, from 1; schema 0 means no schema.
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

McapWriter::McapWriter(Sink sink, std::string_view library, const Form& form)
    : sink_(std::move(sink)), chunk_size_(form.chunk), compression_(form.compression) {
  put(kMcapMagic);
  put(as_record(Op::header, fields_of(form.profile, library)));
}

void McapWriter::put(std::string_view bytes) {
  crc_ = crc32(bytes, crc_);
  at_ += bytes.size();
  sink_(bytes);
}

std::uint16_t McapWriter::add_schema(std::string_view name, std::string_view encoding,
                                     std::string_view data) {
  const std::string schema = as_record(Op::schema, fields_of(++schemas_, name, encoding, data));
  chunk_ += schema;
  schema_records_ += schema;
  return schemas_;
}

std::uint16_t McapWriter::add_channel(std::string_view topic, std::uint16_t schema,
                                      std::string_view message_encoding) {
  channels_.emplace_back();
  const std::uint16_t number = number_of(channels_.size() - 1);
  constexpr std::uint32_t kNoMetadata = 0;
  const std::string channel =
      as_record(Op::channel, fields_of(number, schema, topic, message_encoding, kNoMetadata));
  chunk_ += channel;
  channel_records_ += channel;
  return number;
}

void McapWriter::message(std::uint16_t channel, std::uint64_t log_time, std::uint64_t publish_time,
                         std::string_view data) {
  Channel& of = channels_.at(channel - 1U);
  of.entries.push_back({log_time, chunk_.size()});
  begin_record(chunk_, Op::message, 2 + 4 + 8 + 8 + data.size());
  put_fields(chunk_, channel, static_cast<std::uint32_t>(of.messages++), log_time, publish_time);
  chunk_ += data;
  chunk_times_.add(log_time);
  times_.add(log_time);
  ++messages_;
  if (chunk_.size() >= chunk_size_) flush_chunk();
}

// Writes the positions of the chunk's messages, channel by channel. Returns the positions of these lists.
std::string McapWriter::write_message_indexes() {
  std::string offsets;
  for (std::size_t i = 0; i < channels_.size(); ++i) {
    std::vector<Entry>& entries = channels_[i].entries;
    if (entries.empty()) continue;
    put_fields(offsets, number_of(i), at_);
    std::string index = fields_of(number_of(i), static_cast<std::uint32_t>(16 * entries.size()));
    for (const Entry& entry : entries) put_fields(index, entry.time, entry.offset);
    put(as_record(Op::message_index, index));
    entries.clear();
  }
  return offsets;
}

// Writes the chunk and its message indexes, and adds both positions to the summary.
void McapWriter::flush_chunk() {
  if (chunk_.empty()) return;
  const bool packs = compression_ == ChunkCompression::zstd;
  const std::string packed = packs ? compressed(chunk_) : std::string();
  const std::string& records = packs ? packed : chunk_;
  const std::string_view compression = packs ? "zstd" : "";
  const std::uint64_t size = chunk_.size(), in_file = records.size(), begins = at_;
  const std::string head =
      fields_of(chunk_times_.first, chunk_times_.last, size, crc32(chunk_), compression, in_file);
  std::string begin;
  begin_record(begin, Op::chunk, head.size() + records.size());
  put(begin + head);
  put(records);

  const std::uint64_t ends = at_;
  const std::string offsets = write_message_indexes();

  chunk_indexes_ +=
      as_record(Op::chunk_index, fields_of(chunk_times_.first, chunk_times_.last, begins, ends - begins,
                                           offsets, at_ - ends, compression, in_file, size));
  ++chunks_;
  chunk_.clear();
  chunk_times_ = {};
}

void McapWriter::attach(std::string_view name, std::string_view media_type, std::string_view data) {
  constexpr std::uint64_t kCame = 0, kMade = 0;  // sorted before all messages
  const std::uint64_t size = data.size();
  std::string attachment = fields_of(kCame, kMade, name, media_type, size);
  attachment += data;
  put_field(attachment, crc32(attachment));
  attachment = as_record(Op::attachment, attachment);
  attachment_indexes_ += as_record(Op::attachment_index, fields_of(at_, std::uint64_t{attachment.size()},
                                                                   kCame, kMade, size, name, media_type));
  ++attachments_;
  put(attachment);
}

void McapWriter::metadata(std::string_view name, const std::map<std::string, std::string>& texts) {
  std::string pairs;
  for (const auto& [key, text] : texts) put_fields(pairs, key, text);
  const std::string metadata = as_record(Op::metadata, fields_of(name, pairs));
  metadata_indexes_ += as_record(Op::metadata_index, fields_of(at_, std::uint64_t{metadata.size()}, name));
  ++metadatas_;
  put(metadata);
}

std::string McapWriter::statistics() const {
  std::string counts;
  for (std::size_t i = 0; i < channels_.size(); ++i) put_fields(counts, number_of(i), channels_[i].messages);
  return as_record(Op::statistics,
                   fields_of(messages_, schemas_, static_cast<std::uint32_t>(channels_.size()), attachments_,
                             metadatas_, chunks_, times_.first, times_.last, counts));
}

// Writes all records, grouped by kind, then the begin of each group.
void McapWriter::write_summary() {
  const std::uint64_t begins = at_;
  const std::string said = statistics();
  std::string offsets;
  crc_ = 0;  // CRC of the summary only
  for (const auto& [op, records] : {std::pair<Op, const std::string&>{Op::schema, schema_records_},
                                    {Op::channel, channel_records_},
                                    {Op::statistics, said},
                                    {Op::chunk_index, chunk_indexes_},
                                    {Op::attachment_index, attachment_indexes_},
                                    {Op::metadata_index, metadata_indexes_}}) {
    if (records.empty()) continue;
    std::string offset(1, static_cast<char>(op));
    put_fields(offset, at_, std::uint64_t{records.size()});
    offsets += as_record(Op::summary_offset, offset);
    put(records);
  }
  const std::uint64_t offsets_begin = at_;
  put(offsets);
  std::string footer;
  begin_record(footer, Op::footer, 8 + 8 + 4);
  put_fields(footer, begins, offsets_begin);
  put(footer);
  put(fields_of(crc_));
}

void McapWriter::close() {
  flush_chunk();
  put(as_record(Op::data_end, fields_of(crc_)));
  write_summary();
  put(kMcapMagic);
}

}  // namespace enc::trial
