#include "lab/stepping/Separation.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

#include "lab/fast/GraphArrays.hpp"
#include "lab/stepping/Scene.hpp"

namespace lab {

namespace {
constexpr double infinite = std::numeric_limits<double>::infinity();
}  // namespace

Track::Track(double t_end, std::size_t nodes) {
  const double count =
      std::clamp(2e7 / double(std::max<std::size_t>(nodes, 1)), 8., 64.);
  for (int k = 1; k <= int(count); ++k) due_.push_back(t_end * k / int(count));
}

Track Track::beside() const {
  Track other;
  for (const State& s : states_) other.due_.push_back(s.time);
  return other;
}

void Track::look(const Scene& scene) {
  const double now = scene.time() + round_off();
  if (next_ == due_.size() || now < due_[next_]) return;
  while (next_ < due_.size() && due_[next_] <= now) ++next_;
  const Cloth& g = scene.cloth();
  const auto x = arrays(g).positions();
  State& s = states_.emplace_back(State{scene.time(), {}});
  s.x.assign(x.begin(), x.end());
  for (unsigned id = 0; id < s.x.size(); ++id)
    if (!arrays(g).node_in_use(id))
      s.x[id] = Point(infinite, infinite, infinite);
}

Separation::Separation(const Track& a, const Track& b) {
  const double round_off = a.round_off();
  auto other = b.states_.begin();
  for (const Track::State& s : a.states_) {
    while (other != b.states_.end() && other->time < s.time - round_off)
      ++other;
    if (other == b.states_.end()) break;
    if (other->time > s.time + round_off) continue;
    At at = {s.time, 0, 0};
    std::size_t count = 0;
    for (std::size_t id = 0; id < std::min(s.x.size(), other->x.size()); ++id) {
      const Point &p = s.x[id], &q = other->x[id];
      const bool p_removed = std::isinf(p.x), q_removed = std::isinf(q.x);
      if (p_removed && q_removed) continue;
      const double d2 =
          p_removed || q_removed ? infinite : double(normSq(p - q));
      ++count, at.rms += d2;
      at.largest = std::max(at.largest, std::sqrt(d2));
    }
    if (count > 0) at.rms = std::sqrt(at.rms / double(count));
    all_.push_back(at);
  }
}

double Separation::horizon(double tolerance) const {
  double last = 0;
  for (const At& at : all_) {
    if (!(at.rms <= tolerance)) break;
    last = at.time;
  }
  return last;
}

double Separation::growth() const {
  double most = 0;
  for (std::size_t k = 1; k < all_.size(); k += 2)
    if (const double before = all_[k / 2].rms;
        before > 0 && std::isfinite(all_[k].rms))
      most = std::max(most, all_[k].rms / before);
  return most;
}

Separation::At Separation::most() const {
  At most = {};
  for (const At& at : all_) {
    most.time = at.time;
    most.rms = std::max(most.rms, at.rms);
    most.largest = std::max(most.largest, at.largest);
  }
  return most;
}

}  // namespace lab
