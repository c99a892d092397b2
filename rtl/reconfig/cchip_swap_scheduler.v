// SPDX-License-Identifier: Apache-2.0 WITH SHL-2.1
`default_nettype none
`include "cchip_defs.vh"
`include "cchip_assert.vh"
// cchip_swap_scheduler: which slot gets which module when. One swap at a time; every request of the
// configuration controller comes from here, those of software too.
//   serves       CCHIP_RM_SERVES
//   rule         a swap is due for a kind that no slot serves and of which pairs wait: `min_batch`
//                of them, a full queue, or any once some kind has waited unserved for `max_age`
//                clocks. Kinds are served in turn. The module is the kind's own, else the next
//                larger one that serves it, with a valid bitstream; the slot is the one that holds
//                least by its ModuleId. Without points it had served nothing that the new module
//                does not, so a swap never takes a kind from the pairs. A test of points serves
//                nothing else: the slot that alone serves a kind of which pairs wait is exchanged
//                with points only once `max_age` has passed, so that neither waits for ever
//   age          clocks since pairs of some unserved kind wait; starts again after every report
//   faults       only a bad bitstream or entry (CCHIP_SWAP_SPOILT) loses its valid bit
//                (`table_invalidate`). An entry that rests (cchip_swap_retry) is not chosen here,
//                by a command it is. A kind that no slot serves, no valid bitstream brings and no
//                swap is bringing for 16 clocks has `no_provider` = 1; a bitstream that is hopeless
//                brings nothing, until it is tried again
//   command      refused with BUSY while a swap is in progress, with REQUEST where the table has no
//                valid bitstream; commands are two clocks apart at least, because a refusal that
//                meets another report waits for a clock
//   latency      a kind is looked at for 4 clocks, and for 9 * SLOTS + 1 more if a swap is due
//                (with points 15 * SLOTS + 1); a command's request leaves 3 clocks after it; 15
//                clocks of rest after a report
//   cuts         every path but rst: all outputs are flip-flops, address and size of m_swap_data
//                those of the table
//   reset        no request, no report, age 0
module cchip_swap_scheduler #(
    parameter integer SLOTS = 2,   // slots; legal: 1..4
    // kinds of pairs, 4 with points against triangles; the modules are 0..KINDS; legal: 3, 4
    parameter integer KINDS = 3,
    parameter integer COUNT_W = 9  // width of the number of waiting pairs (bit); legal: 1..16
) (
    input  wire                             clk,                          // clock, rising edge
    input  wire                             rst,  // synchronous reset, active high
    // ---- registers
    input  wire                             enable,  // 1: exchange modules without being asked
    input  wire [                     31:0] min_batch,  // pairs that are worth a swap
    // clocks after which an unserved kind gets a slot regardless of the batch
    input  wire [                     31:0] max_age,
    // ---- bitstreams: entries of cchip_bitstream_table
    // there is a bitstream; entries as in cchip_bitstream_table
    input  wire [(SLOTS<<`CCHIP_KIND_BITS(KINDS))-1:0] table_valid,
    // the bitstream or its entry is bad (CCHIP_SWAP_SPOILT), one clock
    output wire [(SLOTS<<`CCHIP_KIND_BITS(KINDS))-1:0] table_invalidate,
    // the entry must not be tried now, except by a command (cchip_swap_retry)
    input  wire [(SLOTS<<`CCHIP_KIND_BITS(KINDS))-1:0] table_resting,
    // entries that no pair should wait for
    input  wire [(SLOTS<<`CCHIP_KIND_BITS(KINDS))-1:0] table_hopeless,
    // ---- the entry of the swap; its address and size come 2 clocks after table_look and stay
    output wire                             table_look,  // address and size of an entry are needed
    // {slot, module (3 bits)}; stays until the request is taken
    output wire [                      4:0] table_entry,
    // its address, 2 clocks later, until the next look-up (cchip_bitstream_table)
    input  wire [                     31:0] table_address,
    input  wire [                     31:0] table_size,  // its size likewise, header included
    // ---- queues, kind k at place k - 1
    // pairs in the queue of kind k, at place k - 1
    input  wire [        KINDS*COUNT_W-1:0] waiting,
    input  wire [                KINDS-1:0] full,  // the queue of kind k is full, at place k - 1
    // bit k - 1: no slot and no bitstream provides kind k
    output wire [                KINDS-1:0] no_provider,
    // 3 bits per slot: active module, ModuleId; 0: none or decoupled
    input  wire [  `CCHIP_KIND_W*SLOTS-1:0] slot_module,
    // ---- software's swap, one clock
    input  wire                             command_valid,  // swap by software, one clock
    input  wire [     `CCHIP_SLOT_ID_W-1:0] command_slot,                 // its slot
    input  wire [       `CCHIP_RM_ID_W-1:0] command_module,               // its module
    // give up pairs that are not answered in time
    input  wire                             command_force,
    // ---- to the configuration controller
    output wire                             m_swap_valid,                 // a swap is asked for
    input  wire                             m_swap_ready,  // the controller takes the request
    // the request: record SWAP_REQUEST, docs/hardware/definitions.md
    output wire [`CCHIP_SWAP_REQUEST_W-1:0] m_swap_data,
    input  wire                             s_report_valid,  // report of the controller, one clock
    // the report: record SWAP_REPORT, docs/hardware/definitions.md
    input  wire [ `CCHIP_SWAP_REPORT_W-1:0] s_report_data,
    // the same, and reports of refused commands, one clock
    output wire                             m_report_valid,
    // the report: record SWAP_REPORT, docs/hardware/definitions.md
    output wire [ `CCHIP_SWAP_REPORT_W-1:0] m_report_data
);

  localparam integer KIND_W = `CCHIP_KIND_W;
  localparam integer ID_W = `CCHIP_RM_ID_W;
  localparam integer MODULE_W = `CCHIP_KIND_BITS(KINDS);
  localparam integer TABLE = SLOTS << MODULE_W;
  localparam [31:0] LAST_KIND = KINDS;
  localparam [KIND_W-1:0] ONE = 1;
  localparam [ID_W-1:0] QUADS_ID = `CCHIP_RM_QUAD_QUAD;
  localparam [ID_W-1:0] POINTS_ID = `CCHIP_RM_POINT_TRI;
  localparam [KIND_W-1:0] QUADS = QUADS_ID[KIND_W-1:0];
  localparam [KIND_W-1:0] POINTS = POINTS_ID[KIND_W-1:0];
  // what a slot can hold while it does not serve a kind that another module of its own serves
  localparam [31:0] MOST_HELD = KINDS > 3 ? KINDS : 2;

  reg [TABLE-1:0] table_invalidate_q;
  reg [KINDS-1:0] no_provider_q;
  reg m_swap_valid_q;
  reg [`CCHIP_RM_ID_W-1:0] m_swap_module_q;
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

  localparam integer SLOT_W = SLOTS > 1 ? $clog2(SLOTS) : 1;
  localparam integer ENTRY_W = SLOT_W + MODULE_W;
  localparam integer ENTRIES = 1 << ENTRY_W;
  localparam [31:0] SLOT_COUNT = SLOTS;
  localparam [31:0] LAST_SLOT = SLOTS - 1;

  `CCHIP_REFUSE(SLOTS < 1 || SLOTS > 4, cchip_error_SLOTS_must_be_1_to_4)
  `CCHIP_REFUSE(COUNT_W < 1 || COUNT_W > 16, cchip_error_COUNT_W_must_be_1_to_16)
  `CCHIP_REFUSE(KINDS != 3 && KINDS != 4, cchip_error_KINDS_must_be_3_or_4)

  // ---- the tables are extended to a power of two; slots that do not exist have no bitstream
  wire [ENTRIES-1:0] valid_of = {{ENTRIES - TABLE{1'b0}}, table_valid};
  wire [ENTRIES-1:0] ready_of = {{ENTRIES - TABLE{1'b0}}, table_valid & ~table_resting};

  // ---- swap in progress: chosen, requested, or accepted by the controller
  reg swapping_q, chosen_q, chosen_q2;
  wire asked = swapping_q | m_swap_valid_q | chosen_q | chosen_q2;

  // ---- kinds
  reg [KINDS-1:0] unserved_q;  // pairs wait, no slot serves the kind
  reg [KINDS-1:0] enough_q;  // a full queue, or as many as are worth a swap
  wire [KINDS*SLOTS-1:0] alone;  // pairs of the kind wait that this slot alone serves
  genvar kind, slot;
  generate
    for (kind = 0; kind < KINDS; kind = kind + 1) begin : gen_kinds
      localparam [31:0] KIND = kind + 1;
      wire [SLOTS-1:0] holds, brings;
      for (slot = 0; slot < SLOTS; slot = slot + 1) begin : gen_holds
        wire [ID_W-1:0] module_id = {{ID_W - KIND_W{1'b0}}, slot_module[KIND_W*slot+:KIND_W]};
        assign holds[slot]  = `CCHIP_RM_SERVES(module_id, KIND[ID_W-1:0]);
        assign brings[slot] = |(table_valid[(slot<<MODULE_W)+kind+1+:(kind>2?1:3-kind)] &
            ~table_hopeless[(slot<<MODULE_W)+kind+1+:(kind>2?1:3-kind)]);
      end
      reg some_q, served_q;
      assign alone[SLOTS*kind+:SLOTS] =
          holds & {SLOTS{some_q && (holds & (holds - 1'b1)) == {SLOTS{1'b0}}}};
      always @(posedge clk) begin
        some_q           <= |waiting[COUNT_W*kind+:COUNT_W];
        served_q         <= |holds;
        unserved_q[kind] <= some_q & ~served_q;
        enough_q[kind]   <= full[kind]
            || {{32 - COUNT_W{1'b0}}, waiting[COUNT_W*kind+:COUNT_W]} >= min_batch;
      end

      // table and slots show a change some clocks late: a kind must be absent for 16 clocks
      reg [3:0] absent_clocks_q;
      wire absent = !(|holds) && !(|brings) && !(asked
          && `CCHIP_RM_SERVES(m_swap_module_q, KIND[ID_W-1:0]));
      always @(posedge clk)
        if (rst || !absent) begin
          absent_clocks_q     <= 4'd0;
          no_provider_q[kind] <= 1'b0;
        end else begin
          if (~&absent_clocks_q) absent_clocks_q <= absent_clocks_q + 4'd1;
          no_provider_q[kind] <= &absent_clocks_q;
        end
    end
  endgenerate

  // ---- age
  reg [31:0] age_q;
  reg old_q;
  always @(posedge clk) begin
    if (rst || s_report_valid || unserved_q == {KINDS{1'b0}}) age_q <= 32'd0;
    else if (~&age_q) age_q <= age_q + 32'd1;
    old_q <= age_q >= max_age;
  end

  // ---- search: a kind; if a swap is due for it, every module that serves it, what a slot holds
  // from nothing upwards, every slot. The first slot with such a bitstream is taken.
  reg [3:0] pause_q;  // clocks of rest after a report, until slots and table show its effect
  reg pausing_q;  // pause_q != 0
  wire searching = enable & ~asked & ~command_valid & ~pausing_q;
  reg [KIND_W-1:0] kind_q;  // 1..KINDS
  reg [1:0] wait_q;  // clocks until what is known about the kind is new
  reg due_q, trying_q;
  reg [KIND_W-1:0] module_q;
  reg [KIND_W-1:0] holds_q;
  reg [SLOT_W-1:0] slot_q;
  wire last_slot = slot_q == LAST_SLOT[SLOT_W-1:0];
  wire last_holds = holds_q == MOST_HELD[KIND_W-1:0];
  reg found_q;
  reg [SLOT_W-1:0] found_slot_q;
  reg [MODULE_W-1:0] found_module_q;
  wire [KINDS-1:0] kind_bit = {{KINDS - 1{1'b0}}, 1'b1} << (kind_q - ONE);
  wire last_kind = kind_q == LAST_KIND[KIND_W-1:0];
  wire [KIND_W-1:0] next_kind = last_kind ? ONE : kind_q + ONE;
  // the last module that serves the kind: that of quads, or the kind's own
  wire last_module = module_q == QUADS || module_q == POINTS;
  // an exchange with points takes a kind from its pairs
  reg [SLOTS-1:0] needed_q;
  wire [4*(1<<SLOT_W)-1:0] held;
  wire [(1<<SLOT_W)-1:0] needed = {{(1 << SLOT_W) - SLOTS{1'b0}}, needed_q};
  generate
    for (slot = 0; slot < SLOTS; slot = slot + 1) begin : gen_needed
      wire [KINDS-1:0] kinds_alone;
      for (kind = 0; kind < KINDS; kind = kind + 1) begin : gen_alone
        assign kinds_alone[kind] = alone[SLOTS*kind+slot];
      end
      // what it was when the search for a kind began: its own module is not passed over for a
      // larger one because the slot becomes free meanwhile
      always @(posedge clk)
        if (!trying_q) needed_q[slot] <= KINDS > 3 && kinds_alone != {KINDS{1'b0}} && !old_q;
    end
    // what a slot holds, in 4 bits
    for (slot = 0; slot < (1 << SLOT_W); slot = slot + 1) begin : gen_held
      if (slot < SLOTS) begin : gen_slot
        assign held[4*slot+:4] = {1'b0, slot_module[KIND_W*slot+:KIND_W]};
      end else begin : gen_none
        assign held[4*slot+:4] = 4'd0;
      end
    end
  endgenerate

  always @(posedge clk) begin
    due_q          <= |(kind_bit & unserved_q & (enough_q | {KINDS{old_q}}));
    found_slot_q   <= slot_q;
    found_module_q <= module_q[MODULE_W-1:0];
    pause_q        <= rst || s_report_valid ? 4'd15 : pause_q - {3'd0, pausing_q};
    pausing_q      <= rst || s_report_valid || pause_q[3:1] != 3'd0;
    if (rst || !searching || found_q) begin
      if (rst) kind_q <= ONE;
      else if (found_q) kind_q <= next_kind;
      wait_q   <= 2'd3;
      trying_q <= 1'b0;
      found_q  <= 1'b0;
    end else if (!trying_q) begin
      wait_q   <= wait_q - {1'b0, wait_q != 2'd0};
      module_q <= kind_q;
      holds_q  <= {KIND_W{1'b0}};
      slot_q   <= {SLOT_W{1'b0}};
      if (wait_q == 2'd0) begin
        trying_q <= due_q;
        wait_q   <= 2'd3;
        if (!due_q) kind_q <= next_kind;
      end
    end else begin
      found_q <= ready_of[{slot_q, module_q[MODULE_W-1:0]}]
          && held[{slot_q, 2'b00}+:KIND_W] == holds_q
          && !(needed[slot_q] && (kind_q == POINTS) != (holds_q == POINTS));
      slot_q  <= last_slot ? {SLOT_W{1'b0}} : slot_q + {{SLOT_W - 1{1'b0}}, 1'b1};
      if (last_slot) holds_q <= last_holds ? {KIND_W{1'b0}} : holds_q + ONE;
      if (last_slot && last_holds) begin
        module_q <= module_q + ONE;
        if (last_module) begin
          trying_q <= 1'b0;
          kind_q   <= next_kind;
        end
      end
    end
  end

  // ---- requests
  reg [SLOT_W-1:0] slot_of_swap_q;
  assign m_swap_data = `CCHIP_SWAP_REQUEST_OF({{`CCHIP_SLOT_ID_W - SLOT_W{1'b0}}, slot_of_swap_q},
      m_swap_module_q, table_address, table_size, m_swap_force_q);
  wire command_known = {24'd0, command_slot} < SLOT_COUNT && command_module <= LAST_KIND[ID_W-1:0];
  wire [ENTRY_W-1:0] command_entry = {command_slot[SLOT_W-1:0], command_module[MODULE_W-1:0]};
  wire command_ok = command_known & valid_of[command_entry];
  wire take_command = command_valid & ~asked & command_ok;
  wire take_found = searching & found_q;
  wire [ENTRY_W-1:0] entry = take_command ? command_entry : {found_slot_q, found_module_q};
  assign table_look  = chosen_q;
  assign table_entry = {{2 - SLOT_W{1'b0}}, slot_of_swap_q, m_swap_module_q[2:0]};

  always @(posedge clk) begin
    if (take_command || take_found) begin
      slot_of_swap_q  <= entry[MODULE_W+:SLOT_W];
      m_swap_module_q <= {{ID_W - MODULE_W{1'b0}}, entry[MODULE_W-1:0]};
      m_swap_force_q  <= take_command & command_force;
    end
    if (rst) begin
      m_swap_valid_q <= 1'b0;
      chosen_q     <= 1'b0;
      chosen_q2    <= 1'b0;
      swapping_q   <= 1'b0;
    end else begin
      chosen_q     <= take_command | take_found;
      chosen_q2    <= chosen_q;
      m_swap_valid_q <= chosen_q2 | (m_swap_valid_q & ~m_swap_ready);
      swapping_q   <= (m_swap_valid_q & m_swap_ready) | (swapping_q & ~s_report_valid);
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
    // also of an accepted command: only a refused one is reported
    if (command_valid) begin
      refused_slot_q   <= command_slot;
      refused_module_q <= command_module;
      refused_code_q   <= asked ? `CCHIP_SWAP_BUSY : `CCHIP_SWAP_REQUEST;
    end
    m_report_data_q <= s_report_valid ? s_report_data
        : `CCHIP_SWAP_REPORT_OF(refused_slot_q, refused_module_q, refused_code_q, 16'd0);
    refused_q       <= ~rst & (refuse | (refused_q & s_report_valid));
    m_report_valid_q  <= ~rst & (s_report_valid | refused_q);
    for (i = 0; i < TABLE; i = i + 1)
      table_invalidate_q[i] <= !rst && s_report_valid && reject && {s_report_slot, s_report_module}
          == {i[MODULE_W+:8], {ID_W - MODULE_W{1'b0}}, i[MODULE_W-1:0]};
  end

  wire unused = &{1'b0, table_hopeless};  // those of module 0 bring no kind
  always @(posedge clk)
    if (!rst) begin
      `CCHIP_ASSERT(a_one_swap, {2'd0, swapping_q} + {2'd0, m_swap_valid_q}
          + {2'd0, chosen_q} + {2'd0, chosen_q2} <= 3'd1)
      `CCHIP_ASSERT(a_pause, pausing_q == (pause_q != 4'd0))
      `CCHIP_ASSERT(a_answer, !s_report_valid || swapping_q || (m_swap_valid_q && m_swap_ready))
    end

endmodule
`default_nettype wire
