// `encounter calibrate skin FOLDER`: the colour of skin out of images of hands and their masks.
#include <optional>

#include <fmt/format.h>

#include "app/calibrate/images/commands.h"
#include "app/calibrate/images/skin_study.h"
#include "app/common/shell_word.h"
#include "models/files.h"

namespace enc::app {

int calibrate_skin(const SkinOptions& options) {
  refuse_dash("--out", options.out);
  const std::vector<HandFiles> files = list_hands(options.folder, options.masks);
  std::optional<models::OutFile> file;  // refused before the work
  if (!options.out.empty()) file.emplace(options.out, models::existing(options.force));
  const SkinStudy study = study_skin(files);
  if (file) {
    file->write(
        made_by(fmt::format("skin {} --masks {}", shell_word(options.folder), shell_word(options.masks))) +
        skin_toml(study));
    file->keep();
  }
  fmt::print("{}{}", options.json ? skin_json(study) : skin_text(study), options.json ? "\n" : "");
  return 0;
}

}  // namespace enc::app
