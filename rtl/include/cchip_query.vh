// SPDX-License-Identifier: Apache-2.0 WITH SHL-2.1
// Queries in the traversal. The codes are those of QueryCode in cpp_ref/include/cchip/wire/query.hpp
// (docs/image.md).
`ifndef CCHIP_QUERY_VH
`define CCHIP_QUERY_VH

// ---- how a query ended
`define CCHIP_QUERY_CODE_W 3
`define CCHIP_QUERY_OK 3'd0
`define CCHIP_QUERY_HOST 3'd1
`define CCHIP_QUERY_STEPS 3'd2
`define CCHIP_QUERY_STACK 3'd3
`define CCHIP_QUERY_CORRUPT 3'd4
`define CCHIP_QUERY_OUTSIDE 3'd5
`define CCHIP_QUERY_BAD_DESCRIPTOR 3'd6
`define CCHIP_QUERY_MEMORY 3'd7

// bits of a context's epoch
`define CCHIP_EPOCH_W 2
// what the traversal keeps of a node pair, without its context: {header, epoch, children of B, line
// of B, children of A, line of A}; of a pair of leaves {0, epoch, -, kind of B, -, kind of A}
`define CCHIP_RECORD_W 59
// a node pair's lines as far as the traversal goes: {code, kinds of B's children, first of B's
// children, kinds of A's, first of A's}; of two headers the roots instead of the children
`define CCHIP_NODES_W 67

`endif
