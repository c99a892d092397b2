// SPDX-License-Identifier: Apache-2.0
/// \file
/// How GTKWave shows a waveform of the engine `rtl`.
#ifndef CCHIP_WAVES_WAVE_LAYOUT_HPP
#define CCHIP_WAVES_WAVE_LAYOUT_HPP

#include <cchip/internal/wire/definitions.hpp>
#include <cstdint>
#include <string>
#include <vector>

namespace cchip {

/// Writes the GTKWave save file beside the waveform of this module (same name, .gtkw): signals in the order in which
/// the data flows, grouped by stream and macro stage, zoomed to the first pairs. The waveform need not exist yet.
/// Beside the layout it writes the names that GTKWave shows in place of codes, a file for each kind of code:
/// .gtkw.axis, ... A layout that is moved needs these and the waveform beside it. \throws sim::OutputError the file
/// cannot be written
void write_gtkw(const std::string& fst_path, ModuleId module);
/// The files that write_gtkw() writes, the layout first.
std::vector<std::string> gtkw_files(const std::string& fst_path, ModuleId module);

/// The same for a waveform of cchip_primtest_subsystem with two slots: streams, scheduler, configuration controller and
/// slots, zoomed to a swap.
/// \param from,to time units of the waveform
/// \throws sim::OutputError the file cannot be written
void write_swap_gtkw(const std::string& fst_path, std::uint64_t from, std::uint64_t to);

/// The same for a waveform of cchip_broad_phase_axi with 16 queries: a query from its descriptor to its answer.
/// \param from,to time units of the waveform
/// \throws sim::OutputError the file cannot be written
void write_broad_phase_gtkw(const std::string& fst_path, std::uint64_t from, std::uint64_t to);

/// The same for a waveform of cchip_chip with 16 queries: a query from its ring to its done record.
/// \param from,to time units of the waveform
/// \param swap_slots slots of a chip with swaps, 0: a static one
/// \throws sim::OutputError the file cannot be written
void write_chip_gtkw(const std::string& fst_path, std::uint64_t from, std::uint64_t to, unsigned swap_slots = 0);

}  // namespace cchip

#endif
