// Files as the program reads and writes them: nothing that this run has read is ever written over, nothing at
// all without --force; what is written stands beside its place until it is whole, two runs never write one
// file (sources/choices 14), and no link is followed: a file is written where the user said, or nowhere.
#pragma once

#include <cstdio>
#include <string>
#include <string_view>

namespace enc::models {

// The whole file; or nothing, and `why`: a folder, a device, unreadable, longer than `most` bytes. From here
// on it is an input.
[[nodiscard]] std::string read_file(const std::string& path, std::size_t most, std::string& why);
void note_input(const std::string& path);  // was or will be read by something else

enum class Existing { keep, replace };  // replace: --force

[[nodiscard]] inline Existing existing(bool force) { return force ? Existing::replace : Existing::keep; }

class OutFile {
 public:
  // Throws Error in one line where it may not be written, or cannot be.
  OutFile(std::string path, Existing existing);
  ~OutFile();  // takes away what was not kept
  OutFile(const OutFile&) = delete;
  OutFile& operator=(const OutFile&) = delete;

  // Where it stands until keep(): PATH.part, a new file. A device or a pipe is written at once.
  [[nodiscard]] const std::string& aside() const { return aside_; }
  // The same open file, for a writer of its own, which closes it.
  [[nodiscard]] std::FILE* stream() const;
  void write(std::string_view text);
  void spare() { spared_ = true; }  // part of it is worth something: it stays where it is without keep(), too
  void keep();                      // it is whole: puts it in its place

 private:
  [[nodiscard]] bool begin();       // false: another run has just made, moved or removed it
  [[nodiscard]] bool lock() const;  // false: another run has it
  void refuse_existing() const;
  [[noreturn]] void refuse_other_run();
  void remove_left_over();             // what stands in aside_, where it is of a run that did not end
  [[nodiscard]] bool is_ours() const;  // what stands in aside_
  void close();
  [[noreturn]] void fail(int why) const;

  std::string path_, aside_;
  Existing existing_;
  int fd_ = -1;
  bool spared_ = false;
};

void write_file(const std::string& path, std::string_view text, Existing existing);

// Makes the folder if need be and keeps other runs out of it as long as this lives.
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
