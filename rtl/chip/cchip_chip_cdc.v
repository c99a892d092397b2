// SPDX-License-Identifier: Apache-2.0 WITH SHL-2.1
`default_nettype none
`include "cchip_defs.vh"
// cchip_chip_cdc: cchip_chip with a clock of its own: its registers and interrupt on the clock of
// the host's bus, its memory ports on that of memory, through cchip_axil_cdc and cchip_axi_cdc.
//   clocks       clk, axil_clk and mem_clk of any ratio and phase; the same net may be given to two
//   latency      of the chip, and of cchip_async_fifo for each way through a bridge: a register 2
//                ways, a read of memory 2 ways
//   throughput   a beat of memory per clock of the slower of clk and mem_clk
//   cfg port     cfg_valid, cfg_data on clk, cfg_error from any clock, as in cchip_chip
//   cuts         every path but from the resets
//   reset        rst, axil_rst and mem_rst, each on its clock, together or one after the other, for
//                2 clocks or more. Reset all three, and both buses with them, unless nothing is
//                outstanding: a bridge does not end what the bus behind it still awaits
//   constraints  scripts/vivado/cdc.xdc, scripts/quartus/cdc.sdc
//   test         tests/icarus/bench_cdc.v: the bridges; bench_chip_cdc.v: registers, a read of
//                memory and the interrupt through them
module cchip_chip_cdc #(
    parameter integer QUERIES = 16,  // queries at once (query); legal: 2, 4, 8, 16
    parameter integer PAIRS = 48,  // node pairs in flight; legal: see cchip_traversal
    // leaf pairs that are fetched at once; legal: PAIRS + LEAVES is 8, 16, 32 or 64
    parameter integer LEAVES = 16,
    parameter integer STACK = 64,  // entries of a query's stack (entry); legal: 8, 16, 32, 64
    // entries of the queue of leaves (entry); legal: over PAIRS, to 128
    parameter integer LEAF_DEPTH = 72,
    parameter integer CACHE_KB = 128,  // size of the cache (KiB); legal: 4, 8 ... 1024
    parameter integer MISSES = 32,  // lines in flight from memory; legal: 4, 8, 16, 32
    parameter integer LOCKS = 2,  // ranges of lines to lock; legal: 1..4
    parameter integer COORD_W = 16,  // width of a coordinate on the grid (bit); legal: 4..20
    // registers of the primitive test's stages (clock); legal: see cchip_primtest
    parameter integer SUBSTAGES = `CCHIP_SUBSTAGES_DEFAULT,
    parameter integer PASSES = 1,  // a vertex in the transform (clock); legal: 1, 2
    parameter integer QUEUE_DEPTH = 64,  // primitive pairs that wait; legal: 16, 32 ... 256
    // leaf pairs between leaf feed and record; legal: 4, 8 ... 256
    parameter integer LEAF_NUMBERS = 64,
    parameter integer SLOTS = 1,  // slots of primitive tests; legal: 1..4
    parameter integer SWAPS = 0,  // 1: their modules are exchanged at run time; legal: 0, 1
    // module of slot 0: triangles, triangle and quad, quads; with SWAPS at power-up; legal: 1, 2,
    // 3, with SWAPS 0, too
    parameter integer RM_ID = 3,
    parameter integer SLOT1_RM_ID = 1,                         // of slot 1 (module); legal: 0..3
    parameter integer SLOT2_RM_ID = 2,                         // of slot 2 (module); legal: 0..3
    parameter integer SLOT3_RM_ID = 1,                         // of slot 3 (module); legal: 0..3
    parameter integer CFG_W = 8,  // width of the configuration port (bit); legal: 8, 32
    parameter integer CFG_DIVIDER = 2,  // clocks per word of the port; legal: from 1 on
    // reset on configuration (clock); legal: from 1 on
    parameter integer ROC_CYCLES = `CCHIP_ROC_CLOCKS_DEFAULT,
    // 1: simulated reconfiguration (see cchip_pr_slot); legal: 0, 1
    parameter integer SIMULATION = 0,
    parameter integer SEED = 1,  // start of its random numbers; legal: any
    parameter integer DATA_W = 128,  // width of the data buses (bit); legal: 128, 256, 512
    // ARCACHE: 3 normal memory, 15 a coherent port; legal: 0..15
    parameter integer AXI_ARCACHE = 3,
    // AWCACHE: 2 normal memory, 15 a coherent port; legal: 0..15
    parameter integer AXI_AWCACHE = 2,
    parameter integer AXI_PROT = 0,  // AxPROT: 0 secure, 2 non-secure; legal: 0..7
    // beats of a channel to memory; legal: 4, 8, 16 ... 4096
    parameter integer CDC_DEPTH = 16,
    parameter integer STAGES = 2  // flip-flops of each synchroniser; legal: 2..4
) (
    // ---- clock and reset of the chip and of the configuration port
    input  wire                          clk,                // clock, rising edge
    input  wire                          rst,                // synchronous reset, active high
    // ---- registers, AXI4-Lite, on axil_clk: docs/hardware/chip-registers.md
    input  wire                          axil_clk,           // clock of the registers' bus and irq
    input  wire                          axil_rst,           // synchronous reset, active high
    input  wire                          s_axil_awvalid,
    output wire                          s_axil_awready,
    input  wire [                  11:0] s_axil_awaddr,
    input  wire [                   2:0] s_axil_awprot,
    input  wire                          s_axil_wvalid,
    output wire                          s_axil_wready,
    input  wire [                  31:0] s_axil_wdata,
    input  wire [                   3:0] s_axil_wstrb,
    output wire                          s_axil_bvalid,
    input  wire                          s_axil_bready,
    output wire [                   1:0] s_axil_bresp,
    input  wire                          s_axil_arvalid,
    output wire                          s_axil_arready,
    input  wire [                  11:0] s_axil_araddr,
    input  wire [                   2:0] s_axil_arprot,
    output wire                          s_axil_rvalid,
    input  wire                          s_axil_rready,
    output wire [                  31:0] s_axil_rdata,
    output wire [                   1:0] s_axil_rresp,
    // ---- interrupt, on axil_clk
    // an event that is enabled; level, with a phase of 0 after each write of interrupt_status
    output wire                          irq,
    // ---- memory, AXI4 read, on mem_clk: images, queries, records
    input  wire                          mem_clk,            // clock of both memory buses
    input  wire                          mem_rst,            // synchronous reset, active high
    output wire                          m_axi_arvalid,      // read address: valid
    input  wire                          m_axi_arready,      // taken
    output wire [      $clog2(MISSES):0] m_axi_arid,         // ID: {client, slot}
    output wire [                  63:0] m_axi_araddr,       // address, a multiple of 64
    output wire [                   7:0] m_axi_arlen,        // beats of a line - 1
    output wire [                   2:0] m_axi_arsize,       // whole beats
    output wire [                   1:0] m_axi_arburst,      // INCR
    output wire [                   3:0] m_axi_arcache,      // normal, not cacheable, bufferable
    output wire [                   2:0] m_axi_arprot,       // unprivileged, secure, data
    input  wire                          m_axi_rvalid,       // read data: valid
    output wire                          m_axi_rready,       // taken
    input  wire [      $clog2(MISSES):0] m_axi_rid,          // ID
    input  wire [            DATA_W-1:0] m_axi_rdata,        // data
    input  wire [                   1:0] m_axi_rresp,        // response
    input  wire                          m_axi_rlast,        // last beat
    // ---- memory, AXI4 write, on mem_clk
    output wire                          m_axi_awvalid,      // write address: valid
    input  wire                          m_axi_awready,      // taken
    output wire                          m_axi_awid,         // 0
    output wire [                  63:0] m_axi_awaddr,       // address, a multiple of the beat
    output wire [                   7:0] m_axi_awlen,        // 0: one beat
    output wire [                   2:0] m_axi_awsize,       // whole beats
    output wire [                   1:0] m_axi_awburst,      // INCR
    output wire [                   3:0] m_axi_awcache,  // normal, not cacheable, not bufferable
    output wire [                   2:0] m_axi_awprot,       // unprivileged, secure, data
    output wire                          m_axi_wvalid,       // write data: valid
    input  wire                          m_axi_wready,       // taken
    output wire [            DATA_W-1:0] m_axi_wdata,        // data
    output wire [          DATA_W/8-1:0] m_axi_wstrb,        // the 16 bytes of a record
    output wire                          m_axi_wlast,        // 1
    input  wire                          m_axi_bvalid,       // response of a write: valid
    output wire                          m_axi_bready,       // taken
    input  wire                          m_axi_bid,          // 0
    input  wire [                   1:0] m_axi_bresp,        // response
    // ---- configuration port of the device, on clk
    output wire                          cfg_valid,  // a word is written to the configuration port
    output wire [             CFG_W-1:0] cfg_data,           // the word
    // the device reports an error of its configuration, from any clock; a level, or a pulse of at
    // least two clocks of clk
    input  wire                          cfg_error,
    // ---- memory of the bitstreams, AXI4 read, on mem_clk
    // memory of the bitstreams: AXI4 read, address
    output wire                          m_axi_cfg_arvalid,
    // memory of the bitstreams: AXI4 read, address
    input  wire                          m_axi_cfg_arready,
    // memory of the bitstreams: AXI4 read, address, byte
    output wire [                  31:0] m_axi_cfg_araddr,
    // memory of the bitstreams: AXI4 read, beats - 1, at most 15
    output wire [                   7:0] m_axi_cfg_arlen,
    // memory of the bitstreams: AXI4 read, 2: 4 bytes per beat
    output wire [                   2:0] m_axi_cfg_arsize,
    // memory of the bitstreams: AXI4 read, 1: INCR
    output wire [                   1:0] m_axi_cfg_arburst,
    // memory of the bitstreams: AXI4 read, constant
    output wire [                   3:0] m_axi_cfg_arcache,
    // memory of the bitstreams: AXI4 read, constant
    output wire [                   2:0] m_axi_cfg_arprot,
    // memory of the bitstreams: AXI4 read, data
    input  wire                          m_axi_cfg_rvalid,
    // memory of the bitstreams: AXI4 read, data
    output wire                          m_axi_cfg_rready,
    // memory of the bitstreams: AXI4 read, data
    input  wire [                  31:0] m_axi_cfg_rdata,
    // memory of the bitstreams: AXI4 read, response
    input  wire [                   1:0] m_axi_cfg_rresp,
    // memory of the bitstreams: AXI4 read, last beat of the burst
    input  wire                          m_axi_cfg_rlast
);

  wire chip_axil_awvalid, chip_axil_awready, chip_axil_wvalid, chip_axil_wready,
      chip_axil_bvalid, chip_axil_bready, chip_axil_arvalid, chip_axil_arready, chip_axil_rvalid,
      chip_axil_rready, chip_irq, chip_axi_arvalid, chip_axi_arready, chip_axi_rvalid,
      chip_axi_rready, chip_axi_rlast, chip_axi_awvalid, chip_axi_awready, chip_axi_awid,
      chip_axi_wvalid, chip_axi_wready, chip_axi_wlast, chip_axi_bvalid, chip_axi_bready,
      chip_axi_bid, chip_axi_cfg_arvalid, chip_axi_cfg_arready, chip_axi_cfg_rvalid,
      chip_axi_cfg_rready, chip_axi_cfg_rlast;
  wire [11:0] chip_axil_awaddr, chip_axil_araddr;
  wire [2:0] chip_axil_awprot, chip_axil_arprot;
  wire [31:0] chip_axil_wdata, chip_axil_rdata, chip_axi_cfg_araddr, chip_axi_cfg_rdata;
  wire [3:0] chip_axil_wstrb;
  wire [1:0] chip_axil_bresp, chip_axil_rresp, chip_axi_rresp, chip_axi_bresp, chip_axi_cfg_rresp;
  wire [$clog2(MISSES):0] chip_axi_arid, chip_axi_rid;
  wire [63:0] chip_axi_araddr, chip_axi_awaddr;
  wire [7:0] chip_axi_arlen, chip_axi_awlen, chip_axi_cfg_arlen;
  wire [DATA_W-1:0] chip_axi_rdata, chip_axi_wdata;
  wire [DATA_W/8-1:0] chip_axi_wstrb;

  cchip_axil_cdc #(.ADDRESS_W(12), .DEPTH(4), .STAGES(STAGES)) u_registers (
      .s_clk         (axil_clk),
      .s_rst         (axil_rst),
      .s_axil_awvalid(s_axil_awvalid),
      .s_axil_awready(s_axil_awready),
      .s_axil_awaddr (s_axil_awaddr),
      .s_axil_awprot (s_axil_awprot),
      .s_axil_wvalid (s_axil_wvalid),
      .s_axil_wready (s_axil_wready),
      .s_axil_wdata  (s_axil_wdata),
      .s_axil_wstrb  (s_axil_wstrb),
      .s_axil_bvalid (s_axil_bvalid),
      .s_axil_bready (s_axil_bready),
      .s_axil_bresp  (s_axil_bresp),
      .s_axil_arvalid(s_axil_arvalid),
      .s_axil_arready(s_axil_arready),
      .s_axil_araddr (s_axil_araddr),
      .s_axil_arprot (s_axil_arprot),
      .s_axil_rvalid (s_axil_rvalid),
      .s_axil_rready (s_axil_rready),
      .s_axil_rdata  (s_axil_rdata),
      .s_axil_rresp  (s_axil_rresp),
      .s_irq         (irq),
      .m_clk         (clk),
      .m_rst         (rst),
      .m_axil_awvalid(chip_axil_awvalid),
      .m_axil_awready(chip_axil_awready),
      .m_axil_awaddr (chip_axil_awaddr),
      .m_axil_awprot (chip_axil_awprot),
      .m_axil_wvalid (chip_axil_wvalid),
      .m_axil_wready (chip_axil_wready),
      .m_axil_wdata  (chip_axil_wdata),
      .m_axil_wstrb  (chip_axil_wstrb),
      .m_axil_bvalid (chip_axil_bvalid),
      .m_axil_bready (chip_axil_bready),
      .m_axil_bresp  (chip_axil_bresp),
      .m_axil_arvalid(chip_axil_arvalid),
      .m_axil_arready(chip_axil_arready),
      .m_axil_araddr (chip_axil_araddr),
      .m_axil_arprot (chip_axil_arprot),
      .m_axil_rvalid (chip_axil_rvalid),
      .m_axil_rready (chip_axil_rready),
      .m_axil_rdata  (chip_axil_rdata),
      .m_axil_rresp  (chip_axil_rresp),
      .m_irq         (chip_irq)
  );

  // size, burst, cache and prot of all addresses are constants of the chip: no clock crosses there
  cchip_axi_cdc #(
      .ADDRESS_W (64),
      .DATA_W    (DATA_W),
      .ID_W      ($clog2(MISSES) + 1),
      .WRITE_ID_W(1),
      .DEPTH     (CDC_DEPTH),
      .STAGES    (STAGES)
  ) u_memory (
      .s_clk        (clk),
      .s_rst        (rst),
      .s_axi_arvalid(chip_axi_arvalid),
      .s_axi_arready(chip_axi_arready),
      .s_axi_arid   (chip_axi_arid),
      .s_axi_araddr (chip_axi_araddr),
      .s_axi_arlen  (chip_axi_arlen),
      .s_axi_rvalid (chip_axi_rvalid),
      .s_axi_rready (chip_axi_rready),
      .s_axi_rid    (chip_axi_rid),
      .s_axi_rdata  (chip_axi_rdata),
      .s_axi_rresp  (chip_axi_rresp),
      .s_axi_rlast  (chip_axi_rlast),
      .s_axi_awvalid(chip_axi_awvalid),
      .s_axi_awready(chip_axi_awready),
      .s_axi_awid   (chip_axi_awid),
      .s_axi_awaddr (chip_axi_awaddr),
      .s_axi_awlen  (chip_axi_awlen),
      .s_axi_wvalid (chip_axi_wvalid),
      .s_axi_wready (chip_axi_wready),
      .s_axi_wdata  (chip_axi_wdata),
      .s_axi_wstrb  (chip_axi_wstrb),
      .s_axi_wlast  (chip_axi_wlast),
      .s_axi_bvalid (chip_axi_bvalid),
      .s_axi_bready (chip_axi_bready),
      .s_axi_bid    (chip_axi_bid),
      .s_axi_bresp  (chip_axi_bresp),
      .m_clk        (mem_clk),
      .m_rst        (mem_rst),
      .m_axi_arvalid(m_axi_arvalid),
      .m_axi_arready(m_axi_arready),
      .m_axi_arid   (m_axi_arid),
      .m_axi_araddr (m_axi_araddr),
      .m_axi_arlen  (m_axi_arlen),
      .m_axi_rvalid (m_axi_rvalid),
      .m_axi_rready (m_axi_rready),
      .m_axi_rid    (m_axi_rid),
      .m_axi_rdata  (m_axi_rdata),
      .m_axi_rresp  (m_axi_rresp),
      .m_axi_rlast  (m_axi_rlast),
      .m_axi_awvalid(m_axi_awvalid),
      .m_axi_awready(m_axi_awready),
      .m_axi_awid   (m_axi_awid),
      .m_axi_awaddr (m_axi_awaddr),
      .m_axi_awlen  (m_axi_awlen),
      .m_axi_wvalid (m_axi_wvalid),
      .m_axi_wready (m_axi_wready),
      .m_axi_wdata  (m_axi_wdata),
      .m_axi_wstrb  (m_axi_wstrb),
      .m_axi_wlast  (m_axi_wlast),
      .m_axi_bvalid (m_axi_bvalid),
      .m_axi_bready (m_axi_bready),
      .m_axi_bid    (m_axi_bid),
      .m_axi_bresp  (m_axi_bresp)
  );

  // read only; with SWAPS = 0 the chip offers no address here, and synthesis removes both queues
  cchip_async_fifo #(.WIDTH(40), .DEPTH(CDC_DEPTH), .STAGES(STAGES)) u_cfg_ar (
      .s_clk  (clk),
      .s_rst  (rst),
      .s_valid(chip_axi_cfg_arvalid),
      .s_ready(chip_axi_cfg_arready),
      .s_data ({chip_axi_cfg_araddr, chip_axi_cfg_arlen}),
      .m_clk  (mem_clk),
      .m_rst  (mem_rst),
      .m_valid(m_axi_cfg_arvalid),
      .m_ready(m_axi_cfg_arready),
      .m_data ({m_axi_cfg_araddr, m_axi_cfg_arlen})
  );

  cchip_async_fifo #(.WIDTH(35), .DEPTH(CDC_DEPTH), .STAGES(STAGES)) u_cfg_r (
      .s_clk  (mem_clk),
      .s_rst  (mem_rst),
      .s_valid(m_axi_cfg_rvalid),
      .s_ready(m_axi_cfg_rready),
      .s_data ({m_axi_cfg_rdata, m_axi_cfg_rresp, m_axi_cfg_rlast}),
      .m_clk  (clk),
      .m_rst  (rst),
      .m_valid(chip_axi_cfg_rvalid),
      .m_ready(chip_axi_cfg_rready),
      .m_data ({chip_axi_cfg_rdata, chip_axi_cfg_rresp, chip_axi_cfg_rlast})
  );

  cchip_chip #(
      .QUERIES     (QUERIES),
      .PAIRS       (PAIRS),
      .LEAVES      (LEAVES),
      .STACK       (STACK),
      .LEAF_DEPTH  (LEAF_DEPTH),
      .CACHE_KB    (CACHE_KB),
      .MISSES      (MISSES),
      .LOCKS       (LOCKS),
      .COORD_W     (COORD_W),
      .SUBSTAGES   (SUBSTAGES),
      .PASSES      (PASSES),
      .QUEUE_DEPTH (QUEUE_DEPTH),
      .LEAF_NUMBERS(LEAF_NUMBERS),
      .SLOTS       (SLOTS),
      .SWAPS       (SWAPS),
      .RM_ID       (RM_ID),
      .SLOT1_RM_ID (SLOT1_RM_ID),
      .SLOT2_RM_ID (SLOT2_RM_ID),
      .SLOT3_RM_ID (SLOT3_RM_ID),
      .CFG_W       (CFG_W),
      .CFG_DIVIDER (CFG_DIVIDER),
      .ROC_CYCLES  (ROC_CYCLES),
      .SIMULATION  (SIMULATION),
      .SEED        (SEED),
      .DATA_W      (DATA_W),
      .AXI_ARCACHE (AXI_ARCACHE),
      .AXI_AWCACHE (AXI_AWCACHE),
      .AXI_PROT    (AXI_PROT)
  ) u_chip (
      .clk              (clk),
      .rst              (rst),
      .s_axil_awvalid   (chip_axil_awvalid),
      .s_axil_awready   (chip_axil_awready),
      .s_axil_awaddr    (chip_axil_awaddr),
      .s_axil_awprot    (chip_axil_awprot),
      .s_axil_wvalid    (chip_axil_wvalid),
      .s_axil_wready    (chip_axil_wready),
      .s_axil_wdata     (chip_axil_wdata),
      .s_axil_wstrb     (chip_axil_wstrb),
      .s_axil_bvalid    (chip_axil_bvalid),
      .s_axil_bready    (chip_axil_bready),
      .s_axil_bresp     (chip_axil_bresp),
      .s_axil_arvalid   (chip_axil_arvalid),
      .s_axil_arready   (chip_axil_arready),
      .s_axil_araddr    (chip_axil_araddr),
      .s_axil_arprot    (chip_axil_arprot),
      .s_axil_rvalid    (chip_axil_rvalid),
      .s_axil_rready    (chip_axil_rready),
      .s_axil_rdata     (chip_axil_rdata),
      .s_axil_rresp     (chip_axil_rresp),
      .irq              (chip_irq),
      .m_axi_arvalid    (chip_axi_arvalid),
      .m_axi_arready    (chip_axi_arready),
      .m_axi_arid       (chip_axi_arid),
      .m_axi_araddr     (chip_axi_araddr),
      .m_axi_arlen      (chip_axi_arlen),
      .m_axi_arsize     (m_axi_arsize),
      .m_axi_arburst    (m_axi_arburst),
      .m_axi_arcache    (m_axi_arcache),
      .m_axi_arprot     (m_axi_arprot),
      .m_axi_rvalid     (chip_axi_rvalid),
      .m_axi_rready     (chip_axi_rready),
      .m_axi_rid        (chip_axi_rid),
      .m_axi_rdata      (chip_axi_rdata),
      .m_axi_rresp      (chip_axi_rresp),
      .m_axi_rlast      (chip_axi_rlast),
      .m_axi_awvalid    (chip_axi_awvalid),
      .m_axi_awready    (chip_axi_awready),
      .m_axi_awid       (chip_axi_awid),
      .m_axi_awaddr     (chip_axi_awaddr),
      .m_axi_awlen      (chip_axi_awlen),
      .m_axi_awsize     (m_axi_awsize),
      .m_axi_awburst    (m_axi_awburst),
      .m_axi_awcache    (m_axi_awcache),
      .m_axi_awprot     (m_axi_awprot),
      .m_axi_wvalid     (chip_axi_wvalid),
      .m_axi_wready     (chip_axi_wready),
      .m_axi_wdata      (chip_axi_wdata),
      .m_axi_wstrb      (chip_axi_wstrb),
      .m_axi_wlast      (chip_axi_wlast),
      .m_axi_bvalid     (chip_axi_bvalid),
      .m_axi_bready     (chip_axi_bready),
      .m_axi_bid        (chip_axi_bid),
      .m_axi_bresp      (chip_axi_bresp),
      .cfg_valid        (cfg_valid),
      .cfg_data         (cfg_data),
      .cfg_error        (cfg_error),
      .m_axi_cfg_arvalid(chip_axi_cfg_arvalid),
      .m_axi_cfg_arready(chip_axi_cfg_arready),
      .m_axi_cfg_araddr (chip_axi_cfg_araddr),
      .m_axi_cfg_arlen  (chip_axi_cfg_arlen),
      .m_axi_cfg_arsize (m_axi_cfg_arsize),
      .m_axi_cfg_arburst(m_axi_cfg_arburst),
      .m_axi_cfg_arcache(m_axi_cfg_arcache),
      .m_axi_cfg_arprot (m_axi_cfg_arprot),
      .m_axi_cfg_rvalid (chip_axi_cfg_rvalid),
      .m_axi_cfg_rready (chip_axi_cfg_rready),
      .m_axi_cfg_rdata  (chip_axi_cfg_rdata),
      .m_axi_cfg_rresp  (chip_axi_cfg_rresp),
      .m_axi_cfg_rlast  (chip_axi_cfg_rlast)
  );

endmodule
`default_nettype wire
