// SPDX-License-Identifier: Apache-2.0
`default_nettype none
// bench_primtest: self-checking bench of a primitive test with COORD_W = 16: RTL, exported file or netlist. Results
// are known by their tags and may come in any order. Verilog-2005, no package.
//   CCHIP_BENCH_TOP  macro: the module under test, as in -DCCHIP_BENCH_TOP=cchip_primtest_tri_tri
//   +vectors=FILE    one pair per line, hexadecimal: {rm_id, beats, axis, definite, grid, hit, err, mode, tag, b, a},
//                    the first six of them expected of the module; tags differ within 65536 lines
//   +pairs=N         this many of its lines
//   +start=S         state of the generator of idle clocks, back-pressure and resets, not 0 (default 1)
//   +steady          pairs always offered, results always taken, reset at the start only: every pair is answered
//   +lines=FILE      written, if given: "in CLOCK TAG IDLE" and "out CLOCK TAG HIT GRID DEFINITE AXIS BEATS IDLE" for
//                    every handshake; twin.cpp writes the same lines with the Verilated RTL on the same clocks
// Ends with "PASS pairs=N results=R clocks=C" (resets drop the pairs inside, so R may be below N) or "FAIL ...", after
// which Icarus ends with code 1.
module bench_primtest;

  localparam integer COORD_W = 16;
  localparam integer SIDE_W = 4 * 3 * COORD_W;
  localparam integer PAIR_W = 4 + 2 + 16 + 2 * SIDE_W;
  localparam integer RESULT_W = 6 + 9 + 3;
  localparam integer VECTOR_W = 8 + RESULT_W + PAIR_W;
  localparam integer TAGS = 65536;
  // clocks without a handshake after which nothing is expected any more
  localparam integer PATIENCE = 100000;

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

  `CCHIP_BENCH_TOP dut (
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
  reg [VECTOR_W-1:0] vector;  // the next one
  reg [8*256-1:0] vectors_file, lines_file;
  integer pairs, vectors, lines, clock, reset_left, next, results, held, quiet, silent;
  reg [31:0] random;
  reg steady, offer, ready, accepted, done, failed;

  // ---- what is expected, by tag
  reg [RESULT_W-1:0] expected[0:TAGS-1];
  reg waiting[0:TAGS-1];
  integer i;

  // ---- stream rules
  reg stalled;
  reg [RESULT_W+15:0] result, stalled_result;

  task fail(input [8*80-1:0] what);
    begin
      if (!failed) $display("FAIL clock %0d: %0s", clock, what);
      failed = 1;
    end
  endtask

  task fail_by_tag(input [8*80-1:0] what);
    begin
      if (!failed) begin
        $display("result  tag %h {beats, axis, definite, grid, hit} %h", m_result_tag, result[RESULT_W+15:16]);
        $display("expected     {beats, axis, definite, grid, hit} %h", expected[m_result_tag]);
      end
      fail(what);
    end
  endtask

  task drive;
    begin
      random = random ^ (random << 13);
      random = random ^ (random >> 17);
      random = random ^ (random << 5);
      if (reset_left > 0) reset_left = reset_left - 1;
      else if (random[31:22] == 10'd0 && !steady) reset_left = 1 + {30'd0, random[21:20]};
      rst = reset_left > 0;
      offer = 1;
      ready = 1;
      if (!steady)
        case ((clock / 2048) % 4)
          0: ready = 1;
          1: offer = random[5:0] == 6'd0;
          2: ready = random[11:8] == 4'd0;
          default: begin offer = random[0]; ready = random[8]; end
        endcase
      m_result_ready = ready;
      if (!s_pair_valid && offer && next < pairs) begin
        s_pair_valid = 1;
        {s_pair_err, s_pair_mode, s_pair_tag, s_pair_b, s_pair_a} = vector[PAIR_W-1:0];
      end
    end
  endtask

  task sample;
    begin
      result = {m_result_beats, m_result_axis, m_result_definite, m_result_grid, m_result_hit, m_result_tag};
      accepted = 0;
      silent = silent + 1;
      if (rst) begin
        stalled = 0;
        if (held > 0) for (i = 0; i < TAGS; i = i + 1) waiting[i] = 0;
        held = 0;
      end else begin
        if (^{s_pair_ready, m_result_valid, idle, rm_id} === 1'bx) fail("unknown value on an output");
        if (rm_id !== vector[VECTOR_W-1-:8]) fail("rm_id is not that of the vectors");
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
      if (lines != 0)
        $fdisplay(lines, "out %0d %0d %0d %0d %0d %0d %0d %0d", clock, m_result_tag, m_result_hit, m_result_grid,
                  m_result_definite, m_result_axis, m_result_beats, idle);
      if (waiting[m_result_tag] !== 1'b1) fail("result with a tag that is not in flight");
      else if (result[RESULT_W+15:16] !== expected[m_result_tag]) fail_by_tag("wrong result");
      if (idle !== 1'b0) fail("idle with a pair inside");
      waiting[m_result_tag] = 0;
      held    = held - 1;
      results = results + 1;
      silent  = 0;
    end
  endtask

  task give;
    begin
      if (lines != 0) $fdisplay(lines, "in %0d %0d %0d", clock, s_pair_tag, idle);
      if (waiting[s_pair_tag]) fail("two pairs with one tag in the vectors");
      expected[s_pair_tag] = vector[PAIR_W+:RESULT_W];
      waiting[s_pair_tag] = 1;
      held = held + 1;
      next = next + 1;
      if (next < pairs) fetch;
      accepted = 1;
      silent = 0;
    end
  endtask

  task fetch;
    if ($fscanf(vectors, "%h", vector) != 1) fail("fewer vectors than pairs");
  endtask

  task prepare;
    begin
      clk = 0;
      clock = 0;
      done = 0;
      failed = 0;
      lines = 0;
      random = 1;
      if (!$value$plusargs("vectors=%s", vectors_file) || !$value$plusargs("pairs=%d", pairs))
        fail("usage: +vectors=FILE +pairs=N [+start=S] [+steady] [+lines=FILE]");
      else begin
        vectors = $fopen(vectors_file, "r");
        if (vectors == 0) fail("the file of vectors cannot be read");
        else fetch;
      end
      if ($value$plusargs("start=%d", random) && random == 0) fail("start must not be 0");
      steady = $test$plusargs("steady");
      if ($value$plusargs("lines=%s", lines_file)) lines = $fopen(lines_file, "w");
      for (i = 0; i < TAGS; i = i + 1) waiting[i] = 0;
      s_pair_valid = 0;
      reset_left = 4;
      next = 0;
      results = 0;
      held = 0;
      quiet = 0;
      silent = 0;
      stalled = 0;
    end
  endtask

  initial begin
    prepare;
    while (!done && !failed) begin
      clk = 0;
      drive;
      #5;
      sample;
      clk = 1;
      #1;
      if (accepted) s_pair_valid = 0;
      #4;
      clock = clock + 1;
      // the end: everything sent and answered, and quiet for a while
      quiet = next == pairs && held == 0 ? quiet + 1 : 0;
      if (quiet == 100) begin
        if (idle !== 1'b1 && !rst) fail("not idle at the end");
        done = 1;
      end
      if (silent == PATIENCE) fail("results are missing");
    end
    if (lines != 0) $fclose(lines);
    if (!failed) $display("PASS pairs=%0d results=%0d clocks=%0d", pairs, results, clock);
`ifdef __ICARUS__
    if (failed) $finish_and_return(1);
`endif
    $finish;
  end

endmodule
`default_nettype wire
