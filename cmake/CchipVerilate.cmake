# SPDX-License-Identifier: Apache-2.0
# cchip_verilate(<library> <top> [PREFIX <class>] [PARAMETERS NAME=VALUE ...] [SOURCES file ...])
# Adds the Verilated module <top> to the static library <library> as class <PREFIX> (default
# V<top>). Without SOURCES the file list rtl/cchip.f is used. The first library made this way keeps
# the Verilator runtime; the others link to it, so a program holds one copy.
find_package(verilator 5.006 REQUIRED)
set(CCHIP_RTL_DIR ${PROJECT_SOURCE_DIR}/rtl)
file(STRINGS ${CCHIP_RTL_DIR}/cchip.f CCHIP_RTL_FILES REGEX "\\.v$")
list(TRANSFORM CCHIP_RTL_FILES PREPEND ${CCHIP_RTL_DIR}/)
set_property(DIRECTORY APPEND PROPERTY CMAKE_CONFIGURE_DEPENDS ${CCHIP_RTL_DIR}/cchip.f)

# -fno-const-bit-op-tree: 5.006 miscompiles some XOR/AND trees otherwise (upstream issue 4832).
set(CCHIP_VERILATOR_ARGS -Wall -fno-const-bit-op-tree --assert --x-assign unique --x-initial unique
    -I${CCHIP_RTL_DIR}/include ${CCHIP_RTL_DIR}/lint/verilator_waiver.vlt)

function(cchip_model_library library)
  add_library(${library} STATIC)
  target_compile_options(${library} PRIVATE -w)  # generated code and runtime
  target_compile_definitions(${library} INTERFACE VM_SC=0 VM_TRACE=1 VM_TRACE_FST=1 VM_TRACE_VCD=0 VM_COVERAGE=0)
  target_link_libraries(${library} PUBLIC Threads::Threads)
endfunction()

function(cchip_verilate library top)
  cmake_parse_arguments(ARG "" "PREFIX" "PARAMETERS;SOURCES" ${ARGN})
  if(NOT ARG_PREFIX)
    set(ARG_PREFIX V${top})
  endif()
  if(NOT ARG_SOURCES)
    set(ARG_SOURCES ${CCHIP_RTL_FILES})
  endif()
  set(generics)
  foreach(p IN LISTS ARG_PARAMETERS)
    list(APPEND generics -G${p})
  endforeach()
  verilate(${library} TRACE_FST PREFIX ${ARG_PREFIX} TOP_MODULE ${top}
    VERILATOR_ARGS ${CCHIP_VERILATOR_ARGS} ${generics} SOURCES ${ARG_SOURCES})
  get_target_property(dirs ${library} INTERFACE_INCLUDE_DIRECTORIES)
  set_target_properties(${library} PROPERTIES INTERFACE_SYSTEM_INCLUDE_DIRECTORIES "${dirs}")
endfunction()

# Drops the runtime sources that verilate() added to <library> and takes them from <runtime>.
function(cchip_share_runtime library runtime)
  get_target_property(sources ${library} SOURCES)
  list(FILTER sources EXCLUDE REGEX "/include/verilated[^/]*\\.cpp$")
  set_target_properties(${library} PROPERTIES SOURCES "${sources}")
  target_link_libraries(${library} PUBLIC ${runtime})
endfunction()
