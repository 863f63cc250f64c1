// A record as an MCAP file, or a run for live viewers: its channels and their content
// (docs/reference/mcap.md).
#pragma once

#include <cstdint>
#include <functional>
#include <map>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "core/record/record.h"
#include "models/setup/scene_file.h"
#include "trial/mcap/message_sink.h"

namespace enc::trial {

// JSON with JSON Schemas, or CDR with ros2msg schemas.
enum class McapMessages : std::uint8_t { json, ros2 };

class RecordMcap {
 public:
  // Attaches the scene and the record's other texts. Setup, scene and file must outlive this.
  RecordMcap(MessageSink& file, const models::Setup& setup, const Scene& scene, const RecordTexts& texts,
             McapMessages form = McapMessages::json);

  void add(const RecordedTick& frame);  // in order
  // Adds the texts of the end and `state`, the condition of the record: "whole", or its damage. Closes the
  // file.
  void end(const RecordTexts& end_texts, std::string_view state);

 private:
  template <class Fields>
  [[nodiscard]] std::uint16_t channel(std::string_view topic, std::string_view schema_name, Fields&& fields);
  template <class Fields>
  void say(std::uint16_t channel, Time log, Time publish, Fields&& fields);
  void add_channels();
  void add_fixed_frames(Time t);

  MessageSink& file_;
  const Scene& scene_;
  bool ros2_;
  RecordTexts about_;                               // short texts of the record
  std::vector<std::string> objects_, tools_;        // names, by index
  std::vector<std::string> joints_, joint_speeds_;  // names of fields
  std::optional<std::uint16_t> tool_, tip_, command_, wrench_, arm_, gripper_, surface_;
  std::uint16_t frames_ = 0, core_ = 0;
  std::map<std::string, std::uint16_t, std::less<>> schemas_;  // by name
  Time tool_t_ = Time::min(), surface_t_ = Time::min();        // stamps of the newest packets so far
  std::int64_t ticks_ = 0, missed_ = 0;
  std::string message_;
};

}  // namespace enc::trial
