// Text that a command writes in pieces, so that a long one is never in memory as a whole.
#pragma once

#include <cstdio>
#include <optional>
#include <string>
#include <string_view>

#include "app/process.h"
#include "models/files.h"

namespace enc::app {

// The file, or standard output for "-".
class TextOutput {
 public:
  TextOutput(const std::string& path, models::OverwritePolicy existing) {
    if (path != "-") file_.emplace(path, existing);
  }
  void write(std::string_view text) {
    buffer_ += text;
    if (buffer_.size() > 1U << 16U) flush();
  }
  void end() {
    flush();
    if (file_) file_->keep();
  }

 private:
  void flush() {
    if (file_)
      file_->write(buffer_);
    else if (std::fwrite(buffer_.data(), 1, buffer_.size(), stdout) != buffer_.size())
      fail_output();
    buffer_.clear();
  }
  std::optional<models::OutFile> file_;
  std::string buffer_;
};

}  // namespace enc::app
