// SPDX-License-Identifier: Apache-2.0
/// \file
/// API of the levels whose modules have FIFOs.
#ifndef CCHIP_LEVELS_FUNCTIONAL_API_HPP
#define CCHIP_LEVELS_FUNCTIONAL_API_HPP

#include <cchip/levels/api.hpp>
#include <cchip/levels/functional_test.hpp>

namespace cchip::levels {

/// With one set of ports for each test, or one for all of them.
class FunctionalApi : public Api {
 public:
  sc_core::sc_vector<sc_core::sc_fifo_out<Matrix>> m;
  sc_core::sc_vector<sc_core::sc_fifo_out<Vertices>> a;
  sc_core::sc_vector<sc_core::sc_fifo_out<Vertices>> b;
  sc_core::sc_vector<sc_core::sc_fifo_in<bool>> hit;

  /// \param sets of ports: 4 in the order of ModuleId from tri_tri on, or 1
  FunctionalApi(const sc_core::sc_module_name& name, const Stimulus& stimulus, sc_core::sc_time patience,
                std::size_t sets);

 private:
  void send(std::size_t index) override;
  std::pair<std::size_t, bool> receive() override;
  std::size_t set_of(std::size_t index) const;
};

/// FIFOs of one set of ports.
struct FunctionalChannels {
  explicit FunctionalChannels(const std::string& name)
      : m((name + "_m").c_str()), a((name + "_a").c_str()), b((name + "_b").c_str()), hit((name + "_hit").c_str()) {}
  sc_core::sc_fifo<Matrix> m;
  sc_core::sc_fifo<Vertices> a;
  sc_core::sc_fifo<Vertices> b;
  sc_core::sc_fifo<bool> hit;

  void bind(FunctionalApi& api, std::size_t set) {
    api.m[set](m);
    api.a[set](a);
    api.b[set](b);
    api.hit[set](hit);
  }
  template <class Test>
  void bind(Test& test) {
    test.m(m);
    test.a(a);
    test.b(b);
    test.hit(hit);
  }
};

}  // namespace cchip::levels

#endif
