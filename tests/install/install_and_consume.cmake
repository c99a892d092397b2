# SPDX-License-Identifier: Apache-2.0
# cmake -D BUILD= -D SCRATCH= -D CONSUMER= -D GENERATOR= -D CXX= -D FLAGS= -P install_and_consume.cmake
# Installs BUILD below SCRATCH as a packager does (DESTDIR), builds CONSUMER and CONSUMER_reconfig against
# that and checks what they print; then runs the installed command and reads the installed Verilog file list.
cmake_minimum_required(VERSION 3.25)
set(stage ${SCRATCH}/stage)
set(prefix ${stage}/usr)

function(run)
  execute_process(COMMAND ${ARGN} COMMAND_ERROR_IS_FATAL ANY OUTPUT_VARIABLE out ECHO_OUTPUT_VARIABLE)
  set(out "${out}" PARENT_SCOPE)
endfunction()

file(REMOVE_RECURSE ${SCRATCH})
run(${CMAKE_COMMAND} -E env DESTDIR=${stage} ${CMAKE_COMMAND} --install ${BUILD} --prefix /usr)

# Builds the project ${CONSUMER}${suffix} and checks what its program prints.
function(consume suffix expected)
  set(name consumer${suffix})
  run(${CMAKE_COMMAND} -S ${CONSUMER}${suffix} -B ${SCRATCH}/${name} -G ${GENERATOR} -D CMAKE_BUILD_TYPE=Release
    -D CMAKE_CXX_COMPILER=${CXX} -D CMAKE_CXX_FLAGS=${FLAGS} -D CMAKE_PREFIX_PATH=${prefix}
    -D CMAKE_FIND_USE_PACKAGE_REGISTRY=OFF)
  run(${CMAKE_COMMAND} --build ${SCRATCH}/${name})
  run(${SCRATCH}/${name}/${name})
  if(NOT out STREQUAL expected)
    message(FATAL_ERROR "${name} printed\n${out}instead of\n${expected}")
  endif()
endfunction()

consume("" "touch: 0, pairs of faces: 0\ntouch: 1, pairs of faces: 708\ntouch: 1, pairs of faces: 834\n")
# Again for another instruction set than the library's: what both exchange does not depend on it.
set(plain_flags "${FLAGS}")
set(FLAGS "${FLAGS} -march=native")
consume("" "touch: 0, pairs of faces: 0\ntouch: 1, pairs of faces: 708\ntouch: 1, pairs of faces: 834\n")
set(FLAGS "${plain_flags}")
consume(_reconfig "41\n42\n")

# The same by pkg-config.
file(GLOB_RECURSE pc ${prefix}/lib/collisionchip.pc)
cmake_path(GET pc PARENT_PATH pc_folder)
run(${CMAKE_COMMAND} -E env PKG_CONFIG_PATH=${pc_folder} pkg-config --cflags --libs collisionchip)
separate_arguments(pc_flags UNIX_COMMAND "${FLAGS} ${out}")
run(${CXX} -std=c++17 ${CONSUMER}/../../../examples/collide.cpp ${pc_flags} -o ${SCRATCH}/by_pkg_config)
run(${SCRATCH}/by_pkg_config)
if(NOT out STREQUAL "touch: 0, pairs of faces: 0\ntouch: 1, pairs of faces: 708\ntouch: 1, pairs of faces: 834\n")
  message(FATAL_ERROR "the program that pkg-config helped to build printed\n${out}")
endif()

run(${prefix}/bin/cchip --version)

foreach(list IN ITEMS rtl/cchip.f sim/rtl_models/sim.f)
  set(list ${prefix}/share/collisionchip/${list})
  cmake_path(GET list PARENT_PATH folder)
  file(STRINGS ${list} names REGEX "\\.v$")
  if(NOT names)
    message(FATAL_ERROR "${list} lists no Verilog file")
  endif()
  foreach(name IN LISTS names)
    if(NOT EXISTS ${folder}/${name})
      message(FATAL_ERROR "${list} lists ${name}, which is not installed")
    endif()
  endforeach()
endforeach()
