# SPDX-License-Identifier: Apache-2.0
# Libraries of Verilated modules.
#   cchip_model_library(<library>)                    an empty one
#   cchip_verilate(<library> <module> [PREFIX <class>] [PARAMETERS NAME=VALUE ...] [SOURCES file ...])
#       adds the module as C++ class <class> (default V<module>); without SOURCES from rtl/cchip.f
#   cchip_share_runtime(<library> <other>)            after the last cchip_verilate: takes the
#       Verilator runtime from <other>, so that a program that links both holds one copy of it
# include() this file in every folder that calls them.
find_package(verilator 5.006 REQUIRED)
set(CCHIP_RTL_DIR ${PROJECT_SOURCE_DIR}/rtl)
file(STRINGS ${CCHIP_RTL_DIR}/cchip.f CCHIP_RTL_FILES REGEX "\\.v$")
list(TRANSFORM CCHIP_RTL_FILES PREPEND ${CCHIP_RTL_DIR}/)
set_property(DIRECTORY APPEND PROPERTY CMAKE_CONFIGURE_DEPENDS ${CCHIP_RTL_DIR}/cchip.f)

# -fno-const-bit-op-tree: 5.006 miscompiles some XOR/AND trees otherwise (upstream issue 4832).
set(CCHIP_VERILATOR_ARGS -Wall -fno-const-bit-op-tree --assert --x-assign unique --x-initial unique
    -I${CCHIP_RTL_DIR}/include)
set(CCHIP_VERILATOR_WAIVER ${CCHIP_RTL_DIR}/lint/verilator_waiver.vlt)

function(cchip_model_library library)
  add_library(${library} STATIC)
  # -w: generated code and runtime. -O2: also in debug builds, simulation is useless without.
  target_compile_options(${library} PRIVATE -w -O2)
  if(CCHIP_SANITIZE)  # the FST writer of the runtime stores to unaligned addresses
    target_compile_options(${library} PRIVATE -fno-sanitize=undefined)
  endif()
  target_compile_definitions(${library} INTERFACE VM_SC=0 VM_TRACE=1 VM_TRACE_FST=1 VM_TRACE_VCD=0 VM_COVERAGE=0)
  target_link_libraries(${library} PUBLIC Threads::Threads)
  # one translation unit per module: the common headers cost more than the code
  set_target_properties(${library} PROPERTIES UNITY_BUILD ON UNITY_BUILD_MODE GROUP)
endfunction()

function(cchip_verilate library top)
  cmake_parse_arguments(ARG "" "PREFIX" "PARAMETERS;SOURCES" ${ARGN})
  if(NOT ARG_PREFIX)
    set(ARG_PREFIX V${top})
  endif()
  # Verilator reads the file list itself: a new line in it must not need a new configuration first. The define
  # makes a new configuration forget what it knew of an older list, as after a file has gone.
  set(files)
  if(NOT ARG_SOURCES)
    file(MD5 ${CCHIP_RTL_DIR}/cchip.f list)
    set(files -F ${CCHIP_RTL_DIR}/cchip.f -DCCHIP_FILE_LIST_${list})
  endif()
  list(TRANSFORM ARG_PARAMETERS PREPEND -G)
  verilate(${library} TRACE_FST PREFIX ${ARG_PREFIX} TOP_MODULE ${top}
    VERILATOR_ARGS ${CCHIP_VERILATOR_ARGS} ${ARG_PARAMETERS} ${files}
    SOURCES ${CCHIP_VERILATOR_WAIVER} ${ARG_SOURCES})
  get_target_property(sources ${library} SOURCES)
  list(FILTER sources INCLUDE REGEX "/${ARG_PREFIX}\\.dir/.*\\.cpp$")
  set_source_files_properties(${sources} PROPERTIES UNITY_GROUP ${ARG_PREFIX})
  get_target_property(dirs ${library} INTERFACE_INCLUDE_DIRECTORIES)
  set_target_properties(${library} PROPERTIES INTERFACE_SYSTEM_INCLUDE_DIRECTORIES "${dirs}")
endfunction()

function(cchip_share_runtime library other)
  get_target_property(sources ${library} SOURCES)
  list(FILTER sources EXCLUDE REGEX "/include/verilated[^/]*\\.cpp$")
  set_target_properties(${library} PROPERTIES SOURCES "${sources}")
  target_link_libraries(${library} PUBLIC ${other})
endfunction()
