#!/usr/bin/env bash
# SPDX-License-Identifier: Apache-2.0
# rc2dly of Debian 12's qflow 1.3.17: an SPEF file says that its capacitances are femtofarads and holds picofarads.
#
# The head has "*C_UNIT 1 FF". The load of a pin (*L) is the number of the Liberty file, whose unit is 1 pF, and the
# wires beside it have the numbers of qrouter's file, pF too. So a reader that believes the head, as OpenSTA, takes wires
# and pins for a thousandth of what they are, and a layout seems as fast as one without wires.
# Its nodes are written 1_2, too, although the head says that the delimiter is ":".
# Remedy: "*C_UNIT 1 PF" and ":" in the file before it is read.
# Seen: "unit 1 FF, load of the pin 0.0125, in the library 0.0125 pf", "node 1_1, delimiter :".
set -euo pipefail
folder=$(mktemp -d)
trap 'rm -rf "$folder"' EXIT
cd "$folder"
apt-get download --quiet --quiet -o APT::Sandbox::User=root qflow=1.3.17+dfsg.1-3+b1 qflow-tech-osu018=1.3.17+dfsg.1-3
for package in *.deb; do dpkg-deb --extract "$package" .; done
ls -- *.deb
library=usr/share/qflow/tech/osu018/osu018_stdcells.lib
# a net from the output of one NAND gate to an input of the next one: ohm, picofarads
echo 'n 1 NAND2X1_1/Y 1 ( 10 0.002 NAND2X1_2/A )' > net.rc
usr/lib/qflow/bin/rc2dly -D : -r net.rc -l "$library" -d net.spef > log 2>&1
unit=$(sed -n 's/^\*C_UNIT //p' net.spef)
load=$(sed -n 's/^\*I .*:A I \*L //p' net.spef)
wire=$(awk '$1 == "*CAP" { getline; print $3 }' net.spef)
delimiter=$(sed -n 's/^\*DELIMITER //p' net.spef)
node=$(awk '$1 == "*CAP" { getline; print $2 }' net.spef)
grep -q 'capacitive_load_unit *(1,pf)' "$library"
pin=$(awk '/^cell *\(NAND2X1\)/ { cell = 1 } cell && /pin\(A\)/ { pin = 1 }
    pin && /capacitance:?/ { gsub(/[^0-9.]/, ""); print; exit }' "$library")
echo "unit $unit, load of the pin $load, in the library $pin pf, wire $wire"
echo "node $node, delimiter $delimiter"
test "$unit" = "1 FF"
python3 -c "import sys; assert abs(float(sys.argv[1]) / float(sys.argv[2]) - 1) < 1e-4" "$load" "$pin"
python3 -c "import sys; assert abs(float(sys.argv[1]) / 0.002 - 1) < 1e-4" "$wire"
test "$delimiter" = ":"
case $node in *_*) ;; *) exit 1 ;; esac
