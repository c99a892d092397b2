// SPDX-License-Identifier: Apache-2.0
/// \file
/// Signals inside the Verilated RTL, by name. This is the only file that knows where a signal lies in the hierarchy;
/// its user includes <V...___024root.h> of the model.
///
/// A function template takes every model that has the signal, regardless of the name of its class.
#ifndef CCHIP_MACHINES_PROBES_HPP
#define CCHIP_MACHINES_PROBES_HPP

namespace cchip::probes {

#define CCHIP_PROBE(name, signal)                             \
  template <class Model>                                      \
  auto name(const Model& top)->decltype(+top.rootp->signal) { \
    return top.rootp->signal;                                 \
  }

// Axis controller of a primitive test: a beat leaves it; a pair waits for an axis slot.
#define CCHIP_CONTROLLER_PROBES(module)                                                    \
  CCHIP_PROBE(beat_valid, module##__DOT__u_primtest__DOT__u_controller__DOT__beat_valid_q) \
  CCHIP_PROBE(pair_waits, module##__DOT__u_primtest__DOT__u_controller__DOT__pair_waits)
CCHIP_CONTROLLER_PROBES(cchip_primtest_tri_tri)
CCHIP_CONTROLLER_PROBES(cchip_primtest_tri_quad)
CCHIP_CONTROLLER_PROBES(cchip_primtest_quad_quad)
#undef CCHIP_CONTROLLER_PROBES

// cchip_primtest_array: the lane whose result leaves next, one-hot.
CCHIP_PROBE(array_choice, cchip_primtest_array__DOT__choice_q)

// cchip_counter_file: the place of the walk; the words, to be set.
CCHIP_PROBE(counter_place, cchip_counter_file__DOT__place_q)
template <class Model>
auto& counter_words(Model& top) {
  return top.rootp->cchip_counter_file__DOT__mem;
}

// cchip_primtest_subsystem: the swap in progress and its report.
#define CCHIP_SUBSYSTEM_PROBE(name, signal) CCHIP_PROBE(name, cchip_primtest_subsystem__DOT__##signal)
CCHIP_SUBSYSTEM_PROBE(swap_phase, u_swaps__DOT__gen_swaps__DOT__u_controller__DOT__u_sequencer__DOT__phase_q)
CCHIP_SUBSYSTEM_PROBE(swap_slot, u_swaps__DOT__gen_swaps__DOT__u_scheduler__DOT__slot_of_swap_q)
CCHIP_SUBSYSTEM_PROBE(report_valid, u_swaps__DOT__gen_swaps__DOT__u_scheduler__DOT__m_report_valid_q)
CCHIP_SUBSYSTEM_PROBE(report_data, u_swaps__DOT__gen_swaps__DOT__u_scheduler__DOT__m_report_data_q)
CCHIP_SUBSYSTEM_PROBE(bitstreams_valid, u_swaps__DOT__gen_swaps__DOT__u_table__DOT__valid_q)
// A write to a register that takes effect on this clock: abort, clear, a swap by software.
CCHIP_SUBSYSTEM_PROBE(abort_arrives, u_regs__DOT__control_abort_q)
CCHIP_SUBSYSTEM_PROBE(clear_arrives, u_regs__DOT__control_clear_q)
CCHIP_SUBSYSTEM_PROBE(command_arrives, u_regs__DOT__command_go_q)

// cchip_chip with swaps: the phase of the swap in progress; what is counted on this clock, bit 1 a clock of the box
// test.
CCHIP_PROBE(chip_swap_phase,
            cchip_chip__DOT__u_swaps__DOT__gen_swaps__DOT__u_controller__DOT__u_sequencer__DOT__phase_q)
CCHIP_PROBE(chip_counts, cchip_chip__DOT__count_q)

// cchip_chip: a node pair is at the box test; a vertex leaves the transform, bit 0; an axis leaves the controller of
// the test in slot 0; a line is outstanding.
#define CCHIP_CHIP_PROBE(name, signal) CCHIP_PROBE(name, cchip_chip__DOT__u_core__DOT__##signal)
CCHIP_CHIP_PROBE(chip_box_test, u_broad_phase__DOT__u_get_data__DOT__pair_valid_q)
CCHIP_CHIP_PROBE(chip_transform, u_transform__DOT__u_normaliser__DOT__valid_q)
CCHIP_CHIP_PROBE(
    chip_lane,
    u_slots__DOT__gen_slots__BRA__0__KET____DOT__u_slot__DOT__gen_partition__DOT__u_region__DOT__gen_test__DOT__gen_sat__DOT__u_test__DOT__u_controller__DOT__beat_valid_q)
CCHIP_CHIP_PROBE(chip_read_outstanding, u_read__DOT__any_outstanding_q)
#undef CCHIP_CHIP_PROBE

// Pairs inside slot n in bits [16n +: 16].
CCHIP_SUBSYSTEM_PROBE(outstanding, outstanding)

// A slot of it: the module that it shows, whether it is decoupled.
#define CCHIP_SLOT_PROBE(n, name, signal) \
  CCHIP_SUBSYSTEM_PROBE(slot##n##_##name, \
                        u_slots__DOT__gen_slots__BRA__##n##__KET____DOT__u_slot__DOT__u_decoupler__DOT__##signal)
#define CCHIP_SLOT_PROBES(n)              \
  CCHIP_SLOT_PROBE(n, module_id, rm_id_q) \
  CCHIP_SLOT_PROBE(n, decoupled, decoupled_q)
CCHIP_SLOT_PROBES(0)
CCHIP_SLOT_PROBES(1)
CCHIP_SLOT_PROBES(2)
CCHIP_SLOT_PROBES(3)
#undef CCHIP_SLOT_PROBES
#undef CCHIP_SLOT_PROBE
#undef CCHIP_SUBSYSTEM_PROBE
#undef CCHIP_PROBE

}  // namespace cchip::probes

#endif
