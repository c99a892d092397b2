// SPDX-License-Identifier: Apache-2.0
`default_nettype none
// Prints the generated widths and smallest SUBSTAGES for every legal COORD_W. Run by scripts/datasheet.py --widths.
module bench;
`include "cchip_defs.vh"
  integer w;
  initial begin
    $display("COORD_W edge axis relative_projection absolute_projection axis_norm error_bound smallest_SUBSTAGES");
    for (w = `CCHIP_COORD_W_MIN; w <= `CCHIP_COORD_W_MAX; w = w + 1)
      $display("%0d %0d %0d %0d %0d %0d %0d %0d", w, `CCHIP_EDGE_W(w), `CCHIP_AXIS_W(w), `CCHIP_PROJ_W(w),
               `CCHIP_PROJ_ABS_W(w), `CCHIP_AXIS_NORM_W(w), `CCHIP_BOUND_W(w), `CCHIP_SUBSTAGES_MIN(w));
  end
endmodule
`default_nettype wire
