# SPDX-License-Identifier: Apache-2.0
# cmake -D SOURCE= -D SCRATCH= -D CC= -D CXX= -D GENERATOR= -D MAKE= -P missing.cmake
# Whoever configures without a tool or library that is needed reads which one, and what does without it.
cmake_minimum_required(VERSION 3.25)
file(REMOVE_RECURSE ${SCRATCH})

# refused(<regex> <option> ...): configuring must fail with such a message
function(refused regex)
  execute_process(COMMAND ${CMAKE_COMMAND} -S ${SOURCE} -B ${SCRATCH} --fresh -G ${GENERATOR} -D CMAKE_MAKE_PROGRAM=${MAKE}
    -D CMAKE_C_COMPILER=${CC} -D CMAKE_CXX_COMPILER=${CXX} -D CCHIP_CCACHE=OFF ${ARGN}
    RESULT_VARIABLE code OUTPUT_VARIABLE out ERROR_VARIABLE out)
  string(REGEX REPLACE "[ \n]+" " " out "${out}")
  if(code EQUAL 0 OR NOT out MATCHES "${regex}")
    message(FATAL_ERROR "${ARGN}: exit code ${code}, expected a failure with '${regex}', got:\n${out}")
  endif()
endfunction()

find_program(verilator verilator REQUIRED)
get_filename_component(folder ${verilator} DIRECTORY)
refused("Missing for the simulation.*Verilator.*-D CCHIP_SIMULATION=OFF" "-DCMAKE_IGNORE_PATH=${folder}\;/bin")
refused("Missing for the simulation.*SystemC.*-D CCHIP_SIMULATION=OFF" -D CMAKE_DISABLE_FIND_PACKAGE_PkgConfig=ON)
refused("Missing for the tests.*Catch2.*-D BUILD_TESTING=OFF.*-D CCHIP_SIMULATION=OFF" -D CMAKE_DISABLE_FIND_PACKAGE_Catch2=ON)
refused("Missing for the library.*libeigen3-dev.*libhwy-dev" -D CCHIP_SIMULATION=OFF
  -D CMAKE_DISABLE_FIND_PACKAGE_Eigen3=ON -D CMAKE_DISABLE_FIND_PACKAGE_hwy=ON)
