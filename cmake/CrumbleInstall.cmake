# What an installation holds: the C API (crumble::crumble, crumble::crumble_static), the C++ library (crumble::core), and how
# CMake and pkg-config find them. The export sets are apart because only crumble::core needs Eigen. The archives,
# crumble_static and a static core, hand ccd and fcl on to who links them.
include(CMakePackageConfigHelpers)
set(package_dir ${CMAKE_INSTALL_LIBDIR}/cmake/crumble)

function(crumble_install target set)
  install(TARGETS ${target} EXPORT ${set}
    LIBRARY DESTINATION ${CMAKE_INSTALL_LIBDIR} COMPONENT crumble_Runtime NAMELINK_COMPONENT crumble_Development
    ARCHIVE DESTINATION ${CMAKE_INSTALL_LIBDIR} COMPONENT crumble_Development)
  install(EXPORT ${set} NAMESPACE crumble:: DESTINATION ${package_dir} COMPONENT crumble_Development)
endfunction()
crumble_install(crumble_capi crumble-targets)
crumble_install(crumble_capi_static crumble-static-targets)
crumble_install(crumble_core crumble-core-targets)

install(DIRECTORY ${PROJECT_SOURCE_DIR}/include/crumble ${PROJECT_SOURCE_DIR}/capi/include/crumble
  DESTINATION ${CMAKE_INSTALL_INCLUDEDIR} COMPONENT crumble_Development FILES_MATCHING PATTERN *.h PATTERN *.hpp)

configure_package_config_file(${CMAKE_CURRENT_LIST_DIR}/crumble-config.cmake.in
  ${CMAKE_CURRENT_BINARY_DIR}/crumble-config.cmake INSTALL_DESTINATION ${package_dir} NO_SET_AND_CHECK_MACRO)
write_basic_package_version_file(${CMAKE_CURRENT_BINARY_DIR}/crumble-config-version.cmake COMPATIBILITY SameMinorVersion)
install(FILES ${CMAKE_CURRENT_BINARY_DIR}/crumble-config.cmake ${CMAKE_CURRENT_BINARY_DIR}/crumble-config-version.cmake
  DESTINATION ${package_dir} COMPONENT crumble_Development)

# The prefix is found from where crumble.pc lies, so that an installation may be moved; how far up depends on the libdir
# (lib, lib64, lib/x86_64-linux-gnu).
file(RELATIVE_PATH pc_to_prefix ${CMAKE_INSTALL_FULL_LIBDIR}/pkgconfig ${CMAKE_INSTALL_PREFIX})
configure_file(${CMAKE_CURRENT_LIST_DIR}/crumble.pc.in ${CMAKE_CURRENT_BINARY_DIR}/crumble.pc @ONLY)
install(FILES ${CMAKE_CURRENT_BINARY_DIR}/crumble.pc DESTINATION ${CMAKE_INSTALL_LIBDIR}/pkgconfig
  COMPONENT crumble_Development)
