#include "models/mesh_files/mesh_places.h"

#include <algorithm>
#include <cmath>

#include <fmt/format.h>

#include "core/base/error.h"
#include "models/mesh_files/mesh_file.h"
#include "models/schema/wording.h"

namespace enc::models {
namespace {

constexpr double kFarthest = 1e6;  // m: beyond, squares of double cannot tell a mesh from a point

class PointsReader {
 public:
  PointsReader(const std::string& text, const std::string& path) : path_(path), text_(text) {
    if (line() != "x_m,y_m,z_m")
      fail(1, fmt::format("the header is {}; expected x_m,y_m,z_m; write it in the first line",
                          models::quoted(line_)));
  }

  // False at the end of the file.
  bool next(Vec3& point) {
    if (at_ >= text_.size()) return false;
    if (line().empty()) {
      if (text_.find_first_not_of("\r\n", start_) != std::string::npos)
        fail(1, "an empty line; expected three numbers; remove it");
      return false;
    }
    std::size_t from = 0;
    for (Eigen::Index i = 0; i < 3; ++i) {
      const std::size_t to = std::min(line_.find(',', from), line_.size());
      if (!read_number(std::string_view(line_).substr(from, to - from), point[i]))
        fail(from + 1, fmt::format("{} is no number; expected x,y,z in metres; correct the line",
                                   models::quoted(line_.substr(from, to - from))));
      if (std::abs(point[i]) > kFarthest)
        fail(from + 1, fmt::format("{} m is farther than {:g} m; expected x,y,z in metres; correct the line",
                                   line_.substr(from, to - from), kFarthest));
      from = std::min(to + 1, line_.size());
      if (i == 2 && to < line_.size())
        fail(to + 1, "more than three numbers; expected x,y,z; correct the line");
    }
    return true;
  }

 private:
  const std::string& line() {
    const std::size_t end = std::min(text_.find('\n', at_), text_.size());
    start_ = at_;
    line_ = text_.substr(at_, end - at_);
    if (line_.ends_with('\r')) line_.pop_back();
    at_ = end + 1;
    ++number_;
    return line_;
  }
  [[noreturn]] void fail(std::size_t column, const std::string& what) const {
    throw Error(fmt::format("{}:{}:{}: {}", path_, std::max<std::size_t>(number_, 1), column, what));
  }

  const std::string &path_, &text_;
  std::string line_;
  std::size_t at_ = 0, start_ = 0, number_ = 0;
};

}  // namespace

std::vector<Vec3> parse_places(const std::string& text, const std::string& path) {
  PointsReader reader(text, path);
  std::vector<Vec3> all;
  for (Vec3 place; reader.next(place);) all.push_back(place);
  return all;
}

}  // namespace enc::models
