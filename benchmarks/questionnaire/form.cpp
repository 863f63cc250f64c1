#include "benchmarks/questionnaire/form.h"

#include <algorithm>
#include <cctype>
#include <filesystem>

#include <fmt/format.h>

#include "core/base/error.h"
#include "models/schema/toml_reader.h"
#include "models/schema/wording.h"
#include "models/setup/scene_file.h"
#include "models/tables/csv_reader.h"

namespace enc::bench::questionnaire {
namespace {

namespace fs = std::filesystem;
using models::Key;
using models::Presence;
using models::Visitor;

Key key(std::string_view name, std::string_view meaning, Presence presence = Presence::needed) {
  return {name, meaning, "form", models::Confidence::chosen, models::kAny, presence, {}, true};
}

template <class T, class Walk>
void list(Visitor& v, std::string_view name, std::vector<T>& entries, Walk walk) {
  entries.resize(v.open_list(name, entries.size()));
  for (std::size_t i = 0; i < entries.size(); ++i) {
    v.open_entry(name, i, entries[i].name);
    v.value(key("name", "what tables and columns call it"), &entries[i].name);
    v.value(key("text", "as people read it"), &entries[i].text);
    walk(entries[i]);
    v.close();
  }
}

void describe(Visitor& v, Form& f) {
  const auto no_more = [](Wording&) {};
  Key format = key("format", "version of the form's format; this program reads version 1");
  format.range = {1.0, 1.0};
  v.value(format, &f.format);
  v.value(key("title", "what is asked about"), &f.title);
  v.value(key("source", "where the wording comes from"), &f.source);
  v.value(key("reference", "file in benchmarks/reference with published means", Presence::defaulted),
          &f.reference);
  list(v, "step", f.steps, no_more);
  list(v, "experience", f.experience, no_more);
  list(v, "group", f.groups, no_more);
  list(v, "item", f.items, [&](Item& item) {
    v.value(key("group", "an entry of [[group]]"), &item.group);
    v.value(key("figures", "ids of figures that measure what it asks about", Presence::defaulted),
            &item.figures);
  });
}

void check(const Form& f, const std::string& path, const models::Places& places) {
  const auto fail = [&](const std::string& at, const std::string& what) {
    const auto place = places.find(at);
    throw Error(fmt::format("{}: {}", place == places.end() ? path + ":1:1" : place->second, what));
  };
  if (f.steps.size() < 2) fail("step", "fewer than two steps; expected a scale; add [[step]]");
  for (std::size_t i = 0; i < f.steps.size(); ++i)
    if (f.steps[i].name != std::to_string(i + 1))
      fail(fmt::format("step.{}.name", f.steps[i].name),
           fmt::format("step {} in place {}; expected 1, 2, 3, ... in order; name it \"{}\"",
                       models::quoted(f.steps[i].name), i + 1, i + 1));
  // Names become columns of a table.
  const auto plain = [&](const char* list, const std::string& name) {
    if (std::all_of(name.begin(), name.end(),
                    [](char c) { return std::isalnum(static_cast<unsigned char>(c)) != 0 || c == '_'; }))
      return;
    fail(fmt::format("{}.{}.name", list, name),
         fmt::format("the name {} has other characters than letters, digits and _; expected a column's name; "
                     "rename it",
                     models::quoted(name)));
  };
  for (const Item& item : f.items) plain("item", item.name);
  for (const Wording& e : f.experience) plain("experience", e.name);
  if (f.items.empty()) fail("item", "no items; expected questions; add [[item]]");
  std::vector<std::string> groups;
  groups.reserve(f.groups.size());
  for (const Wording& g : f.groups) groups.push_back(g.name);
  for (const Item& item : f.items)
    if (std::find(groups.begin(), groups.end(), item.group) == groups.end())
      fail(fmt::format("item.{}.group", item.name),
           fmt::format("there is no group {}; expected an entry of [[group]]; {}", models::quoted(item.group),
                       models::advice(item.group, groups)));
}

}  // namespace

Form parse_form(const std::string& text, const std::string& path) {
  Form form;
  const models::Places places = models::read_toml(text, path, [&](Visitor& v) { describe(v, form); });
  check(form, path, places);
  form.name = fs::path(path).stem().string();
  return form;
}

Form load_form(const std::string& models, const std::string& name) {
  if (name.ends_with(".toml"))
    return parse_form(models::csv_text(name, "form", "a TOML file as in models/questionnaires"), name);
  const std::vector<std::string> names = models::files_in(models, "questionnaires");
  if (std::find(names.begin(), names.end(), name) == names.end())
    throw Error(fmt::format("there is no questionnaire {}; expected a file in models/questionnaires; {}",
                            models::quoted(name), models::advice(name, names)));
  const std::string path =
      (fs::path(models) / "questionnaires" / (name + ".toml")).lexically_normal().string();
  return parse_form(models::csv_text(path, "form", "a TOML file"), path);
}

}  // namespace enc::bench::questionnaire
