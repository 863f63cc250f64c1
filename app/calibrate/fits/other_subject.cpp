// What is another subject's is refused with the command that takes it.
#include <fmt/format.h>

#include "app/calibrate/fits/fits.h"
#include "app/common/shell_word.h"
#include "core/base/error.h"
#include "models/identify/camera/point_set.h"
#include "models/identify/tip/pivot_log.h"

namespace enc::app {

void refuse_pairs(const std::string& csv, const std::string& file, const std::string& expected) {
  if (!models::is_point_set(csv)) return;
  throw Error(
      fmt::format("{}:1:1: is a table of pairs of points; expected {}; run: encounter calibrate camera {}",
                  file, expected, shell_word(file)));
}

void refuse_poses(const std::string& csv, const std::string& file, const std::string& expected) {
  if (!models::is_pivot_log(csv)) return;
  throw Error(
      fmt::format("{}:1:1: is a table of a tool's poses; expected {}; run: encounter calibrate tip {}", file,
                  expected, shell_word(file)));
}

bool is_rig(const std::string& what) {
  return what.find_first_of("./") == std::string::npos || what.ends_with(".toml");
}

}  // namespace enc::app
