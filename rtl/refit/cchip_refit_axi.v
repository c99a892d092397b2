// SPDX-License-Identifier: Apache-2.0 WITH SHL-2.1
`default_nettype none
`include "cchip_defs.vh"
`include "cchip_assert.vh"
// cchip_refit_axi: cchip_refit with a cchip_axi_read and a cchip_axi_write of its own, for an AXI4
// memory. Commands, codes and rules are those of cchip_refit.
//   traffic      one line at a time: a read or a write, each a burst of a whole line, aligned
//   limit        of each read and write. The engine itself waits 4 `limit` + 64 clocks, 2^32 - 1 at
//                most, longer than its masters need to say that memory is silent; 0: the defaults
//   outstanding  memory owes an answer to a request of this refit, or of one that was given up
//   latency      7 clocks from s_valid to arvalid
//   cuts         every path: each output is a flip-flop or decoded from flip-flops
//   reset        must reset the bus too, unless s_ready = 1 or m_valid = 1, and outstanding = 0:
//                after an abort, wait for both
module cchip_refit_axi #(
    // levels of nodes, leaves not included: 2..64; a tree of the library has 47 at most
    parameter integer LEVELS = 48,
    // width of the data bus, bit: 64, 128, 256 or 512
    parameter integer DATA_W = 128,
    // AxCACHE of reads and of writes, 0..15, AxPROT of both, 0..7
    parameter integer AXI_ARCACHE = 3,
    parameter integer AXI_AWCACHE = 2,
    parameter integer AXI_PROT = 0
) (
    input  wire                           clk,
    input  wire                           rst,
    input  wire [                   31:0] limit,          // clocks; 0: default
    input  wire                           s_abort,        // a pulse or longer
    // a refit
    input  wire                           s_valid,
    output wire                           s_ready,
    input  wire [                   31:0] s_base,         // address of the image / 64
    input  wire [                   31:0] s_lines,        // of the image
    input  wire [                   23:0] s_root,         // line of the root
    // its end
    output wire                           m_valid,
    input  wire                           m_ready,
    output wire [`CCHIP_REFIT_CODE_W-1:0] m_code,
    output wire [                   23:0] m_line,
    output wire [                   23:0] m_lines,
    output wire                           outstanding,
    // memory
    output wire                           m_axi_arvalid,
    input  wire                           m_axi_arready,
    output wire                           m_axi_arid,
    output wire [                   63:0] m_axi_araddr,
    output wire [                    7:0] m_axi_arlen,
    output wire [                    2:0] m_axi_arsize,
    output wire [                    1:0] m_axi_arburst,
    output wire [                    3:0] m_axi_arcache,
    output wire [                    2:0] m_axi_arprot,
    input  wire                           m_axi_rvalid,
    output wire                           m_axi_rready,
    input  wire                           m_axi_rid,
    input  wire [             DATA_W-1:0] m_axi_rdata,
    input  wire [                    1:0] m_axi_rresp,
    input  wire                           m_axi_rlast,
    output wire                           m_axi_awvalid,
    input  wire                           m_axi_awready,
    output wire                           m_axi_awid,
    output wire [                   63:0] m_axi_awaddr,
    output wire [                    7:0] m_axi_awlen,
    output wire [                    2:0] m_axi_awsize,
    output wire [                    1:0] m_axi_awburst,
    output wire [                    3:0] m_axi_awcache,
    output wire [                    2:0] m_axi_awprot,
    output wire                           m_axi_wvalid,
    input  wire                           m_axi_wready,
    output wire [             DATA_W-1:0] m_axi_wdata,
    output wire [           DATA_W/8-1:0] m_axi_wstrb,
    output wire                           m_axi_wlast,
    input  wire                           m_axi_bvalid,
    output wire                           m_axi_bready,
    input  wire                           m_axi_bid,
    input  wire [                    1:0] m_axi_bresp
);

  `CCHIP_REFUSE(DATA_W != 64 && DATA_W != 128 && DATA_W != 256 && DATA_W != 512,
                cchip_error_refit_axi_DATA_W_must_be_64_128_256_or_512)

  localparam integer BEAT_W = 6 - $clog2(DATA_W / 8);  // of the number of a beat in its line
  localparam integer ADDRESS_W = 58 + BEAT_W;

  reg [31:0] refit_limit_q;
  always @(posedge clk)
    refit_limit_q <= limit == 32'd0 ? 32'd0 :
        limit[31:29] != 3'd0 ? 32'hFFFFFFFF : {1'b0, limit[28:0], 2'd0} + 32'd64;

  wire read_valid, beat_valid, beat_last;
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
      .m_read_line  (read_line),
      .s_read_valid (beat_valid),
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
  wire beat_slot;
  wire [2:0] beat;
  wire [1:0] slots_outstanding;
  cchip_axi_read #(
      .CLIENTS    (1),
      .SLOTS      (2),
      .DATA_W     (DATA_W),
      .AXI_ARCACHE(AXI_ARCACHE),
      .AXI_PROT   (AXI_PROT)
  ) u_read (
      .clk            (clk),
      .rst            (rst),
      .limit          (limit),
      .s_valid        (read_valid),
      .s_slot         (1'b0),
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
      .m_axi_arsize   (m_axi_arsize),
      .m_axi_arburst  (m_axi_arburst),
      .m_axi_arcache  (m_axi_arcache),
      .m_axi_arprot   (m_axi_arprot),
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
      .ID_W       (1),
      .AXI_AWCACHE(AXI_AWCACHE),
      .AXI_PROT   (AXI_PROT)
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
      .m_axi_awsize   (m_axi_awsize),
      .m_axi_awburst  (m_axi_awburst),
      .m_axi_awcache  (m_axi_awcache),
      .m_axi_awprot   (m_axi_awprot),
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

  wire unused = &{1'b0, beat_slot, beat, slots_outstanding, write_beat};

endmodule
`default_nettype wire
