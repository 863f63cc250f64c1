#include "models/schema/toml_writer.h"

#include <cmath>

#include <fmt/format.h>

#include "models/schema/toml_reader.h"
#include "models/schema/units.h"
#include "models/schema/wording.h"

namespace enc::models {
namespace {

struct Text {
  const Unit& unit;

  std::string operator()(const double* v) const { return std::isnan(*v) ? "" : text_of(unit, *v); }
  std::string operator()(const std::int64_t* v) const { return fmt::format("{}", *v); }
  std::string operator()(const std::string* v) const { return quoted_toml(*v); }
  std::string operator()(const Choice& v) const { return quoted_toml(std::string(v.words[*v.index])); }
  std::string operator()(const Vec3* v) const {
    return fmt::format("[{}, {}, {}]", text_of(unit, v->x()), text_of(unit, v->y()), text_of(unit, v->z()));
  }
  std::string operator()(const std::vector<double>* v) const {
    return list(v->size(), [&](std::size_t i) { return text_of(unit, (*v)[i]); });
  }
  std::string operator()(const std::vector<Vec3>* v) const {
    return list(v->size(), [&](std::size_t i) { return (*this)(&(*v)[i]); });
  }
  std::string operator()(std::span<double> v) const {
    return list(v.size(), [&](std::size_t i) { return text_of(unit, v[i], static_cast<int>(i) + 1); });
  }
  template <class Item>
  static std::string list(std::size_t size, Item item) {
    std::string text = "[";
    for (std::size_t i = 0; i < size; ++i) text += (i == 0 ? "" : ", ") + item(i);
    return text + "]";
  }
};

class Writer final : public Visitor {
 public:
  void value(const Key& key, const Target& target) override {
    const std::string value = value_text(key, target);
    if (!value.empty()) text_ += fmt::format("{} = {}\n", key.name, value);
  }
  bool open(std::string_view table, bool present) override {
    if (!present) return false;
    push(table);
    text_ += fmt::format("\n[{}]\n", paths_.back());
    return true;
  }
  std::size_t open_list(std::string_view, std::size_t size) override { return size; }
  void open_entry(std::string_view list, std::size_t, std::string_view) override {
    push(list);
    text_ += fmt::format("\n[[{}]]\n", paths_.back());
  }
  void close() override { paths_.pop_back(); }
  void drivers(std::string_view name, std::vector<DriverTable>& tables) override {
    for (const DriverTable& table : tables) {
      push(fmt::format("{}.{}", name, table.name));
      text_ += fmt::format("\n[{}]\n", paths_.back());
      for (const DriverValue& value : table.values)
        if (!value.text.empty()) text_ += fmt::format("{} = {}\n", value.key, as_value(value.text));
      close();
    }
  }
  [[nodiscard]] std::string text() && { return std::move(text_); }

 private:
  void push(std::string_view name) {
    paths_.push_back(paths_.empty() ? std::string(name) : fmt::format("{}.{}", paths_.back(), name));
  }
  std::string text_;
  std::vector<std::string> paths_;
};

}  // namespace

std::string write_toml(const std::function<void(Visitor&)>& walk) {
  Writer writer;
  walk(writer);
  return std::move(writer).text();
}

std::string value_text(const Key& key, const Target& target) {
  const auto* const* numbers = std::get_if<std::vector<double>*>(&target);
  if (numbers != nullptr && (*numbers)->empty() && key.presence == Presence::optional) return {};  // unset
  return std::visit(Text{unit_of(key.name)}, target);
}

std::string response_text(const ResponseSpec& response, const std::string& source) {
  ResponseFile file{1, source, response};
  return "# F = a_1 d + a_2 d^2 + a_3 d^3 + a_4 d^4: ascending powers of the deflection d, in N/mm, N/mm^2, "
         "N/mm^3, N/mm^4.\n" +
         write_toml([&](Visitor& v) { describe(v, file); });
}

}  // namespace enc::models
