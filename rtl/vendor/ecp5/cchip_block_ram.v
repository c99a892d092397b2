// SPDX-License-Identifier: Apache-2.0 WITH SHL-2.1
`default_nettype none
// cchip_block_ram for Lattice ECP5: blocks DP16KD with their own output registers, which Yosys does
// not pack. Takes the place of common/cchip_block_ram.v in rtl/cchip_ecp5.f.
//   blocks       WORDS = 1: one for 18 bits of a word, up to ADDR_W = 10; WORDS = 4: one for 9
//                bits, written 36 bits wide, up to ADDR_W = 11. Larger memories are left to
//                inference, their output register is made of flip-flops
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

  localparam integer LEAST = WORDS == 4 ? 9 : 18;  // bits of a word in a block
  localparam integer BLOCKS = (WIDTH + LEAST - 1) / LEAST;
  localparam integer FITS = WORDS == 4 ? 11 : 10;  // address bits of a block

  generate
    if (WIDTH < 1 || ADDR_W < 3 || ADDR_W > 16) begin : gen_illegal
      cchip_error_block_ram_WIDTH_below_1_or_ADDR_W_not_3_to_16 u_error ();
    end
    if (WORDS != 1 && WORDS != 4) begin : gen_illegal_words
      cchip_error_block_ram_WORDS_must_be_1_or_4 u_error ();
    end

    if (ADDR_W <= FITS) begin : gen_blocks
      // the address of a block is that of a bit; the lowest bits of the port for writing enable
      // the bytes
      wire [13:0] write_bit, read_bit;
      if (WORDS == 4) begin : gen_wide
        assign write_bit = {{FITS - ADDR_W{1'b0}}, write_addr, 1'b0, 4'b1111};
        assign read_bit  = {{FITS - ADDR_W{1'b0}}, read_addr, 3'd0};
      end else begin : gen_same
        assign write_bit = {{FITS - ADDR_W{1'b0}}, write_addr, 4'b0011};
        assign read_bit  = {{FITS - ADDR_W{1'b0}}, read_addr, 4'd0};
      end
      wire [WORDS*BLOCKS*LEAST-1:0] padded;  // words, each filled up to whole blocks
      wire [BLOCKS*LEAST-1:0] found;
      assign read_data = found[WIDTH-1:0];
      genvar w, b;
      for (w = 0; w < WORDS; w = w + 1) begin : gen_padded
        assign padded[BLOCKS*LEAST*w+:WIDTH] = write_data[WIDTH*w+:WIDTH];
        if (BLOCKS * LEAST > WIDTH) begin : gen_rest
          assign padded[BLOCKS*LEAST*w+WIDTH+:BLOCKS*LEAST-WIDTH] = {BLOCKS * LEAST - WIDTH{1'b0}};
        end
      end
      for (b = 0; b < BLOCKS; b = b + 1) begin : gen_block
        wire [35:0] d;
        wire [17:0] q, unused_a;
        for (w = 0; w < WORDS; w = w + 1) begin : gen_words
          assign d[LEAST*w+:LEAST] = padded[BLOCKS*LEAST*w+LEAST*b+:LEAST];
        end
        if (WORDS == 1) begin : gen_upper
          assign d[35:18] = 18'd0;
        end
        assign found[LEAST*b+:LEAST] = q[LEAST-1:0];
        cchip_dp16kd #(
            .WIDTH_A(WORDS == 4 ? 36 : 18),
            .WIDTH_B(LEAST)
        ) u_block (
            .clk   (clk),
            .write (write),
            .addr_a(write_bit),
            .d_a   (d[17:0]),
            .d_b   (d[35:18]),
            .q_a   (unused_a),
            .addr_b(read_bit),
            .q_b   (q)
        );
        wire unused = &{1'b0, q, unused_a};
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
