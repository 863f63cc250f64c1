// Settings of a scene that looks through the twin's camera: images of a quarter of the pixels.
#pragma once

#include <string>
#include <vector>

namespace enc::test {

[[nodiscard]] inline std::vector<std::string> quarter_size() {
  return {"rig.camera.width_px=320",
          "rig.camera.height_px=240",
          "rig.camera.left.focal_px=[360.5, 360.5]",
          "rig.camera.left.centre_px=[159.5, 119.5]",
          "rig.camera.right.focal_px=[360.5, 360.5]",
          "rig.camera.right.centre_px=[159.5, 119.5]",
          "truth.camera.width_px=320",
          "truth.camera.height_px=240",
          "truth.camera.focal_px=360.5"};
}

}  // namespace enc::test
