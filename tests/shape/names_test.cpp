// The names of types, functions and files: a type is a noun, no participle and no bare adjective, and a word
// that the glossary has replaced does not come back. Each test prints all offenders.
#include <algorithm>
#include <cctype>
#include <filesystem>
#include <functional>
#include <regex>
#include <set>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "tests/shape/bare_code.h"
#include "tests/support/built.h"
#include "tests/support/files.h"

namespace enc::names {
namespace {

namespace fs = std::filesystem;
using Names = std::vector<std::string>;
using WordList = std::set<std::string, std::less<>>;

// Participles that do not end in -ed. Nouns that look the same are missing: cut, hit, run, set, shot, spread.
const WordList kParticiples{
    "begun",  "bent",   "broken", "brought", "built", "burnt",  "caught",  "chosen",   "dealt",  "done",
    "drawn",  "driven", "fallen", "felt",    "found", "frozen", "given",   "gone",     "grown",  "heard",
    "held",   "hidden", "hung",   "kept",    "known", "laden",  "laid",    "learnt",   "led",    "lent",
    "lit",    "lost",   "made",   "meant",   "met",   "paid",   "ran",     "risen",    "said",   "seen",
    "sent",   "shaken", "shown",  "shut",    "sold",  "sought", "spent",   "spoilt",   "spoken", "spun",
    "stolen", "stood",  "struck", "stuck",   "sunk",  "swept",  "swung",   "taken",    "taught", "told",
    "torn",   "thrown", "unread", "won",     "worn",  "woven",  "written", "withdrawn"};

// Nouns in -ed.
const WordList kNounsInEd{"bed", "breed", "deed", "feed", "need", "seed", "shed", "speed"};

// Adjectives, prepositions and pronouns: one of these alone does not say what a type holds.
const WordList kNoNouns{
    "across",   "active",     "alone",   "along",     "anything", "apart",    "around", "bad",     "beside",
    "beyond",   "both",       "clean",   "every",     "existing", "flat",     "free",   "from",    "ideal",
    "infinite", "late",       "latest",  "least",     "left",     "live",     "long",   "longer",  "near",
    "nearby",   "nearest",    "odd",     "of",        "open",     "ordinary", "ours",   "partial", "pending",
    "quickest", "ready",      "right",   "silent",    "smooth",   "static",   "steady", "still",   "straight",
    "theirs",   "tangential", "thermal", "uncertain", "what",     "where",    "which",  "whole",   "why",
    "wide",     "without",    "worst",   "wrong"};

// Words that the glossary has replaced (docs/reference/glossary.md) and that no name has any more.
const WordList kReplaced{"debt", "foresee", "foreseen", "foresees", "foresight", "haste", "impede", "impedes",
                         "lair", "owe",     "owes",     "straying", "tame",      "tamed", "tames"};

// "place", "seen" of PlaceSeen and of place_seen.
Names words_of(std::string_view name) {
  Names words(1);
  for (const char c : name) {
    const bool begins = c == '_' || std::isupper(static_cast<unsigned char>(c)) != 0;
    if (begins && !words.back().empty()) words.emplace_back();
    if (c != '_') words.back() += static_cast<char>(std::tolower(static_cast<unsigned char>(c)));
  }
  return words;
}

bool is_participle(const std::string& word) {
  return kParticiples.contains(word) ||
         (word.ends_with("ed") && word.size() > 3 && !kNounsInEd.contains(word));
}
bool is_noun(std::string_view type) {
  const Names words = words_of(type);
  return !is_participle(words.back()) && !(words.size() == 1 && kNoNouns.contains(words[0]));
}
bool has_replaced_word(std::string_view name) {
  const Names words = words_of(name);
  return std::any_of(words.begin(), words.end(),
                     [](const std::string& word) { return kReplaced.contains(word); });
}

Names all_matches(const std::string& code, const std::regex& pattern) {
  Names all;
  for (std::sregex_iterator at(code.begin(), code.end(), pattern), end; at != end; ++at)
    all.push_back((*at)[1].matched ? (*at)[1] : (*at)[2]);
  return all;
}

// The types that a text defines. A fixture of tests is no type of ours: its name is the suite's.
Names types_of(const std::string& code) {
  static const std::regex kType(
      R"(\b(?:struct|class|union|enum)\s+(?:class\s+)?(\w+)(?:\s+final)?\s*(?=[{:])(?!\s*:\s*public\s+(?:::)?testing::)|\busing\s+(\w+)\s*=)");
  return all_matches(code, kType);
}
// The functions that a text defines or calls.
Names functions_of(const std::string& code) {
  static const std::regex kFunction(R"(\b([a-z]\w*)\()");
  return all_matches(code, kFunction);
}

// Calls `see` with each source, by its name from the root, and its code.
void each_source(const std::function<void(const std::string& file, const std::string& code)>& see) {
  const fs::path top = tests::source_dir();
  for (const char* folder :
       {"core", "sim", "models", "trial", "hw_drivers", "benchmarks", "app", "examples", "tests"})
    for (const auto& entry : fs::recursive_directory_iterator(top / folder)) {
      const fs::path& path = entry.path();
      if (path.extension() == ".h" || path.extension() == ".cpp")
        see(fs::relative(path, top).generic_string(), shape::bare(test::bytes_of(path)));
    }
}

using testing::ElementsAre;

TEST(Names, OfTypesAreFoundInTheTextOfATest) {
  const std::string code = shape::bare(
      "struct Seen {};  // struct Told {\n"
      "enum class Felt : int { no };\n"
      "class Recorded : public testing::Test {};\n"
      "class Shown final : public Role {};\n"
      "template <class Of> struct Sum;\n"
      "using Said = int; const char* text = \"struct Kept {\";\n");
  EXPECT_THAT(types_of(code), ElementsAre("Seen", "Felt", "Shown", "Said"));
  EXPECT_THAT(functions_of("int owes(int a) { return tame(a) + Tamed(b); }"), ElementsAre("owes", "tame"));
}

TEST(Names, ParticiplesAndAdjectivesAreNoNouns) {
  for (const char* name : {"Seen", "PlaceSeen", "NotShown", "Judged", "CarryingEnded", "Around", "Still"})
    EXPECT_FALSE(is_noun(name)) << name;
  for (const char* name : {"Seed", "LowSpeed", "CameraFeed", "SeenTool", "StillSensor", "Verdict", "Bed"})
    EXPECT_TRUE(is_noun(name)) << name;
  for (const char* name : {"owes_energy", "Tame", "Haste", "foreseen_touch"})
    EXPECT_TRUE(has_replaced_word(name)) << name;
  for (const char* name : {"lower", "Tower", "hasten", "ledger"})
    EXPECT_FALSE(has_replaced_word(name)) << name;
}

TEST(Names, OfTypesAreNouns) {
  std::size_t types = 0;
  each_source([&](const std::string& file, const std::string& code) {
    for (const std::string& type : types_of(code)) {
      ++types;
      EXPECT_TRUE(is_noun(type)) << file << ": " << type << ": name the type by what it holds";
    }
  });
  EXPECT_GT(types, 1000U);
}

TEST(Names, HaveNoWordThatTheGlossaryReplaces) {
  each_source([](const std::string& file, const std::string& code) {
    Names all = types_of(code);
    for (std::string& function : functions_of(code)) all.push_back(std::move(function));
    all.push_back(fs::path(file).stem().string());
    for (const std::string& name : all)
      EXPECT_FALSE(has_replaced_word(name)) << file << ": " << name << ": see docs/reference/glossary.md";
  });
}

}  // namespace
}  // namespace enc::names
