#include "trial/mcap/ros2.h"

#include <algorithm>
#include <array>
#include <utility>

namespace enc::trial {

std::string ros2_field(std::string_view name) {
  std::string lower(name);
  for (char& c : lower)
    if (c >= 'A' && c <= 'Z') c = static_cast<char>(c - 'A' + 'a');
  return lower;
}

std::string_view ros2_type(std::string_view name) {
  static constexpr std::array<std::pair<std::string_view, std::string_view>, 8> kTypes{
      {{"header", "std_msgs/Header"},
       {"stamp", "builtin_interfaces/Time"},
       {"pose", "geometry_msgs/Pose"},
       {"position", "geometry_msgs/Point"},
       {"orientation", "geometry_msgs/Quaternion"},
       {"transforms", "geometry_msgs/TransformStamped"},
       {"transform", "geometry_msgs/Transform"},
       {"wrench", "geometry_msgs/Wrench"}}};
  for (const auto& [field, type] : kTypes)
    if (field == name) return type;
  return name == "rotation" ? "geometry_msgs/Quaternion" : "geometry_msgs/Vector3";
}

std::string ros2_schema(std::string_view json_schema) {
  if (json_schema == "foxglove.PoseInFrame") return "geometry_msgs/msg/PoseStamped";
  if (json_schema == "foxglove.FrameTransforms") return "tf2_msgs/msg/TFMessage";
  if (json_schema == "encounter.Wrench") return "geometry_msgs/msg/WrenchStamped";
  return "encounter_msgs/msg/" + std::string(json_schema.substr(json_schema.find('.') + 1));
}

void Ros2Schema::add(std::string_view type, std::string_view name, std::string_view about) {
  text_ += std::string(type) + " " + ros2_field(name);
  if (!about.empty()) text_ += "  # " + std::string(about);
  text_ += '\n';
}

void Ros2Schema::define(std::string_view type, const Ros2Schema& other) {
  const std::string head = std::string(80, '=') + "\nMSG: " + std::string(type) + "\n";
  if (others_.find(head) == std::string::npos) others_ += head + other.text_;
  for (std::size_t at = 0; at < other.others_.size();) {
    const std::size_t end = std::min(other.others_.find(std::string(80, '='), at + 80), other.others_.size());
    const std::string one = other.others_.substr(at, end - at);
    if (others_.find(one.substr(0, one.find('\n', 81) + 1)) == std::string::npos) others_ += one;
    at = end;
  }
}

}  // namespace enc::trial
