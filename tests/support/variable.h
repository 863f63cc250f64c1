// An environment variable that is set while this lives, and is afterwards as it was.
#pragma once

#include <cstdlib>
#include <optional>
#include <string>

namespace enc::test {

class Variable {
 public:
  Variable(const char* name, const std::string& value) : name_(name) {
    if (const char* was = std::getenv(name); was != nullptr) was_ = was;
    setenv(name_, value.c_str(), 1);
  }
  ~Variable() { was_ ? setenv(name_, was_->c_str(), 1) : unsetenv(name_); }
  Variable(const Variable&) = delete;
  Variable& operator=(const Variable&) = delete;

 private:
  const char* name_;
  std::optional<std::string> was_;
};

}  // namespace enc::test
