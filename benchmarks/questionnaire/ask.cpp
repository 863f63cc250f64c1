#include <charconv>
#include <istream>
#include <ostream>
#include <string>

#include <fmt/format.h>

#include "benchmarks/questionnaire/answers.h"
#include "core/base/error.h"
#include "models/schema/wording.h"

namespace enc::bench::questionnaire {
namespace {

class Interview {
 public:
  Interview(std::istream& in, std::ostream& out, bool again) : in_(in), out_(out), again_(again) {}

  // Until it is one of `words`, which are numbered from 0.
  int one_of(const std::string& question, const std::vector<std::string>& words, const std::string& wanted) {
    for (;;) {
      out_ << question << " [" << wanted << "] " << std::flush;
      std::string text;
      ++line_;
      if (!std::getline(in_, text))
        throw Error(
            fmt::format("standard input:{}:1: it ended before the last answer; expected {}; nothing "
                        "was stored, begin anew",
                        line_, wanted));
      if (!again_) out_ << text << '\n';  // nobody has typed it
      while (!text.empty() && (text.back() == '\r' || text.back() == ' ')) text.pop_back();
      for (std::size_t i = 0; i < words.size(); ++i)
        if (text == words[i]) return static_cast<int>(i);
      const std::string what = text.empty() ? "there is no answer" : models::quoted(text) + " is no answer";
      if (!again_)
        throw Error(fmt::format("standard input:{}:1: {}; expected {}; nothing was stored, begin anew", line_,
                                what, wanted));
      out_ << "  " << what << "; please give " << wanted << '\n';
    }
  }

 private:
  std::istream& in_;
  std::ostream& out_;
  const bool again_;
  std::size_t line_ = 0;
};

}  // namespace

Answer ask(const Form& form, std::istream& in, std::ostream& out, bool again) {
  Interview interview(in, out, again);
  Answer answer;
  out << form.title << "\n\n";
  for (const Wording& e : form.experience)
    answer.experience.push_back(interview.one_of(e.text, {"no", "yes"}, "yes or no") == 1 ? 1 : 0);
  out << "\nHow far do you agree?\n";
  std::vector<std::string> steps;
  for (const Wording& step : form.steps) {
    steps.push_back(step.name);
    out << "  " << step.name << "  " << step.text << '\n';
  }
  const std::string wanted = fmt::format("1 to {}", form.highest());
  std::string group;
  for (const Item& item : form.items) {
    for (const Wording& g : form.groups)
      if (g.name == item.group && item.group != group) out << '\n' << g.text << '\n';
    group = item.group;
    answer.points.push_back(1 + interview.one_of(fmt::format("{}. {}", item.name, item.text), steps, wanted));
  }
  out << '\n';
  return answer;
}

}  // namespace enc::bench::questionnaire
