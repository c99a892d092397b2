// SPDX-License-Identifier: Apache-2.0 WITH SHL-2.1
`default_nettype none
`include "cchip_defs.vh"
// Proved of cchip_axi_read, for any behaviour of memory (also against the rules of the bus, but for what SPEAKS_TRUE assumes) and
// any requests of clients that follow the rule "again only after the last beat", with a `limit` that changes on any clock:
//   addresses are stable until taken; the ID of an address is of no read that is still outstanding; the address is that of the
//   request; no beat is handed out that did not come three clocks before under this ID, for a read whose address was
//   taken before and after the request was made, each once and in order; OK only after all beats of the line, each with OKAY, rlast on the
//   last one only; a place is answered only while its client waits, once; rready is
//   never 0 on two clocks.
// One place, any: the solver chooses the client and the place that is followed.
module cchip_axi_read_properties #(
    parameter integer CLIENTS = 1,
    parameter integer SLOTS   = 2,
    parameter integer DATA_W  = 256
) (
    input wire                                      clk,
    input wire                                      rst,
    input wire [                       CLIENTS-1:0] s_valid,
    input wire [         CLIENTS*$clog2(SLOTS)-1:0] s_slot,
    input wire [                    CLIENTS*58-1:0] s_line,
    input wire                                      m_axi_arready,
    input wire                                      m_axi_rvalid,
    input wire [$clog2(CLIENTS)+$clog2(SLOTS)-1:0] m_axi_rid,
    input wire [                        DATA_W-1:0] m_axi_rdata,
    input wire [                               1:0] m_axi_rresp,
    input wire                                      m_axi_rlast
);
  localparam integer SLOT_W = $clog2(SLOTS);
  localparam integer ID_W = $clog2(CLIENTS) + SLOT_W;
  // changes on any clock; 0, which means the default, is a limit that no trace reaches
  (* anyseq *) wire [1:0] any_limit;
  wire [31:0] limit = any_limit;
  localparam [2:0] LAST_BEAT = 512 / DATA_W - 1;
  localparam [2:0] BEAT = $clog2(DATA_W / 8);

  wire [CLIENTS-1:0] m_valid;
  wire [SLOT_W-1:0] m_slot;
  wire [2:0] m_beat;
  wire [CLIENTS*SLOTS-1:0] outstanding;
  wire m_last, any_outstanding, m_axi_arvalid, m_axi_rready;
  wire [`CCHIP_READ_CODE_W-1:0] m_code;
  wire [DATA_W-1:0] m_data;
  wire [ID_W-1:0] m_axi_arid;
  wire [63:0] m_axi_araddr;
  wire [7:0] m_axi_arlen;
  cchip_axi_read #(
      .CLIENTS(CLIENTS),
      .SLOTS  (SLOTS),
      .DATA_W (DATA_W)
  ) dut (
      .clk          (clk),
      .rst          (rst),
      .limit        (limit),
      .s_valid      (s_valid),
      .s_slot       (s_slot),
      .s_line       (s_line),
      .m_valid      (m_valid),
      .m_slot       (m_slot),
      .m_beat       (m_beat),
      .m_last       (m_last),
      .m_code       (m_code),
      .m_data       (m_data),
      .any_outstanding(any_outstanding),
      .outstanding  (outstanding),
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

  wire memory_ok;
  cchip_axi_rules #(
      .DATA_W  (DATA_W),
      .ID_W    (ID_W),
      .WRITES  (0),
      .BOUNDARY(64),
      .MEMORY  (0)
  ) rules (
      .clk          (clk),
      .rst          (rst),
      .memory_ok    (memory_ok),
      .m_axi_arvalid(m_axi_arvalid),
      .m_axi_arready(m_axi_arready),
      .m_axi_arid   (m_axi_arid),
      .m_axi_araddr (m_axi_araddr),
      .m_axi_arlen  (m_axi_arlen),
      .m_axi_arsize (BEAT),
      .m_axi_arburst(2'b01),
      .m_axi_arcache(4'd0),
      .m_axi_arprot (3'd0),
      .m_axi_rvalid (m_axi_rvalid),
      .m_axi_rready (m_axi_rready),
      .m_axi_rid    (m_axi_rid),
      .m_axi_rdata  (m_axi_rdata),
      .m_axi_rresp  (m_axi_rresp),
      .m_axi_rlast  (m_axi_rlast)
  );

  // ---- the rule of the clients: every place
  reg [CLIENTS*SLOTS-1:0] open_q;  // waits for its last beat
  wire [CLIENTS*SLOTS-1:0] asks, answered, answered_last;
  genvar c, s;
  generate
    for (c = 0; c < CLIENTS; c = c + 1) begin : gen_client
      for (s = 0; s < SLOTS; s = s + 1) begin : gen_slot
        assign asks[SLOTS*c+s] = s_valid[c] && s_slot[SLOT_W*c+:SLOT_W] == s;
        assign answered[SLOTS*c+s] = m_valid[c] && m_slot == s;
        assign answered_last[SLOTS*c+s] = answered[SLOTS*c+s] & m_last;
      end
    end
  endgenerate

  // ---- the place that is followed
  (* anyconst *) reg [ID_W-1:0] id;
  // One bit of a beat and of an address stands for all: they do not know of each other.
  wire data_in = m_axi_rdata[DATA_W-1];
  wire data_out = m_data[DATA_W-1];
  wire line_out = m_axi_araddr[63];
  reg line_in;
  integer i;
  always @(*) begin
    line_in = 1'b0;
    for (i = 0; i < CLIENTS; i = i + 1) if (id / SLOTS == i) line_in = s_line[58*i+57];
  end
  wire ask = asks[id];
  wire answer = answered[id];
  wire take = m_axi_arvalid & m_axi_arready & (m_axi_arid == id);
  wire beat = m_axi_rvalid & m_axi_rready & (m_axi_rid == id);
  reg started_q = 1'b0;
  reg rst_q = 1'b1;
  reg rready_q = 1'b1;
  reg line_q;  // asked for
  reg owed_q;  // beats of it are outstanding
  reg mine_q;  // and they are the answer to the present request
  reg given_up_q;  // the address that is offered is that of an earlier request
  reg [2:0] beats_q;  // that came
  reg bad_q;  // one of them was
  reg asked_q;  // an address is offered and was not taken
  reg line_out_q;
  reg [ID_W-1:0] arid_q;
  // of a beat, 1 to 3 clocks ago: it came, belongs to the present request, is the last; its number, fault so far and data
  reg [2:0] came_q, last_q, fault_q, data_q;
  reg [2:0] number_q, number_q2, number_q3;
  reg [2:0] handed_q;  // beats handed out of the present request

  // a beat on the clock on which its address is taken is none of the line
  wire ends = m_axi_rlast | beats_q == LAST_BEAT;
  wire bad = bad_q | (m_axi_rresp != 2'b00);
  wire fault = bad | m_axi_rlast != (beats_q == LAST_BEAT);
  wire of_client = answer & ~(m_last & m_code[1]);  // a beat, not an answer without data
  always @(posedge clk) begin
    started_q <= 1'b1;
    rst_q <= rst;
    rready_q <= m_axi_rready | rst;
    open_q <= rst ? 0 : (open_q & ~answered_last) | asks;
    if (ask) line_q <= line_in;
    owed_q <= ~rst & ((owed_q & ~(beat & m_axi_rlast)) | take);
    mine_q <= ~rst & ~(answer & m_last) & ((mine_q & ~(beat & ends)) | (take & ~given_up_q));
    given_up_q <= ~rst & m_axi_arvalid & (m_axi_arid == id) & ~m_axi_arready & (given_up_q | (answer & m_last));
    beats_q <= take ? 3'd0 : beats_q + {2'd0, beat};
    bad_q <= ~take & (beat ? bad : bad_q);
    asked_q <= ~rst & m_axi_arvalid & ~m_axi_arready;
    line_out_q <= line_out;
    arid_q <= m_axi_arid;
    came_q <= rst | (answer & m_last) ? 3'd0 : {came_q[1:0], beat & owed_q & mine_q};
    last_q <= {last_q[1:0], ends};
    fault_q <= {fault_q[1:0], fault};
    data_q <= {data_q[1:0], data_in};
    {number_q3, number_q2, number_q} <= {number_q2, number_q, beats_q};
    handed_q <= rst | ask ? 3'd0 : handed_q + {2'd0, of_client};
  end

  always @(*) begin
    assume (started_q || rst);
    assume ((asks & open_q & ~answered_last) == 0);
    assume (!(rst || rst_q) || s_valid == 0);
  end
`ifdef COVER
  always @(posedge clk)
    if (started_q && !rst && !rst_q) begin
      if (`COVER == 0) goal_ok: assert (!(answer && m_last && m_code == `CCHIP_READ_OK));
      if (`COVER == 1) goal_late: assert (!(answer && m_last && m_code == `CCHIP_READ_OK && late_q));
      if (`COVER == 2) goal_refused: assert (!(answer && m_code == `CCHIP_READ_OWED && m_last && asked_q));
    end
  // there was a time-out, and the beats came then
  reg timeout_q, late_q;
  always @(posedge clk) begin
    timeout_q <= ~rst & (timeout_q | (answer & m_last & (m_code == `CCHIP_READ_TIMEOUT)));
    late_q <= ~rst & (late_q | (timeout_q & owed_q & beat));
  end
`else
  always @(*)
    if (started_q && !rst_q && !rst) begin
      stable: assert (!asked_q || (m_axi_arvalid && line_out == line_out_q && m_axi_arid == arid_q));
      fresh: assert (!(m_axi_arvalid && m_axi_arid == id && owed_q));
      its_line: assert (!(m_axi_arvalid && m_axi_arid == id && open_q[id]) || line_out == line_q || asked_q);
      kind: assert (m_axi_arlen == LAST_BEAT && m_axi_araddr[5:0] == 0);
      one_client: assert ((m_valid & (m_valid - 1)) == 0);
      waits: assert (!answer || open_q[id]);
      came: assert (!of_client || (came_q[2] && m_beat == number_q3 && m_beat == handed_q && data_out == data_q[2]));
      marked: assert (!of_client || m_last == last_q[2]);
      honest: assert (!(answer && m_last && m_code == `CCHIP_READ_OK) || (m_beat == LAST_BEAT && !fault_q[2]));
      bus: assert (!(answer && m_last && m_code == `CCHIP_READ_BUS) || fault_q[2]);
      handed_out: assert (!came_q[2] || !open_q[id] || of_client || (answer && m_last));
      awake: assert (rready_q || m_axi_rready);
    end
`endif
endmodule
`default_nettype wire
