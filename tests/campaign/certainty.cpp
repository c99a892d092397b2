// SPDX-License-Identifier: Apache-2.0
#include "commands.hpp"
namespace cchip::campaign {
int run_certainty(const CertaintyOptions&) { return 1; }
}
