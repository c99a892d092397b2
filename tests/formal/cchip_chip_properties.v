// SPDX-License-Identifier: Apache-2.0 WITH SHL-2.1
`default_nettype none
// Proved of cchip_chip's interrupt, with its registers and any behaviour of all else: after each
// write of interrupt_status irq is 0 for a clock, before the response to it; irq is 1 on the next
// clock whenever an event that is enabled is set and interrupt_status is not being written, and for
// no other reason; an event stays until it is cleared, also one that comes on the clock of its
// clear. So an event that is left after a write makes an edge, two clocks after the write at most.
module cchip_chip_properties (
    input wire        clk,
    input wire        rst,
    input wire        s_axil_awvalid,
    input wire [11:0] s_axil_awaddr,
    input wire        s_axil_wvalid,
    input wire [31:0] s_axil_wdata,
    input wire [ 3:0] s_axil_wstrb,
    input wire        s_axil_bready
);
  localparam [9:0] INTERRUPT_STATUS = 10'h008;  // address of its word
  wire s_axil_awready, s_axil_wready, s_axil_bvalid, irq;

  cchip_chip dut (
      .clk           (clk),
      .rst           (rst),
      .s_axil_awvalid(s_axil_awvalid),
      .s_axil_awready(s_axil_awready),
      .s_axil_awaddr (s_axil_awaddr),
      .s_axil_awprot (3'd0),
      .s_axil_wvalid (s_axil_wvalid),
      .s_axil_wready (s_axil_wready),
      .s_axil_wdata  (s_axil_wdata),
      .s_axil_wstrb  (s_axil_wstrb),
      .s_axil_bvalid (s_axil_bvalid),
      .s_axil_bready (s_axil_bready),
      .s_axil_arvalid(1'b0),
      .s_axil_araddr (12'd0),
      .s_axil_arprot (3'd0),
      .s_axil_rready (1'b1),
      .irq           (irq)
  );
  // signals of cchip_chip: flattening joins them with these wires
  (* hierconn *) wire [8:0] \dut.status ;
  (* hierconn *) wire [8:0] \dut.status_enable ;
  (* hierconn *) wire [8:0] \dut.events ;
  (* hierconn *) wire \dut.status_write ;
  wire [8:0] status = \dut.status ;
  wire [8:0] enabled = \dut.status_enable & status;
  wire [8:0] events = \dut.events ;
  wire status_write = \dut.status_write ;

  // what the host sees: a write is accepted with the later of its address and its data
  reg started_q = 1'b0;
  reg address_q, data_q;  // accepted, not answered
  reg [9:0] word_q;
  reg [31:0] wdata_q;
  reg [3:0] wstrb_q;
  reg fell_q;  // irq was 0 since both were accepted
  wire answer = s_axil_bvalid & s_axil_bready;
  always @(posedge clk) begin
    started_q <= 1'b1;
    if (s_axil_awvalid && s_axil_awready) word_q <= s_axil_awaddr[11:2];
    if (s_axil_wvalid && s_axil_wready) {wdata_q, wstrb_q} <= {s_axil_wdata, s_axil_wstrb};
    address_q <= ~rst & ~answer & (address_q | (s_axil_awvalid & s_axil_awready));
    data_q    <= ~rst & ~answer & (data_q | (s_axil_wvalid & s_axil_wready));
    fell_q    <= address_q & data_q & ~answer & (fell_q | ~irq);
  end

  // the clock before
  reg rst_q = 1'b1, rst_q2 = 1'b1;
  reg write_q, some_q;
  reg [8:0] status_q, events_q, clear_q;
  wire clears = status_write & address_q & data_q;
  always @(posedge clk) begin
    rst_q    <= rst;
    rst_q2   <= rst_q;
    write_q  <= status_write;
    some_q   <= |enabled;
    status_q <= status;
    events_q <= events;
    clear_q  <= {9{clears}} & wdata_q[8:0] & {wstrb_q[1], {8{wstrb_q[0]}}};
  end

  always @(posedge clk) begin
    if (!started_q) start: assume (rst);
    if (started_q && !rst && !rst_q && !rst_q2) begin
      low_after_write: assert (!write_q || !irq);
      high_again: assert (write_q || !some_q || irq);
      not_without_event: assert (some_q || !irq);
      stays: assert ((status_q & ~clear_q & ~status) == 9'd0);
      comes: assert ((events_q & ~status) == 9'd0);
      goes: assert ((status & ~events_q & (clear_q | ~status_q)) == 9'd0);
      fell_before_response: assert (!s_axil_bvalid || word_q != INTERRUPT_STATUS || fell_q || !irq);
    end
  end

  // an event that is left after a write makes an edge
  reg irq_q = 1'b0, left_q = 1'b0;
  always @(posedge clk) begin
    irq_q  <= irq;
    left_q <= ~rst & write_q & |enabled;
    edge_again: cover (left_q && irq && !irq_q && !rst);
  end
endmodule
`default_nettype wire
