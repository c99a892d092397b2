// SPDX-License-Identifier: Apache-2.0
`default_nettype none
// The query of tests/icarus/bench_chip.v for scripts/waveforms.py, from the doorbell to the done record: what the chip counts.
module bench;
  bench_chip chip ();

  wire clk = chip.clk;
  wire show = chip.doorbell != 0 && !chip.done;
  wire read_beat = chip.m_axi_rvalid && chip.m_axi_rready;
  wire [1:0] cache_hit = chip.dut.u_core.count_hit;
  wire [1:0] cache_miss = chip.dut.u_core.count_miss;
  wire node_pair = chip.dut.u_core.count_step;
  wire leaf_pair = chip.dut.u_core.count_leaf_pair;
  wire primitive_pair = chip.dut.u_core.count_pair;
  wire record = chip.dut.u_core.count_record;
  wire write_beat = chip.m_axi_wvalid && chip.m_axi_wready;

  initial $dumpvars(1, bench);
endmodule
`default_nettype wire
