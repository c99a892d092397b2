# SPDX-License-Identifier: Apache-2.0
# Installed tree below the prefix:
#   bin/cchip                     command line (if built)
#   lib/libcchip_*.a              or .so with BUILD_SHARED_LIBS, with include/cchip/ and lib/cmake/collisionchip/:
#                                 find_package(collisionchip) gives collisionchip::core, ::mesh_io, ::certificate and ::device,
#                                 ::assembly if it was built with toml++,
#                                 of cpp_ref (if built) ::wire, ::reference, ::model and ::driver
#   lib/pkgconfig/collisionchip.pc   the same for pkg-config, without reference
#   lib/libcchip_reconfig.a       with include/cchip/rc/ (if built): find_package(collisionchip COMPONENTS reconfig) gives
#                                 collisionchip::reconfig alone, which needs SystemC and nothing of the above
#   share/collisionchip/rtl       Verilog sources, include folder and file list cchip.f
#   share/collisionchip/sim/rtl_models   Verilog for simulations only, file list sim.f
#   share/bash-completion/completions/cchip, share/man/man1/cchip*.1   if cchip is built, the pages with help2man
#   share/doc/collisionchip       licences
# cpack makes a Debian package of that tree: scripts/run deb.
include(GNUInstallDirs)
include(CMakePackageConfigHelpers)
find_package(ZLIB QUIET)  # ZLIB_FOUND of lib is not seen here
set(CCHIP_PACKAGE_DIR ${CMAKE_INSTALL_LIBDIR}/cmake/collisionchip)

set(libraries cchip_core cchip_mesh_io cchip_certificate cchip_device)
set(CCHIP_ASSEMBLY OFF)
set(CCHIP_3MF OFF)
set(CCHIP_URDF OFF)
if(TARGET cchip_assembly)
  set(CCHIP_ASSEMBLY ON)
  list(APPEND libraries cchip_assembly)
  find_package(pugixml QUIET)
  if(pugixml_FOUND AND CCHIP_LIBZIP AND CCHIP_LIBZIP_INCLUDE_DIR AND NOT BUILD_SHARED_LIBS)
    set(CCHIP_3MF ON)
  endif()
  if(pugixml_FOUND AND CCHIP_URDFDOM AND CCHIP_CONSOLE_BRIDGE AND CCHIP_URDFDOM_INCLUDE_DIR AND NOT BUILD_SHARED_LIBS)
    set(CCHIP_URDF ON)
  endif()
  set(CCHIP_PC_ASSEMBLY "-lcchip_assembly ")
endif()
if(CCHIP_MODELS)
  list(APPEND libraries cchip_wire cchip_reference cchip_model cchip_driver)
  set(CCHIP_PC_MODELS "-lcchip_driver -lcchip_model -lcchip_wire ")
endif()
install(TARGETS ${libraries} EXPORT collisionchip
  ARCHIVE DESTINATION ${CMAKE_INSTALL_LIBDIR} LIBRARY DESTINATION ${CMAKE_INSTALL_LIBDIR})
file(RELATIVE_PATH CCHIP_LIBDIR_TO_INCLUDEDIR /${CMAKE_INSTALL_LIBDIR} /${CMAKE_INSTALL_INCLUDEDIR})
if(NOT BUILD_SHARED_LIBS)
  set(CCHIP_PC_STATIC_REQUIRES " libhwy")
  set(CCHIP_PC_STATIC_LIBS " -pthread")
  if(ZLIB_FOUND)
    string(APPEND CCHIP_PC_STATIC_REQUIRES " zlib")
  endif()
  if(CCHIP_3MF)
    string(APPEND CCHIP_PC_STATIC_REQUIRES " libzip pugixml")
  endif()
  if(CCHIP_URDF)
    string(APPEND CCHIP_PC_STATIC_REQUIRES " pugixml")
    string(APPEND CCHIP_PC_STATIC_LIBS " -lurdfdom_model -lconsole_bridge")
  endif()
endif()
configure_file(${CMAKE_CURRENT_LIST_DIR}/collisionchip.pc.in ${PROJECT_BINARY_DIR}/collisionchip.pc @ONLY)
install(FILES ${PROJECT_BINARY_DIR}/collisionchip.pc DESTINATION ${CMAKE_INSTALL_LIBDIR}/pkgconfig)
install(DIRECTORY ${PROJECT_SOURCE_DIR}/lib/include/ ${PROJECT_BINARY_DIR}/lib/forward/ DESTINATION ${CMAKE_INSTALL_INCLUDEDIR}
  FILES_MATCHING PATTERN "*.hpp")
if(CCHIP_MODELS)
  install(DIRECTORY ${PROJECT_SOURCE_DIR}/cpp_ref/include/ DESTINATION ${CMAKE_INSTALL_INCLUDEDIR}
    FILES_MATCHING PATTERN "*.hpp")
