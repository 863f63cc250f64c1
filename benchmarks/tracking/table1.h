// Table 1 [VHMR 4.1], in m: of the paper, of the twin and over devices. Scene `tracking` runs through the
// whole loop; the error counts at each new packet (trial/measure/programme_measures.h). table1.cpp has the
// method, bounds, figures and plots.
#pragma once

#include <array>
#include <cstdint>
#include <string>
#include <vector>

#include "benchmarks/kit/entry.h"
#include "benchmarks/verdict/reference.h"
#include "models/setup/scene_file.h"
#include "trial/measure/programme_measures.h"
#include "trial/trial.h"

namespace enc::bench::tracking {

using trial::Errors;
using trial::ErrorSum;
using trial::MotionDirection;
using trial::PacketError;

struct TravelErrors : trial::TravelSums {
  double simulated = 0.0;  // s
  std::string held{};      // time and reason of a hold of the run
  void add(const TravelErrors& other);
};

// Runs the travel of the set-up once; `base` as in scenes.h.
[[nodiscard]] TravelErrors run_travel(const models::Setup& setup, std::uint64_t seed, bool keep_packets,
                                      const trial::TrialOptions& base = {});

// Table 1 over the devices of the user's rig: tracking.cpp.
void over_rig(Bench& bench);

inline constexpr std::array<int, 3> kTableSpeeds{0, 20, 40};  // mm/s
inline constexpr std::array<const char*, 4> kTableAxes{"x", "y", "z", "norm"};
struct Cell {
  double rmse = 0.0, mae = 0.0;  // m
};
using Column = std::array<Cell, 4>;
using Table1 = std::array<Column, 3>;  // [speed][axis]
struct Statistic {
  const char *name, *id;
  double Cell::*what;
};
inline constexpr std::array<Statistic, 2> kStatistics{
    {{"RMSE", "rmse", &Cell::rmse}, {"MAE", "mae", &Cell::mae}}};

// The two named hypotheses of sources/tracking 6, and a third: motion along + of W, or along -, or both.
enum class BiasSide : std::uint8_t { opposes, adds, both_ways };
inline constexpr std::array<const char*, 3> kSides{"opposes", "adds", "both_ways"};

[[nodiscard]] Table1 table1_of(const Reference& reference);
void fill_norm(Column& column);  // quadrature of the three axes
// Unset for an axis that was not travelled.
[[nodiscard]] Column resting_column(const TravelErrors& errors);
[[nodiscard]] Column moving_column(const TravelErrors& errors, BiasSide side = BiasSide::opposes);
[[nodiscard]] Table1 table_of(const TravelErrors& slow, const TravelErrors& fast,
                              BiasSide side = BiasSide::opposes);

// Travels of one kind: every axis, several seeds.
struct Group {
  std::array<models::Setup, 3> setup;  // for each axis
  std::vector<TravelErrors> seeds;
  [[nodiscard]] TravelErrors all() const;
};
// Travels at a speed (mm/s), one way or both ways; `more` settings come after the benchmark's own.
[[nodiscard]] Group travels_at(const BenchContext& context, int speed, const char* ways,
                               const std::vector<std::string>& more, std::size_t seeds);
void run_all(const std::vector<Group*>& groups, const BenchContext& context, double& simulated);

// A table with the least and the most of each cell.
struct SpannedTable {
  Table1 table{}, least{}, most{};
  std::vector<Table1> seeds{};
};
[[nodiscard]] SpannedTable twin_table(const Group& slow, const Group& fast, BiasSide side);  // over seeds

void add_table_figures(BenchResult& result, const Table1& paper, const SpannedTable& twin,
                       const Table1& theory);
[[nodiscard]] Table table1_table(const Table1& paper, const SpannedTable& twin, const Table1& theory);
// `predicted`: column 40 from the two others.
[[nodiscard]] Plot table1_plot(const Statistic& statistic, const Table1& paper, const SpannedTable& twin,
                               const SpannedTable& predicted);

[[nodiscard]] std::string fine_mm(double metres);
[[nodiscard]] std::string percent(double ratio);  // deviation of a ratio from 1

}  // namespace enc::bench::tracking
