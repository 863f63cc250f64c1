#include "models/schema/toml_reader.h"

#include <algorithm>
#include <cmath>

#include <fmt/format.h>
#include <toml++/toml.h>

#include "core/base/error.h"
#include "core/base/words.h"
#include "models/schema/units.h"
#include "models/schema/wording.h"

namespace enc::models {
namespace {

std::string place_in(const std::string& name, const toml::source_region& source) {
  return fmt::format("{}:{}:{}", name, std::max(source.begin.line, 1U), std::max(source.begin.column, 1U));
}

std::string kind_of(const toml::node& node) {
  switch (node.type()) {
    case toml::node_type::table:
      return "a table";
    case toml::node_type::array:
      return "an array";
    case toml::node_type::string:
      return "a text";
    case toml::node_type::integer:
      return "a whole number";
    case toml::node_type::floating_point:
      return "a number with a fraction";
    case toml::node_type::boolean:
      return "true or false";
    default:
      return "a date or time";
  }
}

// One value as TOML writes it, in every locale.
std::string text_of_node(const toml::node& node) {
  if (const auto* text = node.as_string()) return quoted_toml(text->get());
  if (const auto* whole = node.as_integer()) return fmt::format("{}", whole->get());
  if (const auto* is = node.as_boolean()) return is->get() ? "true" : "false";
  if (const auto* number = node.as_floating_point()) {
    const std::string text = fmt::format("{}", number->get());
    return text.find_first_not_of("-0123456789") == std::string::npos ? text + ".0" : text;
  }
  if (const auto* array = node.as_array()) {
    std::string text;
    for (const toml::node& item : *array) text += (text.empty() ? "" : ", ") + text_of_node(item);
    return "[" + text + "]";
  }
  return quoted_toml(kind_of(node));  // another kind of value; no key accepts it in a list
}

// Reads one node into one target. `place`: position for messages.
class Value {
 public:
  Value(const toml::node& node, const Key& key, std::string place)
      : node_(node), key_(key), unit_(unit_of(key.name)), place_(std::move(place)) {}

  void of(const Target& target) {
    wanted_ = expected(key_, target);
    example_ = example_of(key_, target);
    std::visit([this](const auto& to) { read(to); }, target);
  }

 private:
  void read(double* to) const { *to = number(node_, "", 1); }
  void read(std::int64_t* to) const {
    const auto* whole = node_.as_integer();
    if (whole == nullptr) wrong_type(node_, "");
    check_range(static_cast<double>(whole->get()), fmt::format("{}", whole->get()), "");
    *to = whole->get();
  }
  void read(std::string* to) const {
    *to = text();
    // Otherwise a title could print false lines of a report.
    if (const std::string shown = printable(*to); shown != *to)
      fail(fmt::format("is {}, which cannot be printed as it is", models::quoted(*to)),
           "printable text on one line");
    if (to->empty() && key_.presence == Presence::needed) fail("is empty", wanted_);
    if (!key_.words.empty()) static_cast<void>(word(*to, key_.words));
  }
  void read(const Choice& to) const { *to.index = word(text(), to.words); }
  void read(Vec3* to) const { *to = triple(node_, ""); }
  void read(std::vector<double>* to) const {
    const toml::array& array = list(node_, "", 0);
    if (array.empty()) fail("is empty", wanted_);
    to->clear();
    for (const toml::node& item : array) to->push_back(number(item, element(to->size()), 1));
  }
  void read(std::vector<Vec3>* to) const {
    to->clear();
    for (const toml::node& item : list(node_, "", 0)) to->push_back(triple(item, element(to->size())));
  }
  void read(std::span<double> to) const {
    const toml::array& array = list(node_, "", to.size());
    for (std::size_t i = 0; i < to.size(); ++i)
      to[i] = number(*array.get(i), element(i), static_cast<int>(i) + 1);
  }

  static std::string element(std::size_t i) { return fmt::format("[{}]", i); }

  // `part` is "" for the whole value, "[2]" for an element.
  [[noreturn]] void fail(const std::string& what, const std::string& wanted,
                         const std::string& part = "") const {
    throw Error(fmt::format("{}: '{}{}' {}; expected {}; write it like '{} = {}'", place_, key_.name, part,
                            what, wanted, key_.name, example_));
  }
  [[noreturn]] void wrong_type(const toml::node& node, const std::string& part) const {
    fail("is " + kind_of(node), wanted(part), part);
  }
  [[nodiscard]] std::string wanted(const std::string& part) const {
    return part.empty() ? wanted_ : fmt::format("{} in every place", wanted_number(key_));
  }
  [[nodiscard]] std::string example() const { return fmt::format("{} = {}", key_.name, example_); }

