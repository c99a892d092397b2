# SPDX-License-Identifier: Apache-2.0
# cchip_add_test(<name> LABEL unit|ref|system|long TIMEOUT <seconds> SOURCES file ... [LIBS library ...])
# One test executable whose Catch2 test cases all become CTest tests of this label. main() comes from the
# object library cchip_catch_main, which prints the seed (CCHIP_SEED). A test that finds no test case of its name fails
# (-w NoTests): a semicolon in a name, which CMake takes for the end of a list's element, once made tests that never ran.
find_package(Catch2 2.13 REQUIRED)
include(Catch)

# Half the time of the compiler: the arithmetic of a test is in the libraries, and Catch and Eigen are most of what it reads.
# A precompiled header takes as long as two files save.
function(cchip_test_options name)
  target_compile_options(${name} PRIVATE $<$<CONFIG:Release>:-O1>)
  list(LENGTH ARGN files)
  if(files GREATER 2)
    target_precompile_headers(${name} PRIVATE <catch2/catch.hpp> <Eigen/Geometry> <string> <vector>)
  endif()
endfunction()

function(cchip_add_test name)
  cmake_parse_arguments(ARG "" "LABEL;TIMEOUT" "SOURCES;LIBS" ${ARGN})
  add_executable(${name} ${ARG_SOURCES})
  target_link_libraries(${name} PRIVATE cchip_catch_main ${ARG_LIBS} cchip_warnings)
  cchip_test_options(${name} ${ARG_SOURCES})
  if(CCHIP_COVERAGE)  # counters take their time
    math(EXPR ARG_TIMEOUT "10 * ${ARG_TIMEOUT}")
  endif()
  catch_discover_tests(${name} TEST_PREFIX "${name}: " EXTRA_ARGS -w NoTests PROPERTIES LABELS ${ARG_LABEL} TIMEOUT ${ARG_TIMEOUT})
endfunction()

# cchip_add_program_test(<name> LABEL <label> TIMEOUT <seconds> [CODE <exit code>] TEXT <regex> COMMAND <program> ...)
# A program whose exit code (default 0) and output must both be right; tests/expect.py explains the regex.
find_package(Python3 REQUIRED COMPONENTS Interpreter)
function(cchip_add_program_test name)
  cmake_parse_arguments(ARG "" "LABEL;TIMEOUT;CODE;TEXT" "COMMAND" ${ARGN})
  if(NOT ARG_CODE)
    set(ARG_CODE 0)
  endif()
  list(POP_FRONT ARG_COMMAND program)
  if(TARGET ${program})
    set(program $<TARGET_FILE:${program}>)
  endif()
  add_test(NAME ${name} COMMAND Python3::Interpreter -B ${PROJECT_SOURCE_DIR}/tests/expect.py ${ARG_CODE} ${ARG_TEXT}
    ${program} ${ARG_COMMAND})
  set_tests_properties(${name} PROPERTIES LABELS ${ARG_LABEL} TIMEOUT ${ARG_TIMEOUT})
endfunction()

# cchip_long_programs(<target> ...): of tests with the label long alone, so only `make test-long` builds them.
function(cchip_long_programs)
  if(NOT TARGET long_programs)
    add_custom_target(long_programs)
  endif()
  set_target_properties(${ARGN} PROPERTIES EXCLUDE_FROM_ALL TRUE)
  add_dependencies(long_programs ${ARGN})
endfunction()
