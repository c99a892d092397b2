// SPDX-License-Identifier: Apache-2.0
#include "commands.hpp"
namespace cchip::campaign {
int run_leaves(const LeavesOptions&) { return 1; }
}
