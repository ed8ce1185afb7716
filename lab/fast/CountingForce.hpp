#pragma once
/** @file CountingForce.hpp
 * Counts the force evaluations of a run. */
#include <memory>
#include <optional>
#include <span>

#include "lab/fast/ForcePlan.hpp"

namespace lab {

/** A force of nothing that counts how often it is evaluated. As one part of a
 * sum it counts the force evaluations of a method, and hides no other part.
 * Copies count together. */
class CountingForce : public SweptForce {
 public:
  void begin(double) const override { ++*sweeps_; }
  bool acts() const override { return false; }
  void add_to(const Part&, double, std::span<Point>) const override {}
  bool add_stiffness(const Cloth&, const StiffnessVisitor&) const override {
    return true;  // it has none
  }
  std::optional<int> spring_multiplicity() const override { return 0; }
  long long sweeps() const { return *sweeps_; }

 private:
  std::shared_ptr<long long> sweeps_ = std::make_shared<long long>(0);
};

}  // namespace lab
