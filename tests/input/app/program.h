// The program as a person calls it: a temporary folder with a copy of models/, so that a test may break
// whatever it likes.
#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include <gtest/gtest.h>

#include "tests/support/files.h"
#include "tests/support/run_program.h"

namespace enc::tests {

using Words = std::vector<std::string>;

using test::replaced;

// "12:3" for the first `what` in a text; columns count from 1.
[[nodiscard]] std::string line_and_column(const std::string& text, const std::string& what);
// A loop for `fit`: one press to 6 mm at 4 mm/s, 2 N/mm in, 1.5 N/mm out.
[[nodiscard]] std::string loop_text();

class Program : public ::testing::Test {
 protected:
  Program();

  [[nodiscard]] std::string path(const std::string& name) const { return (folder_ / name).string(); }
  [[nodiscard]] std::string ball() const { return path("models/scenes/tennis_ball.toml"); }
  [[nodiscard]] std::string plane() const { return path("models/scenes/plane.toml"); }
  void write(const std::string& name, const std::string& text) const;
  void edit(const std::string& name, const std::string& from, const std::string& to) const;
  [[nodiscard]] Words files() const;

  // Runs a command that must be refused and returns its single line. Expects an empty stdout and no new file.
  [[nodiscard]] std::string refused(const Words& args, int code = 2) const;
  // Expects `run` with a record and `check` to refuse the scene in equal words.
  [[nodiscard]] std::string scene_refused(const std::string& scene, const Words& more = {}) const;
  // Records half a second of a good run.
  [[nodiscard]] std::string recorded(const Words& more = {}) const;

  test::TemporaryFolder temporary_;
  const std::filesystem::path& folder_ = temporary_.path();
  const test::Variable models_{"ENCOUNTER_MODELS", path("models")};
};

}  // namespace enc::tests
