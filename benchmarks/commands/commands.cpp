#include "benchmarks/commands/commands.h"

#include <algorithm>
#include <atomic>
#include <cctype>
#include <chrono>
#include <cmath>
#include <csignal>
#include <cstdio>
#include <ctime>
#include <filesystem>
#include <fstream>
#include <future>
#include <iostream>
#include <map>
#include <optional>

#include <fmt/format.h>
#include <fmt/ranges.h>
#include <nlohmann/json.hpp>
#include <unistd.h>

#include "benchmarks/commands/committed_results.h"
#include "benchmarks/commands/others.h"
#include "benchmarks/kit/entry.h"
#include "benchmarks/questionnaire/opinion.h"
#include "benchmarks/report/choice.h"
#include "benchmarks/report/plot.h"
#include "benchmarks/report/report.h"
#include "benchmarks/verdict/verdict.h"
#include "core/base/error.h"
#include "models/files.h"
#include "models/schema/wording.h"
#include "models/setup/scene_file.h"
#include "models/tables/csv_reader.h"
#include "trial/operator/operator.h"
#include "trial/operator/terminal.h"
#include "trial/sweep/statistics.h"

namespace enc::bench {
namespace {

// `encounter questionnaire FORM`: asks a person the paper's questions, stores the answers and summarises
// them. It simulates nothing [VHMR 4.4, Fig 14].

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

// Checks the files of write_pictures() in advance, so that a refusal comes before the first question.
void check_pictures(const trial::QuestionnaireOptions& o, const questionnaire::Form& form,
                    const std::vector<questionnaire::ItemReference>& items) {
  if (o.out.empty()) return;
  const models::OutFolder alone(o.out);
  const std::string plot = questionnaire::opinion_plot(form, items, {}).id;
  for (const std::string& name :
       {questionnaire::opinion_table(form, items, {}).id + ".csv",
        questionnaire::experience_table(form, items, {}).id + ".csv", plot + ".plot.csv", plot + ".svg"}) {
    const fs::path path = fs::path(o.out) / name;
    if (fs::weakly_canonical(path) == fs::weakly_canonical(o.store))
      throw Error(o.store + ": is a table of --out, too; expected another file for the answers; choose one");
    const models::OutFile writable(path.string(), models::existing(o.force));
  }
}

// Refuses bad options before the person answers fourteen questions.
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
    throw Error(
        path +
        ":1:1: there is no list 'verdicts'; expected results.json of `encounter bench --out`; run that");
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

// The numbers of the study that contradict each other about an item of this form.
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
       {questionnaire::opinion_table(form, items, rows), questionnaire::experience_table(form, items, rows)})
    write(at / (t.id + ".csv"), table_csv(t));
  write(at / (plot.id + ".plot.csv"), plot_csv(plot));
  const Drawing drawing = draw(plot);
  if (drawing.svg.empty())
    fmt::print(stderr, "encounter: not drawn: {}; the tables are complete\n", drawing.why_not);
  else
    write(at / (plot.id + ".svg"), drawing.svg);
}

using WallClock = std::chrono::steady_clock;

double since(WallClock::time_point start) {
  return std::chrono::duration<double>(WallClock::now() - start).count();
}

std::string bounds(const Figure& f) {
  if (std::isfinite(f.low) && std::isfinite(f.high))
    return fmt::format(" within {:.4g}..{:.4g}", f.low, f.high);
  if (std::isfinite(f.high)) return fmt::format(" at most {:.4g}", f.high);
  return std::isfinite(f.low) ? fmt::format(" at least {:.4g}", f.low) : "";
}

std::string value(const Figure& f) {
  return std::isnan(f.twin) ? std::string("absent") : fmt::format("{:.4g}", f.twin);
}

// The values over seeds; empty: fewer than two.
std::string over_seeds(const Figure& f) {
  const trial::Summary s = trial::summary_of(f.values);
  if (s.n < 2) return "";
  const std::string interval =
      std::isnan(s.half) ? ""
                         : fmt::format(", 95 % interval {:.4g} to {:.4g}", s.mean - s.half, s.mean + s.half);
  return fmt::format("    n {}, mean {:.4g}, SD {:.3g}{}\n", s.n, s.mean, s.sd, interval);
}

