#include "lab/fast/ConstraintPlan.hpp"

#include <algorithm>
#include <atomic>
#include <cmath>

#include "lab/fast/Energy.hpp"
#include "lab/fast/FlatCloth.hpp"
#include "lab/fast/GraphArrays.hpp"
#include "lab/fast/OrderedCloth.hpp"

namespace lab {

std::optional<Point> first_hit(const Ball& ball, const Point& from,
                               const Point& to) {
  const Point way = to - from, start = from - ball.center;
  if (norm(start) < (1 - 1e-6) * ball.radius) return std::nullopt;
  // |start + s way| = radius, of the two s the smaller one
  const double a = normSq(way), b = dot(start, way);
  const double c = normSq(start) - ball.radius * ball.radius;
  const double root = b * b - a * c;
  if (!(root > 0) || b >= 0 || -b >= a) return std::nullopt;
  const Point on = start + (c / (-b + std::sqrt(root))) * way;
  // One that slides along the surface, or ends below it, leaves near by.
  const bool inside = ball.holds(from) || ball.holds(to);
  if (inside && dot(on, to - ball.center) >= 0) return std::nullopt;
  return ball.center + (1 - 1e-9) * on;
}

PinnedNodes::PinnedNodes(const std::vector<PinConstraint::Pin>& pins,
                         const Motion& motion)
    : HoldingConstraint(motion), pins_(pins) {
  std::ranges::sort(pins_, {}, &PinConstraint::Pin::node);
}

void PinnedNodes::each_place(const Cloth& g, double t, unsigned first,
                             unsigned last, const PlaceVisitor& use) const {
  // Nodes of a graph are ordered by id; removed ones can't tell theirs.
  while (first < last && !arrays(g).node_in_use(first)) ++first;
  if (first == last) return;
  const Motion& motion = traits().motion;
  auto pin = std::ranges::lower_bound(pins_, arrays(g).node_with_id(first), {},
                                      &PinConstraint::Pin::node);
  for (; pin != pins_.end(); ++pin) {
    if (!g.has_node(pin->node)) continue;
    if (pin->node.id() >= last) return;
    use(pin->node,
        {motion.place_of(pin->place, t), motion.velocity_of(pin->place, t)});
  }
}

void HoldingConstraint::project(Cloth& g, double t, unsigned first,
                                unsigned last) const {
  each_place(g, t, first, last, [](Node n, const Place& place) {
    n.position() = place.at, n.value().vel = place.velocity;
  });
}

void SweptConstraint::archive(Archive& a) const {
  auto& [work, moment] = exchange_;
  a(work)(moment);
  a.require(std::isfinite(work + norm(moment)));
}

namespace {

// The course's constraints as swept ones.

Traits traits_of(const PlaneConstraint& c) {
  return {.nodewise = true, .zone = Zone::behind({0, 0, c.z}, {0, 0, 1})};
}
Traits traits_of(const SphereConstraint& c) {
  return {.nodewise = true, .zone = Zone::inside(c.ball), .obstacle = c.ball};
}
bool violates(const PlaneConstraint& c, const Point& p) { return p.z < c.z; }
bool violates(const SphereConstraint& c, const Point& p) {
  return c.ball.holds(p);
}

/** One of these. */
template <typename C>
class Projecting final : public NodewiseConstraint {
 public:
  explicit Projecting(const C& c) : NodewiseConstraint(traits_of(c)), c_(c) {}
  void project(Cloth& g, double /*t*/, unsigned first,
               unsigned last) const override {
    for_each_violating(
        g, first, last, [this](const Point& p) { return violates(c_, p); },
        [this](Node n) { c_.project(n); });
  }

 private:
  C c_;
};

class Tear final : public SweptConstraint {
 public:
  explicit Tear(const TearConstraint& c)
      : SweptConstraint({.zone = Zone::inside(c.ball), .obstacle = c.ball}),
        ball_(c.ball) {}
  void operator()(Cloth& g, double /*t*/) const override {
    for_each_violating(
        g, 0, arrays(g).node_slots(),
        [this](const Point& p) { return ball_.holds(p); },
        [&](Node n) {
          exchange_.moment += n.value().mass * n.position();
          g.remove_node(n);
        });
  }

