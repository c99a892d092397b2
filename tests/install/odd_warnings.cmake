# SPDX-License-Identifier: Apache-2.0
# cmake -D SOURCE= -D SCRATCH= -D CXX= -P odd_warnings.cmake
# Warnings of somebody else do not break the build: as flags of this project they are warnings; inside a project that makes
# them errors, neither our sources nor our headers show any. Compiles a few files only.
cmake_minimum_required(VERSION 3.25)
file(REMOVE_RECURSE ${SCRATCH})
set(warnings "-Wall -Wextra -Wconversion -Wfloat-equal -Wold-style-cast -Weffc++")
if(CXX_ID STREQUAL "GNU")
  string(APPEND warnings " -Wuseless-cast")
endif()

# compile(<name> <source> <file regex> <count> <option> ...): configures and compiles the files alone
function(compile name source regex count)
  execute_process(COMMAND ${CMAKE_COMMAND} -S ${source} -B ${SCRATCH}/${name} -D CMAKE_CXX_COMPILER=${CXX}
    -D CMAKE_EXPORT_COMPILE_COMMANDS=ON -D CCHIP_SIMULATION=OFF ${ARGN} OUTPUT_QUIET COMMAND_ERROR_IS_FATAL ANY)
  file(READ ${SCRATCH}/${name}/compile_commands.json commands)
  string(JSON last LENGTH ${commands})
  math(EXPR last "${last} - 1")
  set(compiled 0)
  set(texts)
  foreach(i RANGE ${last})
    string(JSON file GET ${commands} ${i} file)
    if(file MATCHES "${regex}")
      string(JSON command GET ${commands} ${i} command)
      separate_arguments(command UNIX_COMMAND "${command}")
      execute_process(COMMAND ${command} -fsyntax-only WORKING_DIRECTORY ${SCRATCH}/${name} COMMAND_ERROR_IS_FATAL ANY
        ERROR_VARIABLE text)
      set(texts "${texts}${text}")
      math(EXPR compiled "${compiled} + 1")
    endif()
  endforeach()
  if(NOT compiled EQUAL count)
    message(FATAL_ERROR "${name}: ${compiled} files compiled instead of ${count}")
  endif()
  set(texts "${texts}" PARENT_SCOPE)
endfunction()

set(files "/(grid/local_grid|mesh/shapes)\\.cpp$")
compile(top ${SOURCE} ${files} 2 "-DCMAKE_CXX_FLAGS=${warnings}")
if(NOT texts MATCHES "float-equal")  # or this test shows nothing
  message(FATAL_ERROR "the two files do not use what -Wfloat-equal warns of:\n${texts}")
endif()
set(readme ${SOURCE}/tests/install/subdirectory)
compile(inside ${readme} "/(grid/local_grid|mesh/shapes|examples/collide)\\.cpp$" 3 "-DCMAKE_CXX_FLAGS=${warnings} -Werror")
if(texts)
  message(FATAL_ERROR "our sources or headers warn inside another project:\n${texts}")
endif()
