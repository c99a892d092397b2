// SPDX-License-Identifier: Apache-2.0
`default_nettype none
// bench_tri_tri: self-checking bench of cchip_primtest_tri_tri for Icarus. twin.cpp does the same on the same
// clocks with the Verilated module; both write one line per handshake.
//   +vectors=FILE  one pair per line, hexadecimal: {expected beats, axis, definite, grid, hit, err, mode, tag, b, a}
//   +pairs=N       lines of that file
//   +start=S       state of the generator of idle clocks, back-pressure and resets, not 0
//   +lines=FILE    written: "in CLOCK TAG IDLE" and "out CLOCK TAG HIT GRID DEFINITE AXIS BEATS IDLE"
// Prints "PASS pairs=N results=R clocks=C" or "FAIL ...".
module bench_tri_tri;

  localparam integer COORD_W = 16;
  localparam integer SIDE_W = 4 * 3 * COORD_W;
  localparam integer RESULT_W = 6 + 9 + 3;
  localparam integer VECTOR_W = RESULT_W + 4 + 2 + 16 + 2 * SIDE_W;
  localparam integer PAIRS_MAX = 16384;
  localparam integer CLOCKS_MAX = 2000000;

  reg                  clk;
  reg                  rst;
  reg                  s_pair_valid;
  wire                 s_pair_ready;
  reg  [         15:0] s_pair_tag;
  reg  [          1:0] s_pair_mode;
  reg  [   SIDE_W-1:0] s_pair_a, s_pair_b;
  reg  [          3:0] s_pair_err;
  wire                 m_result_valid;
  reg                  m_result_ready;
  wire [         15:0] m_result_tag;
  wire                 m_result_hit, m_result_grid, m_result_definite;
  wire [          8:0] m_result_axis;
  wire [          5:0] m_result_beats;
  wire [          7:0] rm_id;
  wire                 idle;

  cchip_primtest_tri_tri dut (
      .clk              (clk),
      .rst              (rst),
      .s_pair_valid     (s_pair_valid),
      .s_pair_ready     (s_pair_ready),
      .s_pair_tag       (s_pair_tag),
      .s_pair_mode      (s_pair_mode),
      .s_pair_a         (s_pair_a),
      .s_pair_b         (s_pair_b),
      .s_pair_err       (s_pair_err),
      .m_result_valid   (m_result_valid),
      .m_result_ready   (m_result_ready),
      .m_result_tag     (m_result_tag),
      .m_result_hit     (m_result_hit),
      .m_result_grid    (m_result_grid),
      .m_result_definite(m_result_definite),
      .m_result_axis    (m_result_axis),
      .m_result_beats   (m_result_beats),
      .rm_id            (rm_id),
      .idle             (idle)
  );

  // ---- stimulus
  reg [VECTOR_W-1:0] vectors[0:PAIRS_MAX-1];
  reg [8*256-1:0] vectors_file, lines_file;
  integer pairs, lines, clock, reset_left, next, results, inside, quiet;
  reg [31:0] random;
  reg offer, ready, done, failed;

  // ---- what is expected, by tag
  reg [RESULT_W-1:0] expected[0:65535];
  reg waiting[0:65535];
  integer i;

  // ---- stream rules
  reg stalled;
  reg [RESULT_W+15:0] result, stalled_result;

  task fail(input [8*60-1:0] what);
    begin
      if (!failed) $display("FAIL clock %0d: %0s", clock, what);
      failed = 1;
    end
  endtask

  task drive;
    begin
      random = random ^ (random << 13);
      random = random ^ (random >> 17);
      random = random ^ (random << 5);
      if (reset_left > 0) reset_left = reset_left - 1;
      else if (random[31:22] == 10'd0) reset_left = 1 + random[21:20];
      rst = reset_left > 0;
      case ((clock / 2048) % 4)
        0: begin offer = 1; ready = 1; end
        1: begin offer = random[5:0] == 6'd0; ready = 1; end
        2: begin offer = 1; ready = random[11:8] == 4'd0; end
        default: begin offer = random[0]; ready = random[8]; end
      endcase
      m_result_ready = ready;
      if (!s_pair_valid && offer && next < pairs) begin
        s_pair_valid = 1;
        {s_pair_err, s_pair_mode, s_pair_tag, s_pair_b, s_pair_a} = vectors[next][VECTOR_W-RESULT_W-1:0];
      end
    end
  endtask

  task sample;
    begin
      result = {m_result_beats, m_result_axis, m_result_definite, m_result_grid, m_result_hit, m_result_tag};
      if (rst) begin
        stalled = 0;
        if (inside > 0) for (i = 0; i < 65536; i = i + 1) waiting[i] = 0;
        inside = 0;
      end else begin
        if (^{s_pair_ready, m_result_valid, idle, rm_id} === 1'bx) fail("unknown value on an output");
        if (rm_id !== 8'd1) fail("rm_id is not 1");
        if (stalled && !m_result_valid) fail("m_result_valid dropped");
        if (m_result_valid) begin
          if (^result === 1'bx) fail("unknown value on a valid result");
          if (stalled && result !== stalled_result) fail("stalled result changed");
        end
        stalled = m_result_valid & ~m_result_ready;
        stalled_result = result;
        if (m_result_valid && m_result_ready) take;
        if (s_pair_valid && s_pair_ready) give;
      end
    end
  endtask

  task take;
    begin
      $fdisplay(lines, "out %0d %0d %0d %0d %0d %0d %0d %0d", clock, m_result_tag, m_result_hit, m_result_grid,
                m_result_definite, m_result_axis, m_result_beats, idle);
      if (waiting[m_result_tag] !== 1'b1) fail("result with a tag that nobody waits for");
      else if (result[RESULT_W+15:16] !== expected[m_result_tag]) fail("wrong result");
      if (idle !== 1'b0) fail("idle with a pair inside");
      waiting[m_result_tag] = 0;
      inside  = inside - 1;
      results = results + 1;
    end
  endtask

  task give;
    begin
      $fdisplay(lines, "in %0d %0d %0d", clock, s_pair_tag, idle);
      expected[s_pair_tag] = vectors[next][VECTOR_W-1:VECTOR_W-RESULT_W];
      waiting[s_pair_tag] = 1;
      inside = inside + 1;
      next = next + 1;
      s_pair_valid <= #1 0;  // behind the rising edge
    end
  endtask

  initial begin
    if (!$value$plusargs("vectors=%s", vectors_file) || !$value$plusargs("lines=%s", lines_file)
        || !$value$plusargs("pairs=%d", pairs) || !$value$plusargs("start=%d", random)) begin
      $display("FAIL usage: +vectors=FILE +pairs=N +start=S +lines=FILE");
      $finish;
    end
    $readmemh(vectors_file, vectors, 0, pairs - 1);
    lines = $fopen(lines_file, "w");
    for (i = 0; i < 65536; i = i + 1) waiting[i] = 0;
    s_pair_valid = 0;
    reset_left = 4;
    next = 0;
    results = 0;
    inside = 0;
    quiet = 0;
    stalled = 0;
    done = 0;
    failed = 0;
    clock = 0;
    while (!done && !failed) begin
      clk = 0;
      drive;
      #5;
      sample;
      clk = 1;
      #5;
      clock = clock + 1;
      // the end: everything sent and answered, and quiet for a while
      quiet = next == pairs && inside == 0 ? quiet + 1 : 0;
      if (quiet == 100) begin
        if (idle !== 1'b1 && !rst) fail("not idle at the end");
        done = 1;
      end
      if (clock == CLOCKS_MAX) fail("results are missing");
    end
    $fclose(lines);
    if (!failed) $display("PASS pairs=%0d results=%0d clocks=%0d", pairs, results, clock);
    $finish;
  end

endmodule
`default_nettype wire
