// The one error type. The program throws it before the loop starts and catches it once in main; the loop has
// no exceptions.
#pragma once

#include <stdexcept>
#include <string>
#include <utility>

namespace enc {

enum class ErrorKind { input = 2, device = 3 };  // the program's exit codes

// Error::what() is one line that says what is wrong, what was expected and what to do. key: the file key that
// it concerns ("object.ball.radius_mm"), if any; the reader of the file derives line and column from the key.
class Error : public std::runtime_error {
 public:
  explicit Error(const std::string& what, std::string key = {}, ErrorKind kind = ErrorKind::input)
      : std::runtime_error(what), key_(std::move(key)), kind_(kind) {}
  [[nodiscard]] const std::string& key() const { return key_; }
  [[nodiscard]] ErrorKind kind() const { return kind_; }

 private:
  std::string key_;
  ErrorKind kind_;
};

}  // namespace enc
