// SPDX-License-Identifier: Apache-2.0 WITH SHL-2.1
`default_nettype none
`include "cchip_defs.vh"
`include "cchip_assert.vh"
// cchip_chip_core: the whole way of a query, from a ring in memory to records in another one; its
// controls are ports. Formats: docs/hardware/image.md.
//   way          cchip_query_ring -> cchip_broad_phase -> cchip_leaf_feed -> cchip_transform ->
//                queues and operands -> cchip_slots -> cchip_calc_result -> cchip_record_ring
//   records      a query's pair records precede its done record, whose count is theirs. FIRST ends
//                with the first definite hit, or with open_limit open pairs
//   kinds        the module of a slot answers for all kinds up to its own; a primitive pair of a
//                kind that no slot and no bitstream serves comes back as an open pair
//   swaps        with SWAPS = 1 pairs of a kind that no slot serves wait for its module, while the
//                broad phase works on as far as room goes
//   order        queries end in any order
//   errors       end one query with a code. A query that cannot be read stops the query ring, a
//                record that cannot be written the record ring: query_failed, record_failed
//   bound        every wait has one but those for the host: memory by memory_limit, a query by
//                step_limit, a full record ring by nothing
//   deadlock     each block waits only for blocks behind it, and the last one only for the host:
//                room for leaf pairs is reserved before a node pair starts, for primitive pairs
//                before a leaf pair starts, for results before a primitive pair is dispatched
//   latency      of a query by its tree; 1,024 clocks after reset (CACHE_KB 128) for the first one
//   cuts         every path from and to a port
//   idle         no query is between its ring and the records that memory holds; never, once a ring
//                has failed
//   reset        rst drops queries and lines, and must reset the bus too. core_rst drops them
//                while the bus masters work on: hold it until read_outstanding and
//                write_outstanding have been 0 for 16 clocks (cchip_soft_reset). Both act a clock
//                later: hold rst for 2 clocks or more
module cchip_chip_core #(
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
    // reset on configuration (clock); legal: from 1 on
    parameter integer ROC_CYCLES = `CCHIP_ROC_CLOCKS_DEFAULT,
    // 1: simulated reconfiguration (see cchip_pr_slot); legal: 0, 1
    parameter integer SIMULATION = 0,
    parameter integer SEED = 1,  // start of its random numbers; legal: any
    parameter integer DATA_W = 128  // width of the data buses (bit); legal: 128, 256, 512
) (
    input  wire                           clk,                 // clock, rising edge
    input  wire                           rst,                 // synchronous reset, active high
    input  wire                           core_rst,            // resets all but the bus masters
    // ---- limits (cchip_traversal, cchip_axi_read)
    // node pairs of a query that may be in flight, 0..7; 0 counts as 1; with 3 queries or fewer,
    // 2 pairs_each + 1, 7 at most; half of it for a query for the first hit with leaf pairs out
    input  wire [                    2:0] pairs_each,
    // node pairs after which a query ends with code steps, 0..2^32 - 1
    input  wire [                   31:0] step_limit,
    // open pairs after which a query for the first hit ends with code host, 0..255; 0 counts as 1
    input  wire [                    7:0] open_limit,
    // longest read or write, clocks; 0: CCHIP_MEMORY_LIMIT_DEFAULT
    input  wire [                   31:0] memory_limit,
    // ---- rings (cchip_query_ring, cchip_record_ring)
    input  wire                           enable,              // 0: no further query is read
    input  wire [                   57:0] query_base,  // address of the ring of queries / 64
    input  wire [                    3:0] query_size_log2,     // it has 2^n lines
    input  wire [                   15:0] query_producer,      // queries that the host has written
    output wire [                   15:0] query_consumer,      // queries that the chip has read
    // a query could not be read, the ring has stopped
    output wire                           query_failed,
    input  wire [                   59:0] record_base,  // address of the ring of records / 16
    input  wire [                    4:0] record_size_log2,    // it has 2^n records
    input  wire [                   31:0] record_consumer,     // records that the host has read
    output wire [                   31:0] record_producer,     // records that memory holds
    // a record could not be written, the ring has stopped
    output wire                           record_failed,
    // ---- cache (cchip_cache)
    input  wire [           LOCKS*32-1:0] lock_first,          // first line of each range to lock
    // last line of each range; empty if first > last
    input  wire [           LOCKS*32-1:0] lock_last,
    input  wire                           invalidate_valid,    // command: invalidate lines
    output wire                           invalidate_ready,    // no command is in progress
    input  wire [                   31:0] invalidate_first,    // first line
    input  wire [                   31:0] invalidate_last,     // last line
    // ---- the response to a read or a write is outstanding
    // the response to a read is outstanding
    output wire                           read_outstanding,
    // the response to a write is outstanding
    output wire                           write_outstanding,
    // no query is between its ring and the records that memory holds
    output wire                           idle,
    // ---- what happens on this clock, for counters
    output wire                           count_step,          // a node pair was expanded
    output wire                           count_leaf_pair,     // a leaf pair was found
    output wire                           count_pair,          // a primitive pair has its result
    output wire                           count_box_busy,      // the box test works
    output wire                           count_query,         // a done record leaves for its ring
    output wire                           count_error,         // with another code than ok and host
    output wire                           count_record,        // a record leaves for its ring
    output wire                           count_record_wait,   // a record waits
    output wire [                    1:0] count_hit,  // bit p: port p of the cache answered at once
    output wire [                    1:0] count_miss,          // bit p: port p asks memory
    // ---- slots, as in cchip_slots; their swaps: cchip_swaps
    output wire                           answered,            // an answer left, one clock
    output wire [      `CCHIP_KIND_W-1:0] answered_module,     // module of that answer, 0: none
    // a pair of a kind without a provider was taken, one clock
    output wire                           refused_provider,
    // of each of four slots: pairs inside
    output wire [4*`CCHIP_PAIR_COUNT_W-1:0] slot_outstanding,
    output wire [   4*`CCHIP_RM_ID_W-1:0] slot_rm_id,  // of each of four slots: active module
    output wire [                    3:0] slot_decoupled,      // of each of four slots
    // pairs in the queues of kinds 1, 2, 3, see cchip_swaps
    output wire [3*$clog2(QUEUE_DEPTH+1)-1:0] swap_waiting,
    // a queue that is full, or holds pairs while the transform's credit is used up
    output wire [                    2:0] swap_full,
    // of kinds 1, 2, 3, see cchip_swaps; the following, too
    input  wire [                    2:0] no_provider,
    input  wire [`CCHIP_TO_SLOTS_W(SLOTS)-1:0] to_slots,  // see cchip_slots
    output wire [`CCHIP_FROM_SLOTS_W(SLOTS)-1:0] from_slots,  // see cchip_slots
    input  wire                           cfg_valid,  // a word is written to the configuration port
    input  wire [              CFG_W-1:0] cfg_data,            // the word
    // ---- memory
    output wire                           m_axi_arvalid,       // read address: valid
    input  wire                           m_axi_arready,       // taken
    output wire [       $clog2(MISSES):0] m_axi_arid,          // ID: {client, slot}
    output wire [                   63:0] m_axi_araddr,        // address, a multiple of 64
    output wire [                    7:0] m_axi_arlen,         // beats of a line - 1
    input  wire                           m_axi_rvalid,        // read data: valid
    output wire                           m_axi_rready,        // taken
    input  wire [       $clog2(MISSES):0] m_axi_rid,           // ID
    input  wire [             DATA_W-1:0] m_axi_rdata,         // data
    input  wire [                    1:0] m_axi_rresp,         // response
    input  wire                           m_axi_rlast,         // last beat
    output wire                           m_axi_awvalid,       // write address: valid
    input  wire                           m_axi_awready,       // taken
    output wire                           m_axi_awid,          // 0
    output wire [                   63:0] m_axi_awaddr,        // address, a multiple of the beat
    output wire [                    7:0] m_axi_awlen,         // 0: one beat
    output wire                           m_axi_wvalid,        // write data: valid
    input  wire                           m_axi_wready,        // taken
    output wire [             DATA_W-1:0] m_axi_wdata,         // data
    output wire [           DATA_W/8-1:0] m_axi_wstrb,         // the 16 bytes of a record
    output wire                           m_axi_wlast,         // 1
    input  wire                           m_axi_bvalid,        // response of a write: valid
    output wire                           m_axi_bready,        // taken
    input  wire                           m_axi_bid,           // 0
    input  wire [                    1:0] m_axi_bresp          // response
);

  localparam integer CONTEXT_W = $clog2(QUERIES);
  localparam integer LEAF_W = $clog2(LEAF_NUMBERS);
  localparam integer POINT_W = `CCHIP_POINT_W(COORD_W);
  localparam integer READ_SLOT_W = $clog2(MISSES);
  localparam integer KINDS = 3;
  localparam integer CONTEXTS = `CCHIP_CONTEXTS_DEFAULT(SUBSTAGES);
  localparam integer PLACE_W = `CCHIP_KIND_BITS(KINDS) + $clog2(QUEUE_DEPTH);
  localparam integer BEAT_ADDRESS_W = 64 - $clog2(DATA_W / 8);
  localparam integer LEAF_RESULT_W = `CCHIP_LEAF_RESULT_W(CONTEXT_W);

  `CCHIP_REFUSE(MISSES < 4, cchip_error_chip_core_MISSES_must_be_4_8_16_or_32)
  `CCHIP_REFUSE(RM_ID < 0 || RM_ID > 3 || (SWAPS == 0 && RM_ID == 0),
                cchip_error_chip_core_RM_ID_must_be_1_to_3)
  `CCHIP_REFUSE(QUEUE_DEPTH < 16 || QUEUE_DEPTH > 256 || (1 << $clog2(QUEUE_DEPTH)) != QUEUE_DEPTH,
                cchip_error_chip_core_QUEUE_DEPTH_must_be_a_power_of_two_16_to_256)

  // ---- resets: a flip-flop for each block, because one net would have thousands of pins. All
  // blocks leave their reset on the same clock; cchip_broad_phase has flip-flops of its own
  wire reset = rst | core_rst;
  localparam integer QUERY_RING = 0, FEED = 1, TRANSFORM = 2, QUEUES = 3, RESULTS = 4, RECORDS = 5,
      REST = 6, READ = 7, WRITE = 8, SLOTS_RST = 9, SLOTS_CORE = 10, RESETS = 11;
  wire [RESETS-1:0] block_rst;
  genvar n;
  generate
    for (n = 0; n < RESETS; n = n + 1) begin : gen_reset
      cchip_reset_copy u_reset (
          .clk     (clk),
          .rst     (n < READ ? reset : n == SLOTS_CORE ? core_rst : rst),
          .rst_copy(block_rst[n])
      );
    end
  endgenerate

  // ---- memory: client 0 is the cache, client 1 the query ring
  wire [1:0] read_valid, beat_valid;
  wire [2*READ_SLOT_W-1:0] read_slot;
  wire [115:0] read_line;
  wire [READ_SLOT_W-1:0] beat_slot;
  wire [2:0] beat;
  wire beat_last;
  wire [`CCHIP_READ_CODE_W-1:0] beat_code;
  wire [DATA_W-1:0] beat_data;
  wire [2*MISSES-1:0] outstanding_reads;
  cchip_axi_read #(
      .CLIENTS(2),
      .SLOTS  (MISSES),
      .DATA_W (DATA_W)
  ) u_read (
      .clk          (clk),
      .rst          (block_rst[READ]),
      .limit        (memory_limit),
      .s_valid      (read_valid),
      .s_slot       (read_slot),
      .s_line       (read_line),
      .m_valid      (beat_valid),
      .m_slot       (beat_slot),
      .m_beat       (beat),
      .m_last       (beat_last),
      .m_code       (beat_code),
      .m_data       (beat_data),
      .any_outstanding(read_outstanding),
      .outstanding  (outstanding_reads),
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
      .m_axi_rlast  (m_axi_rlast)
  );

  // ---- queries
  wire query_valid, query_ready, queries_idle;
  wire [`CCHIP_QUERY_W-1:0] query;
  cchip_query_ring #(.SLOTS(MISSES), .AHEAD(MISSES < 8 ? 4 : 8), .DATA_W(DATA_W)) u_queries (
      .clk          (clk),
      .rst          (block_rst[QUERY_RING]),
      .enable       (enable),
      .base         (query_base),
      .size_log2    (query_size_log2),
      .producer     (query_producer),
      .consumer     (query_consumer),
      .failed       (query_failed),
      .idle         (queries_idle),
      .m_read_valid (read_valid[1]),
      .m_read_slot  (read_slot[READ_SLOT_W+:READ_SLOT_W]),
      .m_read_line  (read_line[58+:58]),
      .s_read_valid (beat_valid[1]),
      .s_read_slot  (beat_slot),
      .s_read_beat  (beat),
      .s_read_last  (beat_last),
      .s_read_code  (beat_code),
      .s_read_data  (beat_data),
      .m_query_valid(query_valid),
      .m_query_ready(query_ready),
      .m_query_data (query)
  );

  // ---- broad phase
  wire start_valid, leaf_valid, leaf_failed, leaf_credit;
  wire [CONTEXT_W-1:0] start_context, leaf_context;
  wire [1:0] start_epoch, leaf_epoch;
  wire [`CCHIP_QUERY_W-1:0] start_query;
  wire [3:0] leaf_kinds;
  wire [127:0] leaf_lines;
  wire leaf_result_valid, leaf_result_ready;
  wire [LEAF_RESULT_W-1:0] leaf_result;
  wire judged_valid, judged_live, done_valid, done_ready;
  wire [31:0] judged_tag, done_tag, done_steps, done_pairs;
  wire [`CCHIP_END_W-1:0] done_code;
  wire [`CCHIP_QUERY_ANSWER_W-1:0] done_answer;
  wire [4:0] count_tests;
  wire [1:0] count_wait, count_again;
  wire refused_kind;  // never: the leaves have no kind 0
  cchip_broad_phase #(
      .QUERIES   (QUERIES),
      .PAIRS     (PAIRS),
      .LEAVES    (LEAVES),
      .STACK     (STACK),
      .LEAF_DEPTH(LEAF_DEPTH),
      .CACHE_KB  (CACHE_KB),
      .MISSES    (MISSES),
      .LOCKS     (LOCKS),
      .DATA_W    (DATA_W)
  ) u_broad_phase (
      .clk               (clk),
      .rst               (reset),
      .pairs_each        (pairs_each),
      .step_limit        (step_limit),
      .open_limit        (open_limit),
      .s_query_valid     (query_valid),
      .s_query_ready     (query_ready),
      .s_query           (query),
      .m_start_valid     (start_valid),
      .m_start_context   (start_context),
      .m_start_epoch     (start_epoch),
      .m_start_query     (start_query),
      .m_leaf_valid      (leaf_valid),
      .m_leaf_context    (leaf_context),
      .m_leaf_epoch      (leaf_epoch),
      .m_leaf_kinds      (leaf_kinds),
      .m_leaf_failed     (leaf_failed),
      .m_leaf_lines      (leaf_lines),
      .s_credit          (leaf_credit),
      .s_result_valid    (leaf_result_valid),
      .s_result_ready    (leaf_result_ready),
      .s_result_context  (leaf_result[`CCHIP_LEAF_RESULT_CONTEXT(CONTEXT_W)]),
      .s_result_epoch    (leaf_result[`CCHIP_LEAF_RESULT_EPOCH(CONTEXT_W)]),
      .s_result_hits     (leaf_result[`CCHIP_LEAF_RESULT_HITS(CONTEXT_W)]),
      .s_result_open     (leaf_result[`CCHIP_LEAF_RESULT_OPEN(CONTEXT_W)]),
      .s_result_code     (leaf_result[`CCHIP_LEAF_RESULT_CODE(CONTEXT_W)]),
      .m_judged_valid    (judged_valid),
      .m_judged_live     (judged_live),
      .m_judged_tag      (judged_tag),
      .m_done_valid      (done_valid),
      .m_done_ready      (done_ready),
      .m_done_tag        (done_tag),
      .m_done_code       (done_code),
      .m_done_answer     (done_answer),
      .m_done_steps      (done_steps),
      .m_done_pairs      (done_pairs),
      .lock_first        (lock_first),
      .lock_last         (lock_last),
      .invalidate_valid  (invalidate_valid),
      .invalidate_ready  (invalidate_ready),
      .invalidate_first  (invalidate_first),
      .invalidate_last   (invalidate_last),
      .count_step        (count_step),
      .count_tests       (count_tests),
      .count_leaf_pair   (count_leaf_pair),
      .count_hit         (count_hit),
      .count_miss        (count_miss),
      .count_wait        (count_wait),
      .count_again       (count_again),
      .count_box_busy    (count_box_busy),
      .m_read_valid      (read_valid[0]),
      .m_read_slot       (read_slot[0+:READ_SLOT_W]),
      .m_read_line       (read_line[0+:58]),
      .s_read_valid      (beat_valid[0]),
      .s_read_slot       (beat_slot),
      .s_read_beat       (beat),
      .s_read_last       (beat_last),
      .s_read_code       (beat_code),
      .s_read_data       (beat_data),
      .s_read_outstanding(outstanding_reads[MISSES-1:0])
  );

  // ---- leaf pairs to the transform
  wire begin_valid, begin_ready, end_valid, end_ready, feed_valid, feed_ready, corrupt;
  wire [CONTEXT_W-1:0] begin_context, end_context;
  wire [1:0] begin_epoch, begin_pairs, end_epoch;
  wire [`CCHIP_END_W-1:0] end_code;
  wire [LEAF_W-1:0] number, end_number;
  wire [287:0] map_m;
  wire [107:0] map_t;
  wire [3:0] map_shift, feed_kinds;
  wire [11:0] map_error;
  wire [1023:0] feed_lines;
  wire [LEAF_W:0] feed_id;
  cchip_leaf_feed #(.QUERIES(QUERIES), .LEAF_W(LEAF_W)) u_feed (
      .clk            (clk),
      .rst            (block_rst[FEED]),
      .s_start_valid  (start_valid),
      .s_start_context(start_context),
      .s_start_query  (start_query),
      .s_leaf_valid   (leaf_valid),
      .s_leaf_context (leaf_context),
      .s_leaf_epoch   (leaf_epoch),
      .s_leaf_kinds   (leaf_kinds),
      .s_leaf_failed  (leaf_failed),
      .s_leaf_lines   (leaf_lines),
      .m_credit       (leaf_credit),
      .m_begin_valid  (begin_valid),
      .m_begin_ready  (begin_ready),
      .m_begin_context(begin_context),
      .m_begin_epoch  (begin_epoch),
      .m_begin_pairs  (begin_pairs),
      .s_number       (number),
      .m_end_valid    (end_valid),
      .m_end_ready    (end_ready),
      .m_end_number   (end_number),
      .m_end_context  (end_context),
      .m_end_epoch    (end_epoch),
      .m_end_code     (end_code),
      .m_valid        (feed_valid),
      .m_ready        (feed_ready),
      .m_m            (map_m),
      .m_t            (map_t),
      .m_shift        (map_shift),
      .m_error        (map_error),
      .m_kinds        (feed_kinds),
      .m_lines        (feed_lines),
      .m_id           (feed_id),
      .s_corrupt      (corrupt)
  );

  // what leaves the transform, and a clock later: the queues, the operands and the faces lie far
  // from it and from each other
  localparam integer VERTEX_W = 2 + 2 * POINT_W + `CCHIP_ERR_W + `CCHIP_KIND_W + 65 + LEAF_W + 2;
  wire vertex_valid_d;
  wire [VERTEX_W-1:0] vertex_d;
  reg vertex_valid;
  reg [VERTEX_W-1:0] vertex_of_q;
  always @(posedge clk) begin
    vertex_valid <= ~block_rst[TRANSFORM] & vertex_valid_d;
    vertex_of_q  <= vertex_d;
  end
  wire vertex_first, vertex_last, pop;
  wire [POINT_W-1:0] vertex_a, vertex_b;
  wire [`CCHIP_ERR_W-1:0] pair_err;
  wire [`CCHIP_KIND_W-1:0] pair_kind;
  wire [31:0] face_a, face_b;
  wire swapped;
  wire [LEAF_W+1:0] pair_name;  // {number, which of its primitive pairs}
  assign {vertex_first, vertex_last, vertex_a, vertex_b, pair_err, pair_kind, face_a, face_b,
          swapped, pair_name} = vertex_of_q;
  wire [POINT_W-1:0] a_d, b_d;
  wire [`CCHIP_ERR_W-1:0] err_d;
  wire [`CCHIP_KIND_W-1:0] kind_d;
  wire [31:0] face_a_d, face_b_d;
  wire first_d, last_d, swapped_d;
  wire [LEAF_W+1:0] name_d;
  assign vertex_d = {first_d, last_d, a_d, b_d, err_d, kind_d, face_a_d, face_b_d, swapped_d,
                     name_d};
  cchip_transform #(
      .COORD_W(COORD_W),
      .PASSES (PASSES),
      .CREDIT (QUEUE_DEPTH),
      .ID_W   (LEAF_W + 1)
  ) u_transform (
      .clk     (clk),
      .rst     (block_rst[TRANSFORM]),
      .s_valid (feed_valid),
      .s_ready (feed_ready),
      .s_m     (map_m),
      .s_t     (map_t),
      .s_shift (map_shift),
      .s_error (map_error),
      .s_kinds (feed_kinds),
      .s_lines (feed_lines),
      .s_id    (feed_id),
      .corrupt (corrupt),
      .m_valid (vertex_valid_d),
      .m_first (first_d),
      .m_last  (last_d),
      .m_a     (a_d),
      .m_b     (b_d),
      .m_err   (err_d),
      .m_kind  (kind_d),
      .m_face_a(face_a_d),
      .m_face_b(face_b_d),
      .m_id    ({swapped_d, name_d[LEAF_W+1:2]}),
      .m_pair  (name_d[1:0]),
      .s_credit(pop)
  );

  // ---- primitive pairs wait: operands vertex by vertex, the descriptor with the last. All kinds
  // share the transform's credit of QUEUE_DEPTH, so every queue has room; and an operand is
  // overwritten by a pair that began after its own had left, long after it was read
  wire [KINDS:0] some, queue_room, kind;
  wire [(KINDS+1)*$clog2(QUEUE_DEPTH+1)-1:0] waiting;
  wire kind_room, look;
  wire [PLACE_W-1:0] write_place, read_place;
  wire [1:0] read_vertex;
  wire [POINT_W-1:0] a, b;
  wire [`CCHIP_DESCRIPTOR_W-1:0] descriptor;
  wire [15:0] tag = {{14 - LEAF_W{1'b0}}, pair_name};
  reg [1:0] vertex_q;  // number of the vertex
  always @(posedge clk)
    if (block_rst[REST]) vertex_q <= 2'd0;
    else if (vertex_valid) vertex_q <= vertex_last ? 2'd0 : vertex_q + 2'd1;
  cchip_descriptor_queues #(
      .WIDTH(`CCHIP_DESCRIPTOR_W),
      .KINDS(KINDS),
      .DEPTH(QUEUE_DEPTH)
  ) u_queues (
      .clk    (clk),
      .rst    (block_rst[QUEUES]),
      .s_valid(vertex_valid & vertex_last),
      .s_ready(kind_room),
      .s_kind (pair_kind),
      .s_data (`CCHIP_DESCRIPTOR_OF(tag, pair_err, `CCHIP_MODE_DIRECTED)),
      .s_place(write_place),
      .some   (some),
      .waiting(waiting),
      .room   (queue_room),
      .kind   (kind),
      .look   (look),
      .pop    (pop),
      .m_place(read_place),
      .m_data (descriptor)
  );
  cchip_block_ram #(.WIDTH(2 * POINT_W), .ADDR_W(PLACE_W + 2)) u_operands (
      .clk       (clk),
      .write     (vertex_valid),
      .write_addr({write_place, vertex_q}),
      .write_data({vertex_b, vertex_a}),
      .read_addr ({read_place, read_vertex}),
      .read_data ({b, a})
  );

  // ---- slots. All kinds share the transform's credit: pairs of kinds that no slot serves can use
  // it up, so that a queue that holds some is as good as full
  localparam integer COUNT_W = $clog2(QUEUE_DEPTH + 1);
  localparam [31:0] CREDIT_LEFT = QUEUE_DEPTH - 4;  // of a leaf pair's: more than that is used up
  localparam [COUNT_W+1:0] MOST_WAITING = CREDIT_LEFT[COUNT_W+1:0];
  wire [COUNT_W+1:0] waiting_in_all = {2'd0, waiting[COUNT_W+:COUNT_W]} +
      {2'd0, waiting[2*COUNT_W+:COUNT_W]} + {2'd0, waiting[3*COUNT_W+:COUNT_W]};
  reg crowded_q;
  always @(posedge clk) crowded_q <= waiting_in_all > MOST_WAITING;
  assign swap_waiting = waiting[COUNT_W+:3*COUNT_W];
  assign swap_full    = ~queue_room[KINDS:1] | ({KINDS{crowded_q}} & some[KINDS:1]);
  wire result_valid, result_ready;
  wire [`CCHIP_KIND_W-1:0] result_kind;
  wire [`CCHIP_RESULT_W-1:0] result;
  cchip_slots #(
      .COORD_W    (COORD_W),
      .SUBSTAGES  (SUBSTAGES),
      .CONTEXTS   (CONTEXTS),
      .EXHAUSTIVE (0),
      .SLOTS      (SLOTS),
      .SWAPS      (SWAPS),
      .CFG_W      (CFG_W),
      .ROC_CYCLES (ROC_CYCLES),
      .SLOT0_RM_ID(RM_ID),
      .SLOT1_RM_ID(SLOT1_RM_ID),
      .SLOT2_RM_ID(SLOT2_RM_ID),
      .SLOT3_RM_ID(SLOT3_RM_ID),
      .SIMULATION (SIMULATION),
      .SEED       (SEED)
  ) u_slots (
      .clk             (clk),
      .rst             (block_rst[SLOTS_RST]),
      .core_rst        (block_rst[SLOTS_CORE]),
      .some            (some),
      .kind            (kind),
      .look            (look),
      .pop             (pop),
      .vertex          (read_vertex),
      .descriptor      (descriptor),
      .a               (a),
      .b               (b),
      .m_result_valid  (result_valid),
      .m_result_ready  (result_ready),
      .m_result_kind   (result_kind),
      .m_result_data   (result),
      .answered        (answered),
      .answered_module (answered_module),
      .refused_kind    (refused_kind),
      .refused_provider(refused_provider),
      .outstanding     (slot_outstanding),
      .rm_id           (slot_rm_id),
      .decoupled       (slot_decoupled),
      .no_provider     (no_provider),
      .to_slots        (to_slots),
      .from_slots      (from_slots),
      .cfg_valid       (cfg_valid),
      .cfg_data        (cfg_data)
  );
  assign count_pair = result_valid & result_ready;

  // ---- results and records
  wire [`CCHIP_TAG_W-1:0] result_tag = result[`CCHIP_RESULT_TAG];
  wire record_valid, record_ready, records_idle, write_valid, write_ready, write_answer;
  wire [127:0] record;
  wire [BEAT_ADDRESS_W-1:0] write_address;
  wire [DATA_W-1:0] write_data;
  wire [DATA_W/8-1:0] write_strb;
  wire [`CCHIP_WRITE_CODE_W-1:0] write_code;
  cchip_calc_result #(.LEAVES(LEAF_NUMBERS), .CONTEXT_W(CONTEXT_W), .JUDGED(16)) u_calc_result (
      .clk              (clk),
      .rst              (block_rst[RESULTS]),
      .s_begin_valid    (begin_valid),
      .s_begin_ready    (begin_ready),
      .s_begin_context  (begin_context),
      .s_begin_epoch    (begin_epoch),
      .s_begin_pairs    (begin_pairs),
      .m_number         (number),
      .s_end_valid      (end_valid),
      .s_end_ready      (end_ready),
      .s_end_number     (end_number),
      .s_end_context    (end_context),
      .s_end_epoch      (end_epoch),
      .s_end_code       (end_code),
      .s_faces_valid    (vertex_valid & vertex_first),
      .s_faces_pair     (pair_name),
      .s_faces          (swapped ? {face_a, face_b} : {face_b, face_a}),
      .s_result_valid   (result_valid),
      .s_result_ready   (result_ready),
      .s_result_pair    (result_tag[LEAF_W+1:0]),
      .s_result_hit     (result[`CCHIP_RESULT_HIT]),
      .s_result_definite(result[`CCHIP_RESULT_DEFINITE]),
      .m_leaf_valid     (leaf_result_valid),
      .m_leaf_ready     (leaf_result_ready),
      .m_leaf_data      (leaf_result),
      .s_judged_valid   (judged_valid),
      .s_judged_live    (judged_live),
      .s_judged_tag     (judged_tag),
      .s_done_valid     (done_valid),
      .s_done_ready     (done_ready),
      .s_done_data      (`CCHIP_DONE_RECORD_OF(done_tag, 1'b1, done_answer, 5'd0, {5'd0, done_code},
          15'd0, 1'b0, done_steps, done_pairs)),
      .m_record_valid   (record_valid),
      .m_record_ready   (record_ready),
      .m_record_data    (record)
  );
  cchip_record_ring #(.DATA_W(DATA_W)) u_records (
      .clk          (clk),
      .rst          (block_rst[RECORDS]),
      .base         (record_base),
      .size_log2    (record_size_log2),
      .consumer     (record_consumer),
      .producer     (record_producer),
      .failed       (record_failed),
      .idle         (records_idle),
      .s_valid      (record_valid),
      .s_ready      (record_ready),
      .s_data       (record),
      .m_valid      (write_valid),
      .m_ready      (write_ready),
      .m_address    (write_address),
      .m_data       (write_data),
      .m_strb       (write_strb),
      .s_answer     (write_answer),
      .s_answer_code(write_code)
  );
  cchip_axi_write #(
      .CLIENTS    (1),
      .DATA_W     (DATA_W),
      .OUTSTANDING(16),
      .ID_W       (1)
  ) u_write (
      .clk          (clk),
      .rst          (block_rst[WRITE]),
      .limit        (memory_limit),
      .s_valid      (write_valid),
      .s_ready      (write_ready),
      .s_last       (1'b1),
      .s_address    (write_address),
      .s_data       (write_data),
      .s_strb       (write_strb),
      .m_valid      (write_answer),
      .m_code       (write_code),
      .any_outstanding(write_outstanding),
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

  // ---- what is in flight between the rings, and what is counted
  wire last_record = record[`CCHIP_DONE_RECORD_DONE];
  wire [7:0] code = record[`CCHIP_DONE_RECORD_CODE];
  reg [7:0] in_flight_q;
  reg idle_q;
  always @(posedge clk)
    if (block_rst[REST]) begin
      in_flight_q <= 8'd0;
      idle_q      <= 1'b0;
    end else begin
      in_flight_q <= in_flight_q + {7'd0, query_valid & query_ready} - {7'd0, count_query};
      idle_q      <= queries_idle && in_flight_q == 8'd0 && records_idle;
    end
  assign idle = idle_q;
  assign count_record = record_valid & record_ready;
  assign count_record_wait = record_valid & ~record_ready;
  assign count_query = count_record & last_record;
  assign count_error = count_query && code != {5'd0, `CCHIP_END_OK} &&
      code != {5'd0, `CCHIP_END_HOST};

  wire unused = &{1'b0, refused_kind, start_epoch, count_tests, count_wait, count_again,
      waiting[COUNT_W-1:0], queue_room[0], outstanding_reads[2*MISSES-1:MISSES], result_kind,
      result, result_tag};
  always @(posedge clk)
    if (!block_rst[REST]) begin
      `CCHIP_ASSERT(a_kind_room, !(vertex_valid && vertex_last) || kind_room)
      `CCHIP_ASSERT(a_in_flight, in_flight_q != 8'd255 && (!count_query || in_flight_q != 8'd0))
    end

endmodule
`default_nettype wire
