#include <cmath>
#include <filesystem>
#include <fstream>
#include <thread>

#include <encounter_version.h>
#include <fmt/format.h>
#include <nlohmann/json.hpp>
#include <sys/utsname.h>

#include "benchmarks/bench.h"
#include "core/error.h"
#include "sim/mujoco.h"

namespace enc::bench {
namespace {

using Json = nlohmann::ordered_json;

Json number(double x) { return std::isfinite(x) ? Json(x) : Json(nullptr); }

const char* role_name(Role role) {
  switch (role) {
    case Role::calibrated:
      return "calibrated";
    case Role::predicted:
      return "predicted";
    case Role::ours:
      break;
  }
  return "ours";
}

std::string processor() {
  std::ifstream info("/proc/cpuinfo");
  for (std::string line; std::getline(info, line);)
    if (line.rfind("model name", 0) == 0) return line.substr(line.find(':') + 2);
  return "unknown";
}

std::string cell(double x) { return std::isfinite(x) ? fmt::format("{:.4g}", x) : ""; }

void write_whole(const std::filesystem::path& path, const std::string& text) {
  const std::filesystem::path aside = path.string() + ".part";
  std::ofstream file(aside, std::ios::binary);
  file << text;
  file.close();
  std::error_code failed;
  if (file) std::filesystem::rename(aside, path, failed);
  if (!file || failed)
    throw Error(path.string() + ": cannot be written; choose a folder that is yours and has room");
}

}  // namespace

bool Figure::ok() const {
  if (!std::isfinite(twin)) return false;
  return !(std::isfinite(low) && twin < low) && !(std::isfinite(high) && twin > high);
}

std::string results_json(const std::vector<BenchResult>& results, std::uint64_t seed) {
  utsname system{};
  uname(&system);
  Json json;
  json["encounter"] = ENCOUNTER_VERSION;
  json["mujoco"] = sim::mujoco_version();
  json["machine"] = {{"processor", processor()},
                     {"cores", std::thread::hardware_concurrency()},
                     {"system", fmt::format("{} {}", system.sysname, system.machine)},
                     {"compiler", __VERSION__}};
  json["seed"] = seed;
  json["benchmarks"] = Json::array();
  for (const BenchResult& result : results) {
    Json figures = Json::array();
    for (const Figure& f : result.figures)
      figures.push_back({{"id", f.id},
                         {"paper", number(f.paper)},
                         {"twin", number(f.twin)},
                         {"unit", f.unit},
                         {"role", role_name(f.role)},
                         {"low", number(f.low)},
                         {"high", number(f.high)},
                         {"ok", f.ok()},
                         {"note", f.note}});
    json["benchmarks"].push_back({{"name", result.name},
                                  {"scene", result.scene},
                                  {"run_time_s", result.run_time},
                                  {"simulated_s", result.simulated},
                                  {"figures", figures}});
  }
  return json.dump(2) + "\n";
}

std::string report_markdown(const std::vector<BenchResult>& results) {
  std::string text = "# Encounter " ENCOUNTER_VERSION ": benchmark report\n";
  for (const BenchResult& result : results) {
    text += fmt::format(
        "\n## {}\n\nScene `{}`; {:.1f} s simulated in {:.2f} s.\n\n| figure | paper | twin | unit | role | "
        "bounds | holds | note |\n|---|---|---|---|---|---|---|---|\n",
        result.name, result.scene, result.simulated, result.run_time);
    for (const Figure& f : result.figures)
      text +=
          fmt::format("| {} | {} | {} | {} | {} | {}..{} | {} | {} |\n", f.id, cell(f.paper), cell(f.twin),
                      f.unit, role_name(f.role), cell(f.low), cell(f.high), f.ok() ? "yes" : "NO", f.note);
  }
  return text;
}

void write_results(const std::string& folder, const std::vector<BenchResult>& results, std::uint64_t seed) {
  std::error_code failed;
  std::filesystem::create_directories(folder, failed);
  if (failed)
    throw Error(folder + ": cannot be made (" + failed.message() + "); choose a folder that is yours");
  write_whole(std::filesystem::path(folder) / "results.json", results_json(results, seed));
  write_whole(std::filesystem::path(folder) / "REPORT.md", report_markdown(results));
  for (const BenchResult& result : results) {
    std::string csv = "id,paper,twin,unit,role,low,high,ok\n";
    for (const Figure& f : result.figures)
      csv += fmt::format("{},{},{},{},{},{},{},{}\n", f.id, cell(f.paper), cell(f.twin), f.unit,
                         role_name(f.role), cell(f.low), cell(f.high), f.ok() ? 1 : 0);
    write_whole(std::filesystem::path(folder) / (result.name + ".csv"), csv);
  }
}

}  // namespace enc::bench
