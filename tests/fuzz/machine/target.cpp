#include "tests/fuzz/machine/target.h"

#include <map>

namespace enc::fuzz {
namespace {

std::map<std::string, Target (*)()>& offers() {
  static std::map<std::string, Target (*)()> all;
  return all;
}

}  // namespace

Offer::Offer(const std::string& name, Target (*make)()) { offers()[name] = make; }

std::vector<std::string> names() {
  std::vector<std::string> all;
  for (const auto& [name, make] : offers()) all.push_back(name);
  return all;
}

const Target& target(const std::string& name) {
  static std::map<std::string, Target> made;
  const auto found = made.find(name);
  if (found != made.end()) return found->second;
  Target one = offers().at(name)();
  one.name = name;
  return made[name] = std::move(one);
}

}  // namespace enc::fuzz
