# SPDX-License-Identifier: Apache-2.0
# cmake -D SOURCE= -D SCRATCH= -D GENERATOR= -D CXX= -P packages.cmake
# Builds the project `fetch`, which fetches the library; then shared libraries and their Debian package, unpacks that,
# builds the example of README.md against it with pkg-config and against the libraries in a prefix of their own with CMake. All
# programs must start without LD_LIBRARY_PATH.
cmake_minimum_required(VERSION 3.25)
set(expected "touch: 0, pairs of faces: 0\ntouch: 1, pairs of faces: 708\ntouch: 1, pairs of faces: 834\n")
function(run)
  execute_process(COMMAND ${ARGN} COMMAND_ERROR_IS_FATAL ANY OUTPUT_VARIABLE out)
  set(out "${out}" PARENT_SCOPE)
endfunction()
function(expect name)
  if(NOT out STREQUAL expected)
    message(FATAL_ERROR "${name} printed\n${out}instead of\n${expected}")
  endif()
endfunction()

file(REMOVE_RECURSE ${SCRATCH})
set(ENV{LD_LIBRARY_PATH})
set(options -G ${GENERATOR} -D CMAKE_BUILD_TYPE=Release -D CMAKE_CXX_COMPILER=${CXX} -D CCHIP_CCACHE=OFF
  -D CMAKE_FIND_USE_PACKAGE_REGISTRY=OFF)
string(TIMESTAMP start %s)
run(${CMAKE_COMMAND} -S ${CMAKE_CURRENT_LIST_DIR}/fetch -B ${SCRATCH}/fetch ${options})
run(${CMAKE_COMMAND} --build ${SCRATCH}/fetch --parallel 2 --target fetch)
string(TIMESTAMP end %s)
math(EXPR seconds "${end} - ${start}")
run(${SCRATCH}/fetch/fetch)
expect(fetch)

run(${CMAKE_COMMAND} -S ${SOURCE} -B ${SCRATCH}/shared ${options} -D CCHIP_SIMULATION=OFF -D BUILD_SHARED_LIBS=ON
  -D CMAKE_INSTALL_PREFIX=/usr)
run(${CMAKE_COMMAND} --build ${SCRATCH}/shared --parallel 2)
run(${CMAKE_COMMAND} -E chdir ${SCRATCH}/shared cpack)
file(GLOB package ${SCRATCH}/shared/collisionchip_*.deb)
run(dpkg-deb --extract ${package} ${SCRATCH}/root)
file(GLOB_RECURSE pc ${SCRATCH}/root/usr/lib/collisionchip.pc)
cmake_path(GET pc PARENT_PATH pc_folder)
run(${CMAKE_COMMAND} -E env PKG_CONFIG_PATH=${pc_folder} pkg-config --cflags --libs collisionchip)
separate_arguments(flags UNIX_COMMAND "${out}")
run(${CXX} -std=c++17 ${SOURCE}/examples/collide.cpp ${flags} -Wl,-rpath,${pc_folder}/.. -o ${SCRATCH}/from_package)
run(${SCRATCH}/from_package)
expect(from_package)

# The same libraries in a prefix of their own, for a project that makes warnings errors.
run(${CMAKE_COMMAND} --install ${SCRATCH}/shared --prefix ${SCRATCH}/prefix)
run(${CMAKE_COMMAND} -S ${CMAKE_CURRENT_LIST_DIR}/consumer -B ${SCRATCH}/consumer ${options}
  "-DCMAKE_CXX_FLAGS=-Wall -Wextra -Wconversion -Wfloat-equal -Wuseless-cast -Wno-unknown-warning-option -Werror" -D CMAKE_PREFIX_PATH=${SCRATCH}/prefix)
run(${CMAKE_COMMAND} --build ${SCRATCH}/consumer)
run(${SCRATCH}/consumer/consumer)
expect(consumer)

# examples/ as a project of its own over them; it runs its programs
run(${CMAKE_COMMAND} -S ${SOURCE}/examples -B ${SCRATCH}/examples ${options} -D CMAKE_PREFIX_PATH=${SCRATCH}/prefix)
run(${CMAKE_COMMAND} --build ${SCRATCH}/examples)
run(${CMAKE_COMMAND} -E chdir ${SCRATCH}/examples ${CMAKE_CTEST_COMMAND} --no-tests=error --output-on-failure)
cmake_path(GET package FILENAME name)
message(STATUS "fetched, configured and built in ${seconds} s; ${name}")