  [[nodiscard]] const std::string& text() const {
    if (!node_.is_string()) wrong_type(node_, "");
    return node_.as_string()->get();
  }
  void check_range(double value, const std::string& text, const std::string& part) const {
    const Range& r = key_.range;
    if (value <= r.high && (r.above_low ? value > r.low : value >= r.low)) return;
    fail("is " + text, wanted(part), part);
  }
  [[nodiscard]] double number(const toml::node& node, const std::string& part, int k) const {
    if (!node.is_number() || (key_.range.whole && !node.is_integer())) wrong_type(node, part);
    const double value =
        node.is_integer() ? static_cast<double>(node.as_integer()->get()) : node.as_floating_point()->get();
    const double si = to_si(unit_, value, k);
    if (!std::isfinite(si)) fail(fmt::format("is {}", value), "a finite number", part);
    if (si == 0.0 && value != 0.0)  // a positive value would become 0
      fail(fmt::format("is {}", value), "0, or a number of 1e-300 or more", part);
    check_range(value, fmt::format("{}", value), part);
    return si;
  }
  [[nodiscard]] const toml::array& list(const toml::node& node, const std::string& part,
                                        std::size_t size) const {
    const toml::array* array = node.as_array();
    if (array == nullptr) wrong_type(node, part);
    if (size != 0 && array->size() != size) {
      fail("has " + counted(array->size(), "element"), part.empty() ? wanted_ : "3 numbers in every place",
           part);
    }
    return *array;
  }
  [[nodiscard]] Vec3 triple(const toml::node& node, const std::string& part) const {
    const toml::array& array = list(node, part, 3);
    Vec3 v;
    for (std::size_t i = 0; i < 3; ++i)
      v[static_cast<Eigen::Index>(i)] = number(*array.get(i), part + element(i), 1);
    return v;
  }
  [[nodiscard]] std::uint8_t word(const std::string& text, Words words) const {
    const auto found = std::find(words.begin(), words.end(), text);
    if (found != words.end()) return static_cast<std::uint8_t>(found - words.begin());
    const std::vector<std::string> names(words.begin(), words.end());
    throw Error(fmt::format("{}: '{}' is {}; expected {}; {}", place_, key_.name, quoted(text), wanted_,
                            advice(text, names)));
  }

  const toml::node& node_;
  const Key& key_;
  const Unit& unit_;
  std::string place_, wanted_, example_;
};

class Reader final : public Visitor {
 public:
  Reader(const toml::table& root, std::string name) : name_(std::move(name)) { push(root, "", "the file"); }

  void value(const Key& key, const Target& target) override {
    const toml::node* node = find(key.name);
    Level& level = levels_.back();
    if (node == nullptr) {
      if (key.presence == Presence::needed) {
        level.missing.push_back(missing_text(level.title, key, target));
      }
      return;
    }
    places_[path_of(key.name)] = place(*level.table, key.name);
    Value(*node, key, place_in(name_, node->source())).of(target);
  }

  bool open(std::string_view table, bool) override {
    const toml::node* node = find(table);
    if (node == nullptr) return false;
    if (!node->is_table()) {
      throw Error(fmt::format("{}: '{}' is {}; expected a table; write '[{}]' on a line of its own",
                              place(*levels_.back().table, table), table, kind_of(*node), path_of(table)));
    }
    places_[path_of(table)] = place_in(name_, node->source());
    push(*node->as_table(), path_of(table), fmt::format("[{}]", path_of(table)));
    return true;
  }

  std::size_t open_list(std::string_view list, std::size_t) override {
    const toml::node* node = find(list);
    if (node == nullptr) return 0;
    const toml::array* array = node->as_array();
    if (array == nullptr ||
        !std::all_of(array->begin(), array->end(), [](const auto& item) { return item.is_table(); })) {
      throw Error(
          fmt::format("{}: '{}' is {}; expected a list of tables; write '[[{}]]' on a line of its own",
                      place(*levels_.back().table, list), list, kind_of(*node), list));
    }
    return array->size();
  }

  void open_entry(std::string_view list, std::size_t index, std::string_view) override {
    const toml::table& table = *levels_.back().table->get(list)->as_array()->get(index)->as_table();
    const std::string name = table["name"].value_or(fmt::format("{}", index));
    std::string path = fmt::format("{}.{}", path_of(list), name);
    if (places_.contains(path)) {
      throw Error(fmt::format(
          "{}: there are two [[{}]] named {} (the other is at {}); expected different names; rename one",
          place_in(name_, table.source()), list, quoted(name), places_[path]));
    }
    places_[path] = place_in(name_, table.source());
    push(table, std::move(path), fmt::format("[[{}]] {}", list, quoted(name)));
  }