// The command line, for the report: repeating it gives the report's figures.
std::string command_of(const trial::BenchOptions& options) {
  std::string text = "./encounter bench";
  for (const std::string& name : options.names) text += " " + name;
  if (options.quick) text += " --quick";
  if (options.full) text += " --full";
  if (options.seed != 1) text += fmt::format(" --seed {}", options.seed);
  if (options.repeats != 0) text += fmt::format(" --repeats {}", options.repeats);
  if (!options.rig.empty()) text += " --rig " + options.rig;
  if (options.armed) text += " --armed";
  if (options.lockstep) text += " --lockstep";
  if (options.not_real_time) text += " --not-real-time";
  if (options.fakes) text += " --fakes";
  for (const std::string& set : options.set) text += " --set '" + set + "'";
  return text;
}

// A run with other settings gives other figures, so there is nothing to compare them with.
bool is_default(const trial::BenchOptions& options) {
  return !options.quick && !options.full && options.seed == 1 && options.repeats == 0 &&
         options.set.empty() && options.rig.empty();
}

// Columns side by side; the last one keeps its own width.
void print_table(const Table& table) {
  std::vector<std::size_t> width;
  for (const std::string& column : table.columns) width.push_back(column.size());
  for (const auto& row : table.rows)
    for (std::size_t c = 0; c < row.size(); ++c) width[c] = std::max(width[c], row[c].size());
  const auto line = [&](const std::vector<std::string>& row) {
    std::string text;
    for (std::size_t c = 0; c + 1 < row.size(); ++c) text += fmt::format("{:<{}}  ", row[c], width[c]);
    fmt::print("  {}{}\n", text, row.back());
  };
  line(table.columns);
  for (const auto& row : table.rows) line(row);
}

// Holds back signals that end a process until the program polls for them; threads and child processes inherit
// that. Over devices a suspension (Ctrl-Z) ends the run too: a measurement across it is invalid.
class Signals {
 public:
  explicit Signals(bool over_devices) {
    sigemptyset(&set_);
    for (const int signal : {SIGINT, SIGTERM, SIGHUP, SIGQUIT, SIGUSR1}) wait_for(signal);
    if (over_devices)
      for (const int signal : {SIGTSTP, SIGUSR2, SIGALRM, SIGXCPU, SIGPWR}) wait_for(signal);
    sigset_t blocked = set_;
    for (const int signal : {SIGTTIN, SIGTTOU}) sigaddset(&blocked, signal);  // reading fails instead
    pthread_sigmask(SIG_BLOCK, &blocked, &before_);
  }
  ~Signals() { pthread_sigmask(SIG_SETMASK, &before_, nullptr); }
  Signals(const Signals&) = delete;
  Signals& operator=(const Signals&) = delete;
  // Number of the signal that came; 0 or less: no signal.
  [[nodiscard]] int came() const {
    const timespec none{};
    return sigtimedwait(&set_, nullptr, &none);
  }

 private:
  // A signal that is ignored, as by nohup, stays ignored.
  void wait_for(int signal) {
    struct sigaction before {};
    if (sigaction(signal, nullptr, &before) == 0 && before.sa_handler != SIG_IGN) sigaddset(&set_, signal);
  }

  sigset_t set_{}, before_{};
};

// Progress of a benchmark: a line that renews itself in a terminal, one line in a file.
class Teller {
 public:
  Teller(const char* name, std::size_t number, std::size_t of)
      : text_(fmt::format("{} of {}: {}", number, of, name)) {}
  void tell(double share) {
    if (error_.terminal())
      error_.write(
          fmt::format("\r  {} {:3.0f} %  {:.0f} s ", text_, std::floor(100.0 * share), since(start_)));
    else if (since(start_) > 2.0)  // a benchmark that is refused at once prints one line: why
      say();
  }
  void end() {
    if (error_.terminal())
      error_.write(fmt::format("\r{:60}\r", ""));
    else
      say();
  }

 private:
  void say() {
    if (!said_) error_.write(fmt::format("encounter: {}\n", text_));
    said_ = true;
  }
  const trial::StandardError error_;  // this thread looks for signals, too
  const std::string text_;
  const WallClock::time_point start_ = WallClock::now();
  bool said_ = false;
};

// The folder is new, empty, or written by an earlier `bench`: then `bench` may use it.
void check_folder(const std::string& path, bool force) {
  namespace fs = std::filesystem;
  if (force || fs::is_empty(path)) return;
  constexpr std::string_view kOurs = "{\n  \"encounter\"";
  std::string start(kOurs.size(), ' ');
  std::ifstream(fs::path(path) / "results.json")
      .read(start.data(), static_cast<std::streamsize>(start.size()));
  if (start != kOurs)
    throw Error(path +
                ": holds other files; expected a new folder, an empty one or one of `encounter bench`; "
                "choose one, or give --force to write over what has the same names");
}

