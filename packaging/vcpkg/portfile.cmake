# An overlay port that builds the tree it lies in. Untested: no vcpkg was at hand when this was written.
vcpkg_check_linkage(ONLY_DYNAMIC_LIBRARY)
get_filename_component(SOURCE_PATH "${CMAKE_CURRENT_LIST_DIR}/../.." ABSOLUTE)

vcpkg_cmake_configure(SOURCE_PATH "${SOURCE_PATH}"
  OPTIONS
    -DCRUMBLE_BUILD_APPS=OFF
    -DCRUMBLE_BUILD_BENCH=OFF
    -DCRUMBLE_BUILD_EXAMPLES=OFF
    -DCRUMBLE_BUILD_TESTS=OFF
    -DCRUMBLE_INSTALL=ON
    -DCRUMBLE_WARNINGS_AS_ERRORS=OFF)
vcpkg_cmake_install()
vcpkg_cmake_config_fixup(CONFIG_PATH lib/cmake/crumble)
vcpkg_fixup_pkgconfig()
file(REMOVE_RECURSE "${CURRENT_PACKAGES_DIR}/debug/include")
file(INSTALL "${CMAKE_CURRENT_LIST_DIR}/usage" DESTINATION "${CURRENT_PACKAGES_DIR}/share/${PORT}")
vcpkg_install_copyright(FILE_LIST "${SOURCE_PATH}/LICENSE")
