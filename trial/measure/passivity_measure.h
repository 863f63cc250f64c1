// What the passivity controller of an arm saw and did, of each contact (core/safety/passivity).
#pragma once

#include <vector>

#include "trial/trial.h"

namespace enc::trial {

struct PassivityFigures {
  double began = kUnset;     // s
  double given = 0.0;        // J, that had come out more than was put in, at most; observed
  double dissipated = 0.0;   // J, that the law would have given out more
  double most = 0.0;         // N, the largest push that it took away
  double acted = 0.0;        // s
  std::int32_t contact = 0;  // to the core
};

class PassivityMeasure {
 public:
  void see(const Glance& glance);
  // Until the last tick of each contact. Where nothing is controlled there are none.
  [[nodiscard]] const std::vector<PassivityFigures>& contacts() const { return contacts_; }
  [[nodiscard]] PassivityFigures worst() const;  // the largest of each; `dissipated` and `acted` of all

 private:
  std::vector<PassivityFigures> contacts_;
  bool on_ = false;
};

}  // namespace enc::trial
