// The shape of the sources: who includes whom, what must not be said where, how large things may be. Each
// test prints all offenders.
#include <algorithm>
#include <filesystem>
#include <fstream>
#include <map>
#include <regex>
#include <set>
#include <sstream>
#include <string>
#include <vector>

#include <gtest/gtest.h>

#include "core/frames.h"

namespace enc {
namespace {

namespace fs = std::filesystem;
const fs::path kRoot = ENCOUNTER_SOURCE_DIR;
const std::vector<std::string> kFolders{"core", "sim", "models", "trial", "hw_drivers", "benchmarks", "app"};

struct Source {
  std::string name;    // from the root, "core/step.cpp"
  std::string folder;  // the first part of it
  std::vector<std::string> lines;
  std::vector<std::string> code;  // the same without comments and without what stands in quotes
};

bool is_source(const fs::path& path) { return path.extension() == ".h" || path.extension() == ".cpp"; }

// Comments and quoted text become nothing; an include keeps its name, because the layering is read from
// `lines`.
std::vector<std::string> without_words(const std::vector<std::string>& lines) {
  static const std::regex kQuoted(R"re("(\\.|[^"\\])*"|'(\\.|[^'\\])')re");
  std::vector<std::string> code;
  bool block = false;
  for (const std::string& line : lines) {
    std::string text = std::regex_replace(line, kQuoted, "\"\"");
    if (block) {
      const auto end = text.find("*/");
      block = end == std::string::npos;
      text = block ? "" : text.substr(end + 2);
    }
    if (const auto start = text.find("/*"); start != std::string::npos) {
      block = text.find("*/", start) == std::string::npos;
      text = text.substr(0, start);
    }
    code.push_back(text.substr(0, text.find("//")));
  }
  return code;
}

const std::vector<Source>& sources() {
  static const std::vector<Source> kAll = [] {
    std::vector<Source> all;
    for (const std::string& folder : kFolders) {
      if (!fs::exists(kRoot / folder)) continue;
      for (const auto& entry : fs::recursive_directory_iterator(kRoot / folder)) {
        if (!entry.is_regular_file() || !is_source(entry.path())) continue;
        Source source{fs::relative(entry.path(), kRoot).generic_string(), folder, {}, {}};
        std::ifstream in(entry.path());
        for (std::string line; std::getline(in, line);) source.lines.push_back(line);
        source.code = without_words(source.lines);
        all.push_back(std::move(source));
      }
    }
    return all;
  }();
  return kAll;
}

struct Include {
  std::string name;
  bool ours = false;  // "..." and not <...>
};
std::vector<Include> includes(const Source& source) {
  static const std::regex kInclude(R"re(^\s*#\s*include\s*([<"])([^>"]+)[>"])re");
  std::vector<Include> found;
  std::smatch match;
  for (const std::string& line : source.lines)
    if (std::regex_search(line, match, kInclude)) found.push_back({match[2], match[1] == "\""});
  return found;
}
std::string first_part(const std::string& name) { return name.substr(0, name.find('/')); }
bool starts(const std::string& text, const std::string& with) { return text.rfind(with, 0) == 0; }

TEST(Shape, ThereAreSources) { EXPECT_GT(sources().size(), 40U); }

TEST(Shape, NothingIncludesWhatIsAboveIt) {
  const std::map<std::string, std::set<std::string>> allowed{
      {"core", {"core"}},
      {"sim", {"core", "sim"}},
      {"models", {"core", "models"}},
      {"hw_drivers", {"core", "hw_drivers"}},
      {"trial", {"core", "sim", "models", "trial"}},
      {"benchmarks", {"core", "sim", "models", "trial", "benchmarks"}},
      {"app", {"core", "sim", "models", "trial", "hw_drivers", "app"}}};
  for (const Source& source : sources())
    for (const Include& include : includes(source)) {
      if (!include.ours || include.name == "encounter_version.h") continue;
      const bool spec = source.folder == "models" &&
                        include.name == "sim/twin_spec.h";  // a file format is data, wherever it stands
      EXPECT_TRUE(spec || allowed.at(source.folder).contains(first_part(include.name)))
          << source.name << " includes " << include.name;
    }
}

// Fits are a module, too: the program itself must not draw them in.
TEST(Shape, OnlyTheModuleOfFitsIncludesThem) {
  for (const Source& source : sources()) {
    const std::string& name = source.name;
    const bool may = starts(name, "app/fit/") || starts(name, "benchmarks/") || starts(name, "models/fit/") ||
                     starts(name, "trial/fit/") || starts(name, "trial/guided/");
    for (const Include& include : includes(source))
      EXPECT_TRUE(may || (!starts(include.name, "models/fit/") && !starts(include.name, "trial/fit/") &&
                          !starts(include.name, "trial/guided/")))
          << name << " includes " << include.name;
  }
}

// Benchmarks are a module that most never build: their own tests are the only others that may know them.
TEST(Shape, OnlyTheirTestsIncludeBenchmarks) {
  int tests = 0;
  for (const auto& entry : fs::recursive_directory_iterator(kRoot / "tests")) {
    const std::string name = fs::relative(entry.path(), kRoot).generic_string();
    if (!entry.is_regular_file() || !is_source(entry.path()) || starts(name, "tests/benchmarks/")) continue;
    ++tests;
    std::ifstream in(entry.path());
    for (std::string line; std::getline(in, line);)
      EXPECT_FALSE(line.find("#") != std::string::npos && line.find("include") != std::string::npos &&
                   line.find("benchmarks/") != std::string::npos)
          << name << ": " << line;
  }
  EXPECT_GT(tests, 40);
}

TEST(Shape, LibrariesStayInTheirFiles) {
  static const std::regex kStandard("[a-z0-9_]+");
  for (const Source& source : sources())
    for (const Include& include : includes(source)) {
      if (include.ours) continue;
      const std::string& name = include.name;
      const bool good = (source.folder != "core" || starts(name, "Eigen/") || starts(name, "encounter_") ||
                         std::regex_match(name, kStandard)) &&
                        (!starts(name, "mujoco/") || source.name == "sim/mujoco.h") &&
                        (!starts(name, "toml++") || source.name == "models/toml_reader.cpp") &&
                        (!starts(name, "tiny_gltf") || source.name == "models/mesh_gltf.cpp") &&
                        (!starts(name, "embree3/") || source.name == "benchmarks/peers/embree.cpp") &&
                        (!starts(name, "kdl/") || source.name == "benchmarks/peers/kdl.cpp") &&
                        (!starts(name, "opencv2") || source.name.find("vision/") != std::string::npos) &&
                        ((!starts(name, "GL") && !starts(name, "EGL")) || starts(source.name, "sim/view/"));
      EXPECT_TRUE(good) << source.name << " includes " << name;
    }
}

void expect_no_word(const Source& source, const std::regex& word, const std::string& why) {
  std::smatch match;
  for (std::size_t i = 0; i < source.code.size(); ++i)
    if (std::regex_search(source.code[i], match, word))
      ADD_FAILURE() << source.name << ":" << i + 1 << ": '" << match.str() << "': " << why;
}

TEST(Shape, TheCoreNeitherWaitsNorPrintsNorKnowsMillimetres) {
  static const std::regex kWords(
      R"(\bnow\s*\(|\b\w*sleep\w*|\b\w*mutex\b|\block_guard\b|\bc(out|err|log)\b|\b[fs]?n?printf\b|\b\w+_mm\b|\bstd::thread\b|\bgetenv\b|\brand\s*\()");
  for (const Source& source : sources())
    if (source.folder == "core") expect_no_word(source, kWords, "not in the core");
}

TEST(Shape, WallTimeIsInItsPlaces) {
  static const std::regex kWords(
      R"(\b(steady_clock|system_clock|high_resolution_clock|clock_gettime|gettimeofday|nanosleep|clock_nanosleep)\b)");
  for (const Source& source : sources()) {
    const bool place = source.name == "sim/clock.cpp" || source.folder == "hw_drivers" ||
                       source.name == "trial/trial.cpp" || source.folder == "benchmarks" ||
                       source.folder == "app";
    if (!place)
      expect_no_word(source, kWords,
                     "wall time is for sim/clock.cpp, trial/trial.cpp, hw_drivers, benchmarks and app");
  }
}

TEST(Shape, FilesAreShort) {
  for (const Source& source : sources()) {
    const std::size_t most = source.name.ends_with(".h") ? 120 : 400;
    // What walks through a tick is named in one place.
    if (source.name == "core/record/fields.h") continue;
    EXPECT_LE(source.lines.size(), most) << source.name;
  }
}

TEST(Shape, FoldersAreSmall) {
  // core/ is one folder of several subsystems [sources/choices 3]: data and frames, the stages, models, specs
  // and record.
  const std::map<std::string, std::size_t> limits{{"core", 60}, {"models", 54}, {"sim", 44}, {"app", 28}};
  std::map<std::string, std::size_t> files;
  for (const Source& source : sources()) ++files[fs::path(source.name).parent_path().generic_string()];
  for (const auto& [folder, count] : files) {
    const auto own = limits.find(folder);
    EXPECT_LE(count, own == limits.end() ? 20 : own->second) << folder;
  }
}

TEST(Shape, HeadersAreGuardedAndSayWhatTheyAre) {
  for (const Source& source : sources()) {
    if (!source.name.ends_with(".h")) continue;
    EXPECT_TRUE(!source.lines.empty() && starts(source.lines[0], "//"))
        << source.name << ": the first line says what it is";
    EXPECT_NE(std::find(source.lines.begin(), source.lines.end(), "#pragma once"), source.lines.end())
        << source.name;
  }
}

// As one text without blanks and ends of lines.
std::string packed(const Source& source) {
  std::string text;
  for (const std::string& line : source.lines) text += line;
  std::erase_if(text, [](char c) { return c == ' ' || c == '\t'; });
  return text;
}

TEST(Shape, TheWordsOfAnEnumStandOnce) {
  static const std::regex kTable(R"re(enum_words\(("[^)]*,"[^)]*)\))re");
  std::map<std::string, std::string> tables;  // their words and their file
  for (const Source& source : sources()) {
    const std::string text = packed(source);
    for (std::sregex_iterator match(text.begin(), text.end(), kTable), end; match != end; ++match)
      if (source.name != "core/text/words.h") {  // which has an example
        EXPECT_TRUE(tables.emplace((*match)[1], source.name).second) << source.name << ": " << (*match)[1];
        EXPECT_TRUE(source.name.ends_with(".h")) << source.name << ": words stand beside their enum";
      }
  }
  EXPECT_GT(tables.size(), 20U);
  for (const Source& source : sources()) {
    const std::string text = packed(source);
    for (const auto& [words, file] : tables)
      EXPECT_TRUE(source.name == file || text.find(words) == std::string::npos)
          << source.name << " has " << words << " once more; take kWords<> or word_of() [" << file << "]";
  }
}

TEST(Shape, EveryFrameLetterIsKnown) {
  static const std::regex kFrame(R"(\b(?:Pose|Point|Vec)<\s*'(.)'(?:\s*,\s*'(.)')?\s*>)");
  for (const Source& source : sources())
    for (const std::string& line : source.lines)
      for (std::sregex_iterator match(line.begin(), line.end(), kFrame), end; match != end; ++match)
        for (std::size_t group : {1U, 2U}) {
          const std::string letter = (*match)[group];
          EXPECT_TRUE(letter.empty() || kFrames.find(letter[0]) != std::string_view::npos)
              << source.name << ": " << letter;
        }
}

// ---- where the numbers come from: docs/sources
// --------------------------------------------------------------

// Every text of the repository as one line: a reference may break within a comment.
const std::map<std::string, std::string>& texts() {
  static const std::map<std::string, std::string> kAll = [] {
    const std::set<std::string> made{".git", ".deps", "build", "out"};  // not in the repository [.gitignore]
    std::map<std::string, std::string> all;
    fs::recursive_directory_iterator entry(kRoot);
    for (; entry != fs::recursive_directory_iterator(); ++entry) {
      if (entry.depth() == 0 && made.contains(entry->path().filename().string()))
        entry.disable_recursion_pending();
      if (!entry->is_regular_file()) continue;
      std::string text;
      std::ifstream in(entry->path());
      for (std::string line; std::getline(in, line);) {
        std::size_t start = line.find_first_not_of(" \t/#");
        if (start != std::string::npos) text += " " + line.substr(start);
      }
      if (text.find('\0') == std::string::npos)  // else a picture, a mesh or a record
        all[fs::relative(entry->path(), kRoot).generic_string()] = text;
    }
    return all;
  }();
  return kAll;
}
bool is_of_sources(const std::string& name) { return starts(name, "docs/sources/"); }

// "arm 3" of every heading "## 3 ..." of docs/sources/arm.md.
std::set<std::string> sections() {
  static const std::regex kHeading("^## ([0-9]+) .+");
  std::set<std::string> found;
  for (const auto& entry : fs::directory_iterator(kRoot / "docs/sources")) {
    std::ifstream in(entry.path());
    std::smatch match;
    for (std::string line; std::getline(in, line);) {
      if (!std::regex_match(line, match, kHeading)) continue;
      const bool first = found.insert(entry.path().stem().string() + " " + std::string(match[1])).second;
      EXPECT_TRUE(first) << entry.path() << " has it twice: " << line;
    }
  }
  return found;
}

TEST(Shape, EverySourceIsThereAndIsReferredTo) {
  // "docs/sources", "sources/" in a path or a link, and a file's name are no references.
  static const std::regex kReference("\\bsources/([a-z_]+)(\\.md|/)?(?: ([0-9]+))?");
  const std::set<std::string> there = sections();
  std::set<std::string> unused = there;
  EXPECT_GT(there.size(), 40U);
  for (const auto& [name, text] : texts())
    for (std::sregex_iterator match(text.begin(), text.end(), kReference), end; match != end; ++match) {
      if ((*match)[2].matched) continue;
      const std::string section = std::string((*match)[1]) + " " + std::string((*match)[3]);
      EXPECT_TRUE(there.contains(section)) << name << ": '" << match->str() << "' is not in docs/sources";
      if (!is_of_sources(name)) unused.erase(section);
    }
  for (const std::string& section : unused) ADD_FAILURE() << "nothing refers to sources/" << section;
}

// A reader does not have the notes that came before docs/sources.
TEST(Shape, NothingRefersToTextsThatAreNotHere) {
  static const std::regex kOld(
      "\\b(parameters|fidelity|decisions?|features|architecture|performance|protocols)(\\.md)? [A-Z]?[0-9]");
  for (const auto& [name, text] : texts())
    for (std::sregex_iterator match(text.begin(), text.end(), kOld), end; match != end; ++match)
      ADD_FAILURE() << name << ": '" << match->str()
                    << "' is in no file here: name a section of docs/sources";
}

TEST(Shape, TheTopLevelIsTheAllowedList) {
  const std::set<std::string> allowed{"CMakeLists.txt",
                                      "CMakePresets.json",
                                      "LICENSE",
                                      "README.md",
                                      "app",
                                      "benchmarks",
                                      "check",
                                      "cmake",
                                      "core",
                                      "docs",
                                      "encounter",
                                      "hw_drivers",
                                      "models",
                                      "sim",
                                      "tests",
                                      "trial"};
  const std::set<std::string> made{"build", "out"};  // not in the repository [.gitignore]
  for (const auto& entry : fs::directory_iterator(kRoot)) {
    const std::string name = entry.path().filename().string();
    EXPECT_TRUE(name[0] == '.' || allowed.contains(name) || made.contains(name))
        << name << " is not on the list";
  }
  for (const std::string& name : allowed) EXPECT_TRUE(fs::exists(kRoot / name)) << name << " is missing";
}

}  // namespace
}  // namespace enc
