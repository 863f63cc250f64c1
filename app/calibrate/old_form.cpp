// Handles `calibrate WHAT`, the command before it had subjects: finds the subject that the words meant, and
// names the command that replaces it.
#include <algorithm>
#include <array>
#include <filesystem>
#include <fstream>
#include <string_view>

#include <fmt/format.h>

#include "app/calibrate/calibrate.h"
#include "app/common/words.h"
#include "core/base/error.h"
#include "core/record/record.h"
#include "models/schema/wording.h"
#include "models/setup/scene_file.h"
#include "models/tables/csv_reader.h"

namespace enc::app {
namespace {

namespace fs = std::filesystem;
using Words = std::vector<std::string>;

constexpr std::array<std::string_view, 6> kSubjects{"tracker", "tip", "camera", "rig", "stereo", "skin"};
constexpr const char* kExpected = "expected tracker, tip, camera, rig, stereo or skin";

bool is_subject(const std::string& word) {
  return std::find(kSubjects.begin(), kSubjects.end(), word) != kSubjects.end();
}

// Returns "--set" for "--set=a=1".
std::string option_of(const std::string& word) {
  return word.starts_with("--") ? word.substr(0, word.find('=')) : std::string();
}

bool has(const Words& words, std::initializer_list<const char*> options) {
  return std::any_of(words.begin(), words.end(), [&](const std::string& word) {
    return std::find(options.begin(), options.end(), option_of(word)) != options.end();
  });
}

// The first word that is neither an option nor the value of one; else end().
Words::const_iterator what_in(const Words& words) {
  const std::initializer_list<const char*> valued{"--rate-Hz",   "--out",     "--pairs",   "--frames",
                                                  "--seed",      "--set",     "--scene",   "--poses",
                                                  "--square-mm", "--corners", "--picture", "--skin"};
  for (auto word = words.begin(); word != words.end(); ++word) {
    if (!word->starts_with("--")) return word;
    if (word->find('=') != std::string::npos || !has({*word}, valued)) continue;
    if (++word == words.end()) break;
  }
  return words.end();
}

// The first bytes of a file, long enough for a table's header.
std::string begin_of(const std::string& file) {
  std::string text(4096, '\0');
  std::ifstream stream(file, std::ios::binary);
  stream.read(text.data(), static_cast<std::streamsize>(text.size()));
  text.resize(static_cast<std::size_t>(stream.gcount()));
  return text;
}

std::string subject_of_file(const std::string& file) {
  if (is_record(file)) return "tracker";
  const std::string text = begin_of(file);
  const std::string_view header = models::csv_header(text);
  const auto names = [&](std::string_view part) { return header.find(part) != std::string_view::npos; };
  if (names("camera_") || names("device_")) return "camera";
  return (names("tool_q") || names("markers_")) && !names("tip_x_mm") ? "tip" : "tracker";
}

std::string subject_of_rig(const std::string& rig) {
  try {
    return models::load_rig(rig).arm.driver != "none" ? "camera" : "rig";
  } catch (const Error&) {
    return "rig";  // the new command reports the mistakes in this rig
  }
}

// Subject of an input that does not exist or cannot be read, judged by the options; empty: unknown.
std::string subject_of_options(const std::string& what, const Words& words) {
  if (has(words, {"--square-mm", "--corners", "--picture"})) return "stereo";
  if (has(words, {"--through-images", "--pairs", "--frames"})) return "camera";
  if (has(words, {"--poses", "--scene", "--armed", "--lockstep", "--yes", "--not-real-time"})) return "rig";
  if (what.ends_with(".toml")) return "rig";
  const bool log = what.ends_with(".csv") || what.ends_with(".encrec") || has(words, {"--rate-Hz"});
  return log ? "tracker" : "";
}

std::string subject_of(const std::string& what, const Words& words) {
  const Words rigs = models::files_in(models::models_dir(), "rigs");
  if (is_subject(what)) return what;
  if (has(words, {"--skin"})) return "skin";
  if (has(words, {"--pivot"})) return "tip";
  std::error_code none;
  // The name of a rig takes precedence over a folder with that name.
  if (std::find(rigs.begin(), rigs.end(), what) != rigs.end()) return subject_of_rig(what);
  if (fs::is_directory(what, none)) return "stereo";
  if (what.ends_with(".toml") && fs::is_regular_file(what, none)) return subject_of_rig(what);
  if (fs::is_regular_file(what, none)) return subject_of_file(what);
  return subject_of_options(what, words);
}

// The words as a command in the new form.
std::string command_of(const std::string& subject, const Words& words, const Words::const_iterator& what) {
  std::string text = "encounter calibrate " + subject;
  if (*what != subject) text += " " + shell_word(*what);
  for (auto word = words.begin(); word != words.end(); ++word) {
    if (word == what || *word == "--pivot") continue;
    if (*word == "--skin")
      text += " --masks";
    else if (word->starts_with("--skin="))
      text += " --masks=" + shell_word(word->substr(7));
    else
      text += " " + shell_word(*word);
  }
  return text;
}

}  // namespace

void check_subject(const Words& words) {
  const Words::const_iterator what = what_in(words);
  const bool help = !words.empty() && (words.front() == "--help" || words.front() == "-h");
  if (help || (!words.empty() && is_subject(words.front()))) return;
  if (what == words.end())
    throw Error(fmt::format("calibrate: there is no subject; {}; see encounter calibrate --help", kExpected));
  const std::string subject = subject_of(*what, words);
  if (subject.empty()) {
    const std::string near = models::nearest_name(*what, {kSubjects.begin(), kSubjects.end()});
    throw Error(fmt::format("calibrate: {} is no subject; {}; {}", models::quoted(*what), kExpected,
                            near.empty() ? "see encounter calibrate --help"
                                         : fmt::format("did you mean {}?", models::quoted(near))));
  }
  throw Error(fmt::format("calibrate: the subject is missing; {}; run: {}", kExpected,
                          command_of(subject, words, what)));
}

}  // namespace enc::app
