# SPDX-License-Identifier: Apache-2.0
# Without optimisation a query takes some 50 times as long, and CMake's default is no optimisation. So Release is the
# default here; inside another project, whose build type is not ours to set, CCHIP_OPTIMISE holds the flags of Release for
# our own targets. What somebody has chosen stays: a build type that has flags, or -O.. in CMAKE_CXX_FLAGS.
get_property(multi_config GLOBAL PROPERTY GENERATOR_IS_MULTI_CONFIG)
string(TOUPPER "${CMAKE_BUILD_TYPE}" type)
set(flags " ${CMAKE_CXX_FLAGS} ${CMAKE_CXX_FLAGS_${type}}")
set(CCHIP_OPTIMISE)
if(multi_config)  # Debug, Release or another is chosen by whoever builds
elseif(type STREQUAL "DEBUG" OR flags MATCHES " [-/]O([0dg]|[0dg] .*)$")
  message(NOTICE "collisionchip: build type '${CMAKE_BUILD_TYPE}' does not optimise; a query may take 50 times as long as in a Release build")
elseif(NOT flags MATCHES " [-/]O")
  if(PROJECT_IS_TOP_LEVEL AND NOT CMAKE_BUILD_TYPE)
    message(STATUS "Build type: Release, as none was chosen")
    set(CMAKE_BUILD_TYPE Release CACHE STRING "Release, Debug, RelWithDebInfo or MinSizeRel" FORCE)
  else()
    separate_arguments(CCHIP_OPTIMISE NATIVE_COMMAND "${CMAKE_CXX_FLAGS_RELEASE}")
  endif()
endif()
