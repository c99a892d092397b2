// SPDX-License-Identifier: Apache-2.0 WITH SHL-2.1
`default_nettype none
`include "cchip_defs.vh"
`include "cchip_assert.vh"
// cchip_axi_read: AXI4 read master for lines of 64 bytes, shared by several clients. A client has
// SLOTS slots for lines and names the slot in its request; the AXI ID is {client, slot}, so lines
// may arrive in any order and mixed.
//   credit       a slot is the credit: a client requests a slot again only after the last beat of
//                its answer, and takes every beat. There is no ready, and no client can stall the
//                read channel or another client
//   answer       the beats of the line in order, the last one marked and with a code. Data count
//                only if that is CCHIP_READ_OK: rresp other than OKAY on any beat, or rlast too
//                early or too late, is CCHIP_READ_BUS
//   silence      a read that lasts longer than `limit` clocks from the offer of its address on is
//                answered with CCHIP_READ_TIMEOUT 2 limit + 3 CLIENTS SLOTS + 10 clocks after the
//                offer at the latest. Until then it waits behind the addresses requested before
//                it, at most CLIENTS SLOTS - 1, each accepted or abandoned in that time.
//                The last beat of a timeout has no data. While beats are outstanding under that ID,
//                or the address is not taken, a request that would have to wait for it is answered
//                with CCHIP_READ_OWED. Beats that come after the answer, or unasked, are dropped. A
//                client that uses a slot again only while its bit of `outstanding` is 0 is never
//                refused because of a response that is missing
//   limit        1..2^32 - 1 clocks; 0 means CCHIP_MEMORY_LIMIT_DEFAULT. It may change on any
//                clock, also during reads: a lower one ends them after 2 limit + 3 CLIENTS SLOTS +
//                12 clocks from the change at the latest, a higher one, or 0, gives them more time
//   latency      5 clocks from s_valid to arvalid, 3 from a beat to m_valid
//   throughput   a beat and an address on every clock; an answer without data takes a clock of the
//                read channel, at most every other one
//   bursts       one line each, aligned, so never across 4 KiB; the top says arsize (whole beats),
//                arburst (INCR), arcache and arprot
//   reset        must reset the bus too: after it no beat of an earlier read may come; no request
//                on the first clock after it
module cchip_axi_read #(
    parameter integer CLIENTS = 3,      // clients; legal: 1..8
    parameter integer SLOTS = 16,  // lines that a client may be waiting for; legal: 2, 4, 8, 16, 32
    parameter integer DATA_W = 128      // width of the data bus (bit); legal: 64, 128, 256, 512
) (
    // ---- clock and reset
    input  wire                                      clk,              // clock, rising edge
    input  wire                                      rst,  // synchronous reset, active high
    // ---- time limit
    // read timeout in clocks, 1..2^32 - 1; 0: CCHIP_MEMORY_LIMIT_DEFAULT
    input  wire [                              31:0] limit,
    // ---- requests, one of each client per clock
    input  wire [                       CLIENTS-1:0] s_valid,  // bit c: client c asks for a line
    input  wire [         CLIENTS*$clog2(SLOTS)-1:0] s_slot,           // its slot for the line
    // address of the line, in units of 64 bytes
    input  wire [                    CLIENTS*58-1:0] s_line,
    // ---- answers
    // bit c: a beat for client c; at most one bit is 1
    output wire [                       CLIENTS-1:0] m_valid,
    output wire [                 $clog2(SLOTS)-1:0] m_slot,           // its slot
    // number of the beat in its line: 0, 1, ...; nothing in an answer without data
    output wire [                               2:0] m_beat,
    output wire                                      m_last,           // last beat of the answer
    // outcome of the read (ReadCode, docs/hardware/definitions.md), while m_last = 1
    output wire [             `CCHIP_READ_CODE_W-1:0] m_code,
    output wire [                        DATA_W-1:0] m_data,           // data
    // ---- status
    // an address is not accepted yet or beats are outstanding
    output wire                                      any_outstanding,
    // one bit per ID: its address is on offer, or its response is outstanding
    output wire                 [CLIENTS*SLOTS-1:0] outstanding,
    // ---- AXI4 read address
    output wire                                      m_axi_arvalid,    // AXI4 read address
    input  wire                                      m_axi_arready,    // address taken
    output wire [$clog2(CLIENTS)+$clog2(SLOTS)-1:0] m_axi_arid,        // {client, slot}
    output wire [                              63:0] m_axi_araddr,  // address, byte, multiple of 64
    output wire [                               7:0] m_axi_arlen,  // constant: beats of a line - 1
    // ---- AXI4 read data
    input  wire                                      m_axi_rvalid,     // beat
    // 0 in reset and for one clock of each answer without data
    output wire                                      m_axi_rready,
    input  wire [$clog2(CLIENTS)+$clog2(SLOTS)-1:0] m_axi_rid,         // ID of the read
    input  wire [                        DATA_W-1:0] m_axi_rdata,      // data
    // response; anything but OKAY is an error
    input  wire [                               1:0] m_axi_rresp,
    input  wire                                      m_axi_rlast       // last beat of a burst
);

  localparam integer SLOT_W = $clog2(SLOTS);
  localparam integer ID_W = $clog2(CLIENTS) + SLOT_W;
  localparam integer IDS = CLIENTS * SLOTS;
  localparam [31:0] LAST_BEAT = 512 / DATA_W - 1;
  localparam [31:0] NUMBER = IDS;

  `CCHIP_REFUSE(CLIENTS < 1 || CLIENTS > 8, cchip_error_axi_read_CLIENTS_must_be_1_to_8)
  `CCHIP_REFUSE(SLOTS < 2 || SLOTS > 32 || (1 << SLOT_W) != SLOTS,
                cchip_error_axi_read_SLOTS_must_be_2_4_8_16_or_32)
  `CCHIP_REFUSE(DATA_W < 64 || DATA_W > 512 || (1 << $clog2(DATA_W)) != DATA_W,
                cchip_error_axi_read_DATA_W_must_be_64_128_256_or_512)

  // ---- what is in flight. Life of an ID: free, offered (live), taken (live, pending), free behind
  // its last beat. An abandoned read is not live any more; its ID is free after the last beat
  reg [IDS-1:0] live_q;  // the address is or was offered, the client waits for the answer
  reg [IDS-1:0] pending_q;  // the address was taken, its rlast has not come
  reg [IDS-1:0] first_q;  // no beat of it has come
  wire [IDS-1:0] offered, taken, closed, ended, counted;  // what happens to them on this clock

  // ---- requests and addresses. `pending` tells which of them has to be refused
  wire issue, refuse;  // the first request is put on offer, is refused
  wire [ID_W-1:0] head_id;  // of that request
  wire offer, taken_valid;
  wire [ID_W-1:0] taken_id;
  wire report_timeout;
  reg [ID_W-1:0] beat_id_q, beat_id_q2;
  reg failing_q;  // an answer without data is on its way to the read channel's stage
  wire found;  // an expired read, found_id
  cchip_axi_read_address #(
      .CLIENTS(CLIENTS),
      .SLOTS  (SLOTS),
      .DATA_W (DATA_W)
  ) u_address (
      .clk          (clk),
      .rst          (rst),
      .s_valid      (s_valid),
      .s_slot       (s_slot),
      .s_line       (s_line),
      .pending      (pending_q),
      .abandon      (report_timeout),
      .abandon_id   (beat_id_q2),
      .refuse_ready (~failing_q & ~found),
      .refuse       (refuse),
      .issue        (issue),
      .head_id      (head_id),
      .offer        (offer),
      .taken        (taken_valid),
      .taken_id     (taken_id),
      .m_axi_arvalid(m_axi_arvalid),
      .m_axi_arready(m_axi_arready),
      .m_axi_arid   (m_axi_arid),
      .m_axi_araddr (m_axi_araddr),
      .m_axi_arlen  (m_axi_arlen)
  );

  // ---- time: one expired read after the other takes the read channel's stage for a clock
  wire [ID_W-1:0] found_id;
  cchip_axi_read_late #(.IDS(IDS), .ID_W(ID_W)) u_late (
      .clk     (clk),
      .rst     (rst),
      .limit   (limit),
      .live    (live_q),
      .fresh   (offered),
      .found   (found),
      .found_id(found_id),
      .busy    (failing_q)
  );
  reg [ID_W-1:0] fail_id_q;
  reg fail_refused_q;  // 1: refused, 0: out of time
  wire fail = (found | refuse) & ~failing_q;
  always @(posedge clk) begin
    fail_id_q   <= found ? found_id : head_id;
    fail_refused_q <= ~found;
    failing_q   <= ~rst & fail;
  end

  // ---- the read channel's stage: a beat, or an answer without data, for which rready was 0
  reg rready_q, beat_q, fail_q, refused_fail_q, bad_q, rlast_q;
  reg [DATA_W-1:0] data_q;
  wire known = {1'b0, m_axi_rid} < NUMBER[ID_W:0];  // there is a read of this ID
  always @(posedge clk) begin
    beat_id_q <= failing_q ? fail_id_q : m_axi_rid;
    refused_fail_q <= fail_refused_q;
    data_q <= m_axi_rdata;
    bad_q <= m_axi_rresp != 2'b00;
    rlast_q <= m_axi_rlast;
    if (rst) begin
      rready_q <= 1'b0;
      beat_q   <= 1'b0;
      fail_q   <= 1'b0;
    end else begin
      rready_q <= ~fail;
      beat_q   <= m_axi_rvalid & rready_q & known;
      fail_q   <= failing_q;
    end
  end
  assign m_axi_rready = rready_q;

  // {an earlier beat was bad, beats that have come} of each read
  `CCHIP_LUT_RAM
  reg [3:0] progress[0:(1<<ID_W)-1];

  // ---- what is known of its read, a clock later. What the clock before changes in it is added
  reg beat_q2, timeout_q2, refused_q2, bad_q2, rlast_q2;
  reg [DATA_W-1:0] data_q2;
  reg live_q2, pending_q2, first_q2;
  reg [3:0] progress_q2;
  reg closed_q2, ended_q2, counted_q2;  // by the answer or beat before, which is of the same read
  reg [3:0] progress_q3;  // after the beat before
  wire same = beat_id_q == beat_id_q2;
  wire wanted = live_q2 & ~closed_q2;
  wire counts = beat_q2 & pending_q2 & ~ended_q2;  // this beat is outstanding
  wire none_yet = first_q2 & ~counted_q2;
  wire [3:0] progress_now = counted_q2 ? progress_q3 : progress_q2;
  wire [2:0] count = none_yet ? 3'd0 : progress_now[2:0];
  wire bad = bad_q2 | (~none_yet & progress_now[3]);
  wire [3:0] progress_d = {bad, count + 3'd1};
  wire last = rlast_q2 || count == LAST_BEAT[2:0];
  wire wrong_last = rlast_q2 != (count == LAST_BEAT[2:0]);
  assign report_timeout = timeout_q2 & wanted;
  wire close = report_timeout | (counts & last);
  wire deliver = (counts & wanted) | report_timeout | refused_q2;
  always @(posedge clk) begin
    if (counts) progress[beat_id_q2] <= progress_d;
    beat_id_q2 <= beat_id_q;
    data_q2     <= data_q;
    bad_q2      <= bad_q;
    rlast_q2    <= rlast_q;
    live_q2     <= live_q[beat_id_q];
    pending_q2  <= pending_q[beat_id_q];
    first_q2    <= first_q[beat_id_q];
    progress_q2 <= progress[beat_id_q];
    closed_q2   <= same & close;
    ended_q2    <= same & counts & rlast_q2;
    counted_q2  <= same & counts;
    progress_q3 <= progress_d;
    if (rst) begin
      beat_q2    <= 1'b0;
      timeout_q2 <= 1'b0;
      refused_q2 <= 1'b0;
    end else begin
      beat_q2    <= beat_q;
      timeout_q2 <= fail_q & ~refused_fail_q;
      refused_q2 <= fail_q & refused_fail_q;
    end
  end

  reg [IDS-1:0] outstanding_q;
  assign outstanding = outstanding_q;
  genvar i;
  generate
    for (i = 0; i < IDS; i = i + 1) begin : gen_id
      localparam [31:0] I = i;
      wire here = beat_id_q2 == I[ID_W-1:0];
      assign offered[i] = offer && m_axi_arid == I[ID_W-1:0];
      assign taken[i]   = taken_valid && taken_id == I[ID_W-1:0];
      assign counted[i] = here & counts;
      assign ended[i]   = here & counts & rlast_q2;
      assign closed[i]  = here & close;
      always @(posedge clk)
        outstanding_q[i] <= ~rst &
            (pending_q[i] | taken[i] | (m_axi_arvalid && m_axi_arid == I[ID_W-1:0]));
    end
  endgenerate
  always @(posedge clk) begin
    first_q <= (first_q & ~counted) | taken;
    if (rst) begin
      live_q <= {IDS{1'b0}};
      pending_q <= {IDS{1'b0}};
    end else begin
      live_q <= (live_q & ~closed) | offered;
      pending_q <= (pending_q & ~ended) | taken;
    end
  end

  // ---- answers
  reg [CLIENTS-1:0] valid_q;
  reg [SLOT_W-1:0] slot_q;
  reg [2:0] count_q;
  reg last_q, any_outstanding_q;
  reg [`CCHIP_READ_CODE_W-1:0] code_q;
  reg [DATA_W-1:0] data_q3;
  wire [31:0] one_client = 32'd1 << ({{32 - ID_W{1'b0}}, beat_id_q2} >> SLOT_W);
  always @(posedge clk) begin
    slot_q  <= beat_id_q2[SLOT_W-1:0];
    count_q <= count;
    last_q  <= ~beat_q2 | last;
    code_q  <= refused_q2 ? `CCHIP_READ_OWED : timeout_q2 ? `CCHIP_READ_TIMEOUT :
        bad | wrong_last ? `CCHIP_READ_BUS : `CCHIP_READ_OK;
    data_q3 <= data_q2;
    if (rst) begin
      valid_q <= {CLIENTS{1'b0}};
      any_outstanding_q <= 1'b0;
    end else begin
      valid_q <= deliver ? one_client[CLIENTS-1:0] : {CLIENTS{1'b0}};
      any_outstanding_q <= m_axi_arvalid | taken_valid | (|pending_q);
    end
  end
  assign m_valid = valid_q;
  assign m_slot  = slot_q;
  assign m_beat  = count_q;
  assign m_last  = last_q;
  assign m_code  = code_q;
  assign m_data  = data_q3;
  assign any_outstanding = any_outstanding_q;

  wire unused = &{1'b0, one_client};
  always @(posedge clk)
    if (!rst) begin
      `CCHIP_ASSERT(a_place, !(beat_q && fail_q))
      `CCHIP_ASSERT(a_free, !issue || !live_q[head_id])
    end

endmodule
`default_nettype wire
