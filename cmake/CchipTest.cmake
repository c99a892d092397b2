# SPDX-License-Identifier: Apache-2.0
# cchip_add_test(<name> LABEL unit|ref|system|long TIMEOUT <seconds> SOURCES file ... [LIBS library ...])
# One test executable whose Catch2 test cases all become CTest tests of this label. main() comes from the
# object library cchip_catch_main, which prints the seed (CCHIP_SEED).
find_package(Catch2 2.13 REQUIRED)
include(Catch)

function(cchip_add_test name)
  cmake_parse_arguments(ARG "" "LABEL;TIMEOUT" "SOURCES;LIBS" ${ARGN})
  add_executable(${name} ${ARG_SOURCES})
  target_link_libraries(${name} PRIVATE cchip_catch_main ${ARG_LIBS} cchip_warnings)
  catch_discover_tests(${name} TEST_PREFIX "${name}: " PROPERTIES LABELS ${ARG_LABEL} TIMEOUT ${ARG_TIMEOUT})
endfunction()
