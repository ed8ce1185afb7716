#include "lab/fast/ConstraintPlan.hpp"

#include <algorithm>
#include <cmath>

#include "lab/fast/Energy.hpp"
#include "lab/fast/FlatCloth.hpp"
#include "lab/fast/GraphArrays.hpp"
#include "lab/fast/OrderedCloth.hpp"

namespace lab {

std::optional<Point> first_hit(const Ball& ball, const Point& from,
                               const Point& to) {
  if (ball.holds(from) || ball.holds(to)) return std::nullopt;
  const Point way = to - from, start = from - ball.center;
  // |start + s way| = radius, of the two s the smaller one
  const double a = normSq(way), b = dot(start, way);
  const double c = normSq(start) - ball.radius * ball.radius;
  const double root = b * b - a * c;
  if (!(root > 0) || b >= 0 || -b >= a) return std::nullopt;
  const Point on = start + (c / (-b + std::sqrt(root))) * way;
  return ball.center + (1 - 1e-9) * on;
}

PinnedNodes::PinnedNodes(const std::vector<PinConstraint::Pin>& pins)
    : pins_(pins) {
  std::ranges::sort(pins_, {}, &PinConstraint::Pin::node);
}

/** Call @a use(pin) for those with ids in [first, last). */
template <typename Use>
void PinnedNodes::each_of_part(const Cloth& g, unsigned first, unsigned last,
                               Use use) const {
  // Nodes of a graph are ordered by id; removed ones can't tell theirs.
  while (first < last && !arrays(g).node_in_use(first)) ++first;
  if (first == last) return;
  auto pin = std::ranges::lower_bound(pins_, arrays(g).node_with_id(first), {},
                                      &PinConstraint::Pin::node);
  for (; pin != pins_.end(); ++pin) {
    if (!g.has_node(pin->node)) continue;
    if (pin->node.id() >= last) return;
    use(*pin);
  }
}

void PinnedNodes::project(Cloth& g, double t, unsigned first,
                          unsigned last) const {
  each_of_part(g, first, last, [&, by = moved(t)](const auto& pin) {
    Node n = pin.node;
    n.position() = pin.place + by.at;
    n.value().vel = by.velocity;
  });
}

void PinnedNodes::project_flat(FlatCloth& c, Cloth& g, double t, unsigned first,
                               unsigned last) const {
  each_of_part(g, first, last, [&, by = moved(t)](const auto& pin) {
    c.set_position(pin.node.id(), pin.place + by.at);
    c.set_velocity(pin.node.id(), by.velocity);
  });
}

void PinnedNodes::each_place(const Cloth& g, double t,
                             const PlaceVisitor& use) const {
  const Place by = moved(t);
  for (const auto& pin : pins_)
    if (g.has_node(pin.node)) use(pin.node, {pin.place + by.at, by.velocity});
}

bool SweptConstraint::idle(const FlatCloth& c, double t, unsigned first,
                           unsigned last) const {
  const auto where = zone(t);
  return where && !c.any_inside(*where, first, last);
}

void SweptConstraint::project_flat(FlatCloth& c, Cloth& g, double t,
                                   unsigned first, unsigned last) const {
  for (; first < last; first += FlatCloth::tile) {
    const unsigned end = std::min(first + FlatCloth::tile, last);
    if (idle(c, t, first, end)) continue;
    c.write(g, first, end);
    project(g, t, first, end);
    c.read_nodes(g, first, end);
  }
}

void SweptConstraint::apply_flat(FlatCloth& c, Cloth& g, double t) const {
  c.write(g);
  (*this)(g, t);
  c.take(g);
}

namespace {

// The course's constraints as swept ones.

class Plane final : public NodewiseConstraint {
 public:
  explicit Plane(const PlaneConstraint& c) : plane_(c) {}
  void project(Cloth& g, double /*t*/, unsigned first,
               unsigned last) const override {
    const double z = plane_.z;
    for_each_violating(
        g, first, last, [z](const Point& p) { return p.z < z; },
        [this](Node n) { plane_.project(n); });
  }
  bool is_at_rest(double /*t*/) const override { return true; }
  std::optional<Zone> zone(double /*t*/) const override {
    return Zone::behind({0, 0, plane_.z}, {0, 0, 1});
  }

