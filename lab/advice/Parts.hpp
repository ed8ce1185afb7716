#pragma once
/** @file Parts.hpp
 * PartStudy: which parts of a scene its answer does not need, and whether it
 * needs the scene's whole time. */
#include <optional>
#include <string>
#include <vector>

#include "lab/advice/Grids.hpp"

namespace lab {

class PartStudy {
 public:
  /** As long as no part was tried, all are kept. */
  PartStudy(Question& q, const GridStudy& grids)
      : q_(q), grids_(grids), rest_time_(q.scene.t_end) {}

  /** Leave out each part alone on grid @a k; then one more each time, as long
   * as together they change little: first the parts that save springs or steps;
   * within each group, those that change least. Then find rest_time(). */
  void study(std::size_t k);

  /** The level of that grid. */
  std::optional<int> level() const { return level_; }
  /** Parts that are left out together, more each time: first none. */
  const std::vector<std::vector<std::string>>& reductions() const {
    return reductions_;
  }
  /** The time [s] after which the answer stays within a tenth of the tolerance;
   * t-end if it does not. */
  double rest_time() const { return rest_time_; }
  /** Only drag and friction bring a cloth to rest. */
  static bool dissipates(const Model& m);

 private:
  /** How far the answers of two runs differ: at the end and, where it is by
   * more than the tolerance, before. So no part goes whose effect is small at
   * the end by accident. */
  double change(const Trial& without, const Trial& whole) const;

  Question& q_;
  const GridStudy& grids_;
  std::optional<int> level_;
  std::vector<std::vector<std::string>> reductions_ = {{}};
  double rest_time_;

  void try_each(const GridReport& run);
  void combine(const GridReport& run);
  void find_rest(const GridReport& run);
};

}  // namespace lab
