// A run as bytes: inputs and outputs of each tick and the state hash after it, with what is needed to run
// them again. Format: docs/reference/record.md.
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

inline constexpr std::uint32_t kRecordFormat = 2;        // and 1 is read, which says nothing at its end
using RecordTexts = std::map<std::string, std::string>;  // "resolved", "seed", "version"...: what the run was

struct RecordedTick {
  Tick tick;
  Inputs in;
  Outputs out;
  std::uint64_t hash = 0;  // StateHash after the tick
};

// Names and types of all leaves of a frame, in order, and of what the task of the scene remembers. Another
// number is another layout; what other tasks remember does not change it.
[[nodiscard]] std::uint64_t layout_hash(const Scene& scene);

class RecordWriter {
 public:
  static constexpr std::size_t kManyChunks = 256;  // some 18 MB: 16 s at 1 kHz

  // Throws Error where the file cannot be made or its header not be written. With one chunk write() puts it
  // into the file when it is whole; with more another thread calls drain(), and write() only copies a tick.
  // file: the empty file at `path`, open for writing, which is closed here; null: it is opened here, too.
  RecordWriter(const std::string& path, const RecordTexts& texts, std::uint64_t layout,
               std::size_t chunks = 1, std::FILE* file = nullptr);
  ~RecordWriter();  // without close() the record stays unsealed: the run did not end as it should
  RecordWriter(const RecordWriter&) = delete;
  RecordWriter& operator=(const RecordWriter&) = delete;

  // Into memory, no heap. After a failed write, and behind by all chunks, it does nothing: no gap.
  void write(const Tick& tick, const Inputs& in, const Outputs& out, std::uint64_t state_hash) noexcept;
  // What is whole is packed and goes to the file. From one thread at a time; the writer's goes, too.
  void drain() noexcept;
  // What is known only when the run has ended: close() puts it before the seal.
  void end_with(const RecordTexts& texts);
  void close() noexcept;  // the rest, how it ended, and the seal

  [[nodiscard]] bool full() const noexcept { return errno_ != 0 || behind_; }
  [[nodiscard]] std::string error() const;                              // one line; empty while all is well
  [[nodiscard]] std::int64_t ticks() const noexcept { return ticks_; }  // taken

 private:
  using Chunk = std::vector<RecordedTick>;  // with room for most_
  void put(const void* bytes, std::size_t size) noexcept;
  void flush_chunk() noexcept;
  void take_away(Chunk& chunk) noexcept;  // through words_ into the file
  [[nodiscard]] Chunk& chunk(std::size_t number) noexcept { return chunks_[number % chunks_.size()]; }

  std::string path_;
  std::FILE* file_ = nullptr;
  std::size_t most_;  // ticks of a chunk
  std::vector<Chunk> chunks_;
  std::atomic<std::size_t> whole_ = 0, in_file_ = 0;  // chunks; the one that is filled is number whole_
  std::vector<std::uint64_t> words_;  // of the chunk that goes to the file: head, leaves, checksum
  std::vector<std::uint64_t> end_;    // as a chunk, of what is said at the end; empty: nothing
  StateHash chain_;
  std::int64_t ticks_ = 0;
  std::atomic<int> errno_ = 0;
  bool behind_ = false;  // the file, by all chunks
};

// yes: reads the whole chunks of a record that is cut off or was never sealed.
enum class Partial { no, yes };

// Whether a file begins as a record does; false where there is none.
[[nodiscard]] bool is_record(const std::string& path);

class RecordReader {
 public:
  // Checks the whole file (ranges.h) before the first frame is given out. Throws Error with the byte.
  explicit RecordReader(const std::string& path, Partial partial = Partial::no);

  [[nodiscard]] const RecordTexts& texts() const { return texts_; }
  // What was said when the run had ended, such as "ledger"; empty where it did not end, or said nothing.
  [[nodiscard]] const RecordTexts& end_texts() const { return end_texts_; }
  [[nodiscard]] std::uint64_t layout() const { return layout_; }  // layout_hash() of its scene
  [[nodiscard]] std::int64_t ticks() const { return ticks_; }
  [[nodiscard]] bool sealed() const { return sealed_; }
  // Of a partial record that was not only cut off: what is wrong, with the byte; no tick behind it is read.
  [[nodiscard]] const std::string& damage() const { return damage_; }
  // The next frame; false after the last.
  bool next(RecordedTick& frame);
  void rewind();

 private:
  [[noreturn]] void fail(std::uint64_t byte, const std::string& what) const;
  bool get(void* bytes, std::size_t size);
  void read_header();
  bool read_chunk();  // false at the seal, or at the last whole chunk of a partial record

  std::string path_;
  Partial partial_;
  std::ifstream file_;
  RecordTexts texts_, end_texts_;
  std::uint32_t format_ = kRecordFormat;
  std::vector<std::uint64_t> chunk_;  // leaves
  std::size_t used_ = 0;
  std::uint64_t size_ = 0, byte_ = 0, first_chunk_ = 0;  // of the file; where it is read; of the first chunk
  StateHash chain_, header_chain_;
  std::uint64_t layout_ = 0;
  std::int64_t ticks_ = 0, index_ = -1;  // of the last tick of the last chunk
  bool sealed_ = false, done_ = false, told_end_ = false;
  std::string damage_;
};

}  // namespace enc
