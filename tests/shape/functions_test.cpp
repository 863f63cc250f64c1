// Functions, found in the text by braces and names, without a compiler. A reader sees a function at one
// sight: at most 40 lines from its opening to its closing brace, lambdas included. A helper has a name or
// parameters of its own within its folder.
#include <algorithm>
#include <array>
#include <cctype>
#include <cstddef>
#include <filesystem>
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
#include "tests/support/files.h"

namespace enc::functions {
namespace {

namespace fs = std::filesystem;
using shape::bare;
using shape::behind;
using shape::in_word;
using shape::trim;

// ---- Functions.

constexpr std::size_t kMostLines = 40;

struct LengthException {
  std::string_view function, why;  // "FILE: NAME", or with its parameters if others have that name
};
// These functions may be longer. Remove an entry that is no longer too long; add no new one.
constexpr auto kExceptions = std::to_array<LengthException>({
    {"commands.cpp: Commands::all", "the commands of a controller, a table with a line or two for each"},
    {"schema_arm.cpp: describe(Visitor& v, ArmRig& a)", "keys of a file, a table"},
    {"schema_arm.cpp: describe(Visitor& v, sim::ArmTruth& a)", "keys of a file, a table"},
    {"schema_camera.cpp: describe(Visitor& v, FingertipSpec& f)", "keys of a file, a table"},
    {"schema_rig.cpp: describe(Visitor& v, RigSpec& r)", "keys of a file, a table"},
    {"schema_rig.cpp: describe(Visitor& v, TrackerRig& t)", "keys of a file, a table"},
    {"schema_scene.cpp: describe(Visitor& v, SceneSpec& s)", "keys of a file, a table"},
    {"schema_twin.cpp: describe(Visitor& v, sim::CameraTruth& c)", "keys of a file, a table"},
    {"schema_twin.cpp: describe(Visitor& v, sim::HandTruth& h)", "keys of a file, a table"},
    {"schema_twin.cpp: describe(Visitor& v, sim::TrackerTruth& t)", "keys of a file, a table"},
    {"settings.cpp: GcsSettings::declare", "keys of a driver, a table"},
});

std::string squeezed(std::string_view text) {
  std::string out;
  for (const char c : trim(text))
    if (std::isspace(static_cast<unsigned char>(c)) == 0)
      out += c;
    else if (out.back() != ' ')
      out += ' ';
  return out;
}

// The place behind the parenthesis that closes the one at `open`, or the end.
std::size_t behind_parenthesis(std::string_view text, std::size_t open) {
  int depth = 0;
  for (std::size_t i = open; i < text.size(); ++i) {
    if (text[i] == '(') ++depth;
    if (text[i] == ')' && --depth == 0) return i + 1;
  }
  return text.size();
}

// "Arm::mass(int q)" from "PerJoint Arm::mass(int q) const".
std::string name_of(const std::string& head) {
  const std::size_t open = head.find('(');
  if (open == std::string::npos) return head;
  std::size_t from = open;
  while (from > 0 && (in_word(head[from - 1]) || head[from - 1] == ':' || head[from - 1] == '~')) --from;
  return head.substr(from, behind_parenthesis(head, open) - from);
}

bool is_type(std::string_view head) {
  while (head.starts_with("template <")) head = trim(head.substr(std::min(head.find('>') + 1, head.size())));
  return !head.ends_with(')') && (head.starts_with("struct ") || head.starts_with("class ") ||
                                  head.starts_with("union ") || head.starts_with("enum "));
}

// True if a brace behind `head` belongs to a member, in a list such as "Run(int a) : a_".
bool initialises_member(const std::string& head) {
  const std::size_t open = head.find('(');
  if (open == std::string::npos || (!in_word(head.back()) && head.back() != '>')) return false;
  std::string rest = head.substr(behind_parenthesis(head, open));
  for (std::size_t at = 0; (at = rest.find("::", at)) != std::string::npos;) rest.erase(at, 2);
  return rest.find(':') != std::string::npos;
}

struct Function {
  std::string name;
  std::size_t line, lines;  // line of its opening brace, and number of lines up to the closing one
};

enum class Scope { names, function, member, other };

class Reader {
 public:
  std::vector<Function> all;

  void see(char c) {
    if (c == '\n') ++line_;
    if (c == '(') ++parentheses_;
    if (c == ')') --parentheses_;
    if (c == '{')
      open();
    else if (c == '}')
      close();
    else if (c == ';' && parentheses_ == 0)
      head_.clear();
    else
      head_ += c;
  }
  [[nodiscard]] bool balanced() const { return open_.empty() && parentheses_ == 0; }

 private:
  struct OpenBlock {
    Scope scope;
    std::size_t line;
    std::string head, text;  // squeezed, and as it stands
    int parentheses;
  };

  void open() {
    const std::string head = squeezed(head_);
    const auto is = [&](Scope scope) {
      return std::any_of(open_.begin(), open_.end(),
                         [&](const OpenBlock& one) { return one.scope == scope; });
    };
    Scope scope = Scope::other;
    if (is(Scope::function))
      scope = Scope::other;
    else if (parentheses_ > 0 || is(Scope::member) || initialises_member(head))
      scope = Scope::member;
    else if (head.starts_with("namespace") || head.starts_with("inline namespace") || head == "extern" ||
             is_type(head))
      scope = Scope::names;
    else if (head.find('(') != std::string::npos)
      scope = Scope::function;
    open_.push_back({scope, line_, head, head_, parentheses_});
    parentheses_ = 0;
    head_.clear();
  }
  void close() {
    if (open_.empty()) {
      parentheses_ = -1;  // its beginning is missing
      return;
    }
    const OpenBlock last = open_.back();
    open_.pop_back();
    parentheses_ = last.parentheses;
    if (last.scope == Scope::function) all.push_back({name_of(last.head), last.line, line_ - last.line + 1});
    head_ = last.scope == Scope::member ? last.text + "{}" : "";
  }

