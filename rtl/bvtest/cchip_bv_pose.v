// SPDX-License-Identifier: Apache-2.0 WITH SHL-2.1
`default_nettype none
`include "cchip_assert.vh"
// cchip_bv_pose: sets up the poses of the queries and keeps them for the box test.
//   latency      21 clocks from an accepted pose to m_pose_valid, while all of it is in memory;
//                2 clocks from row_context to a row, 3 from lane_context to pose_select, and 4
//                to pose_m, pose_magnitude and pose_factor
//   throughput   a pose every 13 clocks; each port reads on every clock
//   memory       block RAM: the rows of M and t one after the other for cchip_bv_offset, and M and
//                the 13 directions side by side for cchip_bv_lane_a
//   reset        drops the pose in progress, keeps those in memory
//   timing       A pose every 13 clocks; m_pose_valid 21 clocks after it was taken. What is read
//                while it is written is any value.
//   numbers      Those of cchip_pose_setup.
//   inside       cchip_pose_setup and cchip_block_ram: 97 bits for each row, 171 for M, 51 for each
//                direction.
//   why          cchip_bv_offset works on one axis after the other, so it gets the rows so: no
//                multiplexers. cchip_bv_lane_a needs all 13 directions at once, at two clocks; the
//                memories are read at these clocks, and no register waits.
module cchip_bv_pose #(
    parameter integer QUERIES = 16  // queries in flight, one pose each (query); legal: 2, 4, 8, 16
) (
    input  wire                       clk,             // clock, rising edge
    input  wire                       rst,             // synchronous reset, active high
    // ---- a pose, as cchip_pose_setup takes it
    input  wire                       s_pose_valid,    // the pose of a query
    output wire                       s_pose_ready,    // it is taken
    input  wire [$clog2(QUERIES)-1:0] s_pose_context,  // the query's number
    // M, 30 fraction bits, row by row; magnitudes at most 1
    input  wire [              287:0] s_pose_m,
    input  wire [              107:0] s_pose_t,        // t, 32 fraction bits
    input  wire [                3:0] s_pose_shift,    // the map is M 2^-shift
    // bound on the error of a position that the query's map gives, 2^-38
    input  wire [               11:0] s_pose_error,
    // a pose is in memory; node pairs of it may come from this clock on
    output wire                       m_pose_valid,
    output wire [$clog2(QUERIES)-1:0] m_pose_context,  // whose
    // ---- for cchip_bv_offset
    input  wire [$clog2(QUERIES)-1:0] row_context,     // query
    input  wire [                1:0] row,             // axis, 0, 1, 2
    output wire [               56:0] row_m,  // 2 clocks later: that row of M, 17 fraction bits
    output wire [               28:0] row_t,           // t, 24 fraction bits
    output wire [                3:0] shift,           // the map is M 2^-shift
    // bound on the error of a position that M and t give, 2^-24
    output wire [                6:0] epsilon,
    // ---- for cchip_bv_lane_a
    input  wire [$clog2(QUERIES)-1:0] lane_context,    // query
    // 3 clocks later: of 13 directions, as cchip_bv_lane_a takes it
    output wire [               90:0] pose_select,
    output wire [              170:0] pose_m,          // 4 clocks later: M
    output wire [              389:0] pose_magnitude,  // 4 clocks later: of 13 directions
    output wire [              181:0] pose_factor      // 4 clocks later: of 13 directions
);

  localparam integer CONTEXT_W = $clog2(QUERIES);
  localparam [3:0] LAST = 4'd12;
  `CCHIP_REFUSE(QUERIES != 2 && QUERIES != 4 && QUERIES != 8 && QUERIES != 16,
                cchip_error_bv_QUERIES_must_be_2_4_8_or_16)

  // ---- set-up
  wire set_valid;
  wire [3:0] set_direction;
  wire [6:0] set_select;
  wire [29:0] set_magnitude;
  wire [13:0] set_factor;
  wire [170:0] set_m;
  wire [86:0] set_t;
  wire [6:0] set_epsilon;
  cchip_pose_setup u_setup (
      .clk        (clk),
      .rst        (rst),
      .s_valid    (s_pose_valid),
      .s_ready    (s_pose_ready),
      .s_m        (s_pose_m),
      .s_t        (s_pose_t),
      .s_shift    (s_pose_shift),
      .s_error    (s_pose_error),
      .pose_m     (set_m),
      .pose_t     (set_t),
      .epsilon    (set_epsilon),
      .m_valid    (set_valid),
      .m_direction(set_direction),
      .m_select   (set_select),
      .m_magnitude(set_magnitude),
      .m_factor   (set_factor)
  );

  // M and t are there one clock after the start, the directions from 7 clocks after it on, when the
  // next pose may already be in progress
  wire start = s_pose_valid & s_pose_ready;
  reg start_q, done_q, done_q2;
  reg [CONTEXT_W-1:0] set_context_q, write_context_q, done_context_q, done_context_q2;
  reg [3:0] set_shift_q;
  wire last = set_valid && set_direction == LAST;
  always @(posedge clk) begin
    if (start) begin
      set_context_q <= s_pose_context;
      set_shift_q   <= s_pose_shift;
    end
    if (last || !set_valid) write_context_q <= set_context_q;
    done_context_q  <= write_context_q;
    done_context_q2 <= done_context_q;
    start_q         <= start & ~rst;
    done_q          <= last & ~rst;
    done_q2         <= done_q & ~rst;
  end
  assign m_pose_valid   = done_q2;
  assign m_pose_context = done_context_q2;

  // ---- rows
  wire [4*97-1:0] rows;
  genvar i, d;
  generate
    for (i = 0; i < 4; i = i + 1) begin : gen_row
      if (i == 3) begin : gen_none
        assign rows[97*i+:97] = 97'd0;
      end else begin : gen_some
        assign rows[97*i+:97] = {set_shift_q, set_epsilon, set_t[29*i+:29], set_m[57*i+:57]};
      end
    end
  endgenerate
  cchip_block_ram #(.WIDTH(97), .WORDS(4), .ADDR_W(CONTEXT_W + 2)) u_rows (
      .clk       (clk),
      .write     (start_q),
      .write_addr(set_context_q),
      .write_data(rows),
      .read_addr ({row_context, row}),
      .read_data ({shift, epsilon, row_t, row_m})
  );

  // ---- lane A. A memory has 8 words at least
  localparam integer ADDR_W = CONTEXT_W < 3 ? 3 : CONTEXT_W;
  wire [ADDR_W-1:0] set_addr, write_addr, lane_addr;
  generate
    if (CONTEXT_W < 3) begin : gen_padded
      assign set_addr   = {{3 - CONTEXT_W{1'b0}}, set_context_q};
      assign write_addr = {{3 - CONTEXT_W{1'b0}}, write_context_q};
      assign lane_addr  = {{3 - CONTEXT_W{1'b0}}, lane_context};
    end else begin : gen_plain
      assign set_addr   = set_context_q;
      assign write_addr = write_context_q;
      assign lane_addr  = lane_context;
    end
  endgenerate
  reg [ADDR_W-1:0] lane_addr_q, lane_addr_q2;
  always @(posedge clk) begin
    lane_addr_q  <= lane_addr;
    lane_addr_q2 <= lane_addr_q;
  end
  cchip_block_ram #(.WIDTH(171), .ADDR_W(ADDR_W)) u_m (
      .clk       (clk),
      .write     (start_q),
      .write_addr(set_addr),
      .write_data(set_m),
      .read_addr (lane_addr_q2),
      .read_data (pose_m)
  );
  // the memories of the directions lie along the whole lane: a clock for the way
  reg [12:0] write_q;
  reg [ADDR_W-1:0] write_addr_q;
  reg [6:0] select_q;
  reg [29:0] magnitude_q;
  reg [13:0] factor_q;
  always @(posedge clk) begin
    write_addr_q <= write_addr;
    select_q     <= set_select;
    magnitude_q  <= set_magnitude;
    factor_q     <= set_factor;
  end
  generate
    for (d = 0; d < 13; d = d + 1) begin : gen_direction
      localparam [31:0] D = d;
      always @(posedge clk) write_q[d] <= set_valid && set_direction == D[3:0];
      // from a block to the multiplexers behind pose_select it is far
      wire [6:0] select;
      wire [7:0] high;  // of the factors
      reg [6:0] read_select_q;
      reg [7:0] high_q, high_q2;
      always @(posedge clk) begin
        read_select_q <= select;
        high_q        <= high;
        high_q2       <= high_q;
      end
      assign pose_select[7*d+:7]    = read_select_q;
      assign pose_factor[14*d+6+:8] = high_q2;
      cchip_block_ram #(.WIDTH(15), .ADDR_W(ADDR_W)) u_early (
          .clk       (clk),
          .write     (write_q[d]),
          .write_addr(write_addr_q),
          .write_data({factor_q[13:6], select_q}),
          .read_addr (lane_addr),
          .read_data ({high, select})
      );
      cchip_block_ram #(.WIDTH(36), .ADDR_W(ADDR_W)) u_late (
          .clk       (clk),
          .write     (write_q[d]),
          .write_addr(write_addr_q),
          .write_data({factor_q[5:0], magnitude_q}),
          .read_addr (lane_addr_q2),
          .read_data ({pose_factor[14*d+:6], pose_magnitude[30*d+:30]})
      );
    end
  endgenerate

endmodule
`default_nettype wire
