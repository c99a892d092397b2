// SPDX-License-Identifier: Apache-2.0
/// \file
/// The model of the primitive tests as an engine.
#ifndef CCHIP_INTERNAL_DRIVER_MODEL_ENGINE_HPP
#define CCHIP_INTERNAL_DRIVER_MODEL_ENGINE_HPP

#include <cchip/internal/driver/pair_engine.hpp>
#include <memory>

namespace cchip {

/// The clock-exact model of the primitive tests with default parameters.
std::unique_ptr<PairEngine> make_model_engine(int coord_w);

}  // namespace cchip

#endif
