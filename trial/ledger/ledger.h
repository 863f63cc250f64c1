// The energy ledger of a contact: where the work went that the hand did on the machine, in J. By the truth,
// so in simulation alone (docs/reference/ledger.md).
//
//   hand + carried + generated = stored + dissipated,   generated = sampling + delay + quantisation + limits
//
// What the left side has is put in, by the hand, by the law's target that moves, and by a force that is not
// the law's: held for a period, late, counted, limited. `hand` is measured on what pushes, all else on the
// machine and its law: what is left over is an error of the ledger or of the physics.
#pragma once

#include <cstdint>
#include <span>
#include <string>
#include <vector>

namespace enc::trial {

struct ContactLedger {
  std::int32_t contact = 0;         // to the core, from 1
  std::int32_t object = -1;         // index in the scene
  double began = 0.0, ended = 0.0;  // s
  bool rendered = true;             // false: a real thing, which only its prop stands for
  double hand = 0.0;                // done on the machine by what pushes it
  double carried = 0.0;             // by the law's target and surface, which move
  double kinetic = 0.0, spring = 0.0,
         weight = 0.0;             // more at the end than at the begin; weight: uncompensated
  double joints = 0.0, law = 0.0;  // taken by the machine's friction; by damper or hysteresis
  double sampling = 0.0, delay = 0.0, quantisation = 0.0, limits = 0.0;  // above 0: given out
  // What had come out more, at any moment, than had been put in and the law's spring still held; of an arm
  // against its target, from the touch on; of a hexapod along the normal.
  double surplus = 0.0;

  [[nodiscard]] double stored() const { return kinetic + spring + weight; }
  [[nodiscard]] double dissipated() const { return joints + law; }
  [[nodiscard]] double generated() const { return sampling + delay + quantisation + limits; }
  [[nodiscard]] double left_over() const { return hand + carried + generated() - stored() - dissipated(); }
  [[nodiscard]] double largest() const;  // of the terms that are named in the balance and its parts
  // Share of the largest term; 0 where all are.
  [[nodiscard]] double closure() const;
};

// J, of the contact on which something pushed and that has the most; of one that nothing pushes nobody feels
// it.
[[nodiscard]] double worst_surplus(const std::vector<ContactLedger>& contacts);

// What a ledger says, by names that have their units.
struct LedgerTerm {
  const char* name;
  double (*of)(const ContactLedger&);
};
[[nodiscard]] std::span<const LedgerTerm> ledger_terms();
// CSV: a row for each contact.
[[nodiscard]] std::string ledger_table(const std::vector<ContactLedger>& contacts);

}  // namespace enc::trial