  // Unknown keys are reported before missing ones: a misspelt key is usually both.
  void close() override {
    const Level& level = levels_.back();
    for (const auto& [key, node] : *level.table) {
      if (std::find(level.known.begin(), level.known.end(), key.str()) == level.known.end())
        unknown(level, key);
    }
    if (!level.missing.empty()) {
      throw Error(fmt::format("{}: {}", place_in(name_, level.table->source()), level.missing.front()));
    }
    levels_.pop_back();
  }
  void drivers(std::string_view name, std::vector<DriverTable>& tables) override {
    tables.clear();
    if (!open(name, false)) return;
    for (const auto& [driver, ignored] : *levels_.back().table) {
      open(bare(driver), false);
      DriverTable table{std::string(driver.str()), {}};
      for (const auto& [key, node] : *levels_.back().table) {
        places_[path_of(bare(key))] = place_in(name_, key.source());
        levels_.back().known.emplace_back(key.str());
        if (node.is_table() || node.is_date() || node.is_time() || node.is_date_time())
          throw Error(fmt::format("{}: {} is {}; expected a number, a text, true or false, or a list of them",
                                  place_in(name_, key.source()), quoted(std::string(key.str())),
                                  kind_of(node)));
        if (const auto* text = node.as_string(); text != nullptr && printable(text->get()) != text->get())
          throw Error(fmt::format(
              "{}: {} is {}, which cannot be printed as it is; expected printable text on one line",
              place_in(name_, key.source()), quoted(std::string(key.str())), models::quoted(text->get())));
        table.values.push_back({std::string(key.str()), text_of_node(node), {}, {}});
      }
      close();
      tables.push_back(std::move(table));
    }
    close();
  }
  Places finish() {
    close();
    return std::move(places_);
  }

 private:
  struct Level {
    const toml::table* table;
    std::string path, title;
    std::vector<std::string> known, missing;
  };

  // A name that needs no quotes.
  [[nodiscard]] std::string_view bare(const toml::key& key) const {
    const auto plain = [](char c) {
      return (c >= 'a' && c <= 'z') || (c >= 'A' && c <= 'Z') || (c >= '0' && c <= '9') || c == '_' ||
             c == '-';
    };
    if (!key.str().empty() && std::all_of(key.str().begin(), key.str().end(), plain)) return key.str();
    throw Error(fmt::format("{}: {} is no name; expected letters, digits, '_' and '-'; choose another",
                            place_in(name_, key.source()), quoted(std::string(key.str()))));
  }
  // Finds a key and marks it as known; nullptr if it does not exist.
  const toml::node* find(std::string_view name) {
    levels_.back().known.emplace_back(name);
    return levels_.back().table->get(name);
  }
  void push(const toml::table& table, std::string path, std::string title) {
    levels_.push_back({&table, std::move(path), std::move(title), {}, {}});
  }
  [[nodiscard]] std::string path_of(std::string_view key) const {
    return levels_.back().path.empty() ? std::string(key) : fmt::format("{}.{}", levels_.back().path, key);
  }
  [[nodiscard]] std::string place(const toml::table& table, std::string_view key) const {
    return place_in(name_, table.find(key)->first.source());
  }
  [[noreturn]] void unknown(const Level& level, const toml::key& key) const {
    throw Error(fmt::format("{}: {}", place_in(name_, key.source()),
                            unknown_text(level.title, key.str(), level.known)));
  }

  std::string name_;
  std::vector<Level> levels_;
  Places places_;
};

toml::table parse(const std::string& text, const std::string& name) {
  try {
    return toml::parse(text, name);
  } catch (const toml::parse_error& e) {
    throw Error(fmt::format("{}: this is not TOML: {}; expected 'key = value' or '[table]'; correct the line",
                            place_in(name, e.source()), printable(std::string(e.description()))));
  }
}

}  // namespace

Places read_toml(const std::string& text, const std::string& name,
                 const std::function<void(Visitor&)>& walk) {
  const toml::table root = parse(text, name);
  Reader reader(root, name);
  walk(reader);
  return reader.finish();
}

std::string as_value(const std::string& text) {
  try {
    const toml::table table = toml::parse("value = " + text);
    if (table.size() == 1 && table.contains("value")) return text_of_node(*table.get("value"));
  } catch (const toml::parse_error&) {  // words
  }
  return quoted_toml(text);
}

void read_value(const std::string& text, const std::string& place, const Key& key, const Target& target,
                Quotes quotes) {
  auto* const* number = std::get_if<double*>(&target);
  if (number != nullptr && text == "unset" && key.presence == Presence::optional) {
    **number = kUnset;
    return;
  }
  auto* const* numbers = std::get_if<std::vector<double>*>(&target);
  if (numbers != nullptr && text == "unset" && key.presence == Presence::optional) return (*numbers)->clear();
  const bool is_text = std::holds_alternative<std::string*>(target) || std::holds_alternative<Choice>(target);
  const bool bare = quotes == Quotes::may && is_text && !text.starts_with('"') && !text.starts_with('\'');
  toml::table table;
  try {
    table = toml::parse("value = " + (bare ? quoted_toml(text) : text));
  } catch (const toml::parse_error&) {  // stays empty
  }
  const toml::node* node = table.size() == 1 ? table.get("value") : nullptr;
  if (node == nullptr) {
    throw Error(fmt::format("{}: {} is no value; expected {}; write it like '{}'", place, quoted(text),
                            expected(key, target), example_of(key, target)));
  }
  Value(*node, key, place).of(target);
}

}  // namespace enc::models