endif()
if(CCHIP_COMMAND)
  file(RELATIVE_PATH libdir_from_bindir /${CMAKE_INSTALL_BINDIR} /${CMAKE_INSTALL_LIBDIR})
  if(NOT DEFINED CMAKE_INSTALL_RPATH)  # as CchipLibrary.cmake for the libraries
    set(here "$ORIGIN")
    if(APPLE)
      set(here "@loader_path")
    endif()
    set_target_properties(cchip PROPERTIES INSTALL_RPATH "${here}/${libdir_from_bindir}")
  endif()
  install(TARGETS cchip RUNTIME DESTINATION ${CMAKE_INSTALL_BINDIR})
  install(DIRECTORY ${PROJECT_BINARY_DIR}/shell/completion/
    DESTINATION ${CMAKE_INSTALL_DATADIR}/bash-completion/completions OPTIONAL)
  install(DIRECTORY ${PROJECT_BINARY_DIR}/shell/man/ DESTINATION ${CMAKE_INSTALL_MANDIR}/man1 OPTIONAL)
endif()
if(CCHIP_SIMULATION)
  set_target_properties(cchip_reconfig PROPERTIES EXPORT_NAME reconfig)
  install(TARGETS cchip_reconfig EXPORT collisionchipReconfig ARCHIVE DESTINATION ${CMAKE_INSTALL_LIBDIR})
  install(DIRECTORY ${PROJECT_SOURCE_DIR}/sim/reconfig/include/ DESTINATION ${CMAKE_INSTALL_INCLUDEDIR}
    FILES_MATCHING PATTERN "*.hpp")
  install(EXPORT collisionchipReconfig NAMESPACE collisionchip:: FILE collisionchipReconfigTargets.cmake
    DESTINATION ${CCHIP_PACKAGE_DIR})
endif()
install(DIRECTORY ${PROJECT_SOURCE_DIR}/rtl DESTINATION ${CMAKE_INSTALL_DATADIR}/collisionchip)
install(DIRECTORY ${PROJECT_SOURCE_DIR}/sim/rtl_models DESTINATION ${CMAKE_INSTALL_DATADIR}/collisionchip/sim)
install(FILES ${PROJECT_SOURCE_DIR}/LICENSE DESTINATION ${CMAKE_INSTALL_DOCDIR})
install(DIRECTORY ${PROJECT_SOURCE_DIR}/LICENSES DESTINATION ${CMAKE_INSTALL_DOCDIR})

install(EXPORT collisionchip NAMESPACE collisionchip:: FILE collisionchipTargets.cmake
  DESTINATION ${CCHIP_PACKAGE_DIR})
configure_package_config_file(${CMAKE_CURRENT_LIST_DIR}/collisionchipConfig.cmake.in
  ${PROJECT_BINARY_DIR}/collisionchipConfig.cmake INSTALL_DESTINATION ${CCHIP_PACKAGE_DIR})
write_basic_package_version_file(${PROJECT_BINARY_DIR}/collisionchipConfigVersion.cmake
  COMPATIBILITY SameMinorVersion)
install(FILES ${PROJECT_BINARY_DIR}/collisionchipConfig.cmake ${PROJECT_BINARY_DIR}/collisionchipConfigVersion.cmake
  DESTINATION ${CCHIP_PACKAGE_DIR})

if(PROJECT_IS_TOP_LEVEL)
  set(CPACK_GENERATOR DEB)
  set(CPACK_PACKAGE_NAME collisionchip)
  set(CPACK_PACKAGE_CONTACT "the authors of collisionchip")
  set(CPACK_DEBIAN_FILE_NAME DEB-DEFAULT)
  set(CPACK_DEBIAN_PACKAGE_SECTION libdevel)
  # What the commands and shared libraries need is read from them; headers and static libraries need these besides.
  set(CPACK_DEBIAN_PACKAGE_SHLIBDEPS ON)
  set(CPACK_DEBIAN_PACKAGE_DEPENDS "libeigen3-dev, libhwy-dev")
  if(ZLIB_FOUND)
    string(APPEND CPACK_DEBIAN_PACKAGE_DEPENDS ", zlib1g-dev")
  endif()
  if(CCHIP_3MF)
    string(APPEND CPACK_DEBIAN_PACKAGE_DEPENDS ", libzip-dev, libpugixml-dev")
  endif()
  if(CCHIP_URDF)
    string(APPEND CPACK_DEBIAN_PACKAGE_DEPENDS ", liburdfdom-dev, libpugixml-dev")
  endif()
  if(CCHIP_SIMULATION)
    set(CPACK_DEBIAN_PACKAGE_RECOMMENDS "libjs-three")  # cchip collide --html
  endif()
  set(CPACK_PACKAGING_INSTALL_PREFIX /usr)
  set(CPACK_STRIP_FILES ON)
  set(CPACK_RESOURCE_FILE_LICENSE ${PROJECT_SOURCE_DIR}/LICENSE)
  include(CPack)
endif()
