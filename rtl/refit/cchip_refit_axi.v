// SPDX-License-Identifier: Apache-2.0 WITH SHL-2.1
`default_nettype none
`include "cchip_defs.vh"
`include "cchip_assert.vh"
// cchip_refit_axi: cchip_refit with a cchip_axi_read and a cchip_axi_write of its own, for an AXI4
// memory. Commands, codes and rules are those of cchip_refit.
//   traffic      two reads, under IDs 0 and 1, and a write at most in flight, each a burst of a
//                whole line, aligned
//   limit        of each read and write. The engine itself waits 4 `limit` + 64 clocks, 2^32 - 1 at
//                most, longer than its masters need to say that memory is silent; 0: the defaults
//   outstanding  the answer to a request of this refit, or of an abandoned one, is pending
//   latency      7 clocks from s_valid to arvalid
//   cuts         every path: each output is a flip-flop or decoded from flip-flops
//   reset        must reset the bus too, unless s_ready = 1 or m_valid = 1, and outstanding = 0:
//                after an abort, wait for both
module cchip_refit_axi #(
    // levels of nodes in work, leaves not included; a tree of the library has 47 at most; legal:
    // 2..64
    parameter integer LEVELS = 48,
    parameter integer DATA_W = 128,     // width of the data bus (bit); legal: 64, 128, 256, 512
    // ARCACHE: 3 normal memory, 15 a coherent port; legal: 0..15
    parameter integer AXI_ARCACHE = 3,
    // AWCACHE: 2 normal memory, 15 a coherent port; legal: 0..15
    parameter integer AXI_AWCACHE = 2,
    parameter integer AXI_PROT = 0      // AxPROT: 0 secure, 2 non-secure; legal: 0..7
) (
    input  wire                           clk,            // clock, rising edge
    input  wire                           rst,            // synchronous reset, active high
    // longest read and longest write, clocks; 0: CCHIP_MEMORY_LIMIT_DEFAULT
    input  wire [                   31:0] limit,
    // ends the refit before its next request; a pulse or longer
    input  wire                           s_abort,
    input  wire                           s_valid,        // a refit
    output wire                           s_ready,        // it is taken
    input  wire [                   31:0] s_base,         // address of the image / 64
    input  wire [                   31:0] s_lines,        // lines of the image
    input  wire [                   23:0] s_root,         // line of its root
    // ---- its end
    output wire                           m_valid,        // the refit has ended
    input  wire                           m_ready,        // its end is taken
    output wire [`CCHIP_REFIT_CODE_W-1:0] m_code,         // RefitCode, docs/hardware/definitions.md
    // current line when it ended, 0 if there was none
    output wire [                   23:0] m_line,
    output wire [                   23:0] m_lines,        // lines read
    // the answer to a request, abandoned or not, is pending
    output wire                           outstanding,
    // ---- memory
    output wire                           m_axi_arvalid,  // AXI4 read address
    input  wire                           m_axi_arready,  // AXI4
    output wire                           m_axi_arid,     // 0 or 1
    output wire [                   63:0] m_axi_araddr,   // address of a line, bytes
    output wire [                    7:0] m_axi_arlen,    // a whole line: 512 / DATA_W - 1
    output wire [                    2:0] m_axi_arsize,   // AXI4
    output wire [                    1:0] m_axi_arburst,  // INCR
    output wire [                    3:0] m_axi_arcache,  // AXI4
    output wire [                    2:0] m_axi_arprot,   // AXI4
    input  wire                           m_axi_rvalid,   // AXI4 read data
    output wire                           m_axi_rready,   // always 1 after reset
    input  wire                           m_axi_rid,      // AXI4
    input  wire [             DATA_W-1:0] m_axi_rdata,    // AXI4
    input  wire [                    1:0] m_axi_rresp,    // anything but OKAY is an error
    input  wire                           m_axi_rlast,    // AXI4
    output wire                           m_axi_awvalid,  // AXI4 write address
    input  wire                           m_axi_awready,  // AXI4
    output wire                           m_axi_awid,     // always 0
    output wire [                   63:0] m_axi_awaddr,   // address of a line, bytes
    output wire [                    7:0] m_axi_awlen,    // a whole line
    output wire [                    2:0] m_axi_awsize,   // AXI4
    output wire [                    1:0] m_axi_awburst,  // INCR
    output wire [                    3:0] m_axi_awcache,  // AXI4
    output wire [                    2:0] m_axi_awprot,   // AXI4
    output wire                           m_axi_wvalid,   // AXI4 write data
    input  wire                           m_axi_wready,   // AXI4
    output wire [             DATA_W-1:0] m_axi_wdata,    // AXI4
    // all ones; zeros for the rest of a write that was given up
    output wire [           DATA_W/8-1:0] m_axi_wstrb,
    output wire                           m_axi_wlast,    // AXI4
    input  wire                           m_axi_bvalid,   // AXI4 write response
    output wire                           m_axi_bready,   // always 1 after reset
    input  wire                           m_axi_bid,      // AXI4
    input  wire [                    1:0] m_axi_bresp     // anything but OKAY is an error
);

  `CCHIP_REFUSE(DATA_W != 64 && DATA_W != 128 && DATA_W != 256 && DATA_W != 512,
                cchip_error_refit_axi_DATA_W_must_be_64_128_256_or_512)

  localparam integer BEAT_W = 6 - $clog2(DATA_W / 8);  // of the number of a beat in its line
  localparam integer ADDRESS_W = 58 + BEAT_W;

  // ---- what every address says: INCR bursts of whole beats. Writes are not bufferable by default:
  // the response comes from where the data are seen by all
  localparam [31:0] BEAT = $clog2(DATA_W / 8);
  localparam [31:0] ARCACHE = AXI_ARCACHE;
  localparam [31:0] AWCACHE = AXI_AWCACHE;
  localparam [31:0] PROT = AXI_PROT;
  `CCHIP_REFUSE(AXI_ARCACHE < 0 || AXI_ARCACHE > 15, cchip_error_AXI_ARCACHE_must_be_0_to_15)
  `CCHIP_REFUSE(AXI_AWCACHE < 0 || AXI_AWCACHE > 15, cchip_error_AXI_AWCACHE_must_be_0_to_15)
  `CCHIP_REFUSE(AXI_PROT < 0 || AXI_PROT > 7, cchip_error_AXI_PROT_must_be_0_to_7)
  assign m_axi_arsize  = BEAT[2:0];
  assign m_axi_arburst = 2'b01;
  assign m_axi_arcache = ARCACHE[3:0];
  assign m_axi_arprot  = PROT[2:0];
  assign {m_axi_awsize, m_axi_awburst, m_axi_awprot} = {m_axi_arsize, m_axi_arburst, m_axi_arprot};
  assign m_axi_awcache = AWCACHE[3:0];

  reg [31:0] refit_limit_q;
  always @(posedge clk)
    refit_limit_q <= limit == 32'd0 ? 32'd0 :
        limit[31:29] != 3'd0 ? 32'hFFFFFFFF : {1'b0, limit[28:0], 2'd0} + 32'd64;

  wire read_valid, read_slot, beat_valid, beat_slot, beat_last;
  wire [2:0] beat;
  wire [31:0] read_line;
  wire [`CCHIP_READ_CODE_W-1:0] beat_code;
  wire [DATA_W-1:0] beat_data;
  wire write_valid, write_ready, write_last, answer_valid;
  wire [31:0] write_line;
  wire [DATA_W-1:0] write_data;
  wire [`CCHIP_WRITE_CODE_W-1:0] answer_code;
  wire [2:0] write_beat;
  cchip_refit #(.LEVELS(LEVELS), .DATA_W(DATA_W)) u_refit (
      .clk          (clk),
      .rst          (rst),
      .limit        (refit_limit_q),
      .s_abort      (s_abort),
      .s_valid      (s_valid),
      .s_ready      (s_ready),
      .s_base       (s_base),
      .s_lines      (s_lines),
      .s_root       (s_root),
      .m_valid      (m_valid),
      .m_ready      (m_ready),
      .m_code       (m_code),
      .m_line       (m_line),
      .m_lines      (m_lines),
      .m_read_valid (read_valid),
      .m_read_slot  (read_slot),
      .m_read_line  (read_line),
      .s_read_valid (beat_valid),
      .s_read_slot  (beat_slot),
      .s_read_beat  (beat),
      .s_read_last  (beat_last),
      .s_read_code  (beat_code),
      .s_read_data  (beat_data),
      .m_write_valid(write_valid),
      .m_write_ready(write_ready),
      .m_write_last (write_last),
      .m_write_line (write_line),
      .m_write_beat (write_beat),
      .m_write_data (write_data),
      .s_write_valid(answer_valid),
      .s_write_code (answer_code)
  );

  wire read_outstanding, write_outstanding;
  wire [1:0] slots_outstanding;
  cchip_axi_read #(
      .CLIENTS(1),
      .SLOTS  (2),
      .DATA_W (DATA_W)
  ) u_read (
      .clk            (clk),
      .rst            (rst),
      .limit          (limit),
      .s_valid        (read_valid),
      .s_slot         (read_slot),
      .s_line         ({26'd0, read_line}),
      .m_valid        (beat_valid),
      .m_slot         (beat_slot),
      .m_beat         (beat),
      .m_last         (beat_last),
      .m_code         (beat_code),
      .m_data         (beat_data),
      .any_outstanding(read_outstanding),
      .outstanding    (slots_outstanding),
      .m_axi_arvalid  (m_axi_arvalid),
      .m_axi_arready  (m_axi_arready),
      .m_axi_arid     (m_axi_arid),
      .m_axi_araddr   (m_axi_araddr),
      .m_axi_arlen    (m_axi_arlen),
      .m_axi_rvalid   (m_axi_rvalid),
      .m_axi_rready   (m_axi_rready),
      .m_axi_rid      (m_axi_rid),
      .m_axi_rdata    (m_axi_rdata),
      .m_axi_rresp    (m_axi_rresp),
      .m_axi_rlast    (m_axi_rlast)
  );

  // the address counts in beats; it is looked at with the first one
  wire [ADDRESS_W-1:0] write_address = {{(ADDRESS_W - 32) {1'b0}}, write_line} << BEAT_W;
  cchip_axi_write #(
      .CLIENTS    (1),
      .DATA_W     (DATA_W),
      .OUTSTANDING(1),
      .ID_W       (1)
  ) u_write (
      .clk            (clk),
      .rst            (rst),
      .limit          (limit),
      .s_valid        (write_valid),
      .s_ready        (write_ready),
      .s_last         (write_last),
      .s_address      (write_address),
      .s_data         (write_data),
      .s_strb         ({(DATA_W / 8) {1'b1}}),
      .m_valid        (answer_valid),
      .m_code         (answer_code),
      .any_outstanding(write_outstanding),
      .m_axi_awvalid  (m_axi_awvalid),
      .m_axi_awready  (m_axi_awready),
      .m_axi_awid     (m_axi_awid),
      .m_axi_awaddr   (m_axi_awaddr),
      .m_axi_awlen    (m_axi_awlen),
      .m_axi_wvalid   (m_axi_wvalid),
      .m_axi_wready   (m_axi_wready),
      .m_axi_wdata    (m_axi_wdata),
      .m_axi_wstrb    (m_axi_wstrb),
      .m_axi_wlast    (m_axi_wlast),
      .m_axi_bvalid   (m_axi_bvalid),
      .m_axi_bready   (m_axi_bready),
      .m_axi_bid      (m_axi_bid),
      .m_axi_bresp    (m_axi_bresp)
  );
  assign outstanding = read_outstanding | write_outstanding;

  wire unused = &{1'b0, slots_outstanding, write_beat};

endmodule
`default_nettype wire
