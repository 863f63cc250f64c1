// The shape of the sources: allowed includes, forbidden words by folder, and limits of size. Each test prints
// all offenders.
#include <algorithm>
#include <filesystem>
#include <fstream>
#include <iterator>
#include <map>
#include <regex>
#include <set>
#include <sstream>
#include <string>
#include <vector>

#include <gtest/gtest.h>

#include "core/base/frames.h"
#include "tests/support/built.h"

namespace enc {
namespace {

namespace fs = std::filesystem;
const fs::path kTop = tests::source_dir();
const std::vector<std::string> kFolders{"core", "sim", "models", "trial", "hw_drivers", "benchmarks", "app"};

struct Source {
  std::string name;    // from the root, "core/control/step.cpp"
  std::string folder;  // the first part of the name
  std::vector<std::string> lines;
  std::vector<std::string> code;  // lines without comments and without quoted text
};

bool is_source(const fs::path& path) { return path.extension() == ".h" || path.extension() == ".cpp"; }

// Removes comments and quoted text. An include keeps its name, because the layering check reads `lines`.
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

std::vector<Source> read(const std::vector<std::string>& folders) {
  std::vector<Source> all;
  for (const std::string& folder : folders) {
    if (!fs::exists(kTop / folder)) continue;
    for (const auto& entry : fs::recursive_directory_iterator(kTop / folder)) {
      if (!entry.is_regular_file() || !is_source(entry.path())) continue;
      Source source{fs::relative(entry.path(), kTop).generic_string(), folder, {}, {}};
      std::ifstream in(entry.path());
      for (std::string line; std::getline(in, line);) source.lines.push_back(line);
      source.code = without_words(source.lines);
      all.push_back(std::move(source));
    }
  }
  return all;
}
const std::vector<Source>& sources() {
  static const std::vector<Source> kAll = read(kFolders);
  return kAll;
}
const std::vector<Source>& tests() {
  static const std::vector<Source> kAll = read({"tests"});
  return kAll;
}
std::vector<Source> sources_and_tests() {
  std::vector<Source> all = sources();
  all.insert(all.end(), tests().begin(), tests().end());
  return all;
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

void expect_no_word(const Source& source, const std::regex& word, const std::string& why) {
  std::smatch match;
  for (std::size_t i = 0; i < source.code.size(); ++i)
    if (std::regex_search(source.code[i], match, word))
      ADD_FAILURE() << source.name << ":" << i + 1 << ": '" << match.str() << "': " << why;
}

TEST(Shape, ThereAreSources) { EXPECT_GT(sources().size(), 40U); }

TEST(Shape, NothingIncludesWhatIsAboveIt) {
  const std::map<std::string, std::set<std::string>> allowed{
      {"core", {"core"}},
      {"sim", {"core", "sim"}},
      {"models", {"core", "models"}},
      {"hw_drivers", {"core", "hw_drivers"}},
      {"trial", {"core", "sim", "models", "trial"}},
      {"benchmarks", {"core", "sim", "models", "trial", "hw_drivers", "benchmarks"}},
      {"app", {"core", "sim", "models", "trial", "hw_drivers", "app"}}};
  for (const Source& source : sources())
    for (const Include& include : includes(source)) {
      if (!include.ours || include.name == "encounter_version.h") continue;
      const bool spec = source.folder == "models" &&
                        include.name == "sim/spec/twin_spec.h";  // a file format is data, wherever it stands
      EXPECT_TRUE(spec || allowed.at(source.folder).contains(first_part(include.name)))
          << source.name << " includes " << include.name;
    }
}

// A tick has one sequence of steps for every task and every machine.
TEST(Shape, TheTickAsksForNoTask) {
  static const std::regex kWords(R"(\b(\w+Task|render|impedance|probe|travel|has_\w+)\b)");
  for (const Source& source : sources())
    if (source.name == "core/control/step.cpp") expect_no_word(source, kWords, "the tick knows no task");
}

// A task is a folder and includes no other task, except that a push is a meeting, too.
TEST(Shape, TasksKnowNoOtherTask) {
  const auto task_of = [](const std::string& name) -> std::string {
    if (!starts(name, "core/control/task/")) return "";
    const std::string rest = name.substr(18);
    return rest.find('/') == std::string::npos ? "" : first_part(rest);
  };
  for (const Source& source : sources())
    for (const Include& include : includes(source)) {
      const std::string own = task_of(source.name), other = task_of(include.name);
      EXPECT_TRUE(own.empty() || other.empty() || own == other ||
                  (own == "dynamic_object" && other == "impedance"))
          << source.name << " includes " << include.name;
    }
}

// Fits are modules, too, and only the stereo calibration loads OpenCV: the program must not include them.
TEST(Shape, OnlyTheModulesOfFitsIncludeThem) {
  static const std::regex kFits("(models|trial)/identify/.*"),
      kModules("(app/fit|app/calibrate/fits|app/calibrate/images|benchmarks)/.*");
  static const std::regex kStereo("models/identify/stereo/.*"), kImages("app/calibrate/images/.*");
  const auto is = [](const std::string& name, const std::regex& of) { return std::regex_match(name, of); };
  for (const Source& source : sources())
    for (const Include& include : includes(source)) {
      const bool may = is(source.name, kFits) || is(source.name, kModules);
      const bool images = is(source.name, kStereo) || is(source.name, kImages);
      EXPECT_TRUE(may || !is(include.name, kFits)) << source.name << " includes " << include.name;
      EXPECT_TRUE(images || !is(include.name, kStereo)) << source.name << " includes " << include.name;
    }
}

// Benchmarks are a module that most people never build: only their own tests may include them.
TEST(Shape, OnlyTheirTestsIncludeBenchmarks) {
  EXPECT_GT(tests().size(), 40U);
  for (const Source& source : tests()) {
    if (starts(source.name, "tests/benchmarks/")) continue;
    for (const Include& include : includes(source))
      EXPECT_FALSE(starts(include.name, "benchmarks/")) << source.name << " includes " << include.name;
  }
}

// Code of the program that tests need is a library, too.
TEST(Shape, NothingIncludesASource) {
  for (const Source& source : sources_and_tests())
    for (const Include& include : includes(source))
      EXPECT_FALSE(include.name.ends_with(".cpp")) << source.name << " includes " << include.name;
}

TEST(Shape, LibrariesStayInTheirFiles) {
  static const std::regex kStandard("[a-z0-9_]+");
  for (const Source& source : sources())
    for (const Include& include : includes(source)) {
      if (include.ours) continue;
      const std::string& name = include.name;
      const bool good = (source.folder != "core" || starts(name, "Eigen/") || starts(name, "encounter_") ||
                         (name == "immintrin.h" && source.name.ends_with("_avx2.cpp")) ||
                         std::regex_match(name, kStandard)) &&
                        (!starts(name, "mujoco/") || source.name == "sim/bodies/mujoco.h") &&
                        (!starts(name, "toml++") || source.name == "models/schema/toml_reader.cpp") &&
                        (!starts(name, "tiny_gltf") || source.name == "models/mesh_files/mesh_gltf.cpp") &&
                        (!starts(name, "modbus/") || source.name == "hw_drivers/gripper/drive/coupler.cpp") &&
                        (!starts(name, "embree3/") || source.name == "benchmarks/peers/embree.cpp") &&
                        (!starts(name, "kdl/") || source.name == "benchmarks/peers/kdl.cpp") &&
                        (name != "zstd.h" || source.name == "trial/mcap/mcap_writer.cpp") &&
                        (!starts(name, "opencv2") || starts(source.name, "models/identify/stereo/") ||
                         starts(source.name, "benchmarks/peers/")) &&
                        ((!starts(name, "GL") && !starts(name, "EGL")) || starts(source.name, "sim/view/") ||
                         source.name == "sim/window/module.cpp");
      EXPECT_TRUE(good) << source.name << " includes " << name;
    }
}

TEST(Shape, TheCoreNeitherWaitsNorPrintsNorKnowsMillimetres) {
  static const std::regex kWords(
      R"(\bnow\s*\(|\b\w*sleep\w*|\b\w*mutex\b|\block_guard\b|\bc(out|err|log)\b|\b[fs]?n?printf\b|\b\w+_mm\b|\bstd::thread\b|\bgetenv\b|\brand\s*\()");
  for (const Source& source : sources())
    if (source.folder == "core") expect_no_word(source, kWords, "not in the core");
}

// A factor that two files define gets two meanings sooner or later.
TEST(Shape, UnitFactorsStandInOneHeader) {
  static const std::regex kDefined(
      R"(\bk(Mm|Um|Ms|Us|Deg|Degs|Degrees?|Milli\w*|Micro\w*|Kilo\w*|Mega\w*|\w*Per(M|S|Rad|Mm|Ms|Milli\w*)) *= *(1e-?[36]|1000|1'000'000|180\.0 */|M_PI */|std::numbers::pi */))");
  for (const Source& source : sources_and_tests())
    if (source.name != "core/base/units.h")
      expect_no_word(source, kDefined, "unit factors are in core/base/units.h");
}

TEST(Shape, WallTimeIsInItsPlaces) {
  static const std::regex kWords(
      R"(\b(steady_clock|system_clock|high_resolution_clock|clock_gettime|gettimeofday|nanosleep|clock_nanosleep)\b)");
  for (const Source& source : sources()) {
    const bool place = source.name == "sim/clock.cpp" || source.folder == "hw_drivers" ||
                       source.name == "trial/trial.cpp" || source.folder == "benchmarks" ||
                       source.folder == "app" || source.name == "trial/provenance/provenance.cpp";
    if (!place)
      expect_no_word(
          source, kWords,
          "wall time is for sim/clock.cpp, trial/trial.cpp and provenance, hw_drivers, benchmarks and app");
  }
}

TEST(Shape, FilesAreShort) {
  for (const Source& source : sources_and_tests()) {
    const std::size_t most = source.name.ends_with(".h") ? 120 : 600;
    EXPECT_LE(source.lines.size(), most) << source.name;
  }
}

// A folder holds one subject [sources/choices 3].
TEST(Shape, FoldersAreSmall) {
  constexpr std::size_t kMost = 20;
  std::map<std::string, std::size_t> files;
  for (const Source& source : sources_and_tests())
    ++files[fs::path(source.name).parent_path().generic_string()];
  for (const auto& [folder, count] : files) EXPECT_LE(count, kMost) << folder;
}

// A reader finds the unit tests of a folder under the name of the folder.
TEST(Shape, UnitTestsMirrorTheTree) {
  std::set<fs::path> folders;
  for (const Source& source : tests())
    if (starts(source.name, "tests/unit/")) folders.insert(fs::path(source.name).parent_path());
  for (const fs::path& folder : folders) {
    const fs::path mirrored = folder.lexically_relative("tests/unit");
    EXPECT_TRUE(mirrored != "." && fs::is_directory(kTop / mirrored)) << folder;
  }
}

TEST(Shape, HeadersAreGuardedAndSayWhatTheyAre) {
  for (const Source& source : sources_and_tests()) {
    if (!source.name.ends_with(".h")) continue;
    EXPECT_TRUE(!source.lines.empty() && starts(source.lines[0], "//"))
        << source.name << ": the first line says what it is";
    EXPECT_NE(std::find(source.lines.begin(), source.lines.end(), "#pragma once"), source.lines.end())
        << source.name;
  }
}

// The source as one text without blanks and ends of lines.
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
      if (source.name != "core/base/words.h") {  // that file has an example
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

// ---- the benchmarks

std::vector<fs::path> sources_in(const std::string& folder) {
  std::vector<fs::path> all;
  for (const auto& entry : fs::recursive_directory_iterator(kTop / folder))
    if (entry.path().extension() == ".h" || entry.path().extension() == ".cpp") all.push_back(entry.path());
  return all;
}

// The larger example that docs/guide/benchmark.md names.
TEST(BenchmarkShape, APlainBenchmarkIsOneShortFile) {
  const fs::path file = kTop / "benchmarks/encounter/encounter.cpp";
  std::ifstream in(file);
  std::size_t lines = 0;
  for (std::string line; std::getline(in, line);) ++lines;
  EXPECT_GT(lines, 20U);
  EXPECT_LE(lines, 150U) << file;
}

// 24 would be too many; a fifth of that stays free.
TEST(BenchmarkShape, FoldersHaveRoom) {
  for (const char* where : {"benchmarks", "tests/benchmarks"}) {
    std::map<fs::path, int> files;
    for (const fs::path& source : sources_in(where)) ++files[source.parent_path()];
    EXPECT_GT(files.size(), 3U) << where;
    for (const auto& [folder, count] : files) EXPECT_LE(count, 19) << folder;
  }
}

// The kit, the report and the commands take benchmarks from the table, in which benchmarks register
// themselves.
TEST(BenchmarkShape, NoneIsIncludedByWhatServesThemAll) {
  static const std::regex kInclude(R"(^#\s*include "benchmarks[/](\w+).)");
  std::smatch include;
  for (const char* where :
       {"benchmarks/kit", "benchmarks/report", "benchmarks/verdict", "benchmarks/commands"})
    for (const fs::path& source : sources_in(where)) {
      std::ifstream in(source);
      for (std::string line; std::getline(in, line);) {
        if (!std::regex_search(line, include, kInclude)) continue;
        const std::string folder = include[1];
        EXPECT_TRUE(folder == "kit" || folder == "report" || folder == "commands" ||
                    folder == "questionnaire" || folder == "verdict")
            << source << ": " << line;
      }
    }
}

// ---- the question which machine
// Each machine has its own code behind one interface. A place that asks for the machine needs an edit for
// each new machine, so their number is limited and only goes down.
TEST(Shape, FewPlacesAskWhichMachine) {
  constexpr std::size_t kMost = 24;  // 10 ask the scene or its law, 14 read the flag of trial/family.h
  static const std::regex kAsks(R"(impedance\(\)|scene\.arm\b|\bs\.arm\b|has_arm|takes_force)");
  std::vector<std::string> places;
  for (const Source& source : sources()) {
    if (source.folder == "core") continue;
    for (std::size_t i = 0; i < source.lines.size(); ++i)
      if (std::regex_search(source.lines[i], kAsks))
        places.push_back(source.name + ":" + std::to_string(i + 1) + ":" + source.lines[i] + "\n");
  }
  std::string all;
  for (const std::string& place : places) all += place;
  EXPECT_LE(places.size(), kMost) << all;
}

// ---- sources of the numbers: docs/sources

// Every text of the repository as one line, because a reference may break within a comment.
const std::map<std::string, std::string>& texts() {
  static const std::map<std::string, std::string> kAll = [] {
    const std::set<std::string> made{".git", ".deps", "build", "out"};  // not in the repository [.gitignore]
    std::map<std::string, std::string> all;
    fs::recursive_directory_iterator entry(kTop);
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
      if (text.find('\0') == std::string::npos)  // otherwise a picture, a mesh or a record
        all[fs::relative(entry->path(), kTop).generic_string()] = text;
    }
    return all;
  }();
  return kAll;
}
bool is_of_sources(const std::string& name) { return starts(name, "docs/sources/"); }

// "arm 3" for every heading "## 3 ..." of docs/sources/arm.md.
std::set<std::string> sections() {
  static const std::regex kHeading("^## ([0-9]+) .+");
  std::set<std::string> found;
  for (const auto& entry : fs::directory_iterator(kTop / "docs/sources")) {
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

// A reader does not have the notes that preceded docs/sources.
TEST(Shape, NothingRefersToTextsThatAreNotHere) {
  static const std::regex kOld(
      "\\b(parameters|fidelity|decisions?|features|architecture|performance|protocols)(\\.md)? [A-Z]?[0-9]");
  for (const auto& [name, text] : texts())
    for (std::sregex_iterator match(text.begin(), text.end(), kOld), end; match != end; ++match)
      ADD_FAILURE() << name << ": '" << match->str()
                    << "' is in no file here: name a section of docs/sources";
}

TEST(Shape, TheTopLevelIsTheAllowedList) {
  std::istringstream names(
      "CHANGELOG.md CITATION.cff CMakeLists.txt CMakePresets.json LICENSE README.md app benchmarks check "
      "cmake "
      "core docs encounter examples hw_drivers models pyproject.toml python sim tests trial");
  const std::set<std::string> allowed{std::istream_iterator<std::string>(names), {}};
  const std::set<std::string> made{"build", "out"};  // not in the repository [.gitignore]
  for (const auto& entry : fs::directory_iterator(kTop)) {
    const std::string name = entry.path().filename().string();
    EXPECT_TRUE(name[0] == '.' || allowed.contains(name) || made.contains(name))
        << name << " is not on the list";
  }
  for (const std::string& name : allowed) EXPECT_TRUE(fs::exists(kTop / name)) << name << " is missing";
}

}  // namespace
}  // namespace enc
