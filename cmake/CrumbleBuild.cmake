# Settings that every target of the project shares.
if(NOT CMAKE_BUILD_TYPE AND NOT CMAKE_CONFIGURATION_TYPES)
  set(CMAKE_BUILD_TYPE Release CACHE STRING "" FORCE)
endif()
# For tests/architecture, which looks at every compilation, and for clang-tidy.
set(CMAKE_EXPORT_COMPILE_COMMANDS ${PROJECT_IS_TOP_LEVEL})
find_program(CRUMBLE_CCACHE ccache)
if(CRUMBLE_CCACHE AND PROJECT_IS_TOP_LEVEL)
  set(CMAKE_CXX_COMPILER_LAUNCHER ${CRUMBLE_CCACHE})
  set(CMAKE_C_COMPILER_LAUNCHER ${CRUMBLE_CCACHE})
endif()

add_library(crumble_options INTERFACE)
target_compile_features(crumble_options INTERFACE cxx_std_20)
# Contraction would turn a*b+c into one rounding on some processors and two on others.
target_compile_options(crumble_options INTERFACE -ffp-contract=off)
if(CRUMBLE_WARNINGS_AS_ERRORS)
  target_compile_options(crumble_options INTERFACE -Wall -Wextra -Wpedantic -Wshadow -Wconversion -Wno-sign-conversion -Werror)
  # GCC 12 sees overlapping copies in "text" + std::string at -O3 where there are none (its bug 105651).
  target_compile_options(crumble_options INTERFACE $<$<CXX_COMPILER_ID:GNU>:-Wno-restrict>)
endif()
set(CMAKE_CXX_EXTENSIONS OFF)
set(CMAKE_POSITION_INDEPENDENT_CODE ON)
set(CMAKE_CXX_VISIBILITY_PRESET hidden)
set(CMAKE_C_VISIBILITY_PRESET hidden)
set(CMAKE_VISIBILITY_INLINES_HIDDEN ON)
