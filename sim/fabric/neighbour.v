// SPDX-License-Identifier: Apache-2.0
`default_nettype none
// neighbour: a signature of a word a clock; it works on beside the region that is rewritten.
module neighbour (
    input  wire        clk,
    input  wire        rst,
    input  wire [ 6:0] data,
    output wire [15:0] signature
);
  reg [15:0] signature_q;
  wire feedback = signature_q[15] ^ signature_q[13] ^ signature_q[12] ^ signature_q[10];
  always @(posedge clk)
    if (rst) signature_q <= 16'd1;
    else signature_q <= {signature_q[14:0], feedback} ^ {9'd0, data};
  assign signature = signature_q;
endmodule
`default_nettype wire
