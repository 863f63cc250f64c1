// A folder of kept frames: each line of the input is the name of a file. What is accepted is in order.
#include <algorithm>
#include <fstream>
#include <sstream>

#include "tests/fuzz/machine/target.h"
#include "tests/fuzz/targets/seeds.h"
#include "trial/camera/kept_frames.h"

namespace enc::fuzz {
namespace {

namespace fs = std::filesystem;

// As a file may be called; what moves a cursor is the command line's, which shows paths without it.
std::string name_of(std::string line) {
  for (char& c : line)
    if (c == '/' || static_cast<unsigned char>(c) < ' ' || static_cast<unsigned char>(c) > 126) c = '_';
  return line.substr(0, 200);
}

Target frames() {
  Target target;
  target.seeds = {"0.png\n50000000.png\n100000000.png\n", "9223372036854775807.png\n", "1.png\n01.png\n"};
  target.tokens = {".png", ".jpg", ".", "..", "-1", "+1", "9223372036854775808", "1e3", " 1"};
  target.run = [](const std::string& input) {
    static const Folder kFolder;
    const fs::path left = kFolder.path("left");
    fs::remove_all(left);
    fs::create_directory(left);
    std::istringstream lines(input);
    std::string line;
    for (int i = 0; i < 6 && std::getline(lines, line); ++i)
      if (!line.empty() && line != "." && line != "..") std::ofstream(left / name_of(line)) << "";
    const std::vector<Time> exposed = trial::exposures_in(fs::path(left).parent_path().string());
    expect(std::is_sorted(exposed.begin(), exposed.end()), "its times are not in order");
    expect(exposed.front() >= Time(), "a time is negative");
    return true;
  };
  return target;
}

const Offer kFrames("frames", &frames);

}  // namespace
}  // namespace enc::fuzz
