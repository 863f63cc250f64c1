#include "app/built.h"

#include <algorithm>
#include <cmath>

#include <fmt/format.h>

#include "app/process.h"
#include "core/base/words.h"
#include "models/schema/wording.h"

namespace enc::app {
namespace {

std::string arm_name(const models::Setup& setup) {
  const ArmMachine& machine = setup.rig.arm.machine;
  return machine.kind == ArmKind::phantom ? "PHANToM" : counted(machine.links.size(), "joint");
}

std::string prop_name(const PropSpec& prop) {
  return fmt::format("{}, {:g} g", word_of(prop.kind), std::round(prop.mass * 1e6) * 1e-3);
}

double millimetres(double metres) { return std::round(metres * 1e6) * 1e-3; }

std::string probe_name(const ProbeSpec& probe) {
  return fmt::format("{:g} mm radius, {} of {:g} mm", millimetres(probe.radius),
                     counted(probe.repeats, "push"), millimetres(probe.depth));
}

std::string pusher_name(const PusherSpec& pusher, double stiffness) {
  return fmt::format("{:g} N/mm, {} of {:g} mm or {:g} N", stiffness * 1e-3, counted(pusher.repeats, "push"),
                     millimetres(pusher.depth), pusher.force);
}

std::string travel_name(const TravelSpec& travel) {
  return fmt::format("{} of {:g} mm at {:g} mm/s", travel.axes,
                     millimetres(travel.stops.empty() ? 0.0 : travel.stops.back()),
                     millimetres(travel.speed));
}

}  // namespace

std::vector<Part> parts_of(const models::Setup& setup) {
  const SceneSpec& scene = setup.scene;
  const auto driver = [](const std::string& name) {
    return name == "sim" ? std::string("simulated") : "module '" + name + "'";
  };
  std::vector<Part> parts;
  const auto part = [&](const char* name, bool named, std::string what) {
    parts.push_back({name, named, named ? std::move(what) : "the scene does not name it"});
  };
  part("manipulator", scene.manipulator.has_value(),
       fmt::format("{}, {}", word_of(ManipulatorSpec{}.kind), driver(setup.rig.manipulator.driver)));
  part("force", scene.force.has_value(), driver(setup.rig.force.driver));
  part("tracker", scene.tracker.has_value(),
       scene.camera ? std::string("vision")
                    : fmt::format("{:g} Hz, {}", setup.twin.tracker.rate, driver(setup.rig.tracker.driver)));
  part("camera", scene.camera.has_value(),
       fmt::format("{} x {} at {:g} Hz, {}", setup.rig.camera.width, setup.rig.camera.height,
                   setup.rig.camera.rate, driver(setup.rig.camera.driver)));
  part("display", scene.display.has_value(),
       fmt::format("{:g} Hz, {}", setup.twin.display.rate, driver(setup.rig.display.driver)));
  part("user", scene.user.has_value(),
       trial::meets_person(setup) ? "whoever is at the real devices" : "simulated hand");
  part("probe", scene.probe.has_value(), !scene.probe ? "" : probe_name(*scene.probe));
  part("pusher", scene.pusher.has_value(),
       !scene.pusher ? "" : pusher_name(*scene.pusher, setup.twin.pusher.stiffness));
  part("travel", scene.travel.has_value(), !scene.travel ? "" : travel_name(*scene.travel));
  part("arm", scene.arm.has_value(), fmt::format("{}, {}", arm_name(setup), driver(setup.rig.arm.driver)));
  part("prop", scene.prop.has_value(), !scene.prop ? "" : prop_name(*scene.prop));
  part("gripper", scene.gripper.has_value(),
       fmt::format("{:g} N, {}", setup.rig.gripper.force, driver(setup.rig.gripper.driver)));
  if (scene.hand_tracker)
    part("hand_tracker", true,
         fmt::format("{:g} Hz, {}", setup.twin.hand_tracker.rate, driver(setup.rig.hand_tracker.driver)));
  return parts;
}

std::string parts_text(const models::Setup& setup) {
  std::string built;
  std::string left_out;
  for (const Part& p : parts_of(setup)) {
    std::string& line = p.built ? built : left_out;
    line += (line.empty() ? "" : ", ") + p.name + (p.built ? " (" + p.what + ")" : "");
  }
  return fmt::format("built       {}; {}, {}\nleft out    {}: the scene does not name them\n", built,
                     counted(setup.scene.objects.size(), "object"), counted(thread_count(), "thread"),
                     left_out.empty() ? "nothing" : left_out);
}

std::string devices_text(const std::vector<trial::DeviceWords>& devices) {
  std::string text;
  for (const trial::DeviceWords& d : devices) {
    std::string words = d.words;  // a driver's text, made into one line
    std::replace_if(
        words.begin(), words.end(), [](unsigned char c) { return c < 0x20 || c == 0x7f; }, ' ');
    text += fmt::format("device      {}: {}{}\n", d.role, d.there ? "" : "NOT THERE: ", words);
  }
  return text;
}

SeenParts seen_parts(const SceneSpec& scene) {
  SeenParts seen;
  if (scene.prop) seen.prop = fmt::format("prop ({})", word_of(scene.prop->kind));
  if (scene.user) seen.tool = words_of(scene).tool;
  if (scene.gripper) seen.tool = "clamped tool with markers";
  if (scene.gripper) seen.gripper = "gripper";
  if (scene.force) seen.force_sensor = "force sensor";
  return seen;
}

std::string questionnaire_text(const models::Setup& setup) {
  if (!setup.scene.questionnaire) return "";
  return fmt::format(
      "afterwards  encounter questionnaire {} --store answers.csv   (nothing of it is simulated)\n",
      setup.scene.questionnaire->form);
}

void print_notes(const std::vector<std::string>& notes) {
  for (const std::string& note : notes) fmt::print(stderr, "{}\n", models::printable(note));
}

std::string weak_text(const models::Setup& setup, const Scene& scene) {
  std::string text;
  for (std::size_t i = 0; i < scene.objects.size(); ++i) {
    const Object& object = scene.objects[i];
    if (!(object.limit < object.wanted)) continue;
    text += fmt::format(
        "limited     object '{}': the machine carries at most {:.1f} N, so its deflection is limited to "
        "{:.2f} mm "
        "instead of {:g} mm\n",
        setup.scene.objects[i].name, scene.strength, object.limit * 1e3, object.wanted * 1e3);
  }
  return text;
}

}  // namespace enc::app
