#include "core/record/record.h"

#include <algorithm>
#include <array>
#include <bit>
#include <cerrno>
#include <cstddef>
#include <cstdint>
#include <cstring>
#include <filesystem>
#include <string_view>
#include <system_error>
#include <type_traits>
#include <variant>
#include <vector>

#include "core/base/error.h"
#include "core/record/fields.h"
#include "core/record/ranges.h"

namespace enc {

// A frame of a record, field by field. It is in no anonymous namespace, because wrong_leaf_of() finds it by
// its argument.
template <class F>
void all_fields(F& f, RecordedTick& frame) {
  fields(f, frame.tick);
  fields(f, frame.in);
  fields(f, frame.out);
  f("state_hash", frame.hash);
}

namespace {

struct LayoutHash {
  std::uint64_t value = 0xcbf29ce484222325ULL;  // FNV-1a
  std::size_t leaves = 0;
  void add(char c) { value = (value ^ static_cast<unsigned char>(c)) * 0x100000001b3ULL; }
  template <class T>
  void operator()(std::string_view name, T&) {
    for (const char c : name) add(c);
    add('\0');
    // Kind and size: an int that becomes a double, or grows, makes another layout.
    add(std::is_floating_point_v<T> ? 'f'
        : std::is_enum_v<T>         ? 'e'
        : std::is_integral_v<T>     ? 'i'
        : std::is_same_v<T, Time>   ? 't'
                                    : 'd');
    add(static_cast<char>('0' + sizeof(T)));
    ++leaves;
  }
};
LayoutHash frame_layout() {
  LayoutHash hash;
  RecordedTick frame;
  all_fields(hash, frame);
  return hash;
}
// A frame contains the hash of the state, so another form of state makes another layout, too.
template <class Memory>
std::uint64_t layout_with(Memory memory) {
  LayoutHash hash = frame_layout();
  State state;
  state.task = memory;
  fields(hash, state);
  return hash.value;
}
template <class... Task>
std::vector<std::uint64_t> layouts_of(const std::variant<Task...>*) {
  return {layout_with(typename Task::Memory{})...};
}

// Leaves of a frame, one word each.
std::size_t frame_words() {
  static const std::size_t kWords = frame_layout().leaves;
  return kWords;
}

// Layout hash of each task.
const std::vector<std::uint64_t>& layouts() {
  static const std::vector<std::uint64_t> kLayouts = layouts_of(static_cast<const Tasks::Any*>(nullptr));
  return kLayouts;
}

}  // namespace

std::uint64_t layout_hash(const Scene& scene) { return layouts()[scene.task.index()]; }

namespace {

static_assert(std::endian::native == std::endian::little, "the record is little-endian: put byte swaps here");

constexpr std::uint64_t kMagic =
    0x0a434552434e4589ULL;                    // "\x89ENCREC\n": no text file, and a text copy breaks it
constexpr std::uint32_t kChunk = 0x4b4e4843;  // "CHNK"
constexpr std::uint32_t kEnd = 0x54584554;    // "TEXT"
constexpr std::uint32_t kSeal = 0x4c414553;   // "SEAL"
constexpr std::size_t kChunkBytes = 64 * 1024;
constexpr std::size_t kHeaderBytes = 64 * 1024 * 1024;  // a larger header is damage, not a scene
constexpr std::size_t kWord = sizeof(std::uint64_t);

std::uint64_t head(std::uint32_t tag, std::size_t size) {
  return tag | static_cast<std::uint64_t>(size) << 32;
}

struct PutLeaves {
  std::uint64_t* to;
  StateHash& chain;
  template <class T>
  void operator()(std::string_view, T& x) {
    *to = leaf_bits(x);
    chain.add(*to++);
  }
};
struct GetLeaves {
  const std::uint64_t* from;
  template <class T>
  void operator()(std::string_view, T& x) {
    set_leaf(x, *from++);
  }
};

// Texts as bytes, padded to whole words.
std::vector<std::uint64_t> packed_texts(const RecordTexts& texts) {
  std::string bytes;
  const auto number = [&](std::size_t n) {
    const std::uint64_t wide = n;
    bytes.append(reinterpret_cast<const char*>(&wide), kWord);
  };
  number(texts.size());
  for (const auto& [name, text] : texts) {
    number(name.size());
    number(text.size());
    bytes += name + text;
  }
  std::vector<std::uint64_t> words((bytes.size() + kWord - 1) / kWord, 0);
  std::memcpy(words.data(), bytes.data(), bytes.size());
  return words;
}
bool unpack(const std::vector<std::uint64_t>& words, RecordTexts& texts) {
  const std::string_view bytes(reinterpret_cast<const char*>(words.data()), words.size() * kWord);
  std::size_t at = 0;
  const auto number = [&](std::uint64_t& n) {
    if (bytes.size() - at < kWord) return false;
    std::memcpy(&n, bytes.data() + at, kWord);
    at += kWord;
    return true;
  };
  std::uint64_t count = 0, name = 0, text = 0;
  if (!number(count)) return false;
  for (std::uint64_t i = 0; i < count; ++i) {
    if (!number(name) || !number(text) || name > bytes.size() - at || text > bytes.size() - at - name)
      return false;
    texts.emplace(bytes.substr(at, name), bytes.substr(at + name, text));
    at += name + text;
  }
  return true;
}

std::string hex(std::uint64_t x) {
  static constexpr char kDigits[] = "0123456789abcdef";
  std::string text = "0x";
  for (int shift = 60; shift >= 0; shift -= 4) text += kDigits[x >> shift & 0xf];
  return text;
}

// A text of the file, made safe for a terminal.
std::string shown(std::string text) {
  constexpr std::size_t kMost = 80;
  text.resize(std::min(text.size(), kMost));
  std::replace_if(
      text.begin(), text.end(), [](char c) { return c < ' ' || c > '~'; }, '?');
  return text;
}

std::string text_or(const RecordTexts& texts, const char* name, const char* otherwise) {
  const auto found = texts.find(name);
  return found == texts.end() ? otherwise : shown(found->second);
}

// "Encounter 0.1.0, commit 71961a4f3c2d"
std::string writer_of(const RecordTexts& texts) {
  return "Encounter " + text_or(texts, "version", "(version not said)") + ", commit " +
         text_or(texts, "commit", "not said");
}

// The remedy that names the version that wrote the record.
std::string way_to_writer(const RecordTexts& texts) {
  const std::string commit = text_or(texts, "commit", "unknown");
  if (commit == "unknown") return "use the version of Encounter that wrote it";
  return "use the version of Encounter that wrote it (git checkout " + commit.substr(0, commit.find('-')) +
         ")";
}

// "0x1, 0x2"
std::string listed(const std::vector<std::uint64_t>& numbers) {
  std::string text;
  for (const std::uint64_t number : numbers) text += (text.empty() ? "" : ", ") + hex(number);
  return text;
}

constexpr const char* kCut =
    "the record is cut off here, or the run was not ended: it has no seal; give --partial for what is whole";

// The part that a head announces; none: a head that cannot stand there.
enum class Part { none, frames, texts, seal };
Part part_of(std::uint64_t head, bool told_end, std::uint32_t format) {
  const auto tag = static_cast<std::uint32_t>(head);
  const std::size_t size = head >> 32;
  const auto possible = [size](std::size_t most, std::size_t each) {
    return size > 0 && size <= most && size % each == 0;
  };
  if (tag == kSeal && size == kWord) return Part::seal;
  if (tag == kChunk && !told_end && possible(kChunkBytes, frame_words() * kWord)) return Part::frames;
  if (tag == kEnd && !told_end && format > 1 && possible(kHeaderBytes, kWord)) return Part::texts;
  return Part::none;
}

}  // namespace

// ---- writing
// ---------------------------------------------------------------------------------------------------------

RecordWriter::RecordWriter(const std::string& path, const RecordTexts& texts, std::uint64_t layout,
                           std::size_t chunks, std::FILE* file)
    : path_(path),
      file_(file),
      most_((kChunkBytes / kWord - 2) / frame_words()),
      chunks_(chunks),
      words_(kChunkBytes / kWord) {
  for (Chunk& one : chunks_) {  // touches the memory now, so that the system really provides it
    one.resize(most_);
    one.clear();
  }
  const std::vector<std::uint64_t> packed = packed_texts(texts);
  if (packed.size() * kWord > kHeaderBytes) {
    if (file_ != nullptr) std::fclose(file_);
    throw Error("the record '" + path +
                "' cannot hold meshes of more than 64 MiB; make them coarser, or run without a record");
  }
  std::vector<std::uint64_t> header{kMagic, head(kRecordFormat, packed.size() * kWord), layout,
                                    frame_words()};
  header.insert(header.end(), packed.begin(), packed.end());
  for (const std::uint64_t word : header) chain_.add(word);
  header.push_back(chain_.value);
  if (file_ == nullptr) file_ = std::fopen(path.c_str(), "wb");
  if (file_ == nullptr) {
    errno_ = errno;
    throw Error(error() + "; give a file in a folder that exists and may be written");
  }
  std::setvbuf(file_, nullptr, _IONBF,
               0);  // our chunk is the buffer: put() hands its data straight to the system
  put(header.data(), header.size() * kWord);
  if (full()) {
    std::fclose(file_);
    std::error_code none;
    if (std::filesystem::is_regular_file(path, none)) std::filesystem::remove(path, none);
    throw Error(error() + "; give a file where there is room");
  }
}

RecordWriter::~RecordWriter() {
  if (file_ == nullptr) return;
  flush_chunk();
  drain();
  std::fclose(file_);
}

void RecordWriter::put(const void* bytes, std::size_t size) noexcept {
  if (errno_ != 0) return;
  errno = 0;
  if (std::fwrite(bytes, 1, size, file_) != size) errno_ = errno != 0 ? errno : EIO;
}

void RecordWriter::take_away(Chunk& one) noexcept {
  PutLeaves put_leaves{words_.data() + 1, chain_};
  for (RecordedTick& frame : one) all_fields(put_leaves, frame);
  words_[0] = head(kChunk, one.size() * frame_words() * kWord);
  chain_.add(words_[0]);
  *put_leaves.to++ = chain_.value;
  put(words_.data(), static_cast<std::size_t>(put_leaves.to - words_.data()) * kWord);
  one.clear();
}

void RecordWriter::drain() noexcept {
  for (std::size_t i = in_file_; i < whole_.load(std::memory_order_acquire); ++i) {
    take_away(chunk(i));
    in_file_.store(i + 1, std::memory_order_release);
  }
}

void RecordWriter::flush_chunk() noexcept {
  const std::size_t number = whole_;
  if (behind_ || chunk(number).empty()) return;
  whole_.store(number + 1, std::memory_order_release);
  if (chunks_.size() == 1) drain();
  behind_ = number + 1 - in_file_.load(std::memory_order_acquire) == chunks_.size();
}

void RecordWriter::write(const Tick& tick, const Inputs& in, const Outputs& out,
                         std::uint64_t state_hash) noexcept {
  if (file_ == nullptr || full()) return;
  Chunk& one = chunk(whole_);
  one.push_back(RecordedTick{tick, in, out, state_hash});
  ++ticks_;
  if (one.size() == most_) flush_chunk();
}

void RecordWriter::end_with(const RecordTexts& texts) {
  end_ = packed_texts(texts);
  if (end_.size() * kWord > kHeaderBytes)
    throw Error("the record '" + path_ + "' cannot hold more than 64 MiB at its end; run for a shorter time");
  end_.insert(end_.begin(), head(kEnd, end_.size() * kWord));
  end_.push_back(0);
}

void RecordWriter::close() noexcept {
  if (file_ == nullptr) return;
  flush_chunk();
  drain();
  if (!end_.empty() && !full()) {
    for (std::size_t i = 1; i + 1 < end_.size(); ++i) chain_.add(end_[i]);
    chain_.add(end_.front());
    end_.back() = chain_.value;
    put(end_.data(), end_.size() * kWord);
  }
  std::array<std::uint64_t, 3> seal{head(kSeal, kWord), static_cast<std::uint64_t>(ticks_), 0};
  chain_.add(seal[1]);
  chain_.add(seal[0]);
  seal[2] = chain_.value;
  if (!full()) put(seal.data(), sizeof(seal));
  if (std::fclose(file_) != 0 && !full()) errno_ = errno;
  file_ = nullptr;
}

std::string RecordWriter::error() const {
  if (!full()) return {};
  if (errno_ == 0) return "cannot write the record '" + path_ + "': the disk has not kept up with the run";
  return "cannot write the record '" + path_ + "': " + std::generic_category().message(errno_);
}

RecordReader::RecordReader(const std::string& path, PartialRead partial) : path_(path), partial_(partial) {
  std::error_code none;
  if (std::filesystem::is_fifo(path, none))  // the reader reads it twice
    throw Error(path + ": is a pipe; expected a file; write the record into one");
  file_.open(path, std::ios::binary);
  if (!file_) throw Error("cannot read the record '" + path + "': " + std::generic_category().message(errno));
  file_.seekg(0, std::ios::end);
  size_ = static_cast<std::uint64_t>(std::max<std::streamoff>(file_.tellg(), 0));
  file_.seekg(0);
  read_header();
  while (read_chunk()) ticks_ += static_cast<std::int64_t>(chunk_.size() / frame_words());
  rewind();
}

void RecordReader::fail(std::uint64_t byte, const std::string& what) const {
  throw Error(path_ + ": byte " + std::to_string(byte) + ": " + what);
}

bool is_record(const std::string& path) {
  std::array<char, kWord> start{};
  std::ifstream file(path, std::ios::binary);
  return file.read(start.data(), start.size()) && std::bit_cast<std::uint64_t>(start) == kMagic;
}

bool RecordReader::get(void* bytes, std::size_t size) {
  file_.read(static_cast<char*>(bytes), static_cast<std::streamsize>(size));
  if (static_cast<std::size_t>(file_.gcount()) != size) return false;
  byte_ += size;
  return true;
}

void RecordReader::read_header() {
  std::array<std::uint64_t, 4> start{};
  if (!get(&start[0], kWord) || start[0] != kMagic) fail(0, "this is not a record of Encounter");
  if (!get(&start[1], 3 * kWord)) fail(byte_, "the record is cut off in its header");
  format_ = static_cast<std::uint32_t>(start[1]);
  const std::size_t size = start[1] >> 32;
  if (format_ < 1 || format_ > kRecordFormat)
    fail(8, "record format " + std::to_string(format_) + ", but this program reads formats 1 to " +
                std::to_string(kRecordFormat) + "; use the version of Encounter that wrote it");
  if (size > kHeaderBytes || size % kWord != 0) fail(12, "the record's header is damaged: impossible size");
  if (size > size_ - byte_) fail(byte_, "the record is cut off in its header");
  std::vector<std::uint64_t> packed(size / kWord);
  std::uint64_t checksum = 0;
  if (!get(packed.data(), size) || !get(&checksum, kWord)) fail(byte_, "the record is cut off in its header");
  for (const std::uint64_t word : start) chain_.add(word);
  for (const std::uint64_t word : packed) chain_.add(word);
  if (checksum != chain_.value) fail(byte_ - kWord, "checksum failure: the record's header is damaged");
  if (!unpack(packed, texts_)) fail(32, "the record's header is damaged: impossible texts");
  const auto& known = layouts();
  if (std::find(known.begin(), known.end(), start[2]) == known.end() || start[3] != frame_words()) {
    fail(16, "record of another layout: " + hex(start[2]) + " of " + writer_of(texts_) +
                 ", but this program has " + listed(known) + "; " + way_to_writer(texts_) +
                 ", or record again");
  }
  layout_ = start[2];
  header_chain_ = chain_;
  first_chunk_ = byte_;
}

bool RecordReader::read_chunk() {
  if (done_) return false;
  const std::uint64_t at = byte_;
  const auto stop = [&](std::uint64_t byte, const std::string& what, bool cut = false) {
    if (partial_ == PartialRead::no) fail(byte, what);
    if (!cut) damage_ = "byte " + std::to_string(byte) + ": " + what;
    done_ = true;
    return false;
  };
  std::uint64_t start = 0, checksum = 0;
  if (!get(&start, kWord)) return stop(at, kCut, true);
  const Part part = part_of(start, told_end_, format_);
  const std::size_t size = start >> 32;
  if (part == Part::none) return stop(at, "the record is damaged: neither a chunk nor the seal");
  if (size > size_ - byte_) return stop(at, kCut, true);
  chunk_.resize(size / kWord);
  if (!get(chunk_.data(), size) || !get(&checksum, kWord)) return stop(at, kCut, true);
  for (const std::uint64_t word : chunk_) chain_.add(word);
  chain_.add(start);
  if (checksum != chain_.value)
    return stop(at, "checksum failure: the record is damaged between here and byte " + std::to_string(byte_));
  if (part == Part::frames) {
    const auto [leaf, why] = wrong_leaf_of<RecordedTick>(chunk_, frame_words(), index_);
    return why.empty() || stop(at + kWord * (1 + leaf), why);
  }
  if (part == Part::texts) {
    end_texts_.clear();
    if (!unpack(chunk_, end_texts_)) return stop(at, "the record is damaged: impossible texts at its end");
    told_end_ = true;
    return read_chunk();
  }
  done_ = true;
  // rewind() leaves ticks_ known and unchanged; a seal with another number comes from another writer.
  const std::string sealed = std::to_string(chunk_[0]), there = std::to_string(ticks_);
  if (sealed != there) return stop(at, "the seal is for " + sealed + " ticks, but " + there + " are there");
  char more = 0;
  if (get(&more, 1)) return stop(byte_ - 1, "there is something after the record's seal");
  sealed_ = true;
  return false;
}

void RecordReader::rewind() {
  file_.clear();
  file_.seekg(static_cast<std::streamoff>(first_chunk_));
  byte_ = first_chunk_;
  chain_ = header_chain_;
  chunk_.clear();
  used_ = 0;
  index_ = -1;
  done_ = told_end_ = false;
}

bool RecordReader::next(RecordedTick& frame) {
  if (used_ >= chunk_.size()) {
    used_ = 0;
    if (!read_chunk()) {
      chunk_.clear();
      return false;
    }
  }
  GetLeaves get_leaves{chunk_.data() + used_};
  all_fields(get_leaves, frame);
  used_ += frame_words();
  return true;
}

}  // namespace enc
