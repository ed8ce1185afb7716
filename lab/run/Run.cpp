#include "lab/run/Run.hpp"

#include <algorithm>
#include <cmath>
#include <exception>
#include <filesystem>
#include <fstream>
#include <iomanip>
#include <iostream>
#include <sstream>
#include <utility>

#include "lab/fast/Energy.hpp"
#include "lab/methods/Methods.hpp"
#include "lab/run/Terminal.hpp"
#include "lab/scenes/Acting.hpp"
#include "lab/scenes/Interrupt.hpp"
#include "lab/scenes/NetFile.hpp"
#include "lab/scenes/Warnings.hpp"
#include "lab/stability/StepLimit.hpp"
#include "lab/stepping/Checkpoint.hpp"
#include "lab/stepping/Trial.hpp"

namespace lab {

Run::Run(Scene& scene, const Options& o)
    : scene_(scene),
      o_(o),
      progress_(o.quiet),
      observer_(scene),
      frames_({{FrameFormat::vtp, o.vtp}, {FrameFormat::ply, o.ply}},
              o.frame_rate, scene),
      rows_(scene.stepper(),
            [this](const std::string& row) { write_csv(row), ++written_; }) {
  if (!o.csv.empty() || !o.checkpoint.empty() || !o.restart.empty())
    scene_.stepper().follow_drag();
  if (!o.bounds_error && !o.rest) scene_.watch(o.model.t_end);
  if (!o.out.empty()) out_.emplace(o.out);
  if (const auto quads = quads_beside(o.out); !quads.empty())
    quads_.emplace(quads);
  if (!o.checkpoint.empty())
    archive_scene(scene_as_made_, o.model, scene.cloth());
  if (o.restart.empty())
    start();
  else
    load();
}

void Run::start() {
  progress_ = Progress(o_.quiet);
  observer_.restart();
  seconds_ = next_checkpoint_ = 0, first_step_ = 0;
  rows_.clear(), written_ = 0;
  judged_ = false;
  frames_.restart();
  frames_.add(scene_);
  if (!o_.csv.empty()) begin_csv();
  add_row();
}

void Run::restart() {
  scene_.restart();
  told_ = false;
  start();
}

bool Run::done() const { return interrupted() || scene_.done(o_.model.t_end); }
bool Run::cut_short() const {
  return interrupted() && !scene_.done(o_.model.t_end);
}

void Run::check() {
  scene_.check();
  tell_failure();
}

void Run::advance(int most) {
  scene_.steps_at_once(most, o_.model.t_end);
  look();
}

/** How many steps there are until something is written. */
int Run::steps_to_write() const {
  const bool any_step = !frames_.empty() || o_.model.measure.over_time() ||
                        (!o_.checkpoint.empty() && o_.every_seconds == 0);
  if (any_step) return 1;
  return int(std::min<long long>(o_.every - scene_.steps() % o_.every,
                                 Stepper::guard_interval));
}

void Run::to_end(const std::function<void()>& after) {
  while (!done()) {
    advance(after ? 1 : steps_to_write());
    if (after) after();
  }
  check();
}

/** After each step. */
void Run::look() {
  if (observer_.looks()) observer_.look();
  const bool at_end = scene_.done(o_.model.t_end);
  if (csv_ && (at_end || scene_.steps() % o_.every == 0)) scene_.check();
  seconds_ = progress_.seconds();
  tell_failure();
  if (scene_.steps() % o_.every == 0 || at_end) add_row();
  if (at_end || frames_.due(scene_)) add_frame();
  if (!missed_ && scene_.watched().count() > 0)
    missed_ = true, warn(scene_.missed_text());
  if (!told_ && progress_.due()) show_progress();
  if (!o_.checkpoint.empty() && seconds_ >= next_checkpoint_ && scene_.check())
    save();
}

void Run::show_progress() {
  using CME212::short_text;
  const double t = scene_.time(), t_end = o_.model.t_end,
               rate = double(scene_.steps() - first_step_) / seconds_;
  progress_.show("t = " + short_text(t) + " of " + short_text(t_end) + " s, " +
                     short_text(std::round(rate)) + " steps/s",
                 t / t_end);
}

void Run::announce() {
  if (o_.quiet) return;
  const Net& mesh = scene_.mesh().mesh;
  if (o_.verbose)
    for (const auto& line : what_acts(o_.model, scene_.cloth(), mesh))
      say(std::cout, line);
  const std::string_view method = scene_.method().name;
  const double dt = scene_.dt();
  const auto [limit, since] = scene_.control()
                                  ? Scene::Limit{scene_.safe_limit()}
                                  : scene_.least_limit();
  const bool sharp = scene_.stepper().time_step().rule == StepRule::sharp;
  std::ostringstream out;
  out.precision(3);
  out << "dt = " << dt << " s";
  if (sharp) {
    out << " at first; auto:sharp takes " << CME212::percent(sharp_share)
        << " of the stability limit in the present configuration, at most "
        << limit << " s, the limit in any (" << method << ')';
  } else if (scene_.method().adaptive) {
    out << ": " << method << " chooses its inner steps by their error";
    if (const double t = o_.model.step.tolerance; t > 0)
      out << ", below " << t << " m per inner step, for " << o_.model.tolerance
          << " m at the end";
  } else if (limit == no_limit) {
    const double verlet = scene_.safe_limit(table::verlet);
    out << ": " << method << " has no stability limit";
    if (std::isfinite(verlet))
      out << "; this is " << dt / verlet
          << " times the stability limit of verlet (" << verlet << " s)";
  } else if (limit > 0) {
    out << ": " << CME212::percent(dt / limit) << " of the stability limit ("
        << limit << " s, " << method << ')';
    if (since > 0) out << " from t = " << since << " s on";
  } else {
    out << ": no step is stable with " << method << " and no drag";
  }
  if (scene_.control())
    out << "; afterwards adapted to the energy balance: gain of at most "
        << CME212::percent(o_.model.step.gain) << " of the energy of motion";
  if (first_step_ > 0)
    std::cout << o_.restart << ": continues at t = " << scene_.time() << " s\n";
  say(std::cout, out.str());
  if (first_step_ == 0)  // they are about the cloth as it was made
    for (const auto& w : warnings(o_.model, mesh, scene_.cloth(), dt)) warn(w);
  if (const double work = scene_.flow().work; first_step_ == 0 && work > 0)
    warn("at t = 0 the obstacles give " + CME212::short_text(work) +
         " J to the cloth, which counts as their work");
  if (scene_.method().multirate && limit <= scene_.safe_limit(table::verlet))
    warn(std::string(method) +
         " finds no stiff springs here: use --method verlet, which does the "
         "same");
  warn_of_length();
}

void Run::warn(const std::string& text) {
  if (o_.quiet) return;
  say(std::cerr, "cloth: warning: " + text);
  warnings_.push_back(text);
}

/** Warn of a run of hours, by its steps and what they cost. */
void Run::warn_of_length() {
  using CME212::two_digits;
  const double steps = (o_.model.t_end - scene_.time()) / scene_.dt();
  const double seconds = scene_.work_of(steps) / Scene::trial_work;
  constexpr double hour = 3600, year = 365.25 * 24 * hour;  // [s]
  if (seconds > hour)
    warn(two_digits(steps) + " steps of this dt take about " +
         (seconds > year ? two_digits(seconds / year) + " years"
                         : two_digits(seconds / hour) + " hours") +
         ": shorten --t-end, or soften the springs");
}

int Run::finish() {
  progress_.end();
  std::exception_ptr error;
  auto write = [&error](auto how) {
    try {
      how();
    } catch (const std::runtime_error&) {
      if (!error) error = std::current_exception();
    }
  };
  if (!o_.checkpoint.empty() && !scene_.failure())
    write([this] {
      save();
      wrote("checkpoint " + o_.checkpoint);
    });
  rows_.finish();
  if (csv_)
    write([this] {
      csv_->commit();
      wrote(o_.csv + " (" + CME212::count_of(std::size_t(written_), "row") +
            ')');
    });
  if (out_)
    write([this] {
      write_mesh();
      wrote(o_.out);
    });
  write([this] {
    add_frame();  // of a run that is cut short
    for (const std::string& what : frames_.finish()) {
      if (!o_.quiet) say(std::cout, what);
      wrote(what);
    }
  });
  if (error) std::rethrow_exception(error);
  if (cut_short()) tell_interrupt();
  if (!o_.quiet && !o_.rest) {
    print_summary();
    tell_work();
    if (scene_.control()) tell_steps(*scene_.control());
    if (const Verdict* said = verdict())
      say(std::cout, said->text());
    else if (!scene_.failure() && !o_.bounds_error)
      std::cout << "not compared with half of dt\n";
    if (scene_.changes_left() > 0)
      warn(CME212::count_of(scene_.changes_left(), "change") +
           " would come after the end");
  }
  if (scene_.failure() || !judge()) return 3;
  return cut_short() ? 128 + interrupted() : 0;
}

void Run::wrote(const std::string& what) {
  kept_ += (kept_.empty() ? "" : ", ") + what;
}

void Run::begin_csv() {
  csv_.emplace(o_.csv);
  csv_sum_ = 0;
  write_csv(
      "t,kinetic,elastic,gravitational,total,com_x,com_y,com_z,nodes,edges,"
      "work,drag,balance,evaluations" +
      columns_of(o_.model.measure) + '\n');
}

void Run::write_csv(const std::string& text) {
  csv_->stream() << text;
  csv_sum_ = crc64(text, csv_sum_);
}

/** The state of the run besides that of the scene. */
void Run::archive(Archive& a) {
  std::string asked = name_of(o_.model.measure);
  a(asked)(observer_);
  if (asked != name_of(o_.model.measure) &&
      (o_.model.measure.over_time() || !o_.csv.empty()))
    throw SceneError("measure", "is " + name_of(o_.model.measure) +
                                    ", but the run until "
                                    "the checkpoint was asked for " +
                                    asked);
  a(written_)(missed_).require(written_ >= 0);
  rows_.archive(a);
}

/** Write a checkpoint; before it the rows so far, so that these are there for
 * whoever goes on from it. */
void Run::save() {
  if (csv_) csv_->commit_copy();
  Archive a = scene_as_made_;
  std::uint64_t length = csv_ ? std::uint64_t(csv_->stream().tellp()) : 0;
  a(length)(csv_sum_);
  archive(a);
  scene_.archive(a);
  write_checkpoint(o_.checkpoint, a);
  next_checkpoint_ = progress_.seconds() + o_.every_seconds;
}

void Run::load() {
  Archive a = read_checkpoint(o_.restart);
  std::uint64_t length = 0, sum = 0;
  try {
    archive_scene(a, o_.model, scene_.cloth());
    a(length)(sum);
    archive(a);
    scene_.archive(a);
    if (!a.at_end()) throw std::runtime_error("has data after its end");
  } catch (const SceneError&) {
    throw;
  } catch (const std::runtime_error& e) {
    throw std::runtime_error(o_.restart + ": " + e.what());
  }
  if (const double t = scene_.time(), end = o_.model.t_end;
      t > end * (1 + 1e-9))
    throw SceneError("t-end", "is " + CME212::short_text(end) + ", but " +
                                  o_.restart +
                                  " was saved at t = " + CME212::short_text(t) +
                                  " s, expected at least that");
  first_step_ = scene_.steps();
  next_checkpoint_ = o_.every_seconds;
  frames_.add(scene_);
  if (o_.csv.empty()) return rows_.clear();
  if (std::filesystem::is_regular_file(o_.csv))
    go_on_with_csv(length, sum);
  else
    begin_csv(), written_ = 0;
}

/** Take over the first @a length bytes of the CSV file that is there, if they
 * have the checksum @a sum.  Throws std::runtime_error: another file. */
void Run::go_on_with_csv(std::uint64_t length, std::uint64_t sum) {
  std::ifstream in(o_.csv, std::ios::binary);
  std::string before(
      std::min<std::uint64_t>(length, std::filesystem::file_size(o_.csv)),
      '\0');
  in.read(before.data(), std::streamsize(before.size()));
  if (length == 0 || !in || before.size() < length || crc64(before) != sum)
    throw std::runtime_error(
        o_.csv +
        ": its first rows are not those of the run until the checkpoint " +
        o_.restart + ", expected the CSV file of that run, or no file");
  csv_.emplace(o_.csv);
  write_csv(before);
}

void Run::add_frame() {
  if (frames_.empty()) return;
  check();
  frames_.add(scene_);
}

/** Write the nodes of the mesh that are left and, beside them, its quads, so
 * that they can be read again; or net_left() into FILE.net. */
void Run::write_mesh() {
  const BuiltMesh& built = scene_.mesh();
  if (CME212::ending_of(o_.out) == ".net") {
    write_net(out_->stream(), net_left(scene_.cloth(), built, scene_.held()));
  } else {
    const Net left = mesh_left(scene_.cloth(), built);
    write_nodes(out_->stream(), left);
    if (quads_) write_quads(quads_->stream(), left);
  }
  out_->commit();
  if (quads_) quads_->commit();
}

void Run::add_row() {
  if (!csv_ || rows_.has_present()) return;
  const Cloth& g = scene_.cloth();
  const Energies e = scene_.energy();
  const Point c = center_of_mass(g);
  std::string row;
  for (double a : {scene_.time(), e.kinetic, e.elastic, e.gravitational,
                   e.total(), double(c.x), double(c.y), double(c.z)})
    row += CME212::to_text(a) + ',';
  row += std::to_string(g.num_nodes()) + ',' + std::to_string(g.num_edges());
  const EnergyFlow& flow = scene_.flow();
  for (double a : {flow.work, flow.drag, scene_.stepper().drift(e)})
    row += ',' + CME212::to_text(a);
  row += ',' + std::to_string(scene_.evaluations());
  if (!columns_of(o_.model.measure).empty())
    for (double a : lab::answer(scene_)) row += ',' + CME212::to_text(a);
  rows_.add(row + '\n');
}

void Run::tell_failure() {
  if (told_ || !scene_.failure()) return;
  told_ = true;
  progress_.end();
  const Explanation why = scene_.explanation();
  tell(why.cause, why.remedy);
  say(std::cerr, "place: " + why.place);
}

/** Say @a what is wrong and what helps, with the command for it. */
void Run::tell(const std::string& what, const std::string& remedy) const {
  say(std::cerr, "cloth: " + what);
  say(std::cerr, "cure: " + remedy);
  // A run that goes on from a checkpoint has no command from the start.
  if (remedy == Explanation::interrupted || !o_.restart.empty()) return;
  const Diagnosis& d = scene_.diagnosis();
  if (d.cure)
    say(std::cerr, command_with(o_.words, d.cure->options(d.run.method)));
}

void Run::tell_interrupt() const {
  using CME212::short_text;
  say(std::cerr,
      std::string("cloth: ") + name_of_interrupt() +
          " ended the run at t = " + short_text(scene_.time()) + " s of " +
          short_text(o_.model.t_end) + " s; kept: " +
          (kept_.empty() ? "nothing, as no output was requested" : kept_));
}

void Run::print_summary() const {
  const Energies e = scene_.energy();
  std::ostringstream out;
  out << std::setprecision(3) << scene_.model().name << ": " << scene_.steps()
      << " steps to t = " << scene_.time() << " s in " << seconds_
      << " s; energy " << e.total() << " J = " << e.kinetic << " kinetic + "
      << e.elastic << " elastic + " << e.gravitational << " gravitational; "
      << scene_.cloth().num_nodes() << " nodes and "
      << scene_.cloth().num_edges() << " edges left";
  say(std::cout, out.str());
}

/** Print the cost of the run in numbers that are the same on every machine. */
void Run::tell_work() const {
  using CME212::count_of;
  std::string text =
      count_of(std::size_t(scene_.evaluations()), "force evaluation");
  const Work w = scene_.stepper().work();
  for (const auto& [count, what] :
       {std::pair(w.inner, "inner step"), std::pair(w.newton, "linear system"),
        std::pair(w.products, "matrix product"),
        std::pair(w.factors, "Cholesky factor")})
    if (count > 0) text += ", " + count_of(std::size_t(count), what);
  say(std::cout, "work: " + text);
}

/** What half of the step shows; null if it was not tried. */
const Verdict* Run::verdict() const {
  const Witness* const witness = scene_.witness();
  if (!witness) return nullptr;
  if (witness->said() || scene_.failure() || interrupted())
    return witness->said();
  try {
    witness->verdict(&observer_);
  } catch (const Interrupted&) {  // it was not compared
  }
  return witness->said();
}

static std::string gain_text(const StepControl& c) {
  std::ostringstream out;
  out << std::setprecision(3) << "energy gain " << c.state().gain
      << " J, at most " << c.tolerance() << " J tolerated";
  return out.str();
}

bool Run::judge() {
  const Verdict* const said = verdict();
  // Of steps that are chosen, StepControl tells what it tolerates: a warning is
  // enough.
  const bool wrong = said && said->wrong() && !scene_.control();
  if (said && !std::exchange(judged_, true)) {
    if (wrong) {
      std::string text = said->wrong_text();
      try {
        text += "; " + scene_.diagnosis().cause_text();
      } catch (const Interrupted&) {  // remedy() says so
      }
      warnings_.push_back(text + "; " + scene_.remedy());
      tell(text, scene_.remedy());
    } else if (!o_.quiet && !said->fine()) {
      const std::string text =
          said->wrong() ? said->wrong_text() : said->difference();
      warnings_.push_back(text + "; " + scene_.remedy());
      tell("warning: " + text, scene_.remedy());
    }
  }
  return !wrong;
}

void Run::tell_steps(const StepControl& c) const {
  const auto& r = c.report();
  std::ostringstream out;
  out << std::setprecision(3) << "dt from " << r.shortest << " to " << r.longest
      << " s: shortened " << r.shortened << " times, lengthened "
      << r.lengthened << " times, " << r.taken_back << " steps taken back; ";
  say(std::cout, out.str() + gain_text(c));
}

}  // namespace lab