std::vector<Choice> choices_of(const trial::BenchOptions& options) {
  std::vector<Choice> all = chosen(options.names);
  if (!options.rig.empty()) all = over_devices(std::move(all), !options.names.empty());
  if (options.set.empty() || !options.rig.empty()) return all;
  std::vector<std::string> left;
  all = settable(std::move(all), options.set, !options.names.empty(), models::models_dir(), left);
  if (!left.empty())
    fmt::print(stderr, "encounter: left out: {}; they do not read what --set changes\n",
               fmt::join(left, ", "));
  return all;
}

// A separate thread does the work, so that this one can report progress and stop the run at any time.
class Session {
 public:
  Session(const trial::BenchOptions& options, const trial::ModuleFinder& modules)
      : options_(options), choices_(choices_of(options)), signals_(!options.rig.empty()) {
    if (!options.out.empty()) {
      folder_.emplace(options.out);
      check_folder(options.out, options.force);
    }
    report_.command = command_of(options);
    report_.seed = options.seed;
    report_.set = options.set;
    for (const Choice& choice : choices_) report_.missing.emplace_back(choice.benchmark->name);
    context_.models = models::models_dir();
    report_.background = load_background(context_.models);
    if (is_default(options)) committed_ = CommittedResults::load(context_.models);
    context_.seed = options.seed;
    context_.repeats = options.repeats;
    context_.quick = options.quick;
    context_.full = options.full;
    context_.set = UserSettings(options.set);
    context_.module = modules;
    context_.rig = options.rig;
    context_.armed = options.armed;
    context_.lockstep = options.lockstep;
    context_.fakes = options.fakes;
    context_.not_real_time = options.not_real_time;
    context_.confirm = [this](const std::string& question) { confirm(question); };
    context_.stop = [this] { return stopping_.load(); };
    context_.progress = [this](double share) { share_ = share; };
  }

  int run() {
    begin();
    for (std::size_t i = 0; i < choices_.size(); ++i) {
      const Choice& choice = choices_[i];
      BenchResult result = measured(*choice.benchmark, i + 1);
      check_ids(choice, result);
      print(choice, result);
      add_result(report_, std::move(result));
      write();
    }
    const std::string felt = verdict_line(judged(report_.results, report_.background.thresholds));
    if (!felt.empty()) fmt::print("errors beside what a person can tell: {}\n", felt);
    if (!options_.out.empty() && !report_.not_drawn.empty())
      fmt::print(stderr, "encounter: not drawn: {}; tables and figures are complete\n", report_.not_drawn);
    if (!differ_.empty())
      fmt::print("not as in benchmarks/reference/figures.csv, by more than their spread: {}\n",
                 fmt::join(differ_, ", "));
    if (fell_short_.empty()) return 0;
    fmt::print("out of bounds: {}\n", fmt::join(fell_short_, ", "));
    return 1;
  }

 private:
  BenchResult measured(const Benchmark& benchmark, std::size_t number) {
    if (const int signal = signals_.came(); signal > 0) stop(signal);
    share_ = 0.0;
    Teller teller(benchmark.name, number, choices_.size());
    const WallClock::time_point start = WallClock::now();
    std::future<BenchResult> work =
        std::async(std::launch::async, [&] { return result_of(benchmark, context_); });
    while (work.wait_for(kTurn) != std::future_status::ready) {
      if (const int signal = signals_.came(); signal > 0) {
        let_go(work);
        stop(signal);
      }
      teller.tell(share_);
    }
    BenchResult result = work.get();
    result.run_time = since(start);
    teller.end();
    return result;
  }

  // The run stops its moving machine and ends its fakes, however many signals come meanwhile.
  void let_go(const std::future<BenchResult>& work) {
    stopping_ = true;
    while (!options_.rig.empty() && work.wait_for(kTurn) != std::future_status::ready) {
    }
  }

  // Asks once, before the first motion. The worker's thread asks, and this one still polls for signals.
  void confirm(const std::string& question) {
    if (confirmed_ || options_.yes) return;
    trial::refuse_unasked();
    const trial::Answer answer = trial::ask("\n" + question, [this] { return stopping_.load(); });
    if (answer == trial::Answer::stopped) throw Error("interrupted; nothing has moved");
    if (answer == trial::Answer::no) throw Error("not begun; nothing has moved");
    confirmed_ = true;
  }

