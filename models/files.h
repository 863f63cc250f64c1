// The program's file access. It never overwrites a file that this run has read, and no existing file without
// --force. Output is written beside its place until it is complete, and two runs never write one file
// (sources/choices 14). No link is followed: a file is written exactly at the user's path, or not at all.
#pragma once

#include <cstdio>
#include <string>
#include <string_view>

namespace enc::models {

// Reads the whole file, which then counts as an input. Otherwise returns an empty text and sets `why`: a
// folder, a device, unreadable, longer than `most` bytes.
[[nodiscard]] std::string read_file(const std::string& path, std::size_t most, std::string& why);
void note_input(const std::string& path);  // other code has read it or will read it

enum class OverwritePolicy { keep, replace };  // replace: --force

[[nodiscard]] inline OverwritePolicy existing(bool force) {
  return force ? OverwritePolicy::replace : OverwritePolicy::keep;
}

class OutFile {
 public:
  // Throws Error in one line if the file may not or cannot be written.
  OutFile(std::string path, OverwritePolicy existing);
  ~OutFile();  // removes a file that was not kept
  OutFile(const OutFile&) = delete;
  OutFile& operator=(const OutFile&) = delete;

  // Path until keep(): PATH.part, a new file. A device or a pipe is written directly.
  [[nodiscard]] const std::string& aside() const { return aside_; }
  // This open file, for a separate writer, which closes it.
  [[nodiscard]] std::FILE* stream() const;
  void write(std::string_view text);
  void spare() { spared_ = true; }  // keeps a useful partial file in place even without keep()
  void keep();                      // the file is complete: moves it to its place

 private:
  [[nodiscard]] bool begin();       // false: another run has just made, moved or removed it
  [[nodiscard]] bool lock() const;  // false: another run has it
  void refuse_existing() const;
  [[noreturn]] void refuse_other_run();
  void remove_left_over();             // removes a file in aside_ from an aborted run
  [[nodiscard]] bool is_ours() const;  // true if the file in aside_ is ours
  void close();
  [[noreturn]] void fail(int why) const;

  std::string path_, aside_;
  OverwritePolicy existing_;
  int fd_ = -1;
  bool spared_ = false;
};

void write_file(const std::string& path, std::string_view text, OverwritePolicy existing);

// Makes the folder if necessary, and locks other runs out of it during its lifetime.
class OutFolder {
 public:
  explicit OutFolder(const std::string& path);
  ~OutFolder();
  OutFolder(const OutFolder&) = delete;
  OutFolder& operator=(const OutFolder&) = delete;

 private:
  int fd_ = -1;
};

}  // namespace enc::models
