// SPDX-License-Identifier: Apache-2.0 WITH SHL-2.1
`default_nettype none
`include "cchip_defs.vh"
`include "cchip_assert.vh"
// cchip_calc_result: from results of primitive pairs to results of leaf pairs and to records (the
// block calcResult of the paper, Fig. 2).
//   number       s_begin lends a leaf pair one of LEAVES numbers, on m_number; it comes back when
//                the records of the leaf pair have left. {number, which of its up to four} names a
//                primitive pair from the transform on
//   judgement    only the traversal knows whether the query of a leaf pair was still in flight when
//                its result arrived. It says so in the order in which it took the results
//                (s_judged); hits of live leaf pairs become records, those of dead ones are
//                dropped. No epoch is compared here
//   order        the traversal gives the end of a query after the judgements of all results that
//                it took before, and an end waits here until no judgement does: so the records of
//                a query precede its last one, and `pairs` of that one counts them
//   room         at most JUDGED leaf pairs have a result with the traversal or a judgement that
//                waits for its records
//   throughput   a primitive pair every 2 clocks; s_begin and s_end on the other clock of the two;
//                a record every 5 clocks, a leaf pair without one every 2
//   cuts         every path but one: s_begin_ready, s_end_ready and s_result_ready are a flip-flop,
//                or one and the pool's
//   reset        every number is free
module cchip_calc_result #(
    parameter integer LEAVES = 64,  // leaf pairs between leaf feed and record; legal: 4, 8 ... 256
    parameter integer CONTEXT_W = 4,  // width of a context's number (bit); legal: 1 or more
    // leaf pairs with the traversal, or judged and without their records; legal: 2..64
    parameter integer JUDGED = 16
) (
    input  wire                                      clk,                // clock, rising edge
    input  wire                                      rst,  // synchronous reset, active high
    input  wire                                      s_begin_valid,      // a leaf pair begins
    output wire                                      s_begin_ready,      // it gets m_number
    input  wire [                     CONTEXT_W-1:0] s_begin_context,    // context of its query
    input  wire [                               1:0] s_begin_epoch,      // epoch of its query
    input  wire [                               1:0] s_begin_pairs,      // its primitive pairs - 1
    // number of the leaf pair that begins
    output wire [                $clog2(LEAVES)-1:0] m_number,
    // a leaf pair ends without primitive pairs
    input  wire                                      s_end_valid,
    output wire                                      s_end_ready,        // taken
    input  wire [                $clog2(LEAVES)-1:0] s_end_number,       // its number
    input  wire [                     CONTEXT_W-1:0] s_end_context,      // context of its query
    input  wire [                               1:0] s_end_epoch,        // epoch of its query
    // QueryCode, docs/hardware/definitions.md with which its query ends
    input  wire [                  `CCHIP_END_W-1:0] s_end_code,
    // ---- the faces of a primitive pair, in the user's order; before its result
    // the faces of a primitive pair
    input  wire                                      s_faces_valid,
    // {number of the leaf pair, which of its four}
    input  wire [                $clog2(LEAVES)+1:0] s_faces_pair,
    // {face of the user's second object, of the first}
    input  wire [                              63:0] s_faces,
    input  wire                                      s_result_valid,  // result of a primitive pair
    output wire                                      s_result_ready,     // taken
    // {number of the leaf pair, which of its four}
    input  wire [                $clog2(LEAVES)+1:0] s_result_pair,
    // the primitives touch, or may do so
    input  wire                                      s_result_hit,
    input  wire                                      s_result_definite,  // the answer is certain
    // ---- result of a leaf pair, to the traversal; its judgement; ends of queries
    // result of a leaf pair, to the traversal
    output wire                                      m_leaf_valid,
    input  wire                                      m_leaf_ready,       // taken
    // record LEAF_RESULT, docs/hardware/definitions.md
    output wire [                      CONTEXT_W+10:0] m_leaf_data,
    // judgement of the next result that the traversal took
    input  wire                                      s_judged_valid,
    input  wire                                      s_judged_live,  // its query was in flight
    input  wire [                              31:0] s_judged_tag,       // tag of the query
    input  wire                                      s_done_valid,       // a query has ended
    output wire                                      s_done_ready,       // taken
    // record DONE_RECORD, docs/hardware/definitions.md
    input  wire [        `CCHIP_DONE_RECORD_W-1:0] s_done_data,
    // ---- records
    output wire                                      m_record_valid,     // a record
    input  wire                                      m_record_ready,     // taken
    // record PAIR_RECORD or DONE_RECORD, docs/hardware/definitions.md, phase 0
    output wire [        `CCHIP_PAIR_RECORD_W-1:0] m_record_data
);

  localparam integer LEAF_W = $clog2(LEAVES);

  `CCHIP_REFUSE(LEAVES < 4 || LEAVES > 256 || (1 << LEAF_W) != LEAVES,
                cchip_error_calc_result_LEAVES_must_be_a_power_of_two_4_to_256)
  `CCHIP_REFUSE(JUDGED < 2 || JUDGED > 64 || CONTEXT_W < 1,
                cchip_error_calc_result_JUDGED_must_be_2_to_64_and_CONTEXT_W_positive)

  // ---- numbers
  wire number_valid;
  wire take = s_begin_valid & s_begin_ready;
  reg back_valid_q;
  reg [LEAF_W-1:0] back_number_q;
  cchip_pool #(.COUNT(LEAVES), .WIDTH(LEAF_W)) u_numbers (
      .clk        (clk),
      .rst        (rst),
      .m_valid    (number_valid),
      .m_ready    (take),
      .m_number   (m_number),
      .back_valid (back_valid_q),
      .back_number(back_number_q)
  );

  // ---- what is known of each number. One memory, one writer: new leaf pairs write it while odd_q
  // is 0, and a result reads it; while odd_q is 1 the result is written back
  reg odd_q;
  `CCHIP_LUT_RAM
  reg [CONTEXT_W+1:0] queries[0:LEAVES-1];  // {epoch, context}
  `CCHIP_LUT_RAM
  reg [9:0] counts[0:LEAVES-1];  // {primitive pairs left - 1, definite hits, hits}
  reg result_q, hit_q, definite_q;
  reg [LEAF_W+1:0] pair_q;
  reg [9:0] count_q;
  reg [CONTEXT_W+1:0] query_q;
  wire [LEAF_W-1:0] number = pair_q[LEAF_W+1:2];
  wire [3:0] one = 4'd1 << pair_q[1:0];
  wire [3:0] hits = count_q[3:0] | (one & {4{hit_q}});
  wire [3:0] definite = count_q[7:4] | (one & {4{hit_q & definite_q}});
  wire complete = count_q[9:8] == 2'd0;
  wire [LEAF_W-1:0] result_number = s_result_pair[LEAF_W+1:2];
  assign s_result_ready = ~odd_q;
  assign s_end_ready    = ~odd_q;
  assign s_begin_ready  = ~odd_q & number_valid;
  always @(posedge clk) begin
    odd_q      <= ~rst & ~odd_q;
    result_q   <= ~rst & s_result_valid & ~odd_q;
    hit_q      <= s_result_hit;
    definite_q <= s_result_definite;
    pair_q     <= s_result_pair;
    count_q    <= counts[result_number];
    query_q    <= queries[result_number];
    if (odd_q ? result_q : take)
      counts[odd_q?number : m_number] <= odd_q ? {count_q[9:8] - 2'd1, definite, hits} :
          {s_begin_pairs, 8'd0};
    if (take) queries[m_number] <= {s_begin_epoch, s_begin_context};
  end

  // ---- leaf pairs that are complete
  localparam integer WHOLE_W = `CCHIP_END_W + LEAF_W + 2 + CONTEXT_W + 8;
  reg push_q;
  reg [WHOLE_W-1:0] push_data_q;
  always @(posedge clk) begin
    push_q      <= ~rst & (odd_q ? result_q & complete : s_end_valid);
    push_data_q <= odd_q ? {`CCHIP_END_OK, number, query_q, definite, hits} :
        {s_end_code, s_end_number, s_end_epoch, s_end_context, 8'd0};
  end
  wire whole_ready, whole_valid;
  wire [`CCHIP_END_W-1:0] whole_code;
  wire [LEAF_W-1:0] whole_number;
  wire [1:0] whole_epoch;
  wire [CONTEXT_W-1:0] whole_context;
  wire [3:0] whole_definite, whole_hits;
  wire room, sent;
  cchip_fifo #(.WIDTH(WHOLE_W), .DEPTH(LEAVES), .ROOM_KNOWN(1)) u_whole (
      .clk    (clk),
      .rst    (rst),
      .s_valid(push_q),
      .s_ready(whole_ready),
      .s_data (push_data_q),
      .m_valid(whole_valid),
      .m_ready(m_leaf_ready & room),
      .m_data ({whole_code, whole_number, whole_epoch, whole_context, whole_definite, whole_hits})
  );
  function [2:0] ones(input [3:0] x);
    ones = {2'd0, x[0]} + {2'd0, x[1]} + {2'd0, x[2]} + {2'd0, x[3]};
  endfunction
  wire [2:0] whole_open_count = ones(whole_hits & ~whole_definite);
  wire [2:0] whole_hit_count = ones(whole_definite);
  assign m_leaf_valid = whole_valid & room;
  assign m_leaf_data = `CCHIP_LEAF_RESULT_OF(whole_context, whole_epoch, whole_hit_count,
      whole_open_count, whole_code);
  assign sent = m_leaf_valid & m_leaf_ready;

  // ---- leaf pairs whose result the traversal has, in that order, and its judgements
  wire emitted;
  wire [$clog2(JUDGED+1)-1:0] judged_count;
  wire judged_some, sent_ready, sent_valid, judged_ready, judged_valid, live;
  wire [LEAF_W-1:0] sent_number;
  wire [3:0] sent_definite, sent_hits;
  wire [31:0] tag;
  cchip_count #(.LIMIT(JUDGED)) u_room (
      .clk  (clk),
      .rst  (rst),
      .up   (sent),
      .down (emitted),
      .count(judged_count),
      .some (judged_some),
      .room (room)
  );
  cchip_fifo #(.WIDTH(LEAF_W + 8), .DEPTH(JUDGED), .ROOM_KNOWN(1)) u_sent (
      .clk    (clk),
      .rst    (rst),
      .s_valid(sent),
      .s_ready(sent_ready),
      .s_data ({whole_number, whole_definite, whole_hits}),
      .m_valid(sent_valid),
      .m_ready(emitted),
      .m_data ({sent_number, sent_definite, sent_hits})
  );
  cchip_fifo #(.WIDTH(33), .DEPTH(JUDGED), .ROOM_KNOWN(1)) u_judged (
      .clk    (clk),
      .rst    (rst),
      .s_valid(s_judged_valid),
      .s_ready(judged_ready),
      .s_data ({s_judged_live, s_judged_tag}),
      .m_valid(judged_valid),
      .m_ready(emitted),
      .m_data ({live, tag})
  );

  // ---- records: those of one leaf pair after the other, and ends of queries in between
  localparam [2:0] IDLE = 3'd0, CHOOSE = 3'd1, READ = 3'd2, READ2 = 3'd3, LOAD = 3'd4, SEND = 3'd5;
  reg [2:0] state_q;
  reg [3:0] left_q;  // primitive pairs whose record has not been chosen
  reg definite_now_q, emitted_q, done_ready_q, record_valid_q;
  reg [LEAF_W+1:0] face_q;
  reg [`CCHIP_PAIR_RECORD_W-1:0] record_q;
  wire [63:0] faces;
  cchip_block_ram #(.WIDTH(64), .ADDR_W(LEAF_W + 2)) u_faces (
      .clk       (clk),
      .write     (s_faces_valid),
      .write_addr(s_faces_pair),
      .write_data(s_faces),
      .read_addr (face_q),
      .read_data (faces)
  );
  wire [3:0] next = left_q & (~left_q + 4'd1);  // the lowest one
  wire [1:0] next_number = {|next[3:2], next[3] | next[1]};
  wire [127:0] pair_record = `CCHIP_PAIR_RECORD_OF(tag, 1'b0, definite_now_q, 29'd0, 1'b0,
      faces[31:0], faces[63:32]);
  always @(posedge clk) begin
    emitted_q     <= 1'b0;
    done_ready_q  <= 1'b0;
    back_valid_q  <= ~rst & emitted_q;
    back_number_q <= sent_number;
    case (state_q)
      IDLE:
      if (judged_valid && !emitted_q) begin
        left_q <= sent_hits;
        if (live && sent_hits != 4'd0) state_q <= CHOOSE;
        else emitted_q <= 1'b1;
      end else if (s_done_valid && !done_ready_q && !emitted_q) begin
        left_q         <= 4'd0;
        record_q       <= s_done_data;
        record_valid_q <= 1'b1;
        done_ready_q   <= 1'b1;
        state_q        <= SEND;
      end
      CHOOSE: begin
        face_q         <= {sent_number, next_number};
        definite_now_q <= |(next & sent_definite);
        left_q         <= left_q & ~next;
        state_q        <= READ;
      end
      READ:  state_q <= READ2;
      READ2: state_q <= LOAD;
      LOAD: begin
        record_q       <= pair_record;
        record_valid_q <= 1'b1;
        state_q        <= SEND;
      end
      default:  // GIVE
      if (m_record_ready) begin
        record_valid_q <= 1'b0;
        emitted_q      <= ~record_q[`CCHIP_DONE_RECORD_DONE] & left_q == 4'd0;
        state_q        <= left_q == 4'd0 ? IDLE : CHOOSE;
      end
    endcase
    if (rst) begin
      state_q        <= IDLE;
      emitted_q      <= 1'b0;
      done_ready_q   <= 1'b0;
      record_valid_q <= 1'b0;
    end
  end
  assign emitted        = emitted_q;
  assign s_done_ready   = done_ready_q;
  assign m_record_valid = record_valid_q;
  assign m_record_data  = record_q;

  wire unused = &{1'b0, judged_count, judged_some, whole_ready, sent_ready, judged_ready};
  always @(posedge clk)
    if (!rst) begin
      `CCHIP_ASSERT(a_order, !judged_valid || sent_valid)
      `CCHIP_ASSERT(a_room, !push_q || whole_ready)
    end

endmodule
`default_nettype wire
