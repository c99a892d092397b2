// SPDX-License-Identifier: Apache-2.0
#include <cchip/internal/grid/canonical.hpp>
#include <cchip/levels/rtl_api.hpp>
#include <stdexcept>

namespace cchip::levels {
namespace {

constexpr std::size_t tags = std::size_t{1} << defs::tag_w;
constexpr std::size_t no_test = ~std::size_t{0};

/// `tags` successive numbers all have different tags.
std::uint16_t tag_of(std::size_t index) { return static_cast<std::uint16_t>(40503U * index); }

}  // namespace

RtlApi::RtlApi(const sc_core::sc_module_name& name, const Stimulus& stimulus, sc_core::sc_time patience)
    : Api(name, stimulus, patience), under_way_(tags, no_test) {}

void RtlApi::send(std::size_t index) {
  const GridPair pair = placed(stimulus()[index]);
  RtlRequest request;
  request.pair = {canonical_quad(pair.a), canonical_quad(pair.b), 0};
  request.test = test_of(stimulus()[index]);
  request.tag = tag_of(index);
  request.mode = stimulus()[index].mode;
  under_way_[request.tag] = index;  // far fewer than `tags` are in flight
  requests.write(request);
}

std::pair<std::size_t, bool> RtlApi::receive() {
  const RtlResult result = results.read();
  const std::size_t index = std::exchange(under_way_[result.tag], no_test);
  if (index == no_test) throw std::runtime_error("answer for tag " + std::to_string(result.tag) + ", which is not out");
  if (!result.definite || result.hit != result.grid) {
    throw std::runtime_error("primitive pair " + std::to_string(index) + " was not tested");
  }
  return {index, result.grid};
}

}  // namespace cchip::levels