 private:
  PlaneConstraint plane_;
};

/** A sphere or a ball that tears: both can be tunnelled through. */
template <typename Base>
class Round : public Base {
 public:
  explicit Round(const Ball& ball) : ball_(ball) {}
  std::optional<Point> first_hit(const Point& from,
                                 const Point& to) const override {
    return lab::first_hit(ball_, from, to);
  }
  double thinnest() const override { return ball_.radius; }
  bool is_at_rest(double /*t*/) const override { return true; }
  std::optional<Zone> zone(double /*t*/) const override {
    return Zone::inside(ball_);
  }

 protected:
  Ball ball_;
};

class Sphere final : public Round<NodewiseConstraint> {
 public:
  explicit Sphere(const SphereConstraint& c) : Round(c.ball), sphere_(c.ball) {}
  void project(Cloth& g, double /*t*/, unsigned first,
               unsigned last) const override {
    for_each_violating(
        g, first, last, [this](const Point& p) { return ball_.holds(p); },
        [this](Node n) { sphere_.project(n); });
  }

 private:
  SphereConstraint sphere_;
};

/** What removes nodes, and adds up their moment. */
class Removing : public SweptConstraint {
 public:
  Exchange exchange() const override { return {0, moment_}; }
  void archive(Archive& a) const override {
    a(moment_).require(std::isfinite(moment_));
  }

 protected:
  mutable double moment_ = 0;
};

class Tear final : public Round<Removing> {
 public:
  explicit Tear(const TearConstraint& c) : Round(c.ball) {}
  void operator()(Cloth& g, double /*t*/) const override {
    for_each_violating(
        g, 0, arrays(g).node_slots(),
        [this](const Point& p) { return ball_.holds(p); },
        [&](Node n) {
          moment_ += n.value().mass * n.position().z;
          g.remove_node(n);
        });
  }
  void apply_flat(FlatCloth& c, Cloth& g, double t) const override {
    if (!this->idle(c, t, 0, c.slots())) SweptConstraint::apply_flat(c, g, t);
  }
};

/** A constraint of an unknown class: it is called. */
class Called final : public Removing {
 public:
  explicit Called(std::shared_ptr<const ZeroConstraint> c) : c_(std::move(c)) {}
  void operator()(Cloth& g, double t) const override {
    const auto version = arrays(g).version();
    const double before = moment_of(g);
    (*c_)(g, t);
    if (arrays(g).version() != version) moment_ += before - moment_of(g);
  }
  bool is_at_rest(double /*t*/) const override { return true; }

 private:
  std::shared_ptr<const ZeroConstraint> c_;

