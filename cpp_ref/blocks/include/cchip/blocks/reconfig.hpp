// SPDX-License-Identifier: Apache-2.0
/// \file
/// Clock-exact models of the blocks in rtl/reconfig between a region and the rest. Moore machines, like those in
/// stream.hpp.
#ifndef CCHIP_BLOCKS_RECONFIG_HPP
#define CCHIP_BLOCKS_RECONFIG_HPP

#include <cstdint>

namespace cchip::model {

/// cchip_roc_generator, modelled from power-up on: counts the clocks since the last configuration, power-up or reset.
class RocGenerator {
 public:
  /// \param cycles length of the reset, clocks
  explicit RocGenerator(std::uint64_t cycles) : cycles_(cycles) {}
  bool roc() const { return since_ < cycles_; }
  /// Rising edge.
  void clock(bool rst, bool configured) { since_ = rst || configured ? 0 : since_ + 1; }

 private:
  std::uint64_t cycles_;
  std::uint64_t since_ = 0;
};

}  // namespace cchip::model

#endif
