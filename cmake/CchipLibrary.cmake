# SPDX-License-Identifier: Apache-2.0
# The headers of another project's libraries are none of its own: its warnings are not for them.
set(system)
if(NOT PROJECT_IS_TOP_LEVEL)
  set(system SYSTEM)
endif()

# An installed shared library finds the others beside it, wherever the prefix is; packagers switch that off by
# CMAKE_SKIP_INSTALL_RPATH.
if(NOT DEFINED CMAKE_INSTALL_RPATH)
  if(APPLE)
    set(CMAKE_INSTALL_RPATH "@loader_path")
  else()
    set(CMAKE_INSTALL_RPATH "$ORIGIN")
  endif()
endif()

# cchip_library(<name> <file> ...): library cchip_<name>, target collisionchip::<name>; static, or shared with
# BUILD_SHARED_LIBS
find_package(Boost 1.74 REQUIRED)
function(cchip_library name)
  add_library(cchip_${name} ${ARGN})
  # Until version 1 every minor version may change the binary interface.
  set_target_properties(cchip_${name} PROPERTIES
    VERSION ${PROJECT_VERSION} SOVERSION ${PROJECT_VERSION_MAJOR}.${PROJECT_VERSION_MINOR})
  add_library(collisionchip::${name} ALIAS cchip_${name})
  set_target_properties(cchip_${name} PROPERTIES EXPORT_NAME ${name})
  target_include_directories(cchip_${name} ${system} PUBLIC
    $<BUILD_INTERFACE:${CMAKE_CURRENT_SOURCE_DIR}/include> $<INSTALL_INTERFACE:include>)
  target_include_directories(cchip_${name} PRIVATE ${CMAKE_CURRENT_SOURCE_DIR}/src ${PROJECT_SOURCE_DIR}/lib/src)
  target_compile_features(cchip_${name} PUBLIC cxx_std_17)
  # Proven error bounds hold for the operations as they are written, regardless of the flags of a surrounding project.
  target_compile_options(cchip_${name} PRIVATE ${CCHIP_OPTIMISE}
    $<IF:$<CXX_COMPILER_ID:MSVC>,/fp:precise,-fno-fast-math;-ffp-contract=off>)
  target_link_libraries(cchip_${name} PRIVATE $<BUILD_INTERFACE:cchip_warnings> $<BUILD_INTERFACE:Boost::headers>)
  # Read once in place of a hundred times, two seconds each; not Boost, which brings initialisers into every file. Shared libraries differ in a macro each.
  if(BUILD_SHARED_LIBS)
  elseif(name STREQUAL "core")
    target_precompile_headers(cchip_core PRIVATE <Eigen/Geometry> <algorithm> <memory>
      <string> <vector>)
  else()
    target_precompile_headers(cchip_${name} REUSE_FROM cchip_core)
  endif()
endfunction()
