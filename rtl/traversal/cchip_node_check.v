// SPDX-License-Identifier: Apache-2.0 WITH SHL-2.1
`default_nettype none
`include "cchip_assert.vh"
`include "cchip_defs.vh"
// cchip_node_check: judges the two lines of a node pair, or of two headers, and keeps what they say
// of the children until the verdict of the box test comes.
//   node         its extent must be at most 18; no box of a child may be inverted; its children
//                must lie behind it and inside the image (docs/hardware/image.md)
//   header       magic and version must be right, and the root inside the image; the number of
//                lines of both images is kept for the nodes of that context
//   code         the first that holds: MEMORY of A, BAD_DESCRIPTOR, the end of A, the end of B
//   beats        s_lines is the lower half of the lines with s_valid, the upper half on the next
//                clock
//   latency      4 clocks from s_valid until lookup finds it; 1 clock from lookup to lookup_nodes
//   throughput   a pair every second clock
//   reset        nothing inside; what is kept is unknown until it has been written
//   rules        A line of A could not be read (MEMORY); of two headers one has another magic or
//                version (BAD_DESCRIPTOR); what is wrong with A's line; what is wrong with B's.
//                Wrong with a line may be: it could not be read (MEMORY). The extent of a node is
//                above 18 or the box of a child inverted, greatest < least (CORRUPT). A child lies
//                not behind its node or outside the image, or the root of a header does (OUTSIDE).
//   inside       The fields on the first clock, compared on the second, judged on the third.
module cchip_node_check #(
    parameter integer QUERIES = 16,  // queries at once (query); legal: 2, 4, 8, 16
    parameter integer PLACE_W = 6    // width of the number of a pair (bit); legal: 3..6
) (
    input  wire                       clk,           // clock, rising edge
    input  wire                       rst,           // synchronous reset, active high
    // ---- a pair of lines, {B's, A's} each
    input  wire                       s_valid,       // a pair of lines
    input  wire [        PLACE_W-1:0] s_place,       // its place
    input  wire [$clog2(QUERIES)-1:0] s_context,     // context of its query
    input  wire                       s_header,      // two headers, not two nodes
    // numbers of the lines in their images, {B's, A's}
    input  wire [               47:0] s_numbers,
    // bit p: the line of A (0), of B (1) could not be read
    input  wire [                1:0] s_failed,
    // halves of the lines, {B's, A's}: the lower ones with s_valid, the upper ones on the next
    // clock
    input  wire [              511:0] s_lines,
    // ---- record NODES of a pair
    input  wire                       lookup,        // a verdict has come
    input  wire [        PLACE_W-1:0] lookup_place,  // place of its pair
    // record NODES (definitions, docs/hardware/definitions.md), a clock later
    output wire [ `CCHIP_NODES_W-1:0] lookup_nodes
);

  localparam integer CONTEXT_W = $clog2(QUERIES);
  localparam integer END_W = `CCHIP_END_W;
  localparam integer NODES_W = `CCHIP_NODES_W;
  localparam integer FIRST_CHILD = 96;  // bit of CCHIP_NODE_LINE_CHILD
  localparam [31:0] MAGIC = 32'h4D494343;
  localparam [15:0] VERSION = 16'd1;
  localparam [4:0] STEP_MAX = 5'd18;

  // ---- the fields on the first clock, compared on the second, judged on the third
  `CCHIP_LUT_RAM
  reg [49:0] sizes[0:QUERIES-1];  // lines of each image, {B's, A's}, at most 2^24
  reg [49:0] sizes_q1;
  reg valid_q1, valid_q2, valid_q3;
  reg header_q1, header_q2;
  reg [PLACE_W-1:0] place_q1, place_q2, place_q3;
  reg [CONTEXT_W-1:0] context_q1, context_q2;
  wire [2*END_W-1:0] end3;  // of a node
  wire [1:0] no_header3;
  wire [49:0] size2;
  wire [63:0] node3;
  genvar p, i;
  generate
    for (p = 0; p < 2; p = p + 1) begin : gen_line
      wire [255:0] line = s_lines[256*p+:256];
      wire [4:0] step = line[`CCHIP_NODE_LINE_STEP];
      wire [23:0] first = line[`CCHIP_NODE_LINE_FIRST];
      wire [7:0] kinds = line[`CCHIP_NODE_LINE_KINDS];
      wire [1:0] others = line[`CCHIP_NODE_LINE_CHILDREN];  // behind the first
      // of a header
      wire [31:0] magic = line[`CCHIP_HEADER_LINE_MAGIC];
      wire [15:0] version = line[`CCHIP_HEADER_LINE_VERSION];
      wire [31:0] size = line[`CCHIP_HEADER_LINE_LINES];
      wire [23:0] root = line[`CCHIP_HEADER_LINE_ROOT];

      // greatest < least on an axis of a child: of the first two children in the first beat, of
      // the others in the second. Children that are absent have boxes of 0.
      wire [11:0] inverted;
      for (i = 0; i < 12; i = i + 1) begin : gen_interval
        localparam integer AT = (FIRST_CHILD + 102 * (i / 3) + 14 * (i % 3)) % 256;
        wire signed [6:0] least = line[AT+:7];
        wire signed [6:0] greatest = line[AT+7+:7];
        assign inverted[i] = greatest < least;
      end

      reg [5:0] inverted_q1, late_q2;
      reg [23:0] first_q1, root_q1, at_q1, first_q2, first_q3;
      reg [24:0] last_q1;  // line of the last child
      reg [7:0] kinds_q1, kinds_q2, kinds_q3;
      reg [24:0] size_q1, size_q2;
      reg steep_q1, corrupt_q2, failed_q1, failed_q2, header_here_q1, header_here_q2, outside_q2;
      reg [END_W-1:0] end_q3;
      reg no_header_q3;
      wire [24:0] limit = sizes_q1[25*p+:25];
      always @(posedge clk) begin
        first_q1       <= first;
        root_q1        <= root;
        last_q1        <= {1'b0, first} + {23'd0, others};
        kinds_q1       <= kinds;
        at_q1          <= s_numbers[24*p+:24];
        steep_q1       <= step > STEP_MAX;
        inverted_q1    <= inverted[5:0];
        late_q2        <= inverted[11:6];
        size_q1        <= |size[31:24] ? 25'h1000000 : {1'b0, size[23:0]};
        failed_q1      <= s_failed[p];
        header_here_q1 <= magic == MAGIC && version == VERSION;
        first_q2       <= header_q1 ? root_q1 : first_q1;
        kinds_q2       <= kinds_q1;
        size_q2        <= size_q1;
        corrupt_q2     <= (steep_q1 | (|inverted_q1)) & ~header_q1;
        failed_q2      <= failed_q1;
        header_here_q2 <= header_here_q1;
        outside_q2     <= header_q1 ? {1'b0, root_q1} >= size_q1 :
            first_q1 <= at_q1 || last_q1 >= limit;
        first_q3       <= first_q2;
        kinds_q3       <= kinds_q2;
        no_header_q3   <= header_q2 & ~failed_q2 & ~header_here_q2;
        end_q3         <= failed_q2 ? `CCHIP_END_MEMORY :
            corrupt_q2 || (!header_q2 && |late_q2) ? `CCHIP_END_CORRUPT :
            outside_q2 ? `CCHIP_END_OUTSIDE : `CCHIP_END_OK;
      end
      wire unused = &{1'b0, line};
      assign size2[25*p+:25] = size_q2;
      assign node3[32*p+:32] = {kinds_q3, first_q3};
      assign end3[END_W*p+:END_W] = end_q3;
      assign no_header3[p] = no_header_q3;
    end
  endgenerate
  wire [END_W-1:0] end_a3 = end3[0+:END_W];
  wire [END_W-1:0] end_b3 = end3[END_W+:END_W];
  wire [END_W-1:0] code3 = end_a3 == `CCHIP_END_MEMORY ? `CCHIP_END_MEMORY :
      |no_header3 ? `CCHIP_END_BAD_DESCRIPTOR :
      end_a3 != `CCHIP_END_OK ? end_a3 : end_b3;

  `CCHIP_LUT_RAM
  reg [NODES_W-1:0] nodes[0:(1<<PLACE_W)-1];
  reg [NODES_W-1:0] nodes_q;
  always @(posedge clk) begin
    sizes_q1   <= sizes[s_context];
    header_q1  <= s_header;
    header_q2  <= header_q1;
    place_q1   <= s_place;
    place_q2   <= place_q1;
    place_q3   <= place_q2;
    context_q1 <= s_context;
    context_q2 <= context_q1;
    if (valid_q2 & header_q2) sizes[context_q2] <= size2;
    if (valid_q3) nodes[place_q3] <= {code3, node3};
    if (lookup) nodes_q <= nodes[lookup_place];
    if (rst) begin
      valid_q1 <= 1'b0;
      valid_q2 <= 1'b0;
      valid_q3 <= 1'b0;
    end else begin
      valid_q1 <= s_valid;
      valid_q2 <= valid_q1;
      valid_q3 <= valid_q2;
    end
  end
  assign lookup_nodes = nodes_q;

endmodule
`default_nettype wire
