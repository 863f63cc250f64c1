// `encounter questionnaire FORM`: asks a person what the paper asked, keeps the answers, says what they are
// together. Nothing of it is simulated [VHMR 4.4, Fig 14].
#include <algorithm>
#include <cctype>
#include <chrono>
#include <cmath>
#include <ctime>
#include <filesystem>
#include <iostream>
#include <map>

#include <fmt/format.h>
#include <nlohmann/json.hpp>
#include <unistd.h>

#include "benchmarks/commands/commands.h"
#include "benchmarks/questionnaire/opinion.h"
#include "benchmarks/report/plot.h"
#include "benchmarks/verdict/contradictions.h"
#include "core/base/error.h"
#include "models/files.h"
#include "models/schema/wording.h"
#include "models/setup/scene_file.h"
#include "models/tables/csv_reader.h"

namespace enc::bench {
namespace {

namespace fs = std::filesystem;
using questionnaire::Answer;
using questionnaire::Answers;
using Json = nlohmann::ordered_json;

std::string today() {
  const std::time_t now = std::chrono::system_clock::to_time_t(std::chrono::system_clock::now());
  std::tm parts{};
  localtime_r(&now, &parts);
  return fmt::format("{:04}-{:02}-{:02}", parts.tm_year + 1900, parts.tm_mon + 1, parts.tm_mday);
}

Answers read_answers(const std::string& path, const questionnaire::Form& form) {
  return questionnaire::parse_answers(
      models::csv_text(path, "table of answers", "a CSV file with one row for each participant"), path, form);
}

void check_participant(const std::string& code) {
  const auto plain = [](char c) {
    return std::isalnum(static_cast<unsigned char>(c)) != 0 || c == '_' || c == '-';
  };
  if (!std::all_of(code.begin(), code.end(), plain))
    throw Error(
        fmt::format("--participant: {} has other characters than letters, digits, _ and -; expected a number "
                    "or a code, no name",
                    models::quoted(code)));
}

// What write_pictures() will write, so that it is refused before anything is asked or stored.
void check_pictures(const trial::QuestionnaireOptions& o, const questionnaire::Form& form,
                    const std::vector<questionnaire::ItemReference>& items) {
  if (o.out.empty()) return;
  const models::OutFolder alone(o.out);
  const std::string plot = questionnaire::opinion_plot(form, items, {}).id;
  for (const std::string& name :
       {questionnaire::opinion_table(form, items, {}).id + ".csv",
        questionnaire::experience_table(form, {}).id + ".csv", plot + ".plot.csv", plot + ".svg"}) {
    const fs::path path = fs::path(o.out) / name;
    if (fs::weakly_canonical(path) == fs::weakly_canonical(o.store))
      throw Error(o.store + ": is a table of --out, too; expected another file for the answers; choose one");
    const models::OutFile writable(path.string(), models::existing(o.force));
  }
}

// What can be refused is refused before somebody has answered fourteen questions.
Answers collect(const trial::QuestionnaireOptions& o, const questionnaire::Form& form,
                const std::vector<questionnaire::ItemReference>& items) {
  if (!o.answers.empty()) {
    Answers given = read_answers(o.answers, form);
    check_pictures(o, form, items);
    return o.store.empty() ? given : questionnaire::append_answers(o.store, form, std::move(given.rows));
  }
  if (o.store.empty())
    throw Error(
        "nothing to ask for: expected --store FILE.csv (asks, and keeps the answers there) or --answers "
        "FILE.csv (reads them)");
  Answer draft;
  draft.participant = o.participant;
  if (o.date) draft.date = today();
  questionnaire::check_store(o.store, form, draft);
  check_pictures(o, form, items);
  Answer answer =
      questionnaire::ask(form, std::cin, o.json ? std::cerr : std::cout, isatty(STDIN_FILENO) != 0);
  answer.participant = draft.participant;
  answer.date = draft.date;
  return questionnaire::append_answers(o.store, form, {std::move(answer)});
}

std::string table_text(const Table& table) {
  std::vector<std::size_t> width;
  for (const std::string& column : table.columns) width.push_back(column.size());
  for (const auto& row : table.rows)
    for (std::size_t c = 0; c < row.size(); ++c) width[c] = std::max(width[c], row[c].size());
  std::string text;
  const auto line = [&](const std::vector<std::string>& row) {
    std::string out;
    for (std::size_t c = 0; c < row.size(); ++c)
      out += table.columns[c] == "asked" ? fmt::format("{:<{}}  ", row[c], width[c])
                                         : fmt::format("{:>{}}  ", row[c], width[c]);
    out.erase(out.find_last_not_of(' ') + 1);
    text += out + "\n";
  };
  line(table.columns);
  for (const auto& row : table.rows) line(row);
  return text;
}

// "0.842 mm, felt" of each figure of a bench run that has a verdict.
std::map<std::string, std::string> verdicts_of(const std::string& path) {
  std::map<std::string, std::string> found;
  if (path.empty()) return found;
  const Json json = Json::parse(models::csv_text(path, "results", "results.json of `encounter bench --out`"),
                                nullptr, false);
  if (!json.is_object() || !json.contains("verdicts") || !json["verdicts"].is_array())
    throw Error(path +
                ":1:1: there is no list 'verdicts'; expected results.json of `encounter bench --out`; run "
                "that");
  for (const Json& v : json["verdicts"])
    if (v.is_object() && v.contains("error") && v["error"].is_number())
      found[v.value("figure", "")] =
          fmt::format("{:.3g} {}, {}", v["error"].get<double>(), v.value("unit", ""), v.value("verdict", ""));
  return found;
}

std::string proxies_text(const std::vector<questionnaire::ItemReference>& items,
                         const std::map<std::string, std::string>& verdicts) {
  std::string text;
  for (const questionnaire::ItemReference& item : items)
    for (const std::string& id : item.figures) {
      const auto verdict = verdicts.find(id);
      text += fmt::format("  item {:3} {:24} {}\n", item.name, id,
                          verdict == verdicts.end() ? "" : verdict->second);
      text.erase(text.find_last_not_of(" \n") + 1);
      text += '\n';
    }
  return text.empty() ? "" : "measured    by `encounter bench`: beside the items, no answers\n" + text;
}

// Where the study's own numbers do not agree about an item of this form.
std::vector<Contradiction> doubts(const questionnaire::Form& form, const std::string& models) {
  std::vector<Contradiction> list;
  if (form.reference.empty()) return list;
  const std::string study = fs::path(form.reference).stem().string();
  for (const Contradiction& c : contradictions(models))
    if (c.id.starts_with(study + ".")) list.push_back(c);
  return list;
}

Json number(double x) { return std::isfinite(x) ? Json(x) : Json(nullptr); }

std::string json_text(const questionnaire::Form& form, const std::vector<questionnaire::ItemReference>& items,
                      const std::vector<Answer>& rows, const std::vector<Contradiction>& found) {
  Json json;
  json["form"] = form.name;
  json["title"] = form.title;
  json["source"] = form.source;
  json["simulated"] = false;
  json["participants"] = rows.size();
  json["mean"] = number(questionnaire::global_mean(rows));
  json["items"] = Json::array();
  for (std::size_t i = 0; i < items.size(); ++i) {
    const questionnaire::Opinion o = questionnaire::opinion_of(form, rows, i);
    json["items"].push_back({{"item", items[i].name},
                             {"group", form.items[i].group},
                             {"text", items[i].text},
                             {"mean", number(o.mean)},
                             {"least", o.least == 0 ? Json(nullptr) : Json(o.least)},
                             {"most", o.most == 0 ? Json(nullptr) : Json(o.most)},
                             {"counts", o.counts},
                             {"paper_mean", number(items[i].paper)},
                             {"figures", items[i].figures}});
  }
  json["experience"] = Json::array();
  for (std::size_t e = 0; e < form.experience.size(); ++e)
    json["experience"].push_back({{"name", form.experience[e].name},
                                  {"yes", questionnaire::with_experience(rows, e, true).size()},
                                  {"no", questionnaire::with_experience(rows, e, false).size()}});
  json["contradictions"] = Json::array();
  for (const Contradiction& c : found)
    json["contradictions"].push_back(
        {{"id", c.id}, {"where", c.where}, {"printed", c.printed}, {"found", c.found}});
  return json.dump(2);
}

void write_pictures(const std::string& folder, const questionnaire::Form& form,
                    const std::vector<questionnaire::ItemReference>& items, const std::vector<Answer>& rows,
                    bool force) {
  const models::OutFolder alone(folder);
  const fs::path at = folder;
  const auto write = [&](const fs::path& path, const std::string& text) {
    models::write_file(path.string(), text, models::existing(force));
  };
  const Plot plot = questionnaire::opinion_plot(form, items, rows);
  for (const Table& t :
       {questionnaire::opinion_table(form, items, rows), questionnaire::experience_table(form, rows)})
    write(at / (t.id + ".csv"), table_csv(t));
  write(at / (plot.id + ".plot.csv"), plot_csv(plot));
  const Drawing drawing = draw(plot);
  if (drawing.svg.empty())
    fmt::print(stderr, "encounter: not drawn: {}; the tables are complete\n", drawing.why_not);
  else
    write(at / (plot.id + ".svg"), drawing.svg);
}

}  // namespace

int questionnaire_command(const trial::QuestionnaireOptions& options) {
  check_participant(options.participant);
  const std::string models = models::models_dir();
  const questionnaire::Form form = questionnaire::load_form(models, options.form);
  const std::vector<questionnaire::ItemReference> items = questionnaire::items_of(form, models);
  const std::map<std::string, std::string> verdicts = verdicts_of(options.results);
  const Answers answers = collect(options, form, items);
  const std::vector<Contradiction> found = doubts(form, models);
  if (!options.out.empty()) write_pictures(options.out, form, items, answers.rows, options.force);
  if (options.json) {
    fmt::print("{}\n", json_text(form, items, answers.rows, found));
    return 0;
  }
  const Table table = questionnaire::opinion_table(form, items, answers.rows);
  fmt::print("{} {}\n{}mean of all {:.1f}\n\n{}\n{}", table.title, form.source, table_text(table),
             questionnaire::global_mean(answers.rows),
             table_text(questionnaire::experience_table(form, answers.rows)), proxies_text(items, verdicts));
  for (const Contradiction& c : found) fmt::print("note        {}: {}; {}\n", c.where, c.printed, c.found);
  return 0;
}

}  // namespace enc::bench
