// SPDX-License-Identifier: Apache-2.0 WITH SHL-2.1
`default_nettype none
`include "cchip_assert.vh"
// cchip_block_ram for Lattice ECP5: blocks DP16KD with their own output registers, which Yosys does
// not pack. Takes the place of common/cchip_block_ram.v in rtl/cchip_ecp5.f.
//   LUTs         WORDS = 1 and ADDR_W up to 4: distributed RAM, of which a block would hold 3 %
//   blocks       one for 36 bits of a word with WORDS = 1 and ADDR_W up to 9, its ports as one pair
//                for writing and reading; for 18 bits with ADDR_W = 10; for 9 bits with WORDS = 4
//                and ADDR_W up to 11, written 36 bits wide
//   inference    larger memories; their output register is made of flip-flops
//   latency, throughput, collision, cuts, reset   those of common/cchip_block_ram.v
module cchip_block_ram #(
    // see common/cchip_block_ram.v
    parameter integer WIDTH = 8,
    parameter integer WORDS = 1,
    parameter integer ADDR_W = 9,
    parameter integer MIXED_WIDTH = 1
) (
    input  wire                                   clk,
    input  wire                                   write,
    input  wire [ADDR_W-(WORDS==4 ? 2 : 0)-1:0] write_addr,
    input  wire [                WORDS*WIDTH-1:0] write_data,
    input  wire [                     ADDR_W-1:0] read_addr,
    output wire [                      WIDTH-1:0] read_data
);

  localparam integer BITS = WORDS == 4 ? 9 : ADDR_W <= 9 ? 36 : 18;  // of a word in a block
  localparam integer BLOCKS = (WIDTH + BITS - 1) / BITS;
  localparam integer FITS = BITS == 9 ? 11 : BITS == 36 ? 9 : 10;  // address bits of a block
  localparam integer WRITTEN = BITS == 18 ? 18 : 36;  // bits of a block that are written at once

  `CCHIP_REFUSE(WIDTH < 1 || ADDR_W < 3 || ADDR_W > 16,
                cchip_error_block_ram_WIDTH_below_1_or_ADDR_W_not_3_to_16)
  `CCHIP_REFUSE(WORDS != 1 && WORDS != 4, cchip_error_block_ram_WORDS_must_be_1_or_4)

  generate
    if (WORDS == 1 && ADDR_W <= 4) begin : gen_distributed
      // the first register holds the address, which is narrower than the word
      (* ram_style = "distributed" *)
      reg [WIDTH-1:0] mem[0:(1<<ADDR_W)-1];
      reg [ADDR_W-1:0] read_addr_q;
      reg [WIDTH-1:0] read_data_q;
      always @(posedge clk) if (write) mem[write_addr] <= write_data;
      always @(posedge clk) begin
        read_addr_q <= read_addr;
        read_data_q <= mem[read_addr_q];
      end
      assign read_data = read_data_q;
      wire unused = &{1'b0, MIXED_WIDTH};
    end else if (ADDR_W <= FITS) begin : gen_blocks
      // the address of a block is that of a bit; the lowest bits of the port for writing enable
      // the bytes
      wire [13:0] write_bit, read_bit;
      if (WRITTEN == 36) begin : gen_four_bytes
        assign write_bit = {{FITS - ADDR_W{1'b0}}, write_addr, 5'b01111};
      end else begin : gen_two_bytes
        assign write_bit = {{FITS - ADDR_W{1'b0}}, write_addr, 4'b0011};
      end
      assign read_bit = {{FITS - ADDR_W{1'b0}}, read_addr, {14 - FITS{1'b0}}};
      wire [WORDS*BLOCKS*BITS-1:0] padded;  // words, each filled up to whole blocks
      wire [BLOCKS*BITS-1:0] found;
      assign read_data = found[WIDTH-1:0];
      genvar w, b;
      for (w = 0; w < WORDS; w = w + 1) begin : gen_padded
        assign padded[BLOCKS*BITS*w+:WIDTH] = write_data[WIDTH*w+:WIDTH];
        if (BLOCKS * BITS > WIDTH) begin : gen_rest
          assign padded[BLOCKS*BITS*w+WIDTH+:BLOCKS*BITS-WIDTH] = {BLOCKS * BITS - WIDTH{1'b0}};
        end
      end
      for (b = 0; b < BLOCKS; b = b + 1) begin : gen_block
        wire [35:0] d, q;
        for (w = 0; w < WORDS; w = w + 1) begin : gen_words
          assign d[BITS*w+:BITS] = padded[BLOCKS*BITS*w+BITS*b+:BITS];
        end
        if (WRITTEN < 36) begin : gen_upper
          assign d[35:18] = 18'd0;
        end
        if (BITS == 36) begin : gen_both
          assign found[36*b+:36] = q;
        end else begin : gen_port_b
          assign found[BITS*b+:BITS] = q[18+:BITS];
        end
        cchip_dp16kd #(.WIDTH_A(WRITTEN), .WIDTH_B(BITS)) u_block (
            .clk   (clk),
            .write (write),
            .addr_a(write_bit),
            .d_a   (d[17:0]),
            .d_b   (d[35:18]),
            .q_a   (q[17:0]),
            .addr_b(read_bit),
            .q_b   (q[35:18])
        );
        wire unused = &{1'b0, q};
      end
      wire unused = &{1'b0, found, MIXED_WIDTH};
    end else begin : gen_inferred
      (* ram_style = "block", no_rw_check *)
      reg [WIDTH-1:0] mem [0:(1<<ADDR_W)-1];
      reg [WIDTH-1:0] word_q, read_data_q;
      integer i;
      if (WORDS == 4) begin : gen_wide
        always @(posedge clk)
          for (i = 0; i < 4; i = i + 1)
            if (write) mem[{write_addr, i[1:0]}] <= write_data[WIDTH*i+:WIDTH];
      end else begin : gen_same
        always @(posedge clk) if (write) mem[write_addr] <= write_data;
      end
      always @(posedge clk) begin
        word_q      <= mem[read_addr];
        read_data_q <= word_q;
      end
      assign read_data = read_data_q;
      wire unused = &{1'b0, MIXED_WIDTH};
    end
  endgenerate

endmodule
`default_nettype wire
