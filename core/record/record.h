// A run as bytes: inputs, outputs and state hash of each tick, with everything needed to run them again.
// Format: docs/reference/record.md.
#pragma once

#include <atomic>
#include <cstdint>
#include <cstdio>
#include <fstream>
#include <map>
#include <string>
#include <vector>

#include "core/record/state_hash.h"

namespace enc {

inline constexpr std::uint32_t kRecordFormat = 2;        // also reads format 1, which has no end texts
using RecordTexts = std::map<std::string, std::string>;  // "resolved", "seed", "version"...: about the run

struct RecordedTick {
  Tick tick;
  Inputs in;
  Outputs out;
  std::uint64_t hash = 0;  // StateHash after the tick
};

// Hash of the names and types of all leaves of a frame, in order, and of the state of the scene's task. A
// different number means a different layout; the states of other tasks do not change it.
[[nodiscard]] std::uint64_t layout_hash(const Scene& scene);

class RecordWriter {
 public:
  static constexpr std::size_t kManyChunks = 256;  // some 18 MB: 16 s at 1 kHz

  // Throws Error if it cannot create the file or write its header. With one chunk, write() itself writes each
  // complete chunk to the file; with more, another thread calls drain(), and write() only copies a tick.
  // file: the empty file at `path`, open for writing, which the writer closes; null: the writer opens it.
  RecordWriter(const std::string& path, const RecordTexts& texts, std::uint64_t layout,
               std::size_t chunks = 1, std::FILE* file = nullptr);
  ~RecordWriter();  // without close() the record stays unsealed: the run did not end properly
  RecordWriter(const RecordWriter&) = delete;
  RecordWriter& operator=(const RecordWriter&) = delete;

  // Copies to memory, no heap. After a failed write, or if all chunks are full, it does nothing: no gap.
  void write(const Tick& tick, const Inputs& in, const Outputs& out, std::uint64_t state_hash) noexcept;
  // Packs the complete chunks into the file. Call from one thread at a time; the writer's may call it.
  void drain() noexcept;
  // Texts known only after the run: close() writes them before the seal.
  void end_with(const RecordTexts& texts);
  void close() noexcept;  // writes the rest, the end texts and the seal

  [[nodiscard]] bool full() const noexcept { return errno_ != 0 || behind_; }
  [[nodiscard]] std::string error() const;                              // one line; empty: no error
  [[nodiscard]] std::int64_t ticks() const noexcept { return ticks_; }  // ticks taken so far

 private:
  using Chunk = std::vector<RecordedTick>;  // has capacity for most_
  void put(const void* bytes, std::size_t size) noexcept;
  void flush_chunk() noexcept;
  void take_away(Chunk& chunk) noexcept;  // through words_ into the file
  [[nodiscard]] Chunk& chunk(std::size_t number) noexcept { return chunks_[number % chunks_.size()]; }

  std::string path_;
  std::FILE* file_ = nullptr;
  std::size_t most_;  // ticks in a chunk
  std::vector<Chunk> chunks_;
  std::atomic<std::size_t> whole_ = 0, in_file_ = 0;  // chunk counts; number whole_ is being filled
  std::vector<std::uint64_t> words_;                  // chunk being written: head, leaves, checksum
  std::vector<std::uint64_t> end_;                    // the end texts as a chunk; empty: no texts
  StateHash chain_;
  std::int64_t ticks_ = 0;
  std::atomic<int> errno_ = 0;
  bool behind_ = false;  // the file lags by all chunks
};

// yes: reads the complete chunks of a record that is cut off or was never sealed.
enum class PartialRead { no, yes };

// True if a file begins as a record does; false if there is no file.
[[nodiscard]] bool is_record(const std::string& path);

class RecordReader {
 public:
  // Checks the whole file (ranges.h) before it returns the first frame. Throws Error with the byte.
  explicit RecordReader(const std::string& path, PartialRead partial = PartialRead::no);

  [[nodiscard]] const RecordTexts& texts() const { return texts_; }
  // Texts written after the run, such as "ledger"; empty if the run did not end, or has no end texts.
  [[nodiscard]] const RecordTexts& end_texts() const { return end_texts_; }
  [[nodiscard]] std::uint64_t layout() const { return layout_; }  // layout_hash() of its scene
  [[nodiscard]] std::int64_t ticks() const { return ticks_; }
  [[nodiscard]] bool sealed() const { return sealed_; }
  // Damage of a partial record beyond being cut off, with the byte; the reader stops before it.
  [[nodiscard]] const std::string& damage() const { return damage_; }
  // Reads the next frame; false after the last.
  bool next(RecordedTick& frame);
  void rewind();

 private:
  [[noreturn]] void fail(std::uint64_t byte, const std::string& what) const;
  bool get(void* bytes, std::size_t size);
  void read_header();
  bool read_chunk();  // false at the seal, or at the last complete chunk of a partial record

  std::string path_;
  PartialRead partial_;
  std::ifstream file_;
  RecordTexts texts_, end_texts_;
  std::uint32_t format_ = kRecordFormat;
  std::vector<std::uint64_t> chunk_;  // leaves
  std::size_t used_ = 0;
  std::uint64_t size_ = 0, byte_ = 0, first_chunk_ = 0;  // file size; read position; first chunk's position
  StateHash chain_, header_chain_;
  std::uint64_t layout_ = 0;
  std::int64_t ticks_ = 0, index_ = -1;  // index of the last tick of the last chunk
  bool sealed_ = false, done_ = false, told_end_ = false;
  std::string damage_;
};

}  // namespace enc
