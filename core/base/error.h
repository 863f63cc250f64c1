// The one error type. Thrown before the loop starts, caught once in main; the loop has no exceptions.
#pragma once

#include <stdexcept>
#include <string>
#include <utility>

namespace enc {

enum class ErrorKind { input = 2, device = 3 };  // the program's exit codes

// what(): what is wrong, what was expected, what to do, in one line. key: the file key it is about
// ("object.ball.radius_mm"), if any, from which the reader of the file finds line and column.
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
