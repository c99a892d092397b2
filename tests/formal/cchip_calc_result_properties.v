// SPDX-License-Identifier: Apache-2.0 WITH SHL-2.1
`default_nettype none
`include "cchip_defs.vh"
// Proved of cchip_calc_result, for some clocks after reset: a number that is lent is not lent again until its leaf pair's result
// has been sent, judged and its records have left, and its leaf pair has one result, with its own hits; a hit of a live leaf pair
// becomes one record, a hit of a dead one none; no record of a query comes after its done record.
// Assumed: results come for primitive pairs that have begun, once each, with their faces before; judgements come in the order of
// the results that were taken, and the end of a query two clocks after its last judgement or later; after that no leaf pair of
// its tag is live.
// One number, any, is followed: the leaf pairs that have it, and no others, are of context 1. One tag, any, is followed, too.
module cchip_calc_result_properties #(
    parameter integer LEAVES = 4,
    parameter integer JUDGED = 2
) (
    input wire        clk,
    input wire        rst,
    input wire        s_begin_valid,
    input wire [ 1:0] s_begin_pairs,
    input wire        s_end_valid,
    input wire [ 1:0] s_end_number,
    input wire        s_faces_valid,
    input wire [ 3:0] s_faces_pair,
    input wire        s_face,          // bit 0 of the faces
    input wire        s_result_valid,
    input wire [ 3:0] s_result_pair,
    input wire        s_result_hit,
    input wire        s_result_definite,
    input wire        m_leaf_ready,
    input wire        s_judged_valid,
    input wire        s_judged_live,
    input wire        s_judged_tag,
    input wire        s_done_valid,
    input wire        m_record_ready
);
  (* anyconst *) wire [1:0] followed;
  wire s_begin_ready, s_end_ready, s_result_ready, m_leaf_valid, s_done_ready, m_record_valid;
  wire [1:0] m_number;
  wire [11:0] m_leaf_data;  // context of 1 bit
  wire [127:0] m_record;
  cchip_calc_result #(
      .LEAVES   (LEAVES),
      .CONTEXT_W(1),
      .JUDGED   (JUDGED)
  ) dut (
      .clk              (clk),
      .rst              (rst),
      .s_begin_valid    (s_begin_valid),
      .s_begin_ready    (s_begin_ready),
      .s_begin_context  (m_number == followed),
      .s_begin_epoch    (2'd0),
      .s_begin_pairs    (s_begin_pairs),
      .m_number         (m_number),
      .s_end_valid      (s_end_valid),
      .s_end_ready      (s_end_ready),
      .s_end_number     (s_end_number),
      .s_end_context    (s_end_number == followed),
      .s_end_epoch      (2'd0),
      .s_end_code       (`CCHIP_END_CORRUPT),
      .s_faces_valid    (s_faces_valid),
      .s_faces_pair     (s_faces_pair),
      .s_faces          ({63'd0, s_face}),
      .s_result_valid   (s_result_valid),
      .s_result_ready   (s_result_ready),
      .s_result_pair    (s_result_pair),
      .s_result_hit     (s_result_hit),
      .s_result_definite(s_result_definite),
      .m_leaf_valid     (m_leaf_valid),
      .m_leaf_ready     (m_leaf_ready),
      .m_leaf_data      (m_leaf_data),
      .s_judged_valid   (s_judged_valid),
      .s_judged_live    (s_judged_live),
      .s_judged_tag     ({31'd0, s_judged_tag}),
      .s_done_valid     (s_done_valid),
      .s_done_ready     (s_done_ready),
      .s_done_data      ({95'd0, 1'b1, 31'd0, 1'b1}),  // the followed tag is 1
      .m_record_valid   (m_record_valid),
      .m_record_ready   (m_record_ready),
      .m_record_data    (m_record)
  );

  reg started_q = 1'b0;
  always @(posedge clk) started_q <= 1'b1;
  always @* assume (started_q || rst);

  // ---- every number: lent; its primitive pairs, those that have their faces and their results
  reg [3:0] lent_q, ended_q;
  reg [15:0] pairs_q, faces_q, results_q;
  wire begins = s_begin_valid & s_begin_ready;
  wire ends = s_end_valid & s_end_ready;
  wire results = s_result_valid & s_result_ready;
  wire [3:0] of_begin = 4'd15 >> (2'd3 - s_begin_pairs);
`ifdef NARROW
  // task order: few choices, so that more clocks can be looked at
  always @* assume (s_begin_pairs == 2'd0 && !s_end_valid && s_result_hit && m_leaf_ready && m_record_ready);
`endif
  always @* begin
    assume (s_begin_pairs != 2'd2);
    assume (!s_faces_valid || (pairs_q[s_faces_pair] && !faces_q[s_faces_pair]));
    assume (!s_result_valid || (faces_q[s_result_pair] && !results_q[s_result_pair]));
    assume (!s_end_valid || (lent_q[s_end_number] && !ended_q[s_end_number] && faces_q[4*s_end_number+:4] == 4'd0 &&
        !(s_faces_valid && s_faces_pair[3:2] == s_end_number)));
  end
  always @(posedge clk) begin
    if (begins) begin
      pairs_q[4*m_number+:4] <= of_begin;
      faces_q[4*m_number+:4] <= 4'd0;
      results_q[4*m_number+:4] <= 4'd0;
      ended_q[m_number] <= 1'b0;
      lent_q[m_number] <= 1'b1;
    end
    if (ends) begin
      ended_q[s_end_number] <= 1'b1;
      pairs_q[4*s_end_number+:4] <= 4'd0;
    end
    if (s_faces_valid) faces_q[s_faces_pair] <= 1'b1;
    if (results) results_q[s_result_pair] <= 1'b1;
    if (rst) begin
      lent_q <= 4'd0;
      pairs_q <= 16'd0;
      faces_q <= 16'd0;
    end
  end

  // ---- the followed number
  localparam [2:0] FREE = 3'd0, BEGUN = 3'd1, SENT = 3'd2, JUDGED_LIVE = 3'd3, JUDGED_DEAD = 3'd4;
  reg [2:0] at_q;
  reg [3:0] hits_q, definite_q, face_q;
  reg whole_q, ended_here_q;
  wire of_followed = m_leaf_data[0];
  wire sends = m_leaf_valid & m_leaf_ready;
  // results that the traversal has and has not judged, oldest first: is it the followed one?
  reg [1:0] waiting_q, which_q;
  wire [1:0] left = waiting_q - {1'b0, s_judged_valid};
  always @* assume (!s_judged_valid || waiting_q != 2'd0);
  wire judges = s_judged_valid & which_q[0];
  // records of the followed leaf pair: the ones between its judgement and the next
  reg over_q;  // the done record of the followed tag has left
  reg [1:0] done_at_q;  // clocks since a judgement
  reg done_given_q;
  wire gives = m_record_valid & m_record_ready;
  wire is_done = m_record[`CCHIP_DONE_RECORD_DONE];
  wire [2:0] hit_count = {2'd0, hits_q[0]} + {2'd0, hits_q[1]} + {2'd0, hits_q[2]} + {2'd0, hits_q[3]};
  wire [2:0] definite_count = {2'd0, definite_q[0]} + {2'd0, definite_q[1]} + {2'd0, definite_q[2]} + {2'd0, definite_q[3]};
  always @* begin
    // the end of tag 1 comes once, and after its last judgement
    assume (!(s_done_valid && done_at_q != 2'd2));
    assume (!(s_done_valid && done_given_q));
    assume (!(s_judged_valid && s_judged_live && s_judged_tag && (s_done_valid || done_given_q)));
  end
  reg done_offered_q;
  always @* assume (!done_offered_q || s_done_valid);  // a stream
  always @(posedge clk) begin
    done_offered_q <= ~rst & s_done_valid & ~s_done_ready;
    done_at_q <= rst ? 2'd2 : s_judged_valid && s_judged_tag ? 2'd0 : done_at_q == 2'd2 ? 2'd2 : done_at_q + 2'd1;
    done_given_q <= ~rst & (done_given_q | (s_done_valid & s_done_ready));
    over_q <= ~rst & (over_q | (gives & is_done));
    waiting_q <= rst ? 2'd0 : left + {1'b0, sends};
    which_q <= s_judged_valid ? {1'b0, which_q[1]} : which_q;
    if (sends) which_q[left[0]] <= of_followed;
    case (at_q)
      FREE: if (begins && m_number == followed) at_q <= BEGUN;
      BEGUN: if (sends && of_followed) at_q <= SENT;
      SENT: if (judges) at_q <= s_judged_live ? JUDGED_LIVE : JUDGED_DEAD;
      default: if (begins && m_number == followed) at_q <= BEGUN;
    endcase
    if (begins && m_number == followed) begin
      hits_q <= 4'd0;
      definite_q <= 4'd0;
      whole_q <= 1'b0;
      ended_here_q <= 1'b0;
    end
    if (ends && s_end_number == followed) ended_here_q <= 1'b1;
    if (results && s_result_pair[3:2] == followed) begin
      hits_q[s_result_pair[1:0]] <= s_result_hit;
      definite_q[s_result_pair[1:0]] <= s_result_hit & s_result_definite;
    end
    if (rst) at_q <= FREE;
    if (started_q && !rst) begin
      // lent while it is not in use
      if (begins && m_number == followed) assert (at_q == FREE || at_q == JUDGED_LIVE || at_q == JUDGED_DEAD);
      if (m_leaf_valid && of_followed) begin
        assert (at_q == BEGUN);
        assert (ended_here_q || results_q[4*followed+:4] == pairs_q[4*followed+:4]);
        assert (ended_here_q || m_leaf_data[5:3] == definite_count);
        assert (ended_here_q || m_leaf_data[8:6] == hit_count - definite_count);
        assert (m_leaf_data[11:9] == (ended_here_q ? `CCHIP_END_CORRUPT : `CCHIP_END_OK));
      end
      if (over_q && m_record_valid) assert (m_record[31:0] != 32'd1);
    end
  end

  // ---- records: each is a hit of a live leaf pair
  reg [4:0] owed_q;  // hits of live leaf pairs whose record has not left
  reg [5:0] sent_hits_q;  // of the two results with the traversal, oldest first
  wire [2:0] sent_hits = m_leaf_data[5:3] + m_leaf_data[8:6];
  always @(posedge clk) begin
    sent_hits_q <= s_judged_valid ? {3'd0, sent_hits_q[5:3]} : sent_hits_q;
    if (sends) sent_hits_q[3*left[0]+:3] <= sent_hits;
    owed_q <= rst ? 5'd0 : owed_q + (s_judged_valid && s_judged_live ? {2'd0, sent_hits_q[2:0]} : 5'd0) -
        {4'd0, gives & ~is_done};
    if (started_q && !rst && m_record_valid && !is_done) assert (owed_q != 5'd0);
  end
`ifdef COVER
  always @(posedge clk)
    if (started_q && !rst)
      case (`COVER)
        0: assert (!(gives && is_done && at_q == JUDGED_LIVE && hit_count == 3'd2));
        1: assert (!(begins && m_number == followed && at_q == JUDGED_LIVE && hits_q != 4'd0));
      endcase
`endif
endmodule
`default_nettype wire
