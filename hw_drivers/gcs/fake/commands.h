// Every command line that the fake controller supports.
#pragma once

#include <span>
#include <string_view>

#include "hw_drivers/gcs/fake/controller.h"

namespace enc::gcs {

struct Commands {
  struct Entry {
    std::string_view word, help;
    void (*run)(Controller& of, std::string_view rest);
  };
  [[nodiscard]] static std::span<const Entry> all() noexcept;

  static void help(Controller& of, std::string_view rest);
  static void move(Controller& of, std::string_view rest);
  static void move_by(Controller& of, std::string_view rest);
  static void possible(Controller& of, std::string_view rest);
  static void reference(Controller& of, std::string_view rest);
  static void servo(Controller& of, std::string_view rest);
  static void velocity(Controller& of, std::string_view rest);
  static void pivot(Controller& of, std::string_view rest);
  static void parameter(Controller& of, std::string_view rest);
  static void set_parameter(Controller& of, std::string_view rest);
  static void cycle_time(Controller& of, std::string_view rest);
  static void halt(Controller& of, std::string_view rest);
  static void error(Controller& of, std::string_view rest);

 private:
  static bool names_parameter(Controller& of, std::string_view axis, std::string_view number);
  static bool names_axes(Controller& of, std::string_view rest);  // or no axes
  static void go(Controller& of, std::string_view rest, bool relative);
};

}  // namespace enc::gcs