  void print(const Choice& choice, const BenchResult& result) {
    fmt::print("{} ({}): {}{:.2f} s\n", result.name, choice.benchmark->what,
               result.simulated > 0.0 ? fmt::format("{:.1f} s simulated in ", result.simulated) : "",
               result.run_time);
    for (const Figure& f : result.figures) {
      if (!wanted(choice, f)) continue;
      if (!f.ok()) fell_short_.push_back(f.id);
      const bool differs = committed_.differs(f);
      if (differs) differ_.push_back(f.id);
      fmt::print("  {:34} {:>10} {:5}{}{}{}{}{}\n", f.id, value(f), f.unit,
                 std::isfinite(f.paper) ? fmt::format(" (paper {:.4g}, {})", f.paper, role_name(f.role)) : "",
                 bounds(f), misses(f) ? fmt::format("  misses by {:+.3g}", miss_of(f)) : "",
                 differs ? fmt::format("  was {:.4g}", committed_.find(f.id)->value) : "",
                 f.ok() ? "" : "  OUT OF BOUNDS");
      if (options_.repeats > 0) fmt::print("{}", over_seeds(f));
    }
    for (const Table& table : result.tables)
      if (table.printed && choice.ids.empty()) print_table(table);
    if (!result.note.empty()) fmt::print("  {}\n", result.note);
    std::fflush(stdout);
  }

  // Refuses an unwritable folder before hours of work. An earlier report stays until there is a first result.
  void begin() const {
    if (options_.out.empty()) return;
    const std::string results = (std::filesystem::path(options_.out) / "results.json").string();
    if (!std::filesystem::exists(results)) return write();
    const models::OutFile writable(results, models::OverwritePolicy::replace);
  }
  void write() const {
    if (!options_.out.empty()) write_report(options_.out, report_);
  }

  // The files already list the missing results. The worker may be anywhere, so nothing is torn down.
  [[noreturn]] void stop(int signal) const {
    std::string missing;
    for (const std::string& name : report_.missing) missing += " " + name;
    const trial::StandardError error;
    error.write(fmt::format("{}encounter: interrupted; {} of {} benchmarks complete, missing:{}\n",
                            error.terminal() ? "\n" : "", report_.results.size(), choices_.size(), missing));
    _exit(128 + signal);
  }

  static constexpr std::chrono::milliseconds kTurn{50};

  const trial::BenchOptions& options_;
  const std::vector<Choice> choices_;
  std::optional<models::OutFolder> folder_;
  const Signals signals_;
  Report report_;
  BenchContext context_;
  std::atomic<double> share_{0.0};
  std::atomic<bool> stopping_{false};
  bool confirmed_ = false;               // of the worker
  std::vector<std::string> fell_short_;  // ids
  CommittedResults committed_;
  std::vector<std::string> differ_;  // ids
};

int list_benchmarks() {
  for (const Benchmark& b : benchmarks()) fmt::print("{:12} {}\n", b.name, b.what);
  for (const Group& g : groups()) {
    std::string members;
    for (const std::string& member : g.members) members += " " + member;
    fmt::print("{:12} {}:{}\n", g.name, g.what, members);
  }
  return 0;
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
             table_text(questionnaire::experience_table(form, items, answers.rows)),
             proxies_text(items, verdicts));
  for (const Contradiction& c : found) fmt::print("note        {}: {}; {}\n", c.where, c.printed, c.found);
  return 0;
}

int bench_command(const trial::BenchOptions& options, const trial::ModuleFinder& modules,
                  const std::vector<std::string>& others) {
  register_others(options, modules, others);
  if (options.list) return list_benchmarks();
  if (options.mutate) return mutate_command(options, modules);
  if (options.json) throw Error("--json: only the mutation run has it; expected --mutate, too; add it");
  if (options.repeats < 0 || options.repeats > 1'000'000)
    throw Error("--repeats: expected a whole number from 1 to 1000000");
  for (const auto& [given, name] :
       {std::pair{options.armed, "--armed"}, {options.lockstep, "--lockstep"}, {options.fakes, "--fakes"}})
    if (given && options.rig.empty())
      throw Error(fmt::format(
          "{}: it is of the devices of a rig; expected --rig, too; name one, or leave it out", name));
  if (options.quick && options.full) throw Error("--quick and --full exclude each other; give one of them");
  return Session(options, modules).run();
}

}  // namespace enc::bench
