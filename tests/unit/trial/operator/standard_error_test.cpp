// A terminal that takes nothing keeps nobody waiting.
#include "trial/operator/standard_error.h"

#include <algorithm>
#include <cstdio>
#include <string>

#include <gtest/gtest.h>
#include <pty.h>
#include <unistd.h>

namespace enc::trial {
namespace {

// Standard error is a terminal that nobody reads, or a pipe, while this is there.
class Unread {
 public:
  explicit Unread(bool terminal) {
    std::fflush(stderr);
    if (terminal ? openpty(ends_, ends_ + 1, nullptr, nullptr, nullptr) : pipe(ends_)) return;
    dup2(ends_[1], STDERR_FILENO);
  }
  ~Unread() {
    dup2(before_, STDERR_FILENO);
    close_reader();
    close(ends_[1]);
    close(before_);
  }
  Unread(const Unread&) = delete;
  Unread& operator=(const Unread&) = delete;
  void close_reader() {
    if (ends_[0] >= 0) close(ends_[0]);
    ends_[0] = -1;
  }
  [[nodiscard]] std::string read_all() const {
    std::string all(1 << 20, ' ');
    all.resize(static_cast<std::size_t>(std::max<ssize_t>(0, read(ends_[0], all.data(), all.size()))));
    return all;
  }

 private:
  const int before_ = dup(STDERR_FILENO);
  int ends_[2] = {-1, -1};
};

TEST(StandardError, IsWrittenAsFarAsItTakes) {
  for (const bool terminal : {true, false}) {
    Unread unread(terminal);
    const StandardError error;
    EXPECT_EQ(error.terminal(), terminal);
    EXPECT_EQ(error.write("hello"), 5U);
    EXPECT_EQ(unread.read_all(), "hello");
    const std::string much(1 << 18, 'x');  // more than a pipe holds
    std::size_t taken = 0;
    for (int i = 0; i < 8; ++i) taken += error.write(much);
    EXPECT_GT(taken, 1000U);
    EXPECT_LT(taken, much.size());
    EXPECT_EQ(error.write(much), 0U);
  }
}

TEST(StandardError, WithoutAReaderSwallowsAll) {
  Unread unread(true);
  const StandardError error;
  unread.close_reader();
  EXPECT_EQ(error.write("hello"), 5U);
}

}  // namespace
}  // namespace enc::trial
