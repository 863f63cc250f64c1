#include "benchmarks/ablation/form.h"

#include <algorithm>
#include <array>
#include <cstdio>

#include <fmt/format.h>
#include <sys/mman.h>
#include <sys/stat.h>
#include <unistd.h>

#include "benchmarks/kit/load_scene.h"
#include "core/base/error.h"

namespace enc::bench::ablation {
namespace {

bool among(const std::vector<Part>& parts, Part part) {
  return std::find(parts.begin(), parts.end(), part) != parts.end();
}

// Islands are no part of it: an arm's contacts are solved in another order with them, which gives other bits.
constexpr int kFeatures = mjDSBL_CONTACT | mjDSBL_CONSTRAINT;

// A camera's scene is run for some seconds only: its finger comes from nearby.
std::vector<std::string> soon_touched(const std::string& scene) {
  if (!scene.starts_with("camera/")) return {};
  return {"user.approach_from_mm=20", "user.approach_mm_s=[50]"};
}

}  // namespace

const char* name_of(Part part) {
  constexpr std::array<const char*, 6> kNames{"display",  "camera", "pictures",
                                              "features", "counts", "record"};
  return kNames.at(static_cast<std::size_t>(part));
}

std::vector<Part> left_out(const BenchContext& context, const std::string& scene) {
  Form form(context, scene, {}, 1.0);
  const SceneSpec& named = form.setup().scene;
  const bool renders = named.manipulator && named.user;  // something that could be seen
  const int looked_at = Form(context, scene, {Part::pictures}, 1.0).elements();
  std::vector<Part> parts;
  for (const Part part : kParts)
    if ((part != Part::display || (!named.display && renders)) &&
        (part != Part::pictures || looked_at > form.elements()) &&
        (part != Part::camera || (!named.camera && named.arm && named.user)) &&  // whose rig has one
        (part != Part::features || (form.world().physics().model()->opt.disableflags & kFeatures) != 0))
      parts.push_back(part);
  return parts;
}

Form::Form(const BenchContext& context, const std::string& scene, const std::vector<Part>& with,
           double seconds)
    : parts_(with), setup_(load_scene(context, scene, {}, soon_touched(scene))) {
  trial::TrialOptions options;
  options.seed = context.seed;
  options.seconds = seconds;
  options.drivers = modules_of(context);
  if (among(with, Part::display)) setup_.scene.display = DisplaySpec{};
  options.draw_all = among(with, Part::pictures);
  if (among(with, Part::counts)) counts_ = std::make_unique<trial::RunMeasures>(setup_, options);
  options.watch = [this](const trial::Glance& glance) { see(glance); };
  trial_ = std::make_unique<trial::Trial>(setup_, options);
  if (among(with, Part::features)) world().physics().model()->opt.disableflags &= ~kFeatures;
  if (among(with, Part::camera))
    vision_ = trial::make_vision(setup_, options.drivers, {&world(), context.seed, log_});
  if (!among(with, Part::record)) return;
  file_ = memfd_create("record", 0);
  if (file_ < 0) throw Error("no file in memory could be made");
  record_ = std::make_unique<RecordWriter>(fmt::format("/proc/self/fd/{}", file_),
                                           models::record_texts(setup_), layout_hash(trial_->scene()));
  trial_->record_to(record_.get());
}

Form::~Form() {
  if (record_) record_->close();
  if (file_ >= 0) close(file_);
}

void Form::run(int ticks) {
  for (int i = 0; i < ticks && trial_->tick(); ++i) {
  }
}

// Nine tenths of what is due: the first picture comes late.
bool Form::works(Part part, const Form& minimal) const {
  const double due = 0.9 * static_cast<double>(ticks_) / setup_.rig.loop.rate;
  switch (part) {
    case Part::display:
      return static_cast<double>(surfaces_) >= due * setup_.twin.display.rate;
    case Part::camera:
      return static_cast<double>(pictures_) >= due * setup_.rig.camera.rate;
    case Part::pictures:
      return elements() > minimal.elements();
    case Part::features:
      return (trial_->world().physics().model()->opt.disableflags & kFeatures) == 0;
    case Part::counts:  // a contact is booked when it is over
      return trial_->result().contacts < 2 || !counts_->ledger.contacts().empty() ||
             !counts_->presses.presses().empty() || !counts_->pushes.pushes().empty();
    case Part::record: {
      struct stat file {};
      return fstat(file_, &file) == 0 &&
             file.st_size >= static_cast<off_t>(static_cast<double>(ticks_) * 0.5 * sizeof(Inputs));
    }
  }
  return false;
}

bool Form::has(Part part) const { return among(parts_, part); }

std::vector<Part> Form::idle(const Form& minimal) const {
  std::vector<Part> all;
  for (const Part part : parts_)
    if (!works(part, minimal)) all.push_back(part);
  return all;
}

void Form::see(const trial::Glance& glance) {
  const sim::Truth& truth = glance.truth;
  for (const Vec3 v : {truth.tip.e(), truth.tool_tip.e(), truth.contact_force.e(), glance.out.tip.p(),
                       glance.out.force.e(), glance.out.arm_force.e()})
    for (const double x : v) felt_.add(leaf_bits(x));
  felt_.add(leaf_bits(glance.out.mode));
  ++ticks_;
  touched_ += truth.touching ? 1 : 0;
  if (counts_) counts_->see(glance);
  if (vision_ && vision_->poll(glance.tick.t, unused_)) ++pictures_;
  if (glance.in.dent.health == Health::absent || glance.in.dent.t == drawn_) return;
  drawn_ = glance.in.dent.t;
  ++surfaces_;
}

}  // namespace enc::bench::ablation
