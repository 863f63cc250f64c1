#include "tests/input/app/program.h"

#include <algorithm>
#include <cstdlib>
#include <fstream>

#include <gmock/gmock.h>

#include "tests/support/built.h"
#include "tests/support/files.h"

namespace enc::tests {

namespace fs = std::filesystem;
using ::testing::AllOf;
using ::testing::EndsWith;
using ::testing::StartsWith;

std::string line_and_column(const std::string& text, const std::string& what) {
  const auto at = text.find(what);
  EXPECT_NE(at, std::string::npos) << "not in the file: " << what;
  if (at == std::string::npos) return "?";
  const auto head = text.substr(0, at);
  const auto line = 1 + std::count(head.begin(), head.end(), '\n');
  const auto column = at - (head.rfind('\n') == std::string::npos ? 0 : head.rfind('\n') + 1) + 1;
  return std::to_string(line) + ":" + std::to_string(column);
}

std::string loop_text() {
  std::string text = "time_s,deflection_mm,force_N,repeat\n";
  for (int i = 1; i <= 3000; ++i) {
    const int steps = i <= 1500 ? i : 3000 - i;  // steps of 4 um
    const auto fixed = [](int micro) {
      const std::string digits = std::to_string(micro);
      return "0." + std::string(6 - std::min<std::size_t>(6, digits.size()), '0') + digits;
    };
    const auto decimal = [&](int micro) {
      return std::to_string(micro / 1000000) + fixed(micro % 1000000).substr(1);
    };
    text += decimal(i * 1000) + "," + decimal(steps * 4000) + "," +
            decimal(steps * (i <= 1500 ? 8000 : 6000)) + ",1\n";
  }
  return text;
}

Program::Program() {
  fs::create_directory(folder_ / "models");
  const fs::path models = fs::path(tests::source_dir()) / "models";
  for (const char* part : {"scenes", "rigs", "mjcf", "responses"})
    fs::copy(models / part, folder_ / "models" / part, fs::copy_options::recursive);
  fs::copy(models / "behaviours.toml", folder_ / "models");
  unsetenv("ENCOUNTER_MODULES");
}

void Program::write(const std::string& name, const std::string& text) const {
  std::ofstream(folder_ / name, std::ios::binary) << text;
}

void Program::edit(const std::string& name, const std::string& from, const std::string& to) const {
  write(name, replaced(test::bytes_of(folder_ / name), from, to));
}

Words Program::files() const {
  Words names;
  for (const auto& entry : fs::recursive_directory_iterator(folder_)) names.push_back(entry.path());
  std::sort(names.begin(), names.end());
  return names;
}

std::string Program::refused(const Words& args, int code) const {
  const Words before = files();
  const Result r = run_program(args);
  EXPECT_EQ(r.code, code) << r.err;
  EXPECT_EQ(r.out, "") << "something ran";
  EXPECT_EQ(std::count(r.err.begin(), r.err.end(), '\n'), 1) << "one line: " << r.err;
  EXPECT_THAT(r.err, AllOf(StartsWith("encounter: "), EndsWith("\n")));
  EXPECT_EQ(files(), before) << "a file was left behind";
  return r.err.substr(std::min<std::size_t>(11, r.err.size()));
}

std::string Program::scene_refused(const std::string& scene, const Words& more) const {
  Words run{"run", scene, "--for-s", "0.1", "--record", path("never.encrec")};
  Words check{"check", scene};
  run.insert(run.end(), more.begin(), more.end());
  check.insert(check.end(), more.begin(), more.end());
  const std::string said = refused(run);
  EXPECT_EQ(refused(check), said);
  return said;
}

std::string Program::recorded(const Words& more) const {
  Words run{"run", plane(), "--for-s", "0.5", "--record", path("run.encrec")};
  run.insert(run.end(), more.begin(), more.end());
  const Result r = run_program(run);
  EXPECT_EQ(r.code, 0) << r.err;
  return path("run.encrec");
}

}  // namespace enc::tests
