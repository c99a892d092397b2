# SPDX-License-Identifier: Apache-2.0
# cmake -D UNIT=<folder>/<name>.cpp -D PREFIX=<class> -P verilated_unit.cmake
# Writes UNIT, which includes every source that Verilator generated beside it, and UNIT.d, which says what they were
# generated from.
get_filename_component(dir ${UNIT} DIRECTORY)
file(GLOB sources RELATIVE ${dir} ${dir}/*.cpp)
list(TRANSFORM sources REPLACE "(.+)" "#include \"\\1\"\n")
list(JOIN sources "" text)
file(WRITE ${UNIT} "${text}")
file(READ ${dir}/${PREFIX}__ver.d text)
string(REGEX REPLACE "^[^:]*:" "${UNIT}:" text "${text}")
file(WRITE ${UNIT}.d "${text}")
