// SPDX-License-Identifier: Apache-2.0
`default_nettype none
// bench_chip: one query through cchip_chip, from the ring of queries to the ring of records; the order of register
// accesses is that of docs/hardware/programmers-guide.md. Verilog-2005, no package.
//   +memory=FILE   contents of the memory from address 0 on, 16 bytes a line, hexadecimal: the query, then the images
//   +records=FILE  expected records, the done record last; pair records may come in any order
//   +start=S       state of the generator of memory's idle clocks, not 0 (default 1)
//   +narrow=N      a port of 64 bits before the memory: a record's second half is there N clocks after its first; the
//                  host takes a record when record_producer counts it (default 0: records arrive whole)
// Last line: "query=1 records=N wrong=W clocks=K", K from the doorbell to the done record. Anything wrong is named
// before it, and then Icarus ends with code 1.
module bench_chip;

  localparam integer DATA_W = 128;
  localparam integer ID_W = 6;
  // memory, words of 16 bytes: files of vectors below the ring of records
  localparam integer RECORD_WORD = 4096;
  localparam integer RECORD_LOG2 = 8;
  localparam integer RECORDS = 1 << RECORD_LOG2;
  localparam integer WORDS = RECORD_WORD + RECORDS;
  // clocks that the query may take, and any register access
  localparam integer PATIENCE = 20000;
  // reads that wait in memory: every ID has one
  localparam integer READS = 1 << ID_W;
  // registers: docs/hardware/chip-registers.md
  localparam [11:0] REG_ID = 12'h000, REG_CONTROL = 12'h010, REG_STATUS = 12'h014;
  localparam [11:0] REG_QUERY_BASE_LOW = 12'h040, REG_QUERY_BASE_HIGH = 12'h044;
  localparam [11:0] REG_QUERY_SIZE = 12'h048, REG_QUERY_PRODUCER = 12'h04C;
  localparam [11:0] REG_RECORD_BASE_LOW = 12'h060, REG_RECORD_BASE_HIGH = 12'h064;
  localparam [11:0] REG_RECORD_SIZE = 12'h068, REG_RECORD_CONSUMER = 12'h06C;
  localparam [11:0] REG_RECORD_PRODUCER = 12'h070;
  localparam [31:0] CONTROL_ENABLE = 32'd1, CONTROL_SOFT_RESET = 32'd2;

  reg clk = 0, rst = 1;
  reg s_axil_awvalid = 0, s_axil_wvalid = 0, s_axil_arvalid = 0;
  wire s_axil_awready, s_axil_wready, s_axil_bvalid, s_axil_arready, s_axil_rvalid;
  reg [11:0] s_axil_addr = 0;
  reg [31:0] s_axil_wdata = 0;
  wire [31:0] s_axil_rdata;
  wire [1:0] s_axil_bresp, s_axil_rresp;
  wire m_axi_arvalid, m_axi_rready, m_axi_awvalid, m_axi_wvalid, m_axi_wlast, m_axi_bready;
  wire [ID_W-1:0] m_axi_arid;
  wire [63:0] m_axi_araddr, m_axi_awaddr;
  wire [7:0] m_axi_arlen, m_axi_awlen;
  wire [2:0] m_axi_arsize, m_axi_awsize;
  wire [1:0] m_axi_arburst, m_axi_awburst;
  wire m_axi_awid;
  wire [DATA_W-1:0] m_axi_wdata;
  wire [DATA_W/8-1:0] m_axi_wstrb;
  reg m_axi_arready = 0, m_axi_rvalid = 0, m_axi_rlast = 0;
  reg m_axi_awready = 0, m_axi_wready = 0, m_axi_bvalid = 0;
  reg [ID_W-1:0] m_axi_rid = 0;
  reg [DATA_W-1:0] m_axi_rdata = 0;

  cchip_chip dut (
      .clk              (clk),
      .rst              (rst),
      .s_axil_awvalid   (s_axil_awvalid),
      .s_axil_awready   (s_axil_awready),
      .s_axil_awaddr    (s_axil_addr),
      .s_axil_awprot    (3'd0),
      .s_axil_wvalid    (s_axil_wvalid),
      .s_axil_wready    (s_axil_wready),
      .s_axil_wdata     (s_axil_wdata),
      .s_axil_wstrb     (4'b1111),
      .s_axil_bvalid    (s_axil_bvalid),
      .s_axil_bready    (1'b1),
      .s_axil_bresp     (s_axil_bresp),
      .s_axil_arvalid   (s_axil_arvalid),
      .s_axil_arready   (s_axil_arready),
      .s_axil_araddr    (s_axil_addr),
      .s_axil_arprot    (3'd0),
      .s_axil_rvalid    (s_axil_rvalid),
      .s_axil_rready    (1'b1),
      .s_axil_rdata     (s_axil_rdata),
      .s_axil_rresp     (s_axil_rresp),
      .irq              (),
      .m_axi_arvalid    (m_axi_arvalid),
      .m_axi_arready    (m_axi_arready),
      .m_axi_arid       (m_axi_arid),
      .m_axi_araddr     (m_axi_araddr),
      .m_axi_arlen      (m_axi_arlen),
      .m_axi_arsize     (m_axi_arsize),
      .m_axi_arburst    (m_axi_arburst),
      .m_axi_arcache    (),
      .m_axi_arprot     (),
      .m_axi_rvalid     (m_axi_rvalid),
      .m_axi_rready     (m_axi_rready),
      .m_axi_rid        (m_axi_rid),
      .m_axi_rdata      (m_axi_rdata),
      .m_axi_rresp      (2'd0),
      .m_axi_rlast      (m_axi_rlast),
      .m_axi_awvalid    (m_axi_awvalid),
      .m_axi_awready    (m_axi_awready),
      .m_axi_awid       (m_axi_awid),
      .m_axi_awaddr     (m_axi_awaddr),
      .m_axi_awlen      (m_axi_awlen),
      .m_axi_awsize     (m_axi_awsize),
      .m_axi_awburst    (m_axi_awburst),
      .m_axi_awcache    (),
      .m_axi_awprot     (),
      .m_axi_wvalid     (m_axi_wvalid),
      .m_axi_wready     (m_axi_wready),
      .m_axi_wdata      (m_axi_wdata),
      .m_axi_wstrb      (m_axi_wstrb),
      .m_axi_wlast      (m_axi_wlast),
      .m_axi_bvalid     (m_axi_bvalid),
      .m_axi_bready     (m_axi_bready),
      .m_axi_bid        (1'b0),
      .m_axi_bresp      (2'd0),
      .cfg_valid        (),
      .cfg_data         (),
      .cfg_error        (1'b0),
      .m_axi_cfg_arvalid(),
      .m_axi_cfg_arready(1'b0),
      .m_axi_cfg_araddr (),
      .m_axi_cfg_arlen  (),
      .m_axi_cfg_arsize (),
      .m_axi_cfg_arburst(),
      .m_axi_cfg_arcache(),
      .m_axi_cfg_arprot (),
      .m_axi_cfg_rvalid (1'b0),
      .m_axi_cfg_rready (),
      .m_axi_cfg_rdata  (32'd0),
      .m_axi_cfg_rresp  (2'd0),
      .m_axi_cfg_rlast  (1'b0)
  );

  always #5 clk = ~clk;
  integer clock = 0;
  always @(posedge clk) clock <= clock + 1;

  integer wrong = 0;
  task fail(input [8*80-1:0] what);
    begin
      $display("clock %0d: %0s", clock, what);
      wrong = wrong + 1;
    end
  endtask

  // ---- memory
  reg [DATA_W-1:0] memory[0:WORDS-1];
  integer random = 1;
  function [31:0] next(input [31:0] state);
    begin
      next = state ^ (state << 13);
      next = next ^ (next >> 17);
      next = next ^ (next << 5);
    end
  endfunction
  always @(posedge clk) random <= next(random);

  // reads, in order: a queue of addresses, one beat at a time
  reg [ID_W-1:0] read_id[0:READS-1];
  integer read_word[0:READS-1];
  integer read_beats[0:READS-1];
  integer read_in = 0, read_out = 0, beat = 0;
  always @(posedge clk) begin
    m_axi_arready <= random[0];
    if (m_axi_arvalid && m_axi_arready) begin
      if (m_axi_araddr[3:0] != 0 || m_axi_araddr[63:4] + m_axi_arlen >= WORDS)
        fail("a read beyond the memory");
      if (m_axi_arsize != 3'd4 || m_axi_arburst != 2'd1) fail("a read that is not INCR in 16 bytes");
      read_id[read_in%READS] = m_axi_arid;
      read_word[read_in%READS] = m_axi_araddr[31:4];
      read_beats[read_in%READS] = m_axi_arlen + 1;
      read_in = read_in + 1;
    end
    if (m_axi_rvalid && m_axi_rready) m_axi_rvalid <= 1'b0;
    if ((!m_axi_rvalid || m_axi_rready) && read_in != read_out && random[1]) begin
      m_axi_rvalid <= 1'b1;
      m_axi_rid <= read_id[read_out%READS];
      m_axi_rdata <= memory[read_word[read_out%READS]+beat];
      m_axi_rlast <= beat + 1 == read_beats[read_out%READS];
      beat = beat + 1;
      if (beat == read_beats[read_out%READS]) begin
        beat = 0;
        read_out = read_out + 1;
      end
    end
    if (rst) m_axi_rvalid <= 1'b0;
  end

  // writes, one at a time: address, beats, response
  reg writing = 0, storing = 0;  // until the response; until the last beat
  integer write_word = 0, b;
  integer narrow = 0, late = 0;  // clocks between halves; until the second one is there
  reg [63:0] second = 0;
  always @(posedge clk) begin
    m_axi_awready <= !writing && !m_axi_awready && random[2];
    m_axi_wready  <= storing && random[3];
    if (m_axi_awvalid && m_axi_awready) begin
      if (m_axi_awaddr[3:0] != 0 || m_axi_awaddr[63:4] < RECORD_WORD ||
          m_axi_awaddr[63:4] + m_axi_awlen >= WORDS)
        fail("a write outside the ring of records");
      if (m_axi_awsize != 3'd4 || m_axi_awburst != 2'd1) fail("a write that is not INCR in 16 bytes");
      write_word = m_axi_awaddr[31:4];
      writing <= 1'b1;
      storing <= 1'b1;
      m_axi_awready <= 1'b0;
    end
    if (m_axi_wvalid && m_axi_wready) begin
      for (b = 0; b < DATA_W / 8; b = b + 1)
      if (m_axi_wstrb[b] && (narrow == 0 || b < 8)) memory[write_word][8*b+:8] = m_axi_wdata[8*b+:8];
      if (narrow == 0) write_word = write_word + 1;
      else begin
        if (!m_axi_wlast || m_axi_wstrb != 16'hFFFF) fail("a record that is not one beat");
        second = m_axi_wdata[127:64];
        late   = narrow + 1;
      end
      if (m_axi_wlast) begin
        m_axi_wready <= 1'b0;
        storing <= 1'b0;
        if (narrow == 0) m_axi_bvalid <= 1'b1;
      end
    end
    if (late != 0) begin
      late = late - 1;
      if (late == 0) begin
        memory[write_word][127:64] = second;
        m_axi_bvalid <= 1'b1;
      end
    end
    if (m_axi_bvalid && m_axi_bready) begin
      m_axi_bvalid <= 1'b0;
      writing <= 1'b0;
    end
    if (rst) begin
      m_axi_bvalid <= 1'b0;
      writing <= 1'b0;
      storing <= 1'b0;
      late = 0;
    end
  end

  // ---- registers: inputs change a unit of time after the edge, on which outputs are looked at. (An
  // assignment by <= here would be one by = in Verilator.)
  integer waited;
  reg aw, w, b_or_r, ok;
  task set(input [11:0] address, input [31:0] value);
    begin
      s_axil_awvalid = 1'b1;
      s_axil_wvalid = 1'b1;
      s_axil_addr = address;
      s_axil_wdata = value;
      b_or_r = 1'b0;
      for (waited = 0; !b_or_r && waited < PATIENCE; waited = waited + 1) begin
        @(posedge clk);
        {aw, w, b_or_r} = {s_axil_awready, s_axil_wready, s_axil_bvalid === 1'b1};
        ok = s_axil_bresp === 2'd0;
        #1;
        if (aw) s_axil_awvalid = 1'b0;
        if (w) s_axil_wvalid = 1'b0;
      end
      if (!b_or_r || !ok) fail("a register cannot be written");
    end
  endtask

  reg [31:0] value;
  task get(input [11:0] address);
    begin
      s_axil_arvalid = 1'b1;
      s_axil_addr = address;
      b_or_r = 1'b0;
      for (waited = 0; !b_or_r && waited < PATIENCE; waited = waited + 1) begin
        @(posedge clk);
        {aw, b_or_r} = {s_axil_arready, s_axil_rvalid === 1'b1};
        ok = s_axil_rresp === 2'd0;
        value = s_axil_rdata;
        #1;
        if (aw) s_axil_arvalid = 1'b0;
      end
      if (!b_or_r || !ok) fail("a register cannot be read");
    end
  endtask

  // ---- records
  reg [DATA_W-1:0] expected[0:RECORDS-1];
  reg [RECORDS-1:0] found = 0;
  integer expectations = 0, records = 0, i, match;
  integer confirmed = 0, halves = 0;  // by record_producer; looks at half a record
  reg [DATA_W-1:0] record;
  reg done = 0;

  // a record that is there: its phase bit is 1 in the first round of the ring
  task take;
    begin
      record = memory[RECORD_WORD+records];
      record[63] = 1'b0;
      done = record[32];
      match = -1;
      for (i = 0; i < expectations; i = i + 1) if (!found[i] && expected[i] === record) match = i;
      if (match < 0) begin
        $display("record %h", record);
        fail("a record that is not expected");
      end else found[match] = 1'b1;
      records = records + 1;
    end
  endtask

  reg [8*256-1:0] memory_file, records_file;
  integer doorbell = 0;
  initial begin
    if (!$value$plusargs("memory=%s", memory_file) || !$value$plusargs("records=%s", records_file))
      fail("usage: +memory=FILE +records=FILE [+start=S] [+narrow=N]");
    else begin
      for (i = 0; i < WORDS; i = i + 1) memory[i] = {DATA_W{1'b0}};
      $readmemh(memory_file, memory);
      $readmemh(records_file, expected);
      while (expectations < RECORDS && expected[expectations][32] === 1'b0)
        expectations = expectations + 1;
      if (expectations == RECORDS || expected[expectations][32] !== 1'b1) fail("no expected records");
      expectations = expectations + 1;
      if ($value$plusargs("start=%d", random) && random == 0) fail("start must not be 0");
      if ($value$plusargs("narrow=%d", narrow) && narrow < 1) fail("narrow must be 1 or more");
    end
    if (wrong == 0) begin
      repeat (8) @(posedge clk);
      #1 rst = 1'b0;
      repeat (2) @(posedge clk);
      #1;
      get(REG_ID);
      if (value !== 32'h43484343) fail("not the chip");
      set(REG_CONTROL, CONTROL_SOFT_RESET);
      value = 32'd1;
      for (i = 0; i < PATIENCE && value[0] !== 1'b0; i = i + 1) get(REG_STATUS);
      if (value[0] !== 1'b0) fail("the soft reset does not end");
      set(REG_QUERY_BASE_LOW, 0);
      set(REG_QUERY_BASE_HIGH, 0);
      set(REG_QUERY_SIZE, 0);  // one line
      set(REG_RECORD_BASE_LOW, 16 * RECORD_WORD);
      set(REG_RECORD_BASE_HIGH, 0);
      set(REG_RECORD_SIZE, RECORD_LOG2);
      set(REG_CONTROL, CONTROL_ENABLE);
      set(REG_QUERY_PRODUCER, 1);
      doorbell = clock;
      while (!done && records < RECORDS && clock - doorbell < PATIENCE) begin
        @(posedge clk);
        #1;
        if (memory[RECORD_WORD+records][63]) begin
          if (narrow != 0 && confirmed == records) begin
            if (late != 0) halves = halves + 1;
            get(REG_RECORD_PRODUCER);
            confirmed = value;
          end
          if (narrow == 0 || confirmed != records) take;
        end
      end
      if (narrow != 0) $display("a phase bit was there before its record: %0d times", halves);
      if (narrow != 0 && halves == 0) fail("no record was seen in halves");
      if (!done) fail("no done record");
      if (records != expectations) fail("records are missing");
      doorbell = clock - doorbell;
      set(REG_RECORD_CONSUMER, records);
      repeat (200) @(posedge clk);
      if (memory[RECORD_WORD+records] != 0) fail("a record behind the done record");
      get(REG_STATUS);
      if (value[6:0] !== 7'b0000010) fail("not idle at the end");
    end
    $display("query=1 records=%0d wrong=%0d clocks=%0d", records, wrong, doorbell);
`ifdef __ICARUS__
    if (wrong != 0) $finish_and_return(1);
`endif
    $finish;
  end

endmodule
`default_nettype wire
