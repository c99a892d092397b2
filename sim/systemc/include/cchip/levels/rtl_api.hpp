// SPDX-License-Identifier: Apache-2.0
/// \file
/// API of the levels whose modules are RTL: pairs on the grid with tags, answers in any order.
#ifndef CCHIP_LEVELS_RTL_API_HPP
#define CCHIP_LEVELS_RTL_API_HPP

#include <cchip/internal/wire/pair.hpp>
#include <cchip/levels/api.hpp>
#include <ostream>

namespace cchip::levels {

/// A beat of s_pair in a FIFO.
struct RtlRequest : PairRequest {
  ModuleId test = ModuleId::tri_tri;  ///< module that tests it
  friend std::ostream& operator<<(std::ostream& out, const RtlRequest& x) { return out << "{tag " << x.tag << '}'; }
};

/// A beat of m_result in a FIFO.
struct RtlResult : PairResult {
  friend std::ostream& operator<<(std::ostream& out, const RtlResult& x) {
    return out << "{tag " << x.tag << " grid " << x.grid << '}';
  }
};

/// Places the primitives itself, as the static side of the chip does, and makes quads canonical. eta is 0.
class RtlApi : public Api {
 public:
  sc_core::sc_fifo_out<RtlRequest> requests{"requests"};
  sc_core::sc_fifo_in<RtlResult> results{"results"};

  RtlApi(const sc_core::sc_module_name& name, const Stimulus& stimulus, sc_core::sc_time patience);

 private:
  void send(std::size_t index) override;
  std::pair<std::size_t, bool> receive() override;

  /// By tag: index of the primitive pair in flight.
  std::vector<std::size_t> under_way_;
};

}  // namespace cchip::levels

#endif