 private:
  Ball ball_;
};

/** A constraint of an unknown class: it is called. */
class Called final : public SweptConstraint {
 public:
  explicit Called(std::shared_ptr<const ZeroConstraint> c) : c_(std::move(c)) {}
  void operator()(Cloth& g, double t) const override {
    const auto version = arrays(g).version();
    const Point before = first_moment(g);
    (*c_)(g, t);
    if (arrays(g).version() != version)
      exchange_.moment += before - first_moment(g);
  }

 private:
  std::shared_ptr<const ZeroConstraint> c_;
};

}  // namespace

void ConstraintPlan::add(std::shared_ptr<const ZeroConstraint> constraint) {
  const ZeroConstraint& c = *constraint;
  std::shared_ptr<const SweptConstraint> made;
  if (auto all = exactly<CombinedConstraints, FunctionConstraint>(c)) {
    for (const auto& part : all->parts) add(part);
  } else if (auto pins = exactly<PinConstraint, FunctionConstraint>(c)) {
    made = std::make_shared<PinnedNodes>(pins->pins);
  } else if (auto floor = exactly<PlaneConstraint, FunctionConstraint>(c)) {
    made = std::make_shared<Projecting<PlaneConstraint>>(*floor);
  } else if (auto ball = exactly<SphereConstraint, FunctionConstraint>(c)) {
    made = std::make_shared<Projecting<SphereConstraint>>(*ball);
  } else if (auto tear = exactly<TearConstraint, FunctionConstraint>(c)) {
    made = std::make_shared<Tear>(*tear);
  } else if (auto swept =
                 std::dynamic_pointer_cast<const SweptConstraint>(constraint)) {
    made = std::move(swept);
  } else if (!exactly<ZeroConstraint, FunctionConstraint>(c)) {
    made = std::make_shared<Called>(std::move(constraint));
  }
  if (!made) return;
  const auto* forwards = dynamic_cast<const ForwardingConstraint*>(made.get());
  if (forwards)
    for (const auto& leaf : forwards->inner().leaves_) leaves_.push_back(leaf);
  else
    leaves_.push_back(made);
  terms_.push_back({std::move(made), forwards});
}

const ConstraintPlan* ConstraintPlan::Term::instead() const {
  return forwards && forwards->is_inner() ? &forwards->inner() : nullptr;
}

void ConstraintPlan::operator()(Cloth& g, double t) const {
  const auto version = arrays(g).version();
  for (const Term& term : terms_) (*term.constraint)(g, t);
  if (arrays(g).version() != version) restore_order(g);
}

bool ConstraintPlan::nodewise() const {
  return std::ranges::all_of(terms_, [](const Term& term) {
    const ConstraintPlan* plan = term.instead();
    return plan ? plan->nodewise() : term.constraint->traits().nodewise;
  });
}

void ConstraintPlan::project(Cloth& g, double t, unsigned first,
                             unsigned last) const {
  for (const Term& term : terms_)
    if (const ConstraintPlan* plan = term.instead())
      plan->project(g, t, first, last);
    else
      term.constraint->project(g, t, first, last);
}

/** True only if the call of a constraint with @a traits at time @a t changes no
 * node with an id in [first, last). */
static bool is_idle(const Traits& traits, const FlatCloth& c, double t,
                    unsigned first, unsigned last) {
  if (!traits.zone) return false;
  Zone zone = *traits.zone;
  zone.at += traits.motion.way(t);
  return !c.any_inside(zone, first, last);
}

bool ConstraintPlan::apply_to_part(const Term& term, FlatCloth& c, Cloth& g,
                                   double t, unsigned first, unsigned last) {
  if (const ConstraintPlan* plan = term.instead())
    return plan->apply_to_part(c, g, t, first, last);
  const Traits& traits = term.constraint->traits();
  if (!traits.nodewise) return is_idle(traits, c, t, first, last);
  if (traits.holds) {
    term.constraint->each_place(g, t, first, last,
                                [&c](Node n, const Place& place) {
                                  c.set_position(n.id(), place.at);
                                  c.set_velocity(n.id(), place.velocity);
                                });
    return true;
  }
  for (; first < last; first += FlatCloth::tile) {
    const unsigned end = std::min(first + FlatCloth::tile, last);
    if (is_idle(traits, c, t, first, end)) continue;
    c.write(g, first, end);
    term.constraint->project(g, t, first, end);
    c.read_nodes(g, first, end);
  }
  return true;
}

bool ConstraintPlan::apply_to_part(FlatCloth& c, Cloth& g, double t,
                                   unsigned first, unsigned last) const {
  return std::ranges::all_of(terms_, [&](const Term& term) {
    return apply_to_part(term, c, g, t, first, last);
  });
}

void ConstraintPlan::apply(FlatCloth& c, Cloth& g, double t) const {
  const auto version = arrays(g).version();
  for (const Term& term : terms_) {
    if (const ConstraintPlan* plan = term.instead()) {
      plan->apply(c, g, t);
    } else if (!apply_to_part(term, c, g, t, 0, c.slots())) {
      c.write(g);
      (*term.constraint)(g, t);
      c.take(g);
    }
  }
  if (arrays(g).version() == version) return;
  restore_order(g);
  if (c.version() != arrays(g).version()) c.write(g), c.take(g);
}

void ConstraintPlan::each_place(const Cloth& g, double t,
                                const PlaceVisitor& use) const {
  for (const auto& leaf : leaves_)
    leaf->each_place(g, t, 0, arrays(g).node_slots(), use);
}

double ConstraintPlan::next_velocity_jump(double t) const {
  double first = std::numeric_limits<double>::infinity();
  for (const auto& leaf : leaves_) {
    const Motion& m = leaf->traits().motion;
    if (leaf->traits().holds && m.moves() && t < m.until * (1 - 1e-12))
      first = std::min(first, m.until);
  }
  return first;
}

std::optional<Point> ConstraintPlan::first_hit(const Point& from,
                                               const Point& to) const {
  std::optional<Point> first;
  for (const auto& leaf : leaves_) {
    if (!leaf->traits().obstacle) continue;
    // A ball that tears removes what ends in it.
    if (!leaf->traits().nodewise && leaf->traits().obstacle->holds(to))
      continue;
    const auto place = lab::first_hit(*leaf->traits().obstacle, from, to);
    if (place && (!first || norm(*place - from) < norm(*first - from)))
      first = place;
  }
  return first;
}

double ConstraintPlan::thinnest() const {
  double least = std::numeric_limits<double>::infinity();
  for (const auto& leaf : leaves_)
    if (const auto& ball = leaf->traits().obstacle)
      least = std::min(least, ball->radius);
  return least;
}

bool ConstraintPlan::is_at_rest(double t) const {
  return std::ranges::all_of(leaves_, [t](const auto& leaf) {
    const Motion& m = leaf->traits().motion;
    return !m.moves() || !(t < m.until);
  });
}

Exchange ConstraintPlan::exchange() const {
  Exchange all;
  for (const Term& term : terms_) {
    all += term.constraint->exchange();
    if (term.forwards) all += term.forwards->inner().exchange();
  }
  return all;
}

void ConstraintPlan::archive(Archive& a) const {
  for (const auto& leaf : leaves_) leaf->archive(a);
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

void WatchedConstraint::operator()(Cloth& g, double t) const {
  if (before_.empty()) return inner_(g, t);
  for (Node n : g.nodes()) {
    if (n.id() >= before_.size()) continue;  // added since
    auto place = inner_.first_hit(before_[n.id()], n.position());
    if (!place) continue;
    // A shorter way passes less than 1/128 of the radius below the surface.
    const double way = norm(n.position() - before_[n.id()]);
    if (way > inner_.thinnest() / 4 && count_++ == 0) first_ = {n.index(), way};
    n.position() = *place;
  }
  inner_(g, t);
  remember(g);
}

}  // namespace lab
