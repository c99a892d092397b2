// SPDX-License-Identifier: Apache-2.0 WITH SHL-2.1
`default_nettype none
`include "cchip_assert.vh"
// cchip_dual_ram for Lattice ECP5: blocks DP16KD with their own output registers. Takes the place
// of common/cchip_dual_ram.v in rtl/cchip_ecp5.f.
//   blocks       one for 18 bits of a word with ADDR_W up to 10, for 9 bits with 11, for 4 bits
//                with 12, for 2 bits with 13, for 1 bit with 14.
//                Larger memories are left to inference, their output registers to flip-flops
//   latency, throughput, collision, cuts, reset   those of common/cchip_dual_ram.v
module cchip_dual_ram #(
    // see common/cchip_dual_ram.v
    parameter integer WIDTH = 8,
    parameter integer ADDR_W = 11
) (
    input  wire              clk,
    input  wire              write,
    input  wire [ADDR_W-1:0] addr_a,
    input  wire [ WIDTH-1:0] write_data,
    output wire [ WIDTH-1:0] read_data_a,
    input  wire [ADDR_W-1:0] addr_b,
    output wire [ WIDTH-1:0] read_data_b
);

  // of a word in a block
  localparam integer BITS = ADDR_W <= 10 ? 18 : ADDR_W == 11 ? 9 : ADDR_W == 12 ? 4 :
      ADDR_W == 13 ? 2 : 1;
  localparam integer BLOCKS = (WIDTH + BITS - 1) / BITS;

  `CCHIP_REFUSE(WIDTH < 1 || ADDR_W < 3 || ADDR_W > 16,
                cchip_error_dual_ram_WIDTH_below_1_or_ADDR_W_not_3_to_16)

  generate
    if (ADDR_W <= 14) begin : gen_blocks
      wire [13:0] bit_a, bit_b;
      wire [13:0] word_a, word_b;
      assign word_a[ADDR_W-1:0] = addr_a;
      assign word_b[ADDR_W-1:0] = addr_b;
      if (ADDR_W < 14) begin : gen_small
        assign word_a[13:ADDR_W] = {14 - ADDR_W{1'b0}};
        assign word_b[13:ADDR_W] = {14 - ADDR_W{1'b0}};
      end
      if (BITS == 1) begin : gen_bit
        assign bit_a = word_a;
        assign bit_b = word_b;
      end else if (BITS < 18) begin : gen_part
        assign bit_a = {word_a[ADDR_W-1:0], {14 - ADDR_W{1'b0}}};
        assign bit_b = {word_b[ADDR_W-1:0], {14 - ADDR_W{1'b0}}};
      end else begin : gen_half
        assign bit_a = {word_a[9:0], 4'b0011};
        assign bit_b = {word_b[9:0], 4'b0000};
      end
      wire [BLOCKS*BITS-1:0] padded, found_a, found_b;
      assign padded[WIDTH-1:0] = write_data;
      if (BLOCKS * BITS > WIDTH) begin : gen_rest
        assign padded[BLOCKS*BITS-1:WIDTH] = {BLOCKS * BITS - WIDTH{1'b0}};
      end
      assign read_data_a = found_a[WIDTH-1:0];
      assign read_data_b = found_b[WIDTH-1:0];
      genvar b;
      for (b = 0; b < BLOCKS; b = b + 1) begin : gen_block
        wire [17:0] d, q_a, q_b;
        assign d[BITS-1:0] = padded[BITS*b+:BITS];
        if (BITS < 18) begin : gen_upper
          assign d[17:BITS] = {18 - BITS{1'b0}};
        end
        assign found_a[BITS*b+:BITS] = q_a[BITS-1:0];
        assign found_b[BITS*b+:BITS] = q_b[BITS-1:0];
        cchip_dp16kd #(.WIDTH_A(BITS), .WIDTH_B(BITS)) u_block (
            .clk   (clk),
            .write (write),
            .addr_a(bit_a),
            .d_a   (d),
            .d_b   (18'd0),
            .q_a   (q_a),
            .addr_b(bit_b),
            .q_b   (q_b)
        );
        wire unused = &{1'b0, q_a, q_b};
      end
      wire unused = &{1'b0, found_a, found_b, word_a, word_b};
    end else begin : gen_inferred
      (* ram_style = "block", no_rw_check *)
      reg [WIDTH-1:0] mem[0:(1<<ADDR_W)-1];
      reg [WIDTH-1:0] word_a_q, word_b_q, read_data_a_q, read_data_b_q;
      always @(posedge clk) begin
        if (write) mem[addr_a] <= write_data;
        word_a_q      <= mem[addr_a];
        read_data_a_q <= word_a_q;
      end
      always @(posedge clk) begin
        word_b_q      <= mem[addr_b];
        read_data_b_q <= word_b_q;
      end
      assign read_data_a = read_data_a_q;
      assign read_data_b = read_data_b_q;
    end
  endgenerate

endmodule
`default_nettype wire
