#include "app/process.h"

#include <filesystem>
#include <fstream>
#include <set>

namespace enc::app {

int thread_count() {
  int count = 0;
  for ([[maybe_unused]] const auto& task : std::filesystem::directory_iterator("/proc/self/task")) ++count;
  return count;
}

std::vector<std::string> mapped_libraries() {
  std::set<std::string> names;
  std::ifstream maps("/proc/self/maps");
  for (std::string line; std::getline(maps, line);) {
    const std::size_t path = line.find('/');
    if (path == std::string::npos) continue;
    const std::string name = std::filesystem::path(line.substr(path)).filename().string();
    if (name.find(".so") != std::string::npos) names.insert(name);
  }
  return {names.begin(), names.end()};
}

}  // namespace enc::app
