// SPDX-License-Identifier: Apache-2.0 WITH SHL-2.1
`default_nettype none
`include "cchip_defs.vh"
`include "cchip_assert.vh"
// cchip_config_controller: exchanges the module of a slot: fetches a bitstream, streams it into the
// configuration port and sequences the slot. Phases CCHIP_PHASE_*, outcomes CCHIP_SWAP_*.
//   order        HEADER, SHUTDOWN, DECOUPLE, RESET, TRANSFER, CHECK, ROC, RECOUPLE, REPORT; a bad
//                header or a shutdown that fails leaves the slot active; any failure from
//                DECOUPLE on leaves it stopped, decoupled and in reset
//   time         payload: CFG_DIVIDER clocks per port word (the paper's eq. 4) while memory keeps
//                up; see the datasheet for the rest; every wait has a bound: shutdown_limit for the
//                pairs, memory_limit for each beat
//   limits       1..2^32 - 1 clocks; 0 means CCHIP_SHUTDOWN_LIMIT_DEFAULT and
//                CCHIP_MEMORY_LIMIT_DEFAULT. Each counts from the clock on which it is written,
//                in a swap in flight too: a lower one also for the clocks that have passed, a
//                higher one, or 0, gives more time
//   busy         a request that is offered during a swap waits until the swap has ended; every
//                request is answered by exactly one report
//   clocks       cfg_error may come from any clock, as a level or for at least two clocks of clk: a
//                shorter pulse may be lost (see cchip_swap_sequencer). The rest of the port belongs
//                to clk
//   cuts         every path but read_phase to read_clocks: each output comes from flip-flops,
//                swapped and rejected through the code of m_report_data
//   reset        no swap, slots active, except one whose transfer had begun and not ended well:
//                `half_q` outlives rst and keeps it stopped, decoupled and in reset until a good
//                transfer
module cchip_config_controller #(
    parameter integer SLOTS = 1,          // slots; legal: 1..4
    parameter integer CFG_W = 8,          // width of the configuration port (bit); legal: 8, 32
    // clocks per word of the port; at 100 MHz 2 for 8 bit at 50 MHz, 1 for 32 bit at 100 MHz;
    // legal: >= 1
    parameter integer CFG_DIVIDER = 2,
    // longest wait for a slot to decouple, to end its reset on configuration, to recouple (clock);
    // legal: >= 16
    parameter integer SLOT_LIMIT = 4096
) (
    input  wire                                 clk,             // clock, rising edge
    input  wire                                 rst,             // synchronous reset, active high
    input  wire                                 s_swap_valid,    // a swap is requested
    // the request is taken if s_swap_valid = 1 as well; 1 also during a swap
    output wire                                 s_swap_ready,
    // the request: record SWAP_REQUEST, docs/hardware/definitions.md
    input  wire [    `CCHIP_SWAP_REQUEST_W-1:0] s_swap_data,
    // 1 for one clock: a report; there is no ready
    output wire                                 m_report_valid,
    // the report: record SWAP_REPORT, docs/hardware/definitions.md
    output wire [     `CCHIP_SWAP_REPORT_W-1:0] m_report_data,
    // 1: abort the swap in progress; ignored without one and from RECOUPLE on
    input  wire                                 abort_swap,
    input  wire                                 clear,  // 1: read_clocks is 0 for every phase
    // longest wait for the pairs inside: 1..2^32 - 1 clocks; 0: CCHIP_SHUTDOWN_LIMIT_DEFAULT
    input  wire [                         31:0] shutdown_limit,
    // longest wait for an address to be taken or a beat: 1..2^32 - 1 clocks; 0:
    // CCHIP_MEMORY_LIMIT_DEFAULT
    input  wire [                         31:0] memory_limit,
    output wire [                    SLOTS-1:0] stop,            // per slot: accept no more pairs
    // per slot: outputs of the region become constants
    output wire [                    SLOTS-1:0] decouple,
    output wire [                    SLOTS-1:0] hold_reset,      // per slot: the region is in reset
    // per slot: 1 for one clock starts the reset on configuration
    output wire [                    SLOTS-1:0] roc_start,
    // per slot: stop is in force and every accepted pair was answered
    input  wire [                    SLOTS-1:0] quiet,
    input  wire [                    SLOTS-1:0] decoupled,       // per slot: it is decoupled
    // per slot: reset on configuration in progress, from the clock after roc_start on
    input  wire [                    SLOTS-1:0] roc_busy,
    // per slot: module in the region, behind no gate
    input  wire [     `CCHIP_RM_ID_W*SLOTS-1:0] region_rm_id,
    // per slot: pairs lost by decoupling it; read when decoupled rises
    input  wire [`CCHIP_PAIR_COUNT_W*SLOTS-1:0] lost,
    output wire                                 busy,            // a swap is in progress
    output wire [           `CCHIP_PHASE_W-1:0] phase,           // its phase, SwapPhase
    output wire [         `CCHIP_SLOT_ID_W-1:0] phase_slot,      // its slot
    output wire                                 m_axi_arvalid,   // AXI4 read address
    input  wire                                 m_axi_arready,   // address taken
    output wire [                         31:0] m_axi_araddr,    // address, byte
    output wire [                          7:0] m_axi_arlen,     // beats - 1, up to 15
    input  wire                                 m_axi_rvalid,    // beat
    output wire                                 m_axi_rready,    // 1 except in reset
    input  wire [                         31:0] m_axi_rdata,     // data
    // response; anything but OKAY is an error
    input  wire [                          1:0] m_axi_rresp,
    input  wire                                 m_axi_rlast,     // last beat of a burst
    // a word passes the configuration port, one clock
    output wire                                 cfg_valid,
    output wire [                    CFG_W-1:0] cfg_data,        // the word, first byte lowest
    // the device reports an error, from any clock: a level, or a pulse of at least two clocks of
    // clk, as it passes two flip-flops and a shorter one may be lost; looked at during TRANSFER and
    // CHECK
    input  wire                                 cfg_error,
    // ---- to be counted, one clock each: a swap ended well, one failed or was refused, a slot of
    //      the port passed without data
    output wire                                 swapped,         // a swap ended well, one clock
    // a swap failed or was refused, SAME not counted, one clock
    output wire                                 rejected,
    output wire                                 stall,  // a slot of the port passed without data
    // ---- clocks of a phase of the last swap; read_phase stays for 2 clocks
    input  wire [           `CCHIP_PHASE_W-1:0] read_phase,      // a phase, SwapPhase
    // its clocks in the last swap, from 1 clock after read_phase on
    output wire [                         31:0] read_clocks
);

  wire [`CCHIP_SLOT_ID_W-1:0] slot;
  wire [`CCHIP_RM_ID_W-1:0] module_id;
  wire [31:0] address, size, clocks;
  wire in_header = phase == `CCHIP_PHASE_HEADER;
  wire in_transfer = phase == `CCHIP_PHASE_TRANSFER;
  wire run, outstanding, bus_error, timeout;
  wire header_done, header_ok;
  wire [`CCHIP_SWAP_W-1:0] header_code;
  wire fetch_valid, port_ready, transfer_done;
  wire [31:0] length, payload_crc, fetch_data, crc;
  reg crc_ok_q;
  reg in_header_q;  // late at both ends, where the fetch has no words
  always @(posedge clk) begin
    crc_ok_q <= crc == payload_crc;
    in_header_q <= in_header;
  end

  cchip_swap_sequencer #(
      .SLOTS     (SLOTS),
      .SLOT_LIMIT(SLOT_LIMIT)
  ) u_sequencer (
      .clk           (clk),
      .rst           (rst),
      .s_swap_valid  (s_swap_valid),
      .s_swap_ready  (s_swap_ready),
      .s_swap_data   (s_swap_data),
      .m_report_valid(m_report_valid),
      .m_report_data (m_report_data),
      .abort_swap    (abort_swap),
      .shutdown_limit(shutdown_limit),
      .stop          (stop),
      .decouple      (decouple),
      .hold_reset    (hold_reset),
      .roc_start     (roc_start),
      .quiet         (quiet),
      .decoupled     (decoupled),
      .roc_busy      (roc_busy),
      .region_rm_id  (region_rm_id),
      .lost          (lost),
      .phase         (phase),
      .phase_clocks  (clocks),
      .busy          (busy),
      .slot          (slot),
      .module_id     (module_id),
      .address       (address),
      .size          (size),
      .run           (run),
      .header_done   (header_done),
      .header_ok     (header_ok),
      .header_code   (header_code),
      .outstanding   (outstanding),
      .bus_error     (bus_error),
      .timeout       (timeout),
      .transfer_done (transfer_done),
      .crc_ok        (crc_ok_q),
      .cfg_error     (cfg_error)
  );

  // ---- memory to header or port
  reg [31:0] fetch_address_q;
  reg [29:0] fetch_words_q;
  always @(posedge clk) begin
    fetch_address_q <= address + (in_header ? 32'd0 : `CCHIP_BITSTREAM_HEADER);
    fetch_words_q   <= in_header ? 30'd4 : length[31:2] + {29'd0, length[1:0] != 2'd0};
  end

  cchip_bitstream_fetch u_fetch (
      .clk          (clk),
      .rst          (rst),
      .run          (run),
      .address      (fetch_address_q),
      .words        (fetch_words_q),
      .limit        (memory_limit),
      .m_valid      (fetch_valid),
      .m_ready      (in_header_q | port_ready),
      .m_data       (fetch_data),
      .bus_error    (bus_error),
      .timeout      (timeout),
      .outstanding  (outstanding),
      .m_axi_arvalid(m_axi_arvalid),
      .m_axi_arready(m_axi_arready),
      .m_axi_araddr (m_axi_araddr),
      .m_axi_arlen  (m_axi_arlen),
      .m_axi_rvalid (m_axi_rvalid),
      .m_axi_rready (m_axi_rready),
      .m_axi_rdata  (m_axi_rdata),
      .m_axi_rresp  (m_axi_rresp),
      .m_axi_rlast  (m_axi_rlast)
  );

  cchip_bitstream_header #(
      .CFG_W(CFG_W)
  ) u_header (
      .clk           (clk),
      .clear         (~busy),
      .s_valid       (in_header & fetch_valid),
      .s_data        (fetch_data),
      .slot          (slot),
      .module_id     (module_id),
      .size          (size),
      .done          (header_done),
      .ok            (header_ok),
      .code          (header_code),
      .payload_length(length),
      .payload_crc   (payload_crc)
  );

  cchip_config_port #(
      .CFG_W      (CFG_W),
      .CFG_DIVIDER(CFG_DIVIDER)
  ) u_port (
      .clk      (clk),
      .rst      (rst),
      .run      (in_transfer),
      .length   (length),
      .s_valid  (fetch_valid),
      .s_ready  (port_ready),
      .s_data   (fetch_data),
      .cfg_valid(cfg_valid),
      .cfg_data (cfg_data),
      .done     (transfer_done),
      .crc      (crc),
      .stall    (stall)
  );

  // ---- the past
  cchip_phase_clocks u_phase_clocks (
      .clk        (clk),
      .rst        (rst),
      .clear      (clear),
      .phase      (phase),
      .elapsed    (clocks),
      .read_phase (read_phase),
      .read_clocks(read_clocks)
  );
  wire [`CCHIP_SWAP_W-1:0] report_code = m_report_data[`CCHIP_SWAP_REPORT_CODE];
  assign swapped  = m_report_valid && report_code == `CCHIP_SWAP_OK;
  assign rejected = m_report_valid && report_code != `CCHIP_SWAP_OK
      && report_code != `CCHIP_SWAP_SAME;

  assign phase_slot = slot;

  always @(posedge clk)
    if (!rst) begin
      `CCHIP_ASSERT(a_transfer, !cfg_valid || (hold_reset & decouple & stop) != {SLOTS{1'b0}})
    end

endmodule
`default_nettype wire
