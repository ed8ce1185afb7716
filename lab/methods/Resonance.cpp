#include "lab/methods/Resonance.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <sstream>
#include <utility>

#include "CME212/Util.hpp"

namespace lab {

using std::numbers::pi;

namespace {
// Large motion adds side bands: waves in the soft springs may exceed their
// bound by this factor. Measured: 1.2 is too little, see README.md.
constexpr double side_bands = 1.3;
constexpr double margin = 0.02;  // of c
// A third of the shortest period, as Izaguirre, Reich, Skeel 1999 advise for
// large motion, is 2/3 of the first resonance.
constexpr double share_of_first = 0.6;
}  // namespace

HalfTrace::HalfTrace(double omega, double soft, double dt, int inner) {
  const double y = dt * omega / (2 * inner);
  phase = 2 * inner * std::asin(y);
  value = std::cos(phase) - dt * soft * soft /
                                (2 * omega * std::sqrt(1 - y * y)) *
                                std::sin(phase);
}

Resonances::Resonances(StiffSplit split, double soft)
    : split_(std::move(split)), soft_(soft) {
  double low = 0, high = pi / split_.omega;  // beyond it by the inner steps
  for (int k = 0; k < 50; ++k) {
    const double middle = (low + high) / 2;
    (at(middle) ? high : low) = middle;
  }
  first_ = low;
}

/** The eigenvalues of a step are pairs e^{+-ib} with cos(b) = c. Those of stiff
 * springs with sin(a) < 0 have the opposite Krein signature to all others.
 * Where the two kinds meet, both leave the unit circle; and any pair does at
 * |c| = 1. So a step is stable if some number separates the c of both kinds. In
 * addition, a stiff spring past its first half turn that turns no faster than
 * soft waves, c >= 1 - (dt soft)^2/2, takes up energy from them and heats up.
 */
bool Resonances::at(double dt) const {
  const int inner = split_.inner_steps(dt);
  const double waves = dt * side_bands * soft_;
  double low = -1, high = 1;
  if (split_.connected > 0) {
    const HalfTrace top(split_.connected, soft_, dt, inner);
    if (top.phase >= pi) return true;
    high = top.value;  // lower frequencies have larger values
  }
  for (double omega : split_.alone) {
    const HalfTrace c(omega, soft_, dt, inner);
    if (c.phase >= pi && c.value > 1 - waves * waves / 2) return true;
    if (std::sin(c.phase) < 0)
      low = std::max(low, c.value);
    else
      high = std::min(high, c.value);
    if (low + margin > high) return true;
  }
  return low + margin > high;
}

double Resonances::below(double dt) const {
  // Few digits, so that a user can type in the result.
  const double least =
      std::min(dt, std::stod(CME212::two_digits(share_of_first * first_)));
  if (dt <= least || split_.connected > 0) return least;
  const double unit = std::pow(10, std::floor(std::log10(0.1 / split_.omega)));
  for (double k = std::floor(dt / unit); k * unit > first_; --k)
    if (const double h = std::stod(CME212::short_text(k * unit)); !at(h))
      return h;
  return least;
}

std::string Resonances::text(double dt) const {
  const int inner = split_.inner_steps(dt);
  // The spring for which dt is nearest to a multiple of its half period.
  double worst = split_.connected, off = pi;
  if (!(HalfTrace(worst, soft_, dt, inner).phase >= pi))
    for (double omega : split_.alone) {
      const double a = HalfTrace(omega, soft_, dt, inner).phase;
      if (std::abs(std::remainder(a, pi)) < off)
        worst = omega, off = std::abs(std::remainder(a, pi));
    }
  std::ostringstream out;
  out.precision(4);
  out << "dt is " << HalfTrace(worst, soft_, dt, inner).phase / pi
      << " times half of their period of " << 2 * pi / worst << " s";
  if (worst == split_.connected)
    out << "; as they are connected, all steps above half of it may resonate";
  return out.str();
}

}  // namespace lab