  static double moment_of(const Cloth& g) { return gravitational_energy(g, 1); }
};

}  // namespace

ConstraintPlan::ConstraintPlan(const ZeroConstraint& c) {
  add(std::shared_ptr<const ZeroConstraint>(std::shared_ptr<void>(), &c));
}

void ConstraintPlan::add(std::shared_ptr<const ZeroConstraint> constraint) {
  const ZeroConstraint& c = *constraint;
  if (auto all = exactly<CombinedConstraints, FunctionConstraint>(c)) {
    for (const auto& part : all->parts) add(part);
  } else if (auto pins = exactly<PinConstraint, FunctionConstraint>(c)) {
    terms_.push_back(std::make_shared<PinnedNodes>(pins->pins));
  } else if (auto floor = exactly<PlaneConstraint, FunctionConstraint>(c)) {
    terms_.push_back(std::make_shared<Plane>(*floor));
  } else if (auto ball = exactly<SphereConstraint, FunctionConstraint>(c)) {
    terms_.push_back(std::make_shared<Sphere>(*ball));
  } else if (auto tear = exactly<TearConstraint, FunctionConstraint>(c)) {
    terms_.push_back(std::make_shared<Tear>(*tear));
  } else if (auto swept =
                 std::dynamic_pointer_cast<const SweptConstraint>(constraint)) {
    terms_.push_back(std::move(swept));
  } else if (!exactly<ZeroConstraint, FunctionConstraint>(c)) {
    terms_.push_back(std::make_shared<Called>(std::move(constraint)));
  }
}

void ConstraintPlan::operator()(Cloth& g, double t) const {
  const auto version = arrays(g).version();
  for (const auto& term : terms_) (*term)(g, t);
  if (arrays(g).version() != version) restore_order(g);
}

bool ConstraintPlan::nodewise() const {
  return std::ranges::all_of(terms_,
                             [](const auto& c) { return c->nodewise(); });
}

void ConstraintPlan::project(Cloth& g, double t, unsigned first,
                             unsigned last) const {
  for (const auto& term : terms_) term->project(g, t, first, last);
}

void ConstraintPlan::project_flat(FlatCloth& c, Cloth& g, double t,
                                  unsigned first, unsigned last) const {
  for (const auto& term : terms_) term->project_flat(c, g, t, first, last);
}

void ConstraintPlan::apply_flat(FlatCloth& c, Cloth& g, double t) const {
  const auto version = arrays(g).version();
  for (const auto& term : terms_)
    if (term->nodewise())
      term->project_flat(c, g, t, 0, c.slots());
    else
      term->apply_flat(c, g, t);
  if (arrays(g).version() == version) return;
  restore_order(g);
  if (c.version() != arrays(g).version()) c.write(g), c.take(g);
}

bool ConstraintPlan::project_alone(FlatCloth& c, Cloth& g, double t,
                                   unsigned first, unsigned last) const {
  return std::ranges::all_of(terms_, [&](const auto& term) {
    return term->project_alone(c, g, t, first, last);
  });
}

void ConstraintPlan::each_place(const Cloth& g, double t,
                                const PlaceVisitor& use) const {
  for (const auto& term : terms_) term->each_place(g, t, use);
}

double ConstraintPlan::next_velocity_jump(double t) const {
  double first = std::numeric_limits<double>::infinity();
  for (const auto& term : terms_)
    first = std::min(first, term->next_velocity_jump(t));
  return first;
}

void ConstraintPlan::each_held(const Cloth& g, const NodeVisitor& use) const {
  each_place(g, 0, [&use](Node n, const Place&) { use(n); });
}
void ConstraintPlan::place_held_at_rest(Cloth& g, double t) const {
  each_place(g, t, [](Node n, const Place& place) {
    n.position() = place.at, n.value().vel = Point();
  });
}
void ConstraintPlan::set_held_velocities(Cloth& g, double t) const {
  each_place(
      g, t, [](Node n, const Place& place) { n.value().vel = place.velocity; });
}

std::optional<Point> ConstraintPlan::first_hit(const Point& from,
                                               const Point& to) const {
  std::optional<Point> first;
  for (const auto& term : terms_)
    if (auto place = term->first_hit(from, to);
        place && (!first || norm(*place - from) < norm(*first - from)))
      first = place;
  return first;
}

double ConstraintPlan::thinnest() const {
  double least = std::numeric_limits<double>::infinity();
  for (const auto& term : terms_) least = std::min(least, term->thinnest());
  return least;
}

bool ConstraintPlan::is_at_rest(double t) const {
  return std::ranges::all_of(
      terms_, [t](const auto& term) { return term->is_at_rest(t); });
}

Exchange ConstraintPlan::exchange() const {
  Exchange all;
  for (const auto& term : terms_) all += term->exchange();
  return all;
}

void ConstraintPlan::archive(Archive& a) const {
  for (const auto& term : terms_) term->archive(a);
}

void WatchedConstraint::operator()(Cloth& g, double t) const {
  if (before_.empty()) return inner_(g, t);
  for (Node n : g.nodes()) {
    if (n.id() >= before_.size()) continue;  // added since
    auto place = inner_.first_hit(before_[n.id()], n.position());
    if (!place) continue;
    if (count_++ == 0)
      first_ = {n.index(), norm(n.position() - before_[n.id()])};
    n.position() = *place;
  }
  inner_(g, t);
  remember(g);
}

}  // namespace lab
