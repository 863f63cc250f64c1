// What a run writes while it goes on: its record, the run as MCAP, and the run for viewers.
#pragma once

#include <memory>
#include <string>

#include "app/common/options.h"
#include "core/record/record.h"
#include "models/setup/scene_file.h"
#include "trial/provenance/provenance.h"
#include "trial/trial.h"

namespace enc::app {

class LiveRun;

class RunFiles {
 public:
  explicit RunFiles(const RunOptions& options);
  RunFiles(const RunFiles&) = delete;
  RunFiles& operator=(const RunFiles&) = delete;
  ~RunFiles();

  // Begins the files that the options name. Throws Error.
  void begin(const trial::Trial& trial, trial::WallTime started);
  void watch(trial::TrialOptions& how);            // joins the hook after each tick
  [[nodiscard]] RecordWriter* record();            // null: no record
  void end(const RecordTexts& texts);              // texts known only after the run
  [[nodiscard]] std::string record_error() const;  // one line; empty: no error

 private:
  struct Record;
  struct Mcap;
  const RunOptions& options_;
  std::unique_ptr<Record> record_;
  std::unique_ptr<Mcap> mcap_;
  std::unique_ptr<LiveRun> live_;
};

}  // namespace enc::app
