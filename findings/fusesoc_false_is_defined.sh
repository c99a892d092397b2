#!/usr/bin/env bash
# SPDX-License-Identifier: Apache-2.0
# FuseSoC 2.4.7 with Edalize 0.6.8: a bool parameter with the default false still switches its feature on.
#
# Of a core's `FAST: {datatype: bool, paramtype: vlogdefine, default: false}` Edalize makes +define+FAST=0, so `ifdef FAST is
# true, and of a plusarg the same way +TRACE=0, so $test$plusargs("TRACE") is true. Left without a default both are off, and
# --FAST and --TRACE switch them on. To write the default down, which reads like a comment, turns the design round; there is no
# --FAST=false to take it back. The value is 0 only for those who ask for it (`if (`FAST)`, $value$plusargs).
# Seen (Icarus Verilog 11.0, Debian 12): "false: FAST defined, TRACE given", "none: QUICK not defined, WATCH not given".
set -euo pipefail
folder=$(mktemp -d)
trap 'rm -rf "$folder"' EXIT
grep -q '^Icarus Verilog version 11\.0 ' <<< "$(iverilog -V 2> /dev/null)"
python3 -m venv "$folder/venv"
"$folder/venv/bin/pip" install --quiet --disable-pip-version-check fusesoc==2.4.7 edalize==0.6.8
cd "$folder"
mkdir core
cat > core/probe.core << 'END'
CAPI=2:
name: example:test:probe:1
filesets:
  all: {files: [top.v], file_type: verilogSource}
parameters:
  FAST: {datatype: bool, paramtype: vlogdefine, default: false}
  TRACE: {datatype: bool, paramtype: plusarg, default: false}
  QUICK: {datatype: bool, paramtype: vlogdefine}
  WATCH: {datatype: bool, paramtype: plusarg}
targets:
  default: &all {filesets: [all], toplevel: top}
  sim: {<<: *all, flow: sim, flow_options: {tool: icarus}, parameters: [FAST, TRACE, QUICK, WATCH]}
END
cat > core/top.v << 'END'
module top;
    initial begin
`ifdef FAST
        $write("false: FAST defined");
`else
        $write("false: FAST not defined");
`endif
        $display(", TRACE %0s", $test$plusargs("TRACE") ? "given" : "not given");
`ifdef QUICK
        $write("none: QUICK defined");
`else
        $write("none: QUICK not defined");
`endif
        $display(", WATCH %0s", $test$plusargs("WATCH") ? "given" : "not given");
        $finish;
    end
endmodule
END
for arguments in "" "--QUICK --WATCH"; do
    # shellcheck disable=SC2086
    venv/bin/fusesoc --cores-root core run --target sim example:test:probe $arguments 2>&1 | grep -E '^(false|none):'
done | tee seen
diff seen - << 'END'
false: FAST defined, TRACE given
none: QUICK not defined, WATCH not given
false: FAST defined, TRACE given
none: QUICK defined, WATCH given
END
