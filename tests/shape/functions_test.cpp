// A function is read at one sight: at most 40 lines from its opening to its closing brace. Found in the text,
// by braces and without a compiler; the lambdas of a function count with it.
#include <algorithm>
#include <array>
#include <cstddef>
#include <filesystem>
#include <fstream>
#include <iterator>
#include <set>
#include <string>
#include <string_view>
#include <vector>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "tests/shape/bare_code.h"
#include "tests/support/built.h"

namespace enc::functions {
namespace {

namespace fs = std::filesystem;
using shape::in_word;
using shape::trim;

constexpr std::size_t kMostLines = 40;

struct Longer {
  std::string_view function, why;  // "FILE: NAME", or with its parameters where others have that name
};
// These may be longer. Take one off that is no longer; none is added.
constexpr auto kExceptions = std::to_array<Longer>({
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

// Still to be shortened. None is added.
constexpr auto kToShorten = std::to_array<std::string_view>({
    "ablation.cpp: run",
    "block_fit.cpp: BlockFit::solve",
    "calibrate_camera.cpp: calibrate_arm",
    "calibrate_rig.cpp: calibrate_rig",
    "calibrate_tracker.cpp: remarks_text",
    "device_removal.cpp: measure",
    "extremes_cost.cpp: add_error_over_time",
    "extremes_cost.cpp: studies",
    "factors.cpp: look_at",
    "factors.cpp: tell",
    "force_precision.cpp: add_force_precision",
    "force_channel.cpp: see_probed",
    "gravity_catalogue.cpp: add_catalogue",
    "gravity_race.cpp: add_race",
    "gravity_twin.cpp: add_equations",
    "gravity_twin.cpp: add_swing",
    "ideal.cpp: solved",
    "impact.cpp: add_law",
    "impact.cpp: add_speeds",
    "impact.cpp: add_sweep",
    "indent_accuracy.cpp: add_trade_off",
    "indent_plots.cpp: add_loops",
    "indent_press_time.cpp: add_sweep",
    "indentation.cpp: add_single_figures",
    "indentation.cpp: run",
    "ledger.cpp: run",
    "machine_calibration.cpp: CarriedTool::stand",
    "machine_calibration.cpp: calibrate_machine",
    "machine_channel.cpp: see_machine",
    "machine_fit.cpp: fit_hand_eye",
    "mesh.cpp: run",
    "moving_things.cpp: hit_balls",
    "places.cpp: leaves",
    "reaching.cpp: random_part",
    "reaching.cpp: speed_part",
    "reaching_ideal.cpp: add_ideal",
    "reaching_rest.cpp: add_rest",
    "registration.cpp: run",
    "registration.cpp: table_of_doubts",
    "registration_images.cpp: table_of_doubts",
    "session.cpp: add_training",
    "shadow.cpp: meaning_of",
    "soak.cpp: hours",
    "soak.cpp: storm",
    "speed.cpp: beside_parts",
    "stability_button.cpp: add_button_map",
    "stability_cost.cpp: add_error_over_time",
    "stability_passivity.cpp: add_passivity",
    "stability_spare.cpp: add_spare",
    "stability_width.cpp: add_widths",
    "stiffness.cpp: add_boundary",
    "stiffness.cpp: add_error_plots",
    "stiffness.cpp: run",
    "stiffness_switches.cpp: add_knee",
    "structure.cpp: work_and_precision",
    "switching.cpp: chatter",
    "switching.cpp: timing",
    "tool_channel.cpp: see_carried",
    "tool_channel.cpp: see_pressing",
    "tracking.cpp: run",
    "whole_stack.cpp: tell_wall",
    "work_precision.cpp: add_work_precision",
    "workspace.cpp: add_slices",
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

// "Arm::mass(int q)" of "PerJoint Arm::mass(int q) const".
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

// Whether a brace behind `head` is that of a member, in a list such as "Run(int a) : a_".
bool initialises_member(const std::string& head) {
  const std::size_t open = head.find('(');
  if (open == std::string::npos || (!in_word(head.back()) && head.back() != '>')) return false;
  std::string rest = head.substr(behind_parenthesis(head, open));
  for (std::size_t at = 0; (at = rest.find("::", at)) != std::string::npos;) rest.erase(at, 2);
  return rest.find(':') != std::string::npos;
}

struct Function {
  std::string name;
  std::size_t line, lines;  // of its opening brace, and up to the closing one
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
  struct Open {
    Scope scope;
    std::size_t line;
    std::string head, text;  // squeezed, and as it stands
    int parentheses;
  };

  void open() {
    const std::string head = squeezed(head_);
    const auto is = [&](Scope scope) {
      return std::any_of(open_.begin(), open_.end(), [&](const Open& one) { return one.scope == scope; });
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
      parentheses_ = -1;  // there is no beginning of this
      return;
    }
    const Open last = open_.back();
    open_.pop_back();
    parentheses_ = last.parentheses;
    if (last.scope == Scope::function) all.push_back({name_of(last.head), last.line, line_ - last.line + 1});
    head_ = last.scope == Scope::member ? last.text + "{}" : "";
  }

  std::vector<Open> open_;
  std::string head_;  // since the last end of a statement or block
  std::size_t line_ = 1;
  int parentheses_ = 0;  // open, in this block
};

Reader read(std::string_view text) {
  Reader reader;
  for (const char c : shape::bare(text)) reader.see(c);
  return reader;
}

// Those of product code that are too long, "FILE: NAME", each with its place.
struct Found {
  std::string file, name, place;
  std::size_t lines;
};
struct Product {
  std::vector<Found> longer;
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
      std::ifstream in(path);
      const Reader reader = read(std::string(std::istreambuf_iterator<char>(in), {}));
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

bool is(const Found& found, std::string_view listed) {
  const std::string name = found.file + ": " + found.name;
  return name == listed || name.substr(0, name.find('(')) == listed;
}
std::string_view listed(const Longer& one) { return one.function; }
std::string_view listed(std::string_view one) { return one; }
template <class List>
bool lists(const List& list, const Found& found) {
  return std::any_of(list.begin(), list.end(), [&](const auto& one) { return is(found, listed(one)); });
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
  for (const Found& one : product().longer)
    EXPECT_TRUE(lists(kExceptions, one) || lists(kToShorten, one))
        << one.place << ": " << one.name << " has " << one.lines << " lines; at most " << kMostLines;
}

TEST(Functions, ExceptionsAreFewAndStillNeeded) {
  EXPECT_LE(kExceptions.size(), 20U);
  const auto is_longer = [](std::string_view name) {
    return std::any_of(product().longer.begin(), product().longer.end(),
                       [&](const Found& one) { return is(one, name); });
  };
  for (const Longer& one : kExceptions)
    EXPECT_TRUE(is_longer(one.function) && !one.why.empty()) << one.function << ": take it off the list";
  for (const std::string_view one : kToShorten)
    EXPECT_TRUE(is_longer(one)) << one << ": take it off the list";
}

}  // namespace
}  // namespace enc::functions
