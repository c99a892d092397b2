// SPDX-License-Identifier: Apache-2.0 WITH SHL-2.1
`default_nettype none
`include "cchip_defs.vh"
`include "cchip_assert.vh"
// cchip_swap_scheduler: which slot gets which module when. One swap at a time; every request of the
// configuration controller comes from here, those of software too.
//   idle         a slot without a module, or without waiting pairs of its kind, is given the kind
//                with the most waiting pairs that no slot provides, once these are `min_batch` or
//                have waited for `max_age` clocks
//   preemption   a kind that has waited for `max_age` clocks, the oldest first, also gets a slot
//                that still works, the one not exchanged last, once that slot has taken `min_batch`
//                pairs (at least one) or worked for max(max_age, 1024) clocks since its last swap:
//                so no kind starves and every turn makes progress
//   age          of a kind: clocks since pairs of it wait and no slot has its module; starts again
//                after every attempt
//   faults       only a bad bitstream or entry (CCHIP_SWAP_SPOILT) loses its valid bit
//                (`table_invalidate`). An entry that rests (cchip_swap_retry) is not chosen here,
//                by a command it is. A kind that no slot holds, no valid bitstream brings and no
//                swap is bringing for 16 clocks has `no_provider` = 1.
//   command      refused with BUSY while a swap is under way, with REQUEST where the table has no
//                valid bitstream
//   latency      a scan of all slots and kinds takes 3 * SLOTS + 2 clocks, a request leaves one
//                clock after its end; a command's leaves 2 clocks after it; 15 clocks of rest after
//                a report
//   cuts         every path but rst: all outputs are flip-flops
//   reset        no request, no report, ages 0
module cchip_swap_scheduler #(
    // slots, 1 or 2
    parameter integer SLOTS = 2,
    // width of the number of waiting pairs, bit, 1..16
    parameter integer COUNT_W = 9
) (
    input  wire                             clk,
    input  wire                             rst,
    // registers
    input  wire                             enable,
    input  wire [                     31:0] min_batch,
    input  wire [                     31:0] max_age,
    // bitstreams: entry 4 * slot + module
    input  wire [              4*SLOTS-1:0] table_valid,
    input  wire [           4*32*SLOTS-1:0] table_address,
    input  wire [           4*32*SLOTS-1:0] table_size,
    output wire [              4*SLOTS-1:0] table_invalidate,
    input  wire [              4*SLOTS-1:0] table_resting,
    // queues, kind k at place k - 1
    input  wire [            3*COUNT_W-1:0] waiting,
    output wire [                      2:0] no_provider,
    // slots: module that works (ModuleId, 0: none or decoupled), a pair was taken
    input  wire [  `CCHIP_KIND_W*SLOTS-1:0] slot_module,
    input  wire [                SLOTS-1:0] slot_taken,
    // software's swap, one clock
    input  wire                             command_valid,
    input  wire [     `CCHIP_SLOT_ID_W-1:0] command_slot,
    input  wire [       `CCHIP_RM_ID_W-1:0] command_module,
    input  wire                             command_force,
    // to the configuration controller
    output wire                             m_swap_valid,
    input  wire                             m_swap_ready,
    output wire [`CCHIP_SWAP_REQUEST_W-1:0] m_swap_data,
    // its report, one clock
    input  wire                             s_report_valid,
    input  wire [ `CCHIP_SWAP_REPORT_W-1:0] s_report_data,
    // the same, and the reports of refused commands, one clock
    output wire                             m_report_valid,
    output wire [ `CCHIP_SWAP_REPORT_W-1:0] m_report_data
);

  reg [4*SLOTS-1:0] table_invalidate_q;
  reg [2:0] no_provider_q;
  reg m_swap_valid_q;
  reg [`CCHIP_RM_ID_W-1:0] m_swap_module_q;
  reg [31:0] m_swap_address_q;
  reg [31:0] m_swap_size_q;
  reg m_swap_force_q;
  reg m_report_valid_q;
  reg [`CCHIP_SWAP_REPORT_W-1:0] m_report_data_q;
  assign table_invalidate = table_invalidate_q;
  assign no_provider = no_provider_q;
  assign m_swap_valid = m_swap_valid_q;
  assign m_report_valid = m_report_valid_q;
  assign m_report_data = m_report_data_q;

  wire [`CCHIP_SLOT_ID_W-1:0] s_report_slot = s_report_data[`CCHIP_SWAP_REPORT_SLOT];
  wire [`CCHIP_RM_ID_W-1:0] s_report_module = s_report_data[`CCHIP_SWAP_REPORT_MODULE];
  wire [`CCHIP_SWAP_W-1:0] s_report_code = s_report_data[`CCHIP_SWAP_REPORT_CODE];

  localparam [31:0] COUNT_BITS = COUNT_W;
  localparam [31:0] LAST = 3 * SLOTS - 1;

  generate
    if (SLOTS < 1 || SLOTS > 2) begin : gen_illegal
      cchip_error_SLOTS_must_be_1_or_2 u_error ();
    end
    if (COUNT_W < 1 || COUNT_W > 16) begin : gen_illegal_count
      cchip_error_COUNT_W_must_be_1_to_16 u_error ();
    end
  endgenerate

  // ---- the tables are extended to two slots; with SLOTS = 1 the second one has no valid bitstream
  wire [  7:0] valid_of = {{8 - 4 * SLOTS{1'b0}}, table_valid};
  wire [  7:0] ready_of = {{8 - 4 * SLOTS{1'b0}}, table_valid & ~table_resting};
  wire [255:0] address_of = {{32 * (8 - 4 * SLOTS) {1'b0}}, table_address};
  wire [255:0] size_of = {{32 * (8 - 4 * SLOTS) {1'b0}}, table_size};

  // ---- swap under way: chosen, requested, or accepted by the controller
  reg  swapping_q, chosen_q;
  wire asked = swapping_q | m_swap_valid_q | chosen_q;

  // ---- 1: the registers that a scan reads are updated; they do not change during a scan
  wire look;

  // ---- kinds
  wire [  2:0] provided;  // a slot holds the kind
  wire [  2:0] bitstream;  // a slot could get it
  wire [  2:0] some;  // pairs wait
  wire [  2:0] restart = {3{s_report_valid}} &
      {s_report_module == `CCHIP_RM_QUAD_QUAD, s_report_module == `CCHIP_RM_TRI_QUAD,
          s_report_module == `CCHIP_RM_TRI_TRI};
  reg  [ 95:0] age_q;
  // pairs of the kind: have waited max_age; are min_batch; wait and no slot holds their module
  reg  [  2:0] over_q, enough_q, open_q;
  genvar kind, slot;
  generate
    for (kind = 0; kind < 3; kind = kind + 1) begin : gen_kinds
      localparam [31:0] KIND = kind + 1;
      reg some_q;
      reg ageing_q;  // waits without a slot
      wire [SLOTS-1:0] holds, brings;
      for (slot = 0; slot < SLOTS; slot = slot + 1) begin : gen_holds
        assign holds[slot]  = slot_module[2*slot+:2] == KIND[1:0];
        assign brings[slot] = table_valid[4*slot+kind+1];
      end
      assign provided[kind]  = |holds;
      assign bitstream[kind] = |brings;
      assign some[kind]      = some_q;

      wire [31:0] age = age_q[32*kind+:32];
      always @(posedge clk) begin
        some_q   <= |waiting[COUNT_W*kind+:COUNT_W];
        ageing_q <= some_q & ~provided[kind] & ~restart[kind];
        if (rst || !ageing_q) age_q[32*kind+:32] <= 32'd0;
        else if (~&age) age_q[32*kind+:32] <= age + 32'd1;
        if (look) begin
          open_q[kind]   <= ageing_q;
          over_q[kind]   <= age >= max_age;
          enough_q[kind] <= {{32 - COUNT_W{1'b0}}, waiting[COUNT_W*kind+:COUNT_W]} >= min_batch;
        end
      end

      // table and slots show a change some clocks late: a kind must be absent for 16 clocks
      reg [3:0] absent_clocks_q;
      wire absent = !provided[kind] && !bitstream[kind] && !(asked && m_swap_module_q == KIND[7:0]);
      always @(posedge clk)
        if (rst || !absent) begin
          absent_clocks_q   <= 4'd0;
          no_provider_q[kind] <= 1'b0;
        end else begin
          if (~&absent_clocks_q) absent_clocks_q <= absent_clocks_q + 4'd1;
          no_provider_q[kind] <= &absent_clocks_q;
        end
    end
  endgenerate

  // ---- slots
  reg [SLOTS-1:0] idle_q, settled_q;
  generate
    for (slot = 0; slot < SLOTS; slot = slot + 1) begin : gen_slots
      localparam [31:0] SLOT = slot;
      reg  [15:0] taken_q;
      reg  [31:0] clocks_q;
      wire [ 1:0] module_id = slot_module[2*slot+:2];
      wire [ 3:0] work = {some, 1'b0};
      always @(posedge clk) begin
        if (rst || module_id == 2'd0 || (s_report_valid && s_report_slot == SLOT[7:0])) begin
          taken_q  <= 16'd0;
          clocks_q <= 32'd0;
        end else begin
          if (slot_taken[slot] && ~&taken_q) taken_q <= taken_q + 16'd1;
          if (~&clocks_q) clocks_q <= clocks_q + 32'd1;
        end
        if (look) begin
          idle_q[slot] <= ~work[module_id];
          settled_q[slot] <= (taken_q != 16'd0 && {16'd0, taken_q} >= min_batch)
              || (clocks_q[31:10] != 22'd0 && clocks_q >= max_age);
        end
      end
    end
  endgenerate

  // ---- scan: a candidate, a clock later its comparison with the best so far
  reg         last_slot_q;  // exchanged last
  reg  [ 2:0] scan_q;  // candidate: kind, slot inner
  reg         scan_slot_q, scan_end_q;
  reg  [ 1:0] scan_kind_q;  // kind - 1
  reg         legal_q, end_q;
  reg         slot_q, best_slot_q;
  reg  [ 1:0] kind_q, best_kind_q;
  reg  [34:0] merit_q, best_q;  // {too old, age or pairs, idle, not exchanged last}
  reg         found_q;
  // ages grow during the scan, so for two slots of one kind only the last two bits are compared
  wire        better = legal_q & (~found_q |
      (kind_q == best_kind_q ? merit_q[1:0] > best_q[1:0] : merit_q[34:2] > best_q[34:2]));
  reg  [ 3:0] pause_q;  // clocks of rest after a report, until slots and table show its effect
  reg         pausing_q;  // pause_q != 0
  wire        scanning = enable & ~asked & ~command_valid & ~pausing_q;
  assign look = ~scanning | scan_end_q;

  wire [ 1:0] scan_kind_d = scan_kind_q + {1'b0, SLOTS == 1 || scan_slot_q};
  wire        scan_old = over_q[scan_kind_q];
  wire [ 1:0] idle_of = {{2 - SLOTS{1'b0}}, idle_q};
  wire [ 1:0] settled_of = {{2 - SLOTS{1'b0}}, settled_q};
  wire        scan_idle = idle_of[scan_slot_q];
  wire        scan_settled = settled_of[scan_slot_q];
  wire [31:0] scan_waiting =
      {{32 - COUNT_W{1'b0}}, waiting[COUNT_BITS*{30'd0, scan_kind_q}+:COUNT_W]};

  always @(posedge clk) begin
    legal_q <= ready_of[{scan_slot_q, scan_kind_q + 2'd1}] & open_q[scan_kind_q]
        & ((scan_idle & (enough_q[scan_kind_q] | scan_old)) | (scan_settled & scan_old));
    merit_q <= {scan_old, scan_old ? age_q[{scan_kind_q, 5'd0}+:32] : scan_waiting, scan_idle,
        scan_slot_q != last_slot_q};
    slot_q  <= scan_slot_q;
    kind_q  <= scan_kind_q;
    end_q   <= scan_q == LAST[2:0];
    if (better) begin
      best_q      <= merit_q;
      best_slot_q <= slot_q;
      best_kind_q <= kind_q;
    end
    scan_end_q <= end_q;
    pause_q    <= rst || s_report_valid ? 4'd15 : pause_q - {3'd0, pausing_q};
    pausing_q  <= rst || s_report_valid || pause_q[3:1] != 3'd0;
    if (rst || look) begin
      scan_q      <= 3'd0;
      scan_slot_q <= 1'b0;
      scan_kind_q <= 2'd0;
      legal_q     <= 1'b0;
      end_q       <= 1'b0;
      scan_end_q  <= 1'b0;
      found_q     <= 1'b0;
    end else begin
      if (scan_q != LAST[2:0] + 3'd1) begin
        scan_q      <= scan_q + 3'd1;
        scan_slot_q <= SLOTS == 2 && !scan_slot_q;
        scan_kind_q <= scan_kind_d;
      end else legal_q <= 1'b0;
      found_q <= found_q | legal_q;
    end
  end

  // ---- requests
  reg slot_of_swap_q;
  assign m_swap_data = `CCHIP_SWAP_REQUEST_OF({7'd0, slot_of_swap_q}, m_swap_module_q,
      m_swap_address_q, m_swap_size_q, m_swap_force_q);
  wire command_known = command_slot[7:1] == 7'd0 && (SLOTS == 2 || !command_slot[0])
      && command_module[7:2] == 6'd0;
  wire [2:0] command_entry = {command_slot[0], command_module[1:0]};
  wire command_ok = command_known & valid_of[command_entry];
  wire take_command = command_valid & ~asked & command_ok;
  wire take_best = scanning & scan_end_q & found_q;
  wire [2:0] entry = take_command ? command_entry : {best_slot_q, best_kind_q + 2'd1};

  always @(posedge clk) begin
    if (take_command || take_best) begin
      slot_of_swap_q <= entry[2];
      m_swap_module_q  <= {6'd0, entry[1:0]};
      m_swap_force_q   <= take_command & command_force;
    end
    // the table is read one clock after the choice
    if (chosen_q) m_swap_address_q <= address_of[{slot_of_swap_q, m_swap_module_q[1:0], 5'd0}+:32];
    if (chosen_q) m_swap_size_q <= size_of[{slot_of_swap_q, m_swap_module_q[1:0], 5'd0}+:32];
    if (rst) begin
      m_swap_valid_q <= 1'b0;
      chosen_q     <= 1'b0;
      swapping_q   <= 1'b0;
      last_slot_q  <= 1'b1;
    end else begin
      chosen_q     <= take_command | take_best;
      m_swap_valid_q <= chosen_q | (m_swap_valid_q & ~m_swap_ready);
      swapping_q   <= (m_swap_valid_q & m_swap_ready) | (swapping_q & ~s_report_valid);
      if (m_swap_valid_q && m_swap_ready) last_slot_q <= slot_of_swap_q;
    end
  end

  // ---- reports: if both come on one clock, that of the refused command waits
  reg         refused_q;
  reg  [ 7:0] refused_slot_q, refused_module_q;
  reg  [`CCHIP_SWAP_W-1:0] refused_code_q;
  wire        refuse = command_valid & (asked | ~command_ok);
  wire        reject = `CCHIP_SWAP_SPOILT(s_report_code);
  integer i;
  always @(posedge clk) begin
    if (refuse) begin
      refused_slot_q   <= command_slot;
      refused_module_q <= command_module;
      refused_code_q   <= asked ? `CCHIP_SWAP_BUSY : `CCHIP_SWAP_REQUEST;
    end
    m_report_data_q <= s_report_valid ? s_report_data
        : `CCHIP_SWAP_REPORT_OF(refused_slot_q, refused_module_q, refused_code_q, 16'd0);
    refused_q       <= ~rst & (refuse | (refused_q & s_report_valid));
    m_report_valid_q  <= ~rst & (s_report_valid | refused_q);
    for (i = 0; i < 4 * SLOTS; i = i + 1)
      table_invalidate_q[i] <= !rst && s_report_valid && reject && s_report_module[7:2] == 6'd0
          && {s_report_slot[0], s_report_module[1:0]} == i[2:0];
  end

  always @(posedge clk)
    if (!rst) begin
      `CCHIP_ASSERT(a_one_swap, {1'b0, swapping_q} + {1'b0, m_swap_valid_q}
          + {1'b0, chosen_q} <= 2'd1)
      `CCHIP_ASSERT(a_pause, pausing_q == (pause_q != 4'd0))
      `CCHIP_ASSERT(a_answer, !s_report_valid || swapping_q || (m_swap_valid_q && m_swap_ready))
    end

endmodule
`default_nettype wire
