// SPDX-License-Identifier: Apache-2.0
/// Figures of Table 1 as text and as CSV.
#ifndef CCHIP_TABLE1_REPORT_HPP
#define CCHIP_TABLE1_REPORT_HPP

#include <ostream>

#include "experiments.hpp"

namespace cchip::table1 {

/// The paper's table beside ours, the arithmetic, what contradicts what, variants, overhead by decades. The last line
/// is key=value.
void print_report(const Figures& figures, std::ostream& out);

/// All points, one a row, times in ns.
void write_csv(const Figures& figures, std::ostream& out);

}  // namespace cchip::table1

#endif  // CCHIP_TABLE1_REPORT_HPP