  std::vector<OpenBlock> open_;
  std::string head_;  // since the last end of a statement or block
  std::size_t line_ = 1;
  int parentheses_ = 0;  // open, in this block
};

Reader read(std::string_view text) {
  Reader reader;
  for (const char c : bare(text)) reader.see(c);
  return reader;
}

// Functions of product code that are too long, "FILE: NAME", each with its place.
struct LongFunction {
  std::string file, name, place;
  std::size_t lines;
};
struct Product {
  std::vector<LongFunction> longer;
  std::size_t functions = 0;
  std::vector<std::string> unbalanced;  // files
};
Product read_product() {
  Product product;
  const fs::path root = tests::source_dir();
  for (const char* top : {"core", "sim", "models", "trial", "app", "hw_drivers", "benchmarks"})
    for (const auto& entry : fs::recursive_directory_iterator(root / top)) {
      const fs::path& path = entry.path();
      if (path.extension() != ".h" && path.extension() != ".cpp") continue;
      const Reader reader = read(test::bytes_of(path));
      product.functions += reader.all.size();
      const std::string name = fs::relative(path, root).generic_string();
      if (!reader.balanced()) product.unbalanced.push_back(name);
      for (const Function& one : reader.all)
        if (one.lines > kMostLines)
          product.longer.push_back(
              {path.filename().string(), one.name, name + ":" + std::to_string(one.line), one.lines});
    }
  return product;
}
const Product& product() {
  static const Product kProduct = read_product();
  return kProduct;
}

bool is(const LongFunction& found, std::string_view listed) {
  const std::string name = found.file + ": " + found.name;
  return name == listed || name.substr(0, name.find('(')) == listed;
}
bool is_exception(const LongFunction& found) {
  return std::any_of(kExceptions.begin(), kExceptions.end(),
                     [&](const LengthException& one) { return is(found, one.function); });
}

TEST(Functions, AreFoundInTheTextOfATest) {
  const Reader reader = read(R"text(
#define BRACE {
namespace enc { namespace {
constexpr int kMany[] = {1'000, 2};
template <class T> struct Bench {
  Bench(int a, std::vector<int> b = {1}) : a_{a}, b_(b) {
    c();
  }
  bool operator()(int x) const { return x > a_; }
};
[[nodiscard]] std::string Refused::text(const Setup& setup, int times = 3) const noexcept {
  const auto inner = [&] {  // {
    return "}{";
  };
  return R"(})";
}
enum class Kind : int { one, two };
}
void outside() {}
}
)text");
  EXPECT_TRUE(reader.balanced());
  std::vector<std::string> all;
  for (const Function& one : reader.all) all.push_back(one.name + " " + std::to_string(one.lines));
  EXPECT_THAT(all, testing::ElementsAre("Bench(int a, std::vector<int> b = {}) 3", "operator() 1",
                                        "Refused::text(const Setup& setup, int times = 3) 6", "outside() 1"));
  EXPECT_FALSE(read("void f() { }}").balanced());
}

TEST(Functions, HaveAtMostFortyLines) {
  EXPECT_GT(product().functions, 6000U) << "nothing is found any more";
  EXPECT_THAT(product().unbalanced, testing::IsEmpty());
  for (const LongFunction& one : product().longer)
    EXPECT_TRUE(is_exception(one)) << one.place << ": " << one.name << " has " << one.lines
                                   << " lines; at most " << kMostLines;
}

TEST(Functions, ExceptionsAreFewAndStillNeeded) {
  EXPECT_LE(kExceptions.size(), 20U);
  const auto is_longer = [](std::string_view name) {
    return std::any_of(product().longer.begin(), product().longer.end(),
                       [&](const LongFunction& one) { return is(one, name); });
  };
  for (const LengthException& one : kExceptions)
    EXPECT_TRUE(is_longer(one.function) && !one.why.empty()) << one.function << ": take it off the list";
}

// ---- Helpers. The build compiles the files of a folder as one (enc_batches in cmake/targets.cmake). There,
// and only there, two helpers in anonymous namespaces of two files collide if they share name and parameters.

// "int" from "int count = 3"; "const Setup&" stays whole.
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

// The types in "(int a, std::map<int, int> b)" from its parenthesis on.
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

// "refused(const Setup&)" from the text before a brace; nullopt if it is no function of ours.
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

// Each function in an anonymous namespace, behind the named namespaces around it.
std::set<std::string> helpers_of(std::string_view text) {
  struct Space {
    bool space;
    std::string name;  // name of a namespace; empty: anonymous
  };
  std::set<std::string> found;
  std::vector<Space> scopes;
  std::string head;
  for (const char c : bare(text)) {
    if (c == '{') {
      const std::string_view words = trim(head);
      const bool space = words.starts_with("namespace");
      if (space) scopes.push_back({true, std::string(trim(words.substr(9)))});
      const bool anonymous =
          std::all_of(scopes.begin(), scopes.end(), [](const Space& one) { return one.space; }) &&
          std::any_of(scopes.begin(), scopes.end(), [](const Space& one) { return one.name.empty(); });
      if (const auto function = function_of(words); !space && anonymous && function) {
        std::string path;
        for (const Space& one : scopes) path += one.name.empty() ? "" : one.name + "::";
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
      const std::string text = test::bytes_of(entry.path());
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
}  // namespace enc::functions
