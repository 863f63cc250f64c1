// Measures the parts that a scene leaves out and their cost. Each scene runs as it ships, with all parts, and
// with one part at a time. The hand must feel the same force to the bit.
#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <cstdio>
#include <filesystem>
#include <functional>
#include <memory>
#include <optional>
#include <set>
#include <string>
#include <vector>

#include <fmt/format.h>
#include <sys/mman.h>
#include <sys/stat.h>
#include <unistd.h>

#include "benchmarks/kit/cost.h"
#include "benchmarks/kit/entry.h"
#include "benchmarks/kit/kit.h"
#include "core/base/error.h"
#include "core/record/record.h"
#include "core/record/state_hash.h"
#include "trial/assemble/vision.h"
#include "trial/devices/device_log.h"
#include "trial/measure/run_measures.h"
#include "trial/trial.h"

namespace enc::bench::ablation {
namespace {

// A scene with more parts than it needs. None of them may change what the hand feels.

// The parts that a scene can leave out, each with its own cost.
enum class Part : std::uint8_t {
  display,   // a device: the headset, and the surface that it draws
  camera,    // images and vision in addition to the scene's tracker: a device, buffers and libraries
  pictures,  // elements of the physics: bodies, meshes and lights that are only displayed
  features,  // physics: contacts and constraints where nothing can touch
  counts,    // counters of `run`: presses, touches, the energy ledger
  record,    // each tick into a file
};

constexpr std::array kParts{Part::display,  Part::camera, Part::pictures,
                            Part::features, Part::counts, Part::record};

// The behaviour of a run, tick by tick, as hashes: contacts, positions and commands, and the complete state
// and output of the core.
struct Bits {
  std::uint64_t felt = 0, core = 0;
  bool operator==(const Bits&) const = default;
};

// A run of a scene with some of these parts.
class Form {
 public:
  Form(const BenchContext& context, const std::string& scene, const std::vector<Part>& with, double seconds);
  Form(const Form&) = delete;
  Form& operator=(const Form&) = delete;
  ~Form();

  void run(int ticks);
  [[nodiscard]] Bits bits() const { return {felt_.value, trial_->result().hash}; }
  [[nodiscard]] bool has(Part part) const;
  // The parts that had no effect so far, or are off: they would have cost nothing.
  [[nodiscard]] std::vector<Part> idle(const Form& minimal) const;
  [[nodiscard]] std::int64_t touched() const { return touched_; }  // ticks
  [[nodiscard]] int elements() const { return trial_->world().physics().elements(); }
  [[nodiscard]] const models::Setup& setup() const { return setup_; }
  [[nodiscard]] sim::World& world() { return trial_->world(); }

 private:
  void see(const trial::Glance& glance);
  [[nodiscard]] bool works(Part part, const Form& minimal) const;

