// SPDX-License-Identifier: Apache-2.0 WITH SHL-2.1
`default_nettype none
// cchip_apb_axil: registers on AXI4-Lite for a host that has APB (AMBA APB4; of APB3 tie
// s_apb_pstrb to 1111 and s_apb_pprot to 000).
//   latency      3 clocks of wait states, and those that the registers take
//   throughput   one access at a time
//   errors       s_apb_pslverr = 1 for SLVERR and DECERR. An access that the registers never answer
//                is never ready: APB has no way out, so let them have a timeout
//   cuts         every path from APB to AXI4-Lite and back; BREADY and RREADY are decoded from
//                the state
//   reset        one clock or more, together with the registers: an access inside is lost
module cchip_apb_axil #(
    parameter integer ADDRESS_W = 12  // width of an address (bit); legal: >= 1
) (
    input  wire                 clk,             // rising edge
    input  wire                 rst,             // synchronous reset, active high
    // ---- from the host
    input  wire                 s_apb_psel,      // selected
    input  wire                 s_apb_penable,   // 1 in the access phase
    input  wire                 s_apb_pwrite,    // 1: write
    input  wire [ADDRESS_W-1:0] s_apb_paddr,     // address
    input  wire [          2:0] s_apb_pprot,     // protection
    input  wire [         31:0] s_apb_pwdata,    // data of a write
    input  wire [          3:0] s_apb_pstrb,     // bytes that are written
    output wire                 s_apb_pready,    // the access ends
    output wire [         31:0] s_apb_prdata,    // data of a read
    output wire                 s_apb_pslverr,   // it ends with an error
    // ---- to the registers
    output wire                 m_axil_awvalid,  // write addresses: valid
    input  wire                 m_axil_awready,  // taken
    output wire [ADDRESS_W-1:0] m_axil_awaddr,   // address
    output wire [          2:0] m_axil_awprot,   // protection
    output wire                 m_axil_wvalid,   // write data: valid
    input  wire                 m_axil_wready,   // taken
    output wire [         31:0] m_axil_wdata,    // data
    output wire [          3:0] m_axil_wstrb,    // bytes that are written
    input  wire                 m_axil_bvalid,   // responses of writes: valid
    output wire                 m_axil_bready,   // taken
    input  wire [          1:0] m_axil_bresp,    // response
    output wire                 m_axil_arvalid,  // read addresses: valid
    input  wire                 m_axil_arready,  // taken
    output wire [ADDRESS_W-1:0] m_axil_araddr,   // address
    output wire [          2:0] m_axil_arprot,   // protection
    input  wire                 m_axil_rvalid,   // read data: valid
    output wire                 m_axil_rready,   // taken
    input  wire [         31:0] m_axil_rdata,    // data
    input  wire [          1:0] m_axil_rresp     // response
);

  generate
    if (ADDRESS_W < 1) begin : gen_illegal
      cchip_error_apb_axil_ADDRESS_W_below_1 u_illegal ();
    end
  endgenerate

  localparam [1:0] IDLE = 2'd0, WRITE = 2'd1, READ = 2'd2, DONE = 2'd3;

  reg [1:0] state_q;
  reg aw_q, w_q, ar_q, error_q;
  reg [ADDRESS_W-1:0] address_q;
  reg [2:0] prot_q;
  reg [31:0] data_q;
  reg [3:0] strb_q;

  wire setup = s_apb_psel && !s_apb_penable;

  always @(posedge clk) begin
    case (state_q)
      IDLE: begin
        address_q <= s_apb_paddr;
        prot_q    <= s_apb_pprot;
        data_q    <= s_apb_pwdata;
        strb_q    <= s_apb_pstrb;
        aw_q      <= setup && s_apb_pwrite;
        w_q       <= setup && s_apb_pwrite;
        ar_q      <= setup && !s_apb_pwrite;
        if (setup) state_q <= s_apb_pwrite ? WRITE : READ;
      end
      WRITE: begin
        if (m_axil_awready) aw_q <= 1'b0;
        if (m_axil_wready) w_q <= 1'b0;
        error_q <= m_axil_bresp[1];
        if (m_axil_bvalid) state_q <= DONE;
      end
      READ: begin
        if (m_axil_arready) ar_q <= 1'b0;
        error_q <= m_axil_rresp[1];
        data_q  <= m_axil_rdata;
        if (m_axil_rvalid) state_q <= DONE;
      end
      default: state_q <= IDLE;
    endcase
    if (rst) begin
      state_q <= IDLE;
      aw_q    <= 1'b0;
      w_q     <= 1'b0;
      ar_q    <= 1'b0;
    end
  end

  assign s_apb_pready = state_q == DONE;
  assign s_apb_prdata = data_q;
  assign s_apb_pslverr = error_q;
  assign m_axil_awvalid = aw_q;
  assign m_axil_awaddr = address_q;
  assign m_axil_awprot = prot_q;
  assign m_axil_wvalid = w_q;
  assign m_axil_wdata = data_q;
  assign m_axil_wstrb = strb_q;
  assign m_axil_bready = state_q == WRITE;
  assign m_axil_arvalid = ar_q;
  assign m_axil_araddr = address_q;
  assign m_axil_arprot = prot_q;
  assign m_axil_rready = state_q == READ;

  // bit 0 of a response tells EXOKAY or DECERR from the others
  wire unused = &{1'b0, m_axil_bresp[0], m_axil_rresp[0]};

endmodule
`default_nettype wire
