# SPDX-License-Identifier: Apache-2.0
# cmake -D SOURCE= -D SCRATCH= -D CXX= -P flags.cmake
# The library is optimised for whoever builds it without a thought of build types, and what somebody chose stays: configures
# the project with README.md's lines, and this project itself, and reads the compile commands.
cmake_minimum_required(VERSION 3.25)
file(REMOVE_RECURSE ${SCRATCH})
set(ENV{CXXFLAGS})  # defaults that would be a choice
set(ENV{CMAKE_BUILD_TYPE})
set(ENV{CMAKE_GENERATOR})

# configure(<name> <source> <option> ...): the project in folder <name>; its messages in variable `out`
function(configure name source)
  execute_process(COMMAND ${CMAKE_COMMAND} -S ${source} -B ${SCRATCH}/${name} -D CMAKE_CXX_COMPILER=${CXX}
    -D CMAKE_EXPORT_COMPILE_COMMANDS=ON -D CCHIP_SIMULATION=OFF -D CCHIP_CCACHE=OFF ${ARGN}
    COMMAND_ERROR_IS_FATAL ANY OUTPUT_VARIABLE out ERROR_VARIABLE out)
  set(out "${out}" PARENT_SCOPE)
endfunction()

# expect(<name> <regex>): the options on optimisation with which the SIMD search is compiled, or "none"; of several
# configurations with a comma between two
function(expect name regex)
  file(READ ${SCRATCH}/${name}/compile_commands.json commands)
  string(JSON last LENGTH ${commands})
  math(EXPR last "${last} - 1")
  set(all)
  foreach(i RANGE ${last})
    string(JSON file GET ${commands} ${i} file)
    if(file MATCHES "/search/simd_search\\.cpp$")
      string(JSON command GET ${commands} ${i} command)
      string(REGEX MATCHALL " (-O[^ ]*|-DNDEBUG)" got "${command}")
      string(REPLACE ";" "" got "${got}")
      if(NOT got)
        set(got "none")
      endif()
      list(APPEND all "${got}")
    endif()
  endforeach()
  list(JOIN all "," got)
  if(NOT got MATCHES "^${regex}$")
    message(FATAL_ERROR "${name}: simd_search.cpp is compiled with '${got}'; expected: '${regex}'")
  endif()
endfunction()

set(readme ${SOURCE}/tests/install/subdirectory)
configure(readme ${readme})
expect(readme " -O3 -DNDEBUG")
configure(readme_none ${readme} -D CMAKE_BUILD_TYPE=None)  # of Debian's packages
expect(readme_none " -O3 -DNDEBUG")
configure(readme_own_flags ${readme} -D CMAKE_CXX_FLAGS=-O1)
expect(readme_own_flags " -O1")
configure(readme_debug_info ${readme} -D CMAKE_BUILD_TYPE=RelWithDebInfo)
expect(readme_debug_info " -O2 -DNDEBUG")
configure(readme_size ${readme} -D CMAKE_BUILD_TYPE=MinSizeRel)
expect(readme_size " -Os -DNDEBUG")
if(out MATCHES "does not optimise")
  message(FATAL_ERROR "a warning for an optimised build:\n${out}")
endif()
foreach(options "-DCMAKE_BUILD_TYPE=Debug" "-DCMAKE_BUILD_TYPE=Release;-DCMAKE_CXX_FLAGS_RELEASE=-O0" "-DCMAKE_CXX_FLAGS=-O0")
  string(MAKE_C_IDENTIFIER "readme${options}" name)
  configure(${name} ${readme} ${options})
  expect(${name} "(none| -O0| -O0 -DNDEBUG)")
  if(NOT out MATCHES "does not optimise")
    message(FATAL_ERROR "${options}: no message says that the library is built without optimisation:\n${out}")
  endif()
endforeach()

configure(top ${SOURCE})
expect(top " -O3 -DNDEBUG")
configure(top_debug ${SOURCE} -D CMAKE_BUILD_TYPE=Debug)
expect(top_debug "none")
configure(top_own_flags ${SOURCE} -D CMAKE_CXX_FLAGS=-O1)
expect(top_own_flags " -O1")

# Many configurations in one build folder: Debug, Release and RelWithDebInfo.
find_program(ninja ninja)
if(ninja)
  foreach(source ${readme} ${SOURCE})
    get_filename_component(name ${source} NAME)
    configure(${name}_multi ${source} -G "Ninja Multi-Config")
    expect(${name}_multi "none, -O3 -DNDEBUG, -O2 -DNDEBUG")
  endforeach()
endif()