  std::vector<Part> parts_;
  models::Setup setup_;
  std::unique_ptr<trial::RunMeasures> counts_;
  std::unique_ptr<trial::Trial> trial_;
  trial::DeviceLog log_;
  std::unique_ptr<PoseTracker> vision_;
  int file_ = -1;  // in memory
  std::unique_ptr<RecordWriter> record_;
  Measurement<TrackedTool> unused_;
  std::int64_t ticks_ = 0, touched_ = 0;
  std::int64_t pictures_ = 0, surfaces_ = 0;  // seen by vision; drawn by the display
  Time drawn_{};
  StateHash felt_;
};

bool among(const std::vector<Part>& parts, Part part) {
  return std::find(parts.begin(), parts.end(), part) != parts.end();
}

// Islands are left on: without them MuJoCo solves an arm's contacts in another order, which gives other bits.
constexpr int kFeatures = mjDSBL_CONTACT | mjDSBL_CONSTRAINT;

// A scene with a camera runs only for some seconds: its finger comes from nearby.
std::vector<std::string> soon_touched(const std::string& scene) {
  if (!scene.starts_with("camera/")) return {};
  return {"user.approach_from_mm=20", "user.approach_mm_s=[50]"};
}

const char* name_of(Part part) {
  constexpr std::array<const char*, 6> kNames{"display",  "camera", "pictures",
                                              "features", "counts", "record"};
  return kNames.at(static_cast<std::size_t>(part));
}

// The parts that the scene leaves out.
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
  const bool other = context.mutated("other_seed") && !with.empty();
  trial::TrialOptions options{
      .seed = context.seed + (other ? 1 : 0), .seconds = seconds, .drivers = modules_of(context)};
  if (among(with, Part::display)) setup_.scene.display = DisplaySpec{};
  options.draw_all = among(with, Part::pictures);
  if (among(with, Part::counts)) counts_ = std::make_unique<trial::RunMeasures>(setup_, options);
  options.watch = [this](const trial::Glance& glance) { see(glance); };
  trial_ = std::make_unique<trial::Trial>(setup_, options);
  if (among(with, Part::features)) world().physics().model()->opt.disableflags &= ~kFeatures;
  if (among(with, Part::camera))
    vision_ = trial::make_vision(setup_, options.drivers, {&world(), context.seed, log_});
  if (!among(with, Part::record) || context.mutated("no_record")) return;
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

// Nine tenths of the expected pictures: the first one comes late.
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
    case Part::counts:  // a contact is counted when it ends
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
  for (const Vec3 v : {truth.tip.e(), truth.tool_tip.e(), truth.contact_force.e(),
                       glance.out.manipulator.tip.p(), glance.out.force.e(), glance.out.arm.force.e()})
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

namespace fs = std::filesystem;

constexpr int kChunk = 240;  // ticks
constexpr double kTick = 1e-3;

std::vector<std::string> scenes(const BenchContext& context) {
  if (context.quick) return {"plane", "wall"};
  std::set<std::string> names;
  for (const std::string folder : {"", "camera/"})
    for (const auto& entry : fs::directory_iterator(context.models + "/scenes/" + folder))
      if (entry.path().extension() == ".toml") names.insert(folder + entry.path().stem().string());
  return {names.begin(), names.end()};
}

struct Costs {
  std::string scene;
  std::vector<Part> parts{};
  std::vector<double> each{};              // s per tick, of a part
  double minimal = 0.0, everything = 0.0;  // s per tick
  double ratio = kUnset;                   // everything over minimal
  int elements = 0, all_elements = 0;      // of the physics
  std::size_t equal = 0, forms = 0;        // felt as by the minimal form
  std::string idle{};                      // parts that did nothing
  bool seen = false;         // the scene has a camera: its pictures hide the cost of the other parts
  std::int64_t touched = 0;  // ticks, of the minimal form
  // Sum of the costs of all parts but the camera, measured one at a time, over their cost together; its
  // standard error.
  double explained = kUnset, doubt = kUnset;
};

// Raw mj_step of the scene's model, from the state of the physics half-way through the run.
double raw_over(const BenchContext& context, const std::string& scene, double seconds) {
  Form form(context, scene, {}, seconds);
  sim::Physics& physics = form.world().physics();
  const int whole = static_cast<int>(seconds / kTick);
  form.run(whole / 2);
  const auto state = physics.save();
  const double step = physics.model()->opt.timestep;
  const auto steps = static_cast<int>(std::lround(kChunk * kTick / step));
  Form other(context, scene, {}, seconds);
  other.run(whole / 2 - 20 * kChunk);
  const Race race(36, {[&] { other.run(kChunk); },
                       [&] {
                         physics.restore(state);
                         for (int i = 0; i < steps; ++i) mj_step(physics.model(), physics.data());
                       }});
  return race.ratio(0, 1);
}

// The core receives a surface from the display, but the surface does not change the force: that is equal.
bool equal(const Form& form, const Form& minimal) {
  if (form.has(Part::display)) return form.bits().felt == minimal.bits().felt;
  return form.bits() == minimal.bits();
}

// Forms of one scene, each a chunk of ticks in turn: minimal, with all of some parts, with each of them.
class Rivals {
 public:
  Rivals(const BenchContext& context, const std::string& scene, const std::vector<std::vector<Part>>& forms,
         int chunks) {
    std::vector<std::function<void()>> ways;
    for (const std::vector<Part>& with : forms) {
      forms_.push_back(std::make_unique<Form>(context, scene, with, (chunks + 1) * kChunk * kTick + 1.0));
      ways.emplace_back([form = forms_.back().get()] { form->run(kChunk); });
    }
    race_.emplace(static_cast<std::size_t>(chunks), ways);
  }
  [[nodiscard]] double minimal() const { return race_->seconds(0) / kChunk; }  // s for each tick
  [[nodiscard]] double more(std::size_t form) const { return race_->more(form, 0) / kChunk; }
  [[nodiscard]] double ratio(std::size_t form) const { return race_->ratio(form, 0); }
  [[nodiscard]] int elements(std::size_t form) const { return forms_[form]->elements(); }
  // Sum of the parts' costs measured one at a time, over their cost together.
  [[nodiscard]] double explained() const {
    double singly = 0.0;
    for (std::size_t form = 2; form < forms_.size(); ++form) singly += race_->more(form, 0);
    return singly / race_->more(1, 0);
  }
  // The standard error of explained(), or a little more if chunks were disturbed. All forms of a round are
  // compared with one minimal form, so it is computed from what is left of the round.
  [[nodiscard]] double doubt() const {
    const double ratio = explained();
    std::vector<double> left;
    for (std::size_t round = 0; round < race_->rounds(); ++round) {
      const double minimal = race_->spent(0, round);
      left.push_back(-ratio * (race_->spent(1, round) - minimal));
      for (std::size_t form = 2; form < forms_.size(); ++form)
        left.back() += race_->spent(form, round) - minimal;
    }
    return trimmed_mean(left).doubt / std::abs(race_->more(1, 0));
  }
  void judge(Costs& costs) const {
    costs.touched = forms_.front()->touched();
    costs.forms += forms_.size();
    for (const auto& form : forms_) {
      costs.equal += equal(*form, *forms_.front()) ? 1 : 0;
      for (const Part part : form->idle(*forms_.front()))
        if (costs.idle.find(name_of(part)) == std::string::npos)
          costs.idle += fmt::format(" {}", name_of(part));
    }
  }

