#!/usr/bin/env bash
# SPDX-License-Identifier: Apache-2.0
# A fabric of FABulous 2.2.0, placed and routed by Debian 12's nextpnr-generic 0.4 (--uarch fabulous): an output pin that
# is 0 and one that is 1 give the same bits.
#
# nextpnr makes a LUT for each constant, sets its table, and gives it no wire to the pin: the net of the constant has no
# user any more. There is no error and no warning; the pin takes what an input that nothing drives has. A constant from a
# LUT of the design (LUT1 with both entries 1) is wired.
# Remedy: let Yosys put such a LUT there, `hilomap` with a cell that becomes one.
# Seen: "0 and 1: the same, wires 0"; by a LUT "0 and 1: different, wires" above 0.
# Needs Python 3.12 or newer (FABulous), Debian's yosys and nextpnr-generic.
set -euo pipefail
folder=$(mktemp -d)
trap 'rm -rf "$folder"' EXIT
cd "$folder"
for python in python3.14 python3.13 python3.12 "$HOME"/.pyenv/versions/3.1[2-9]*/bin/python3; do
    if "$python" -c 'import ensurepip' 2> /dev/null; then break; fi
done
"$python" -m venv venv
venv/bin/pip install --quiet --disable-pip-version-check FABulous-FPGA==2.2.0 FABulous-bit-gen==0.3.1 FABulous-fasm==0.2.0
dpkg-query --show --showformat '${Package} ${Version}\n' nextpnr-generic yosys
venv/bin/FABulous create-project project > log 2>&1
sed -i '/FAB_PDK/d' project/.FABulous/.env # no process kit is needed for place and route
printf 'load_fabric\nrun_FABulous_fabric\nexit\n' > generate.tcl
venv/bin/FABulous -p project script generate.tcl --type tcl >> log 2>&1
pin=$(grep -m 1 ',IO_1_bidirectional_frame_config_pass,' project/.FABulous/bel.v2.txt)
IFS=, read -r _ tile letter cell _ <<< "$pin"
bits() {  # NAME DRIVER: bits and wires of a design whose pin is driven so
    cat > "$1.v" << END
(* blackbox *) module $cell (output O, Q, input I, T, CLK); endmodule
(* blackbox *) module LUT1 (output O, input I0); parameter [1:0] INIT = 0; endmodule
module top;
    wire one, in;
    $2
    (* keep, BEL = "$tile.$letter" *) $cell pin (.I(one), .T(1'b0), .O(in));
endmodule
END
    yosys -q -p "read_verilog $1.v; hierarchy -top top; proc; opt_clean; write_json $1.json"
    FAB_ROOT=project nextpnr-generic --uarch fabulous --seed 1 --json "$1.json" -o "fasm=$1.fasm" > "$1.log" 2>&1
}
compare() {  # NAME of both
    local same=different
    if diff -q "$1"0.fasm "$1"1.fasm > same.log; then same="the same"; fi
    echo "0 and 1: $same, wires $(grep -c '^X[0-9]*Y[0-9]*\.[^.]*\.[^.[]*$' "$1"1.fasm || true)"
}
for value in 0 1; do
    bits "constant$value" "assign one = 1'b$value;"
    bits "table$value" "(* keep *) LUT1 #(.INIT({2{1'b$value}})) lut (.O(one), .I0(in));"
done
if grep -i warning constant?.log; then exit 1; fi
compare constant | tee seen
compare table | tee -a seen
grep -qx '0 and 1: the same, wires 0' seen
grep -qx '0 and 1: different, wires [1-9][0-9]*' seen
