# SPDX-License-Identifier: Apache-2.0
# cmake -D SCRIPT=<verilated_unit.cmake> -D FOLDER=<scratch> -P test_verilated_unit.cmake
# The translation unit of a model is another one when a file that it includes is, and the same file when none is.
file(REMOVE_RECURSE ${FOLDER})
foreach(step IN ITEMS 1 2 2)
  file(WRITE ${FOLDER}/fresh/Vm.h "")
  file(WRITE ${FOLDER}/fresh/Vm__DepSet_0.cpp "int logic = ${step};\n")
  file(WRITE ${FOLDER}/fresh/Vm__ver.d "Vm.cpp : m.v\n")
  execute_process(COMMAND ${CMAKE_COMMAND} -D FRESH=${FOLDER}/fresh -D UNIT=${FOLDER}/Vm.unit.cpp -D PREFIX=Vm -P ${SCRIPT} COMMAND_ERROR_IS_FATAL ANY)
  file(READ ${FOLDER}/Vm.unit.cpp text)
  list(APPEND texts "${text}")
endforeach()
list(GET texts 0 first)
list(GET texts 1 second)
list(GET texts 2 third)
if(first STREQUAL second OR NOT second STREQUAL third)
  message(FATAL_ERROR "the unit does not follow what it includes:\n${texts}")
endif()
