// A record as a table, for programs that know nothing of Encounter (docs/rig.md). Row by row: a long record
// is never in memory as a whole.
#include <cerrno>
#include <cmath>
#include <cstdio>
#include <cstring>
#include <filesystem>
#include <string_view>
#include <utility>

#include <fmt/format.h>

#include "app/options.h"
#include "benchmarks/trial.h"
#include "core/error.h"

namespace enc::app {
namespace {

constexpr const char* kColumns =
    "time_s,mode,tip_x_mm,tip_y_mm,tip_z_mm,force_x_N,force_y_N,force_z_N,deflection_mm,force_N,repeat\n";

// The file, or standard output for "-".
class Output {
 public:
  explicit Output(const std::string& path)
      : path_(path), file_(path == "-" ? stdout : std::fopen(path.c_str(), "wb")) {
    if (file_ == nullptr) fail();
  }
  ~Output() {
    if (file_ != nullptr && file_ != stdout) std::fclose(file_);
  }
  Output(const Output&) = delete;
  Output& operator=(const Output&) = delete;

  void write(std::string_view text) {
    if (std::fwrite(text.data(), 1, text.size(), file_) != text.size()) fail();
  }
  void close() {
    std::FILE* file = std::exchange(file_, nullptr);
    if ((file == stdout ? std::fflush(file) : std::fclose(file)) != 0) fail();
  }

 private:
  [[noreturn]] void fail() const {
    throw Error(fmt::format("{}: cannot be written: {}; choose a file in a folder that is yours and has room",
                            path_ == "-" ? "standard output" : path_, std::strerror(errno)));
  }
  std::string path_;
  std::FILE* file_;
};

// The shortest text that reads back to the same number; nothing where the number is not known.
void add(std::string& row, double x) {
  row += ',';
  if (std::isfinite(x)) row += fmt::format("{}", x);
}

// How hard the object is pressed, N. By a probe: as measured in this tick, not filtered. In a contact: what
// the object was made to answer to, which is filtered.
double pressing(const Scene& scene, const Outputs& out) {
  if (scene.probe) return dot(out.felt, scene.probe->X_WN * Vec<'N'>(0, 0, 1));
  return -out.force.xyz[2];
}

// Number of the push or contact that a row belongs to; 0: none.
std::int32_t repeat(const Outputs& out) {
  const bool pressed = out.mode == Mode::contact || (out.mode == Mode::probe && out.deflection > 0.0);
  return pressed ? out.contacts : 0;
}

std::string row_of(const Scene& scene, const RecordedTick& frame) {
  constexpr double kMillimetres = 1e3;
  const Outputs& out = frame.out;
  std::string row = fmt::format("{},{}", seconds(frame.tick.t.time_since_epoch()), mode_name(out.mode));
  const Point<'W'> tip = scene.X_WR * frame.in.tip.value.X_RH.origin();
  for (const double x : tip.xyz) add(row, kMillimetres * x);
  for (const double x : out.felt.xyz) add(row, x);
  add(row, kMillimetres * out.deflection);
  add(row, pressing(scene, out));
  return row + fmt::format(",{}\n", repeat(out));
}

}  // namespace

int export_record(const ExportOptions& options) {
  std::error_code none;
  if (std::filesystem::equivalent(options.record, options.csv, none))
    throw Error(options.csv + ": is the record itself; choose another file for the table");
  RecordReader record(options.record, options.partial ? Partial::yes : Partial::no);
  const models::Setup setup = models::setup_of(record.texts(), options.record);
  const Scene scene = bench::prepare_setup(setup);
  Output output(options.csv);
  output.write(kColumns);
  for (RecordedTick frame; record.next(frame);) output.write(row_of(scene, frame));
  output.close();
  return 0;
}

}  // namespace enc::app
