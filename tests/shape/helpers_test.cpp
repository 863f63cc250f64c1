// The files of a folder are compiled as one (enc_batches in cmake/targets.cmake): two helpers of one name and
// with the same parameters, in anonymous namespaces of two of them, are one too many there, and nowhere else.
// Found in the text: by braces and names, without a compiler.
#include <algorithm>
#include <cctype>
#include <filesystem>
#include <fstream>
#include <iterator>
#include <map>
#include <optional>
#include <set>
#include <string>
#include <string_view>
#include <vector>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "tests/shape/bare_code.h"
#include "tests/support/built.h"

namespace enc::helpers {
namespace {

namespace fs = std::filesystem;
using shape::bare;
using shape::in_word;
using shape::trim;

// "int" of "int count = 3"; of "const Setup&" all.
std::string type_of(std::string_view parameter) {
  parameter = trim(parameter.substr(0, parameter.find('=')));
  std::size_t word = parameter.size();
  while (word > 0 && in_word(parameter[word - 1])) --word;
  const std::string_view type = trim(parameter.substr(0, word));
  const bool unnamed = type.empty() || type.ends_with(':') || type == "const" || type == "unsigned";
  std::string text;
  for (const char c : unnamed || word == parameter.size() ? parameter : type)
    if (in_word(c) && !text.empty() && text.back() == ' ')
      text += c;
    else if (std::isspace(static_cast<unsigned char>(c)) == 0)
      text += c;
    else if (!text.empty() && in_word(text.back()))
      text += ' ';
  return std::string(trim(text));
}

// Of "(int a, std::map<int, int> b)" from its parenthesis on.
std::string types_of(std::string_view list) {
  std::string types;
  int depth = 0;
  std::size_t begin = 1;
  for (std::size_t i = 0; i < list.size(); ++i) {
    const char c = list[i];
    if (std::string_view("([{<").find(c) != std::string_view::npos) ++depth;
    if (std::string_view(")]}>").find(c) != std::string_view::npos) --depth;
    if (depth > 1 || (depth == 1 && c != ',')) continue;
    types += (types.empty() ? "" : ", ") + type_of(list.substr(begin, i - begin));
    begin = i + 1;
    if (depth == 0) break;
  }
  return types;
}

// "refused(const Setup&)" of what stands before a brace; none: it is no function of ours.
std::optional<std::string> function_of(std::string_view head) {
  head = trim(head);
  for (const std::string_view other : {"struct ", "class ", "enum ", "union "})
    if (head.starts_with(other)) return {};
  int depth = 0;
  for (std::size_t i = 0; i < head.size(); ++i) {
    if (head[i] == '<') ++depth;
    if (head[i] == '>') --depth;
    if (head[i] == '=' && depth == 0) return {};
    if (head[i] != '(' || depth > 0) continue;
    const std::string_view before = trim(head.substr(0, i));
    std::size_t word = before.size();
    while (word > 0 && in_word(before[word - 1])) --word;
    const std::string_view name = before.substr(word);
    const bool macro =
        std::none_of(name.begin(), name.end(), [](unsigned char c) { return std::islower(c) != 0; });
    const bool member = before.substr(0, word).ends_with(':');
    if (macro || member) return {};
    return std::string(name) + "(" + types_of(head.substr(i)) + ")";
  }
  return {};
}

// Each function that is in an anonymous namespace, behind the named ones around it.
std::set<std::string> helpers_of(std::string_view text) {
  struct Scope {
    bool space;
    std::string name;  // of a namespace; empty: anonymous
  };
  std::set<std::string> found;
  std::vector<Scope> scopes;
  std::string head;
  for (const char c : bare(text)) {
    if (c == '{') {
      const std::string_view words = trim(head);
      const bool space = words.starts_with("namespace");
      if (space) scopes.push_back({true, std::string(trim(words.substr(9)))});
      const bool anonymous =
          std::all_of(scopes.begin(), scopes.end(), [](const Scope& one) { return one.space; }) &&
          std::any_of(scopes.begin(), scopes.end(), [](const Scope& one) { return one.name.empty(); });
      if (const auto function = function_of(words); !space && anonymous && function) {
        std::string path;
        for (const Scope& one : scopes) path += one.name.empty() ? "" : one.name + "::";
        found.insert(path + *function);
      }
      if (!space) scopes.push_back({false, {}});
    } else if (c == '}' && !scopes.empty()) {
      scopes.pop_back();
    }
    if (c == '{' || c == '}' || c == ';')
      head.clear();
    else
      head += c;
  }
  return found;
}

TEST(Helpers, AreFoundInTheTextOfATest) {
  EXPECT_THAT(helpers_of(R"text(
#define BRACE {
namespace enc::test {
int outside(int a) { return a; }
namespace {
// void commented() {}
constexpr int kMany = 1'000;
struct Bench { int member() { return f({1}); } };
Bench::Bench(int a) : a_{a} {}
const auto lambda = [](int x) { return x; };
std::string refused(const models::Setup& setup, int times = 3) { if (a) { b(); } return "}{"; }
template <class Made, int kSize>
std::function<void(int)> made(std::map<int, Made> all, char quote /* '{' */, std::size_t) { return {}; }
void declared(int);
TEST(Some, Thing) { const char c = '{'; }
TEST_F(Other, Thing) {}
[[noreturn]] void raw(std::string_view text = R"(})") noexcept {}
}
namespace deeper { namespace { bool mine() { return true; } } }
}
)text"),
              testing::ElementsAre(
                  "enc::test::deeper::mine()", "enc::test::made(std::map<int,Made>, char, std::size_t)",
                  "enc::test::raw(std::string_view)", "enc::test::refused(const models::Setup&, int)"));
}

TEST(Helpers, OfAFolderHaveNamesOrParametersOfTheirOwn) {
  std::map<std::string, std::map<std::string, std::string>> folders;  // file by helper
  std::size_t all = 0;
  for (const char* top : {"app", "benchmarks", "core", "hw_drivers", "models", "sim", "tests", "trial"})
    for (const auto& entry : fs::recursive_directory_iterator(fs::path(tests::source_dir()) / top)) {
      const std::string folder = entry.path().parent_path().string(), file = entry.path().filename().string();
      const bool alone = file == "main.cpp" || file.ends_with("_avx2.cpp");
      if (entry.path().extension() != ".cpp" || alone) continue;
      std::ifstream in(entry.path());
      const std::string text(std::istreambuf_iterator<char>(in), {});
      for (const std::string& helper : helpers_of(text)) {
        ++all;
        const auto [other, is_new] = folders[folder].emplace(helper, file);
        EXPECT_TRUE(is_new) << folder << ": " << helper << " is in " << other->second << " and in " << file
                            << ": these are compiled as one; rename one of them";
      }
    }
  EXPECT_GT(all, 1000U) << "nothing is found any more";
}

}  // namespace
}  // namespace enc::helpers
