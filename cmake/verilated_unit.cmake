# SPDX-License-Identifier: Apache-2.0
# cmake -D FRESH=<folder> -D UNIT=<folder>/<name>.cpp -D PREFIX=<class> -P verilated_unit.cmake
# Takes what Verilator generated in FRESH over into UNIT's folder, where it differs from what is there; deletes what is no
# longer generated, and FRESH. Writes UNIT, which includes every source, and UNIT.d, which says what they were generated
# from. UNIT ends with a hash of all that it includes: a build looks at the times of included files before this runs, so
# what tells it that one has changed is UNIT.
get_filename_component(dir ${UNIT} DIRECTORY)
file(GLOB sources RELATIVE ${FRESH} ${FRESH}/*.cpp)
file(GLOB headers RELATIVE ${FRESH} ${FRESH}/*.h)
file(GLOB old RELATIVE ${dir} ${dir}/${PREFIX}.cpp ${dir}/${PREFIX}.h ${dir}/${PREFIX}__*.cpp ${dir}/${PREFIX}__*.h)
list(REMOVE_ITEM old ${sources} ${headers})
foreach(file IN LISTS old)
  file(REMOVE ${dir}/${file})
endforeach()
set(hashes "")
foreach(file IN LISTS sources headers)
  file(SHA256 ${FRESH}/${file} hash)
  string(APPEND hashes ${hash})
  file(COPY_FILE ${FRESH}/${file} ${dir}/${file} ONLY_IF_DIFFERENT)
endforeach()

# What runs once (constructors, tables of signals) or only for a waveform is most of the text and not worth optimising;
# Verilator's own makefile does the same (OPT_SLOW).
set(text "")
foreach(file IN LISTS sources)
  if(file MATCHES "__(Slow|Syms|Trace)[_.]")
    string(APPEND text "#pragma GCC push_options\n#pragma GCC optimize(\"O0\")\n#include \"${file}\"\n#pragma GCC pop_options\n")
  else()
    string(APPEND text "#include \"${file}\"\n")
  endif()
endforeach()
string(SHA256 hash "${hashes}")
string(APPEND text "// ${hash}\n")
file(CONFIGURE OUTPUT ${UNIT} CONTENT "${text}" @ONLY)  # leaves a file alone that has this text

file(READ ${FRESH}/${PREFIX}__ver.d text)
string(REGEX REPLACE "^[^:]*:" "${UNIT}:" text "${text}")
file(WRITE ${UNIT}.d "${text}")
file(REMOVE_RECURSE ${FRESH})
