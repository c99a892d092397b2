// SPDX-License-Identifier: Apache-2.0 WITH SHL-2.1
// Options of slang: every warning, and those that are off with the reason.
--std 1364-2005
// One finding, one block of text (rtl/lint/slang.waiver).
--diag-hierarchy never
-Weverything
// Every module is top once, so the others are unused.
-Wno-unused-def
// Bits of flat vectors are unsigned by nature; $signed and the width of both sides are what Verilator checks.
-Wno-sign-conversion