 private:
  std::vector<std::unique_ptr<Form>> forms_;
  std::optional<Race> race_;
};

// The camera races apart: its pictures evict the other forms' data from the processor's caches.
Costs costs_of(const BenchContext& context, const std::string& scene) {
  Costs costs{scene};
  costs.parts = left_out(context, scene);
  std::vector<Part> unseen = costs.parts;
  std::erase(unseen, Part::camera);
  std::vector<std::vector<Part>> forms{{}, unseen};
  for (const Part part : unseen) forms.push_back({part});
  costs.seen = load_scene(context, scene).scene.camera.has_value();
  const int chunks = costs.seen ? 12 : 120;
  const Rivals small(context, scene, forms, chunks);
  small.judge(costs);
  costs.explained = small.explained();
  costs.doubt = small.doubt();
  costs.minimal = small.minimal();
  costs.everything = costs.minimal + small.more(1);
  costs.ratio = small.ratio(1);
  costs.elements = small.elements(0);
  costs.all_elements = small.elements(1);
  std::size_t next = 2;
  for (const Part part : costs.parts)
    costs.each.push_back(part == Part::camera ? kUnset : small.more(next++));
  const auto camera = std::find(costs.parts.begin(), costs.parts.end(), Part::camera);
  if (camera == costs.parts.end()) return costs;
  const Rivals seen(context, scene, {{}, costs.parts, {Part::camera}}, context.quick ? 8 : 24);
  seen.judge(costs);
  costs.everything = costs.minimal + seen.more(1);
  costs.ratio = seen.ratio(1);
  costs.all_elements = seen.elements(1);
  costs.each[static_cast<std::size_t>(camera - costs.parts.begin())] = seen.more(2);
  return costs;
}

// The scene's row of the table: times in us for each tick.
std::vector<std::string> row_of(const Costs& costs) {
  std::vector<std::string> row{costs.scene, fixed(costs.minimal * 1e6, 2), fixed(costs.everything * 1e6, 2),
                               fixed(costs.ratio, 2)};
  for (const Part part : kParts) {
    const auto at = std::find(costs.parts.begin(), costs.parts.end(), part);
    row.push_back(at == costs.parts.end()
                      ? "-"
                      : fixed(costs.each[static_cast<std::size_t>(at - costs.parts.begin())] * 1e6, 2));
  }
  row.push_back(costs.seen ? "-" : fixed(costs.explained * 100.0, 0));
  row.push_back(fmt::format("{} of {}", costs.elements, costs.all_elements));
  return row;
}

void judge_scene(Bench& bench, const Costs& costs) {
  std::string name = costs.scene;
  std::replace(name.begin(), name.end(), '/', '.');
  bench.figure(name + ".equal", static_cast<double>(costs.equal), "",
               exactly(static_cast<double>(costs.forms)),
               "forms in which all that is felt and commanded has the same bits, and without a display all "
               "that the core knows");
  bench.figure(name + ".idle", costs.idle.empty() ? 0.0 : 1.0, "", exactly(0.0),
               costs.idle.empty() ? "parts that were switched on and did nothing" : "idle:" + costs.idle);
  if (costs.seen)
    bench.figure(name + ".touched.count", static_cast<double>(costs.touched), "", at_least(1.0),
                 "ticks at which something was touched");
  bench.cost(name + ".everything_over_minimal.cpu", costs.ratio, "x");
  if (costs.seen) return;
  bench.cost(name + ".parts_over_difference", costs.explained, "x",
             fmt::format("what the parts but the camera cost one at a time over what they cost together; "
                         "standard error {:.1f} %",
                         costs.doubt * 100.0));
}

void run(Bench& bench) {
  Table table{"scenes",
              "What each part that a scene leaves out would cost, us for each tick",
              {"scene", "as it ships", "everything", "times"}};
  for (const Part part : kParts) table.columns.emplace_back(name_of(part));
  table.columns.insert(table.columns.end(), {"sum of parts (%)", "MuJoCo elements"});
  table.printed = true;
  const std::vector<std::string> all = scenes(bench.context);
  for (const std::string& scene : all) {
    bench.progress(static_cast<double>(table.rows.size()) / static_cast<double>(all.size()));
    const Costs costs = costs_of(bench.context, scene);
    table.rows.push_back(row_of(costs));
    judge_scene(bench, costs);
  }
  bench.cost("plane.tick_over_mj_step", raw_over(bench.context, "plane", 16.0), "x",
             "the whole tick over MuJoCo's step of the same model alone");
  table.note =
      "As it ships: devices, physics and core alone, without what `run` counts. The camera is the rig's own, "
      "with vision, beside the tracker that the scene has. Of a scene that a camera looks at the times are "
      "those of its pictures; what is asked of it is that the results are equal.";
  bench.table(std::move(table));
}

const Reads kReads{"ablation", {.scenes = {"*"}}};
const Entry kEntry{"ablation", "all", "what each scene leaves out: same results, and what it would have cost",
                   run};

}  // namespace
}  // namespace enc::bench::ablation
