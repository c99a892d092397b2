# SPDX-License-Identifier: Apache-2.0
# The campaign's table depends on the seed, not on the number of threads.
function(table out seed threads)
  execute_process(COMMAND ${CAMPAIGN} random --shape tri-quad --pairs 200000 --seed ${seed} --threads ${threads}
    OUTPUT_VARIABLE text COMMAND_ERROR_IS_FATAL ANY)
  string(REGEX REPLACE "seconds=[0-9.]+" "" text "${text}")
  set(${out} "${text}" PARENT_SCOPE)
endfunction()

table(one 7 1)
table(three 7 3)
table(other 8 1)
if(NOT one STREQUAL three)
  message(FATAL_ERROR "1 thread:\n${one}\n3 threads:\n${three}")
endif()
string(REPLACE "seed=8" "seed=7" other "${other}")
if(one STREQUAL other)
  message(FATAL_ERROR "seeds 7 and 8 give the same table:\n${one}")
endif()
