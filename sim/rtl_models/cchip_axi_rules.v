// SPDX-License-Identifier: Apache-2.0 WITH SHL-2.1
`default_nettype none
`include "cchip_assert.vh"
// cchip_axi_rules: rules of AXI4 between a master of cchip_chip and memory, for simulations and
// proofs: a checker beside the bus, which drives nothing of it. A rule that is broken is an
// assertion of its name.
//   master       a_<channel>_...: valid stays, and what it offers, until it is taken; no valid on
//                the first clock after rst; INCR bursts of beats of the whole bus at a multiple of
//                a beat, so any strobe is legal, within BOUNDARY bytes; no address under an ID
//                that has READS reads in flight; at most WRITES writes in flight, all of ID 0; data
//                of writes in the order of addresses, at most AHEAD whole bursts before their
//                address, m_axi_wlast on the last beat of the length that the address says, and
//                on no other
//   memory       m_<channel>_...: valid stays, and what it offers, until it is taken; a beat only
//                of a read whose address was taken on an earlier clock, as many as that says,
//                rlast on the last one and no other, those of one ID in the order of addresses; a
//                response only to a write whose address and data were all taken on earlier clocks,
//                one each; no response of an exclusive access, which the masters never make
//   memory_ok    0 on a clock on which memory breaks a rule, also with MEMORY = 0
//   fault        after a fault of memory the master's rules count as the master does: rlast ends a
//                read, and what comes unasked is none
//   latency      a rule is judged on the clock on which it is broken; 0 to memory_ok
//   reset        nothing is in flight, rst is that of master and bus. Not checked: that memory
//                answers at all
module cchip_axi_rules #(
    parameter integer ADDRESS_W = 64,   // width of an address (bit); legal: 12..64
    parameter integer DATA_W = 128,     // width of the data bus (bit); legal: 32, 64, 128, 256, 512
    // width of the ID of reads; a bus without ID: 1, with inputs 0 (bit); legal: 1..8
    parameter integer ID_W = 1,
    // most reads of one ID in flight; 0: no channels of reads; legal: 0, 1, 2
    parameter integer READS = 1,
    parameter integer WRITES = 16,  // most writes in flight; 0: no channels of writes; legal: >= 0
    // most whole bursts of data that are taken before their address; legal: >= 1
    parameter integer AHEAD = 2,
    // no burst crosses a multiple of it (byte); legal: powers of 2 above a beat, up to 4096
    parameter integer BOUNDARY = 4096,
    parameter integer MEMORY = 1        // 1: a fault of memory is an assertion, too; legal: 0, 1
) (
    input  wire                 clk,            // clock, rising edge
    input  wire                 rst,            // synchronous reset, active high, of master and bus
    // 0 on a clock on which memory breaks a rule; from the inputs, no register
    output wire                 memory_ok,
    input  wire                 m_axi_arvalid,  // AXI4
    input  wire                 m_axi_arready,  // AXI4
    input  wire [     ID_W-1:0] m_axi_arid,     // AXI4
    input  wire [ADDRESS_W-1:0] m_axi_araddr,   // AXI4
    input  wire [          7:0] m_axi_arlen,    // AXI4
    input  wire [          2:0] m_axi_arsize,   // AXI4
    input  wire [          1:0] m_axi_arburst,  // AXI4
    input  wire [          3:0] m_axi_arcache,  // AXI4
    input  wire [          2:0] m_axi_arprot,   // AXI4
    input  wire                 m_axi_rvalid,   // AXI4
    input  wire                 m_axi_rready,   // AXI4
    input  wire [     ID_W-1:0] m_axi_rid,      // AXI4
    input  wire [   DATA_W-1:0] m_axi_rdata,    // AXI4
    input  wire [          1:0] m_axi_rresp,    // AXI4
    input  wire                 m_axi_rlast,    // AXI4
    input  wire                 m_axi_awvalid,  // AXI4
    input  wire                 m_axi_awready,  // AXI4
    input  wire                 m_axi_awid,     // AXI4
    input  wire [ADDRESS_W-1:0] m_axi_awaddr,   // AXI4
    input  wire [          7:0] m_axi_awlen,    // AXI4
    input  wire [          2:0] m_axi_awsize,   // AXI4
    input  wire [          1:0] m_axi_awburst,  // AXI4
    input  wire [          3:0] m_axi_awcache,  // AXI4
    input  wire [          2:0] m_axi_awprot,   // AXI4
    input  wire                 m_axi_wvalid,   // AXI4
    input  wire                 m_axi_wready,   // AXI4
    input  wire [   DATA_W-1:0] m_axi_wdata,    // AXI4
    input  wire [ DATA_W/8-1:0] m_axi_wstrb,    // AXI4
    input  wire                 m_axi_wlast,    // AXI4
    input  wire                 m_axi_bvalid,   // AXI4
    input  wire                 m_axi_bready,   // AXI4
    input  wire                 m_axi_bid,      // AXI4
    input  wire [          1:0] m_axi_bresp     // AXI4
);

  localparam integer BYTES_LOG2 = $clog2(DATA_W / 8);
  localparam integer EDGE_LOG2 = $clog2(BOUNDARY);
  localparam [31:0] SIZE = BYTES_LOG2;
  // beats of an address within BOUNDARY, of its last beat
  localparam integer PLACE_W = EDGE_LOG2 - BYTES_LOG2;
  localparam [31:0] LAST_PLACE = BOUNDARY / (DATA_W / 8) - 1;
  localparam integer ADDRESS_ALL_W = ADDRESS_W + 8 + 3 + 2 + 4 + 3;

  generate
    if (READS < 0 || READS > 2) begin : gen_illegal_reads
      cchip_error_axi_rules_READS_must_be_0_to_2 u_error ();
    end
    if (WRITES < 0 || AHEAD < 1) begin : gen_illegal_writes
      cchip_error_axi_rules_WRITES_or_AHEAD_too_small u_error ();
    end
    if (BOUNDARY <= DATA_W / 8 || BOUNDARY > 4096 || (1 << EDGE_LOG2) != BOUNDARY)
    begin : gen_illegal_boundary
      cchip_error_axi_rules_BOUNDARY_must_be_a_power_of_2_above_a_beat_to_4096 u_error ();
    end
  endgenerate

  // first clock after reset
  reg rst_q;
  always @(posedge clk) rst_q <= rst;
  wire unused_reset = &{1'b0, rst_q};

  wire read_ok, write_ok;
  assign memory_ok = rst | (read_ok & write_ok);

  generate
    if (READS != 0) begin : gen_read
      localparam integer IDS = 1 << ID_W;
      localparam integer AR_W = ID_W + ADDRESS_ALL_W;
      localparam integer R_W = ID_W + DATA_W + 2 + 1;
      wire [AR_W-1:0] ar = {
        m_axi_arid,
        m_axi_araddr,
        m_axi_arlen,
        m_axi_arsize,
        m_axi_arburst,
        m_axi_arcache,
        m_axi_arprot
      };
      wire [R_W-1:0] r = {m_axi_rid, m_axi_rdata, m_axi_rresp, m_axi_rlast};
      wire take = m_axi_arvalid & m_axi_arready;
      wire beat = m_axi_rvalid & m_axi_rready;
      reg ar_stays_q, r_stays_q;
      reg [AR_W-1:0] ar_q;
      reg [R_W-1:0] r_q;

      // of each ID: a read is in flight, a second one behind it, a beat of the first has come;
      // their lengths, and the beats that have come
      reg [IDS-1:0] owed_q, two_q, begun_q;
      reg [7:0] first_length[0:IDS-1];
      reg [7:0] second_length[0:IDS-1];
      reg [7:0] beats[0:IDS-1];
      wire counts = beat & owed_q[m_axi_rid];
      wire ends = counts & m_axi_rlast;
      wire [7:0] place = begun_q[m_axi_rid] ? beats[m_axi_rid] : 8'd0;
      wire leaves = ends && m_axi_rid == m_axi_arid && !two_q[m_axi_arid];
      wire behind = owed_q[m_axi_arid] & ~leaves;
      always @(posedge clk) begin
        ar_q <= ar;
        r_q  <= r;
        if (counts) begin
          begun_q[m_axi_rid] <= ~m_axi_rlast;
          beats[m_axi_rid]   <= place + 8'd1;
        end
        if (ends) begin
          owed_q[m_axi_rid] <= two_q[m_axi_rid];
          two_q[m_axi_rid]  <= 1'b0;
          first_length[m_axi_rid] <= second_length[m_axi_rid];
        end
        if (take) begin
          owed_q[m_axi_arid] <= 1'b1;
          two_q[m_axi_arid]  <= behind;
          if (behind) second_length[m_axi_arid] <= m_axi_arlen;
          else first_length[m_axi_arid] <= m_axi_arlen;
        end
        ar_stays_q <= ~rst & m_axi_arvalid & ~m_axi_arready;
        r_stays_q  <= ~rst & m_axi_rvalid & ~m_axi_rready;
        if (rst) begin
          owed_q  <= {IDS{1'b0}};
          two_q   <= {IDS{1'b0}};
          begun_q <= {IDS{1'b0}};
        end
      end

      wire full = READS > 1 ? two_q[m_axi_arid] : owed_q[m_axi_arid];
      wire [10:0] ar_last = {{11 - PLACE_W{1'b0}}, m_axi_araddr[BYTES_LOG2+:PLACE_W]} +
          {3'd0, m_axi_arlen};
      wire r_stable = !r_stays_q || (m_axi_rvalid && r == r_q);
      wire r_owed = !m_axi_rvalid || owed_q[m_axi_rid];
      wire r_last = !m_axi_rvalid || !owed_q[m_axi_rid] ||
          m_axi_rlast == (place == first_length[m_axi_rid]);
      wire r_response = !m_axi_rvalid || m_axi_rresp != 2'b01;
      assign read_ok = r_stable & r_owed & r_last & r_response;
      always @(posedge clk)
        if (!rst) begin
          `CCHIP_ASSERT(a_ar_reset, !rst_q || !m_axi_arvalid)
          `CCHIP_ASSERT(a_ar_stable, !ar_stays_q || (m_axi_arvalid && ar == ar_q))
          `CCHIP_ASSERT(a_ar_kind, !m_axi_arvalid ||
              (m_axi_arburst == 2'b01 && m_axi_arsize == SIZE[2:0] &&
               m_axi_araddr[BYTES_LOG2-1:0] == {BYTES_LOG2{1'b0}}))
          `CCHIP_ASSERT(a_ar_boundary, !m_axi_arvalid || ar_last <= LAST_PLACE[10:0])
          `CCHIP_ASSERT(a_ar_id, !m_axi_arvalid || !full)
          if (MEMORY != 0) begin
            `CCHIP_ASSERT(m_r_stable, r_stable)
            `CCHIP_ASSERT(m_r_owed, r_owed)
            `CCHIP_ASSERT(m_r_last, r_last)
            `CCHIP_ASSERT(m_r_response, r_response)
          end
        end
    end else begin : gen_no_read
      assign read_ok = 1'b1;
      wire unused = &{1'b0, m_axi_arvalid, m_axi_arready, m_axi_arid, m_axi_araddr, m_axi_arlen,
                      m_axi_arsize, m_axi_arburst, m_axi_arcache, m_axi_arprot, m_axi_rvalid,
                      m_axi_rready, m_axi_rid, m_axi_rdata, m_axi_rresp, m_axi_rlast};
    end

    if (WRITES != 0) begin : gen_write
      localparam integer AW_W = 1 + ADDRESS_ALL_W;
      localparam integer W_W = DATA_W + DATA_W / 8 + 1;
      localparam integer QUEUE_W = $clog2(WRITES + AHEAD);
      localparam integer COUNT_W = QUEUE_W + 1;
      localparam [31:0] MOST = WRITES;
      localparam [31:0] MOST_AHEAD = AHEAD;
      localparam [31:0] ONE = 1;
      localparam [COUNT_W-1:0] NONE = {COUNT_W{1'b0}};
      wire [AW_W-1:0] aw = {
        m_axi_awid,
        m_axi_awaddr,
        m_axi_awlen,
        m_axi_awsize,
        m_axi_awburst,
        m_axi_awcache,
        m_axi_awprot
      };
      wire [W_W-1:0] w = {m_axi_wdata, m_axi_wstrb, m_axi_wlast};
      wire [2:0] b = {m_axi_bid, m_axi_bresp};
      wire take = m_axi_awvalid & m_axi_awready;
      wire beat = m_axi_wvalid & m_axi_wready;
      wire last = beat & m_axi_wlast;
      reg aw_stays_q, w_stays_q, b_stays_q;
      reg [AW_W-1:0] aw_q;
      reg [W_W-1:0] w_q;
      reg [2:0] b_q;

      // writes of which memory has one half, whose lengths are in the queue: the address, or all
      // data; one of both counts is 0. And writes of which it has both and that it has not answered
      reg [COUNT_W-1:0] addresses_q, bursts_q, owed_q;
      reg [7:0] lengths[0:(1<<QUEUE_W)-1];
      reg [QUEUE_W-1:0] write_q, read_q;
      reg [7:0] beats_q;  // of the present burst
      wire some_address = addresses_q != NONE;
      wire some_burst = bursts_q != NONE;
      wire [7:0] length = lengths[read_q];
      wire address_waits = take & ~some_burst & ~(last & ~some_address);
      wire burst_waits = last & ~some_address & ~(take & ~some_burst);
      wire address_meets = take & some_burst;
      wire burst_meets = last & some_address;
      wire whole = (take & last) | address_meets | burst_meets;
      wire answered = m_axi_bvalid & m_axi_bready & ~m_axi_bid & owed_q != NONE;
      always @(posedge clk) begin
        aw_q <= aw;
        w_q  <= w;
        b_q  <= b;
        if (address_waits) lengths[write_q] <= m_axi_awlen;
        else if (burst_waits) lengths[write_q] <= beats_q;
        aw_stays_q <= ~rst & m_axi_awvalid & ~m_axi_awready;
        w_stays_q  <= ~rst & m_axi_wvalid & ~m_axi_wready;
        b_stays_q  <= ~rst & m_axi_bvalid & ~m_axi_bready;
        if (rst) begin
          addresses_q <= NONE;
          bursts_q    <= NONE;
          owed_q      <= NONE;
          write_q     <= {QUEUE_W{1'b0}};
          read_q      <= {QUEUE_W{1'b0}};
          beats_q     <= 8'd0;
        end else begin
          addresses_q <= addresses_q + {NONE[COUNT_W-1:1], address_waits} -
              {NONE[COUNT_W-1:1], burst_meets};
          bursts_q <= bursts_q + {NONE[COUNT_W-1:1], burst_waits} -
              {NONE[COUNT_W-1:1], address_meets};
          owed_q <= owed_q + {NONE[COUNT_W-1:1], whole} - {NONE[COUNT_W-1:1], answered};
          if (address_waits | burst_waits) write_q <= write_q + ONE[QUEUE_W-1:0];
          if (address_meets | burst_meets) read_q <= read_q + ONE[QUEUE_W-1:0];
          if (beat) beats_q <= m_axi_wlast ? 8'd0 : beats_q + 8'd1;
        end
      end

      wire [10:0] aw_last = {{11 - PLACE_W{1'b0}}, m_axi_awaddr[BYTES_LOG2+:PLACE_W]} +
          {3'd0, m_axi_awlen};
      // the address of the beat on offer is known: taken, or taken now
      wire [7:0] its_length = some_address ? length : m_axi_awlen;
      wire known = some_address | (take & ~some_burst);
      wire b_stable = !b_stays_q || (m_axi_bvalid && b == b_q);
      wire b_owed = !m_axi_bvalid || (!m_axi_bid && owed_q != NONE);
      wire b_response = !m_axi_bvalid || m_axi_bresp != 2'b01;
      assign write_ok = b_stable & b_owed & b_response;
      always @(posedge clk)
        if (!rst) begin
          `CCHIP_ASSERT(a_aw_reset, !rst_q || !m_axi_awvalid)
          `CCHIP_ASSERT(a_w_reset, !rst_q || !m_axi_wvalid)
          `CCHIP_ASSERT(a_aw_stable, !aw_stays_q || (m_axi_awvalid && aw == aw_q))
          `CCHIP_ASSERT(a_w_stable, !w_stays_q || (m_axi_wvalid && w == w_q))
          `CCHIP_ASSERT(a_aw_kind, !m_axi_awvalid ||
              (m_axi_awburst == 2'b01 && m_axi_awsize == SIZE[2:0] && !m_axi_awid &&
               m_axi_awaddr[BYTES_LOG2-1:0] == {BYTES_LOG2{1'b0}}))
          `CCHIP_ASSERT(a_aw_boundary, !m_axi_awvalid || aw_last <= LAST_PLACE[10:0])
          `CCHIP_ASSERT(a_aw_room, !m_axi_awvalid || addresses_q + owed_q < MOST[COUNT_W-1:0])
          // of data that came before it
          `CCHIP_ASSERT(a_aw_length, !(take && some_burst) || m_axi_awlen == length)
          `CCHIP_ASSERT(a_w_ahead, !m_axi_wvalid || some_address ||
              bursts_q < MOST_AHEAD[COUNT_W-1:0])
          `CCHIP_ASSERT(a_w_last, !(m_axi_wvalid && known) ||
              (m_axi_wlast ? beats_q == its_length : beats_q < its_length))
          if (MEMORY != 0) begin
            `CCHIP_ASSERT(m_b_stable, b_stable)
            `CCHIP_ASSERT(m_b_owed, b_owed)
            `CCHIP_ASSERT(m_b_response, b_response)
          end
        end
    end else begin : gen_no_write
      assign write_ok = 1'b1;
      wire unused = &{1'b0, m_axi_awvalid, m_axi_awready, m_axi_awid, m_axi_awaddr, m_axi_awlen,
                      m_axi_awsize, m_axi_awburst, m_axi_awcache, m_axi_awprot, m_axi_wvalid,
                      m_axi_wready, m_axi_wdata, m_axi_wstrb, m_axi_wlast, m_axi_bvalid,
                      m_axi_bready, m_axi_bid, m_axi_bresp};
    end
  endgenerate

endmodule
`default_nettype wire
