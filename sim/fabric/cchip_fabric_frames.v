// SPDX-License-Identifier: Apache-2.0
`default_nettype none
// cchip_fabric_frames: words of a configuration port into the frames of a FABulous fabric.
//   stream       CCHIP_FABRIC_SYNC; frames, each an address word ([31:27] column, [19:0] frame, one
//                bit of 20) and ROWS words, lowest row last; a word with bit 20 ends the stream.
//                Words have the first byte of the payload lowest, the fabric's order is reversed
//   strobe       the second half of the clock after the last word: half a clock after the data have
//                changed, a clock and a half before they change again. A word may come every clock
//   fence        once `fenced` is 1, a frame outside the columns FIRST..LAST, or an address that
//                names no frame or several, is not written; error is 1 from then to the next sync
//   abandon      drops a stream that ended early and its error, and waits for the next sync word
//   reset        none: a device waits for the sync word after power-up
module cchip_fabric_frames #(
    parameter integer ROWS = 8,     // rows of the fabric; legal: 1..31
    parameter integer COLUMNS = 10, // columns of the fabric; legal: 1..32
    parameter integer FIRST = 0,    // first column inside the fence
    parameter integer LAST = 9      // last column inside the fence
) (
    input  wire                    clk,        // clock, rising edge
    input  wire                    fenced,     // 1: only the columns FIRST..LAST
    input  wire                    abandon,    // 1: wait for the sync word
    input  wire                    cfg_valid,  // a word passes the configuration port
    input  wire [            31:0] cfg_data,   // the word, first byte lowest
    output wire [     32*ROWS-1:0] frame,      // data of a frame, 32 bits a row
    output wire [  20*COLUMNS-1:0] strobe,     // 1: the latches of this frame are open
    output wire                    writing,    // 1 from the sync word to the end of the stream
    output wire                    error       // a frame was refused since the last sync word
);

  localparam [31:0] SYNC = 32'hFAB0FAB1;
  localparam [1:0] WAIT = 2'd0, ADDRESS = 2'd1, DATA = 2'd2;

  reg [1:0] state_q;
  reg [4:0] row_q;
  reg [32*ROWS-1:0] frame_q;
  reg [4:0] column_q;
  reg [19:0] select_q;
  reg strobe_q, allowed_q, error_q;
  initial state_q = WAIT;
  initial strobe_q = 1'b0;
  initial error_q = 1'b0;

  wire [31:0] word = {cfg_data[7:0], cfg_data[15:8], cfg_data[23:16], cfg_data[31:24]};
  wire [31:0] column = {27'd0, word[31:27]};
  wire one_frame = word[19:0] != 20'd0 && (word[19:0] & (word[19:0] - 20'd1)) == 20'd0;
  wire is_inside = column >= FIRST && column <= LAST;
  wire allowed = one_frame && (is_inside || !fenced);
  // the next frame's address comes on the clock of the strobe
  reg [4:0] next_column_q;
  reg [19:0] next_select_q;

  always @(posedge clk) begin
    strobe_q <= 1'b0;
    if (abandon) begin
      state_q <= WAIT;
      error_q <= 1'b0;
    end else if (cfg_valid)
      case (state_q)
        WAIT:
        if (word == SYNC) begin
          state_q <= ADDRESS;
          error_q <= 1'b0;
        end
        ADDRESS:
        if (word[20]) state_q <= WAIT;
        else begin
          state_q       <= DATA;
          row_q         <= ROWS - 1;
          next_column_q <= word[31:27];
          next_select_q <= word[19:0];
          allowed_q     <= allowed;
          error_q       <= error_q | ~allowed;
        end
        default: begin
          frame_q[32*row_q+:32] <= word;
          row_q <= row_q - 5'd1;
          if (row_q == 5'd0) begin
            state_q  <= ADDRESS;
            strobe_q <= allowed_q;
            column_q <= next_column_q;
            select_q <= next_select_q;
          end
        end
      endcase
  end

  genvar c;
  generate
    for (c = 0; c < COLUMNS; c = c + 1) begin : gen_column
      assign strobe[20*c+:20] = strobe_q && !clk && column_q == c ? select_q : 20'd0;
    end
  endgenerate
  assign frame   = frame_q;
  assign writing = state_q != WAIT || strobe_q;
  assign error   = error_q;

endmodule
`default_nettype wire
