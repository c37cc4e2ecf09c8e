# crumble_module(name DEPENDS below...): the sources of src/<name> as an object library. A module sees only its own
# headers and those of the modules below it, named here; tests/architecture_test checks the includes themselves.
function(crumble_module name)
  cmake_parse_arguments(ARG "" "" "DEPENDS;SOURCES" ${ARGN})
  list(TRANSFORM ARG_SOURCES PREPEND ${CMAKE_CURRENT_SOURCE_DIR}/${name}/)
  add_library(crumble_${name} OBJECT ${ARG_SOURCES})
  target_include_directories(crumble_${name} PUBLIC
    $<BUILD_INTERFACE:${PROJECT_SOURCE_DIR}/include> PRIVATE ${PROJECT_SOURCE_DIR}/src)
  target_link_libraries(crumble_${name} PUBLIC $<BUILD_INTERFACE:crumble_options> Eigen3::Eigen)
  set(closure ${name})
  foreach(below IN LISTS ARG_DEPENDS)
    get_property(deeper GLOBAL PROPERTY CRUMBLE_CLOSURE_${below})
    list(APPEND closure ${deeper})
  endforeach()
  list(REMOVE_DUPLICATES closure)
  set_property(GLOBAL PROPERTY CRUMBLE_CLOSURE_${name} ${closure})
  set_property(GLOBAL APPEND PROPERTY CRUMBLE_MODULES ${name})
endfunction()

# Links the objects of a module and of all that it stands on: for tests of one module.
function(crumble_link_module target module)
  get_property(closure GLOBAL PROPERTY CRUMBLE_CLOSURE_${module})
  foreach(part IN LISTS closure)
    target_link_libraries(${target} PRIVATE crumble_${part})
  endforeach()
endfunction()

# For programs around the library, which is optimised as it ships: their own code only has to compile quickly (a third
# less at -O1).
function(crumble_compile_quickly target)
  target_compile_options(${target} PRIVATE $<$<CONFIG:Release>:-O1>)
endfunction()
