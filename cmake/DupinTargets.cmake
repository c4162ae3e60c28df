# One target a folder: dupin_add_library(nurbs SOURCES … PUBLIC_HEADERS … PRIVATE_HEADERS … LINKS … PRIVATE_LINKS …)
# makes the static library dupin_nurbs with the alias dupin::nurbs. Includes in the tree are relative to the
# including file ("../nurbs/surface.h"); the repository root is on nobody's include path.
set(DUPIN_LIBRARIES "" CACHE INTERNAL "library targets in layer order")

if(NOT CMAKE_BUILD_TYPE AND NOT CMAKE_CONFIGURATION_TYPES)
  set(CMAKE_BUILD_TYPE Release CACHE STRING "" FORCE)
endif()

add_library(dupin_options INTERFACE)
target_compile_features(dupin_options INTERFACE cxx_std_20)
# The same bytes on every machine: no fused operations the source does not ask for, no reassociation.
target_compile_options(dupin_options INTERFACE -Wall -Wextra -Wno-missing-field-initializers -ffp-contract=off)

function(dupin_add_library name)
  cmake_parse_arguments(A "" "" "SOURCES;PUBLIC_HEADERS;PRIVATE_HEADERS;LINKS;PRIVATE_LINKS" ${ARGN})
  set(target dupin_${name})
  add_library(${target} STATIC ${A_SOURCES} ${A_PUBLIC_HEADERS} ${A_PRIVATE_HEADERS})
  add_library(dupin::${name} ALIAS ${target})
  set_target_properties(${target} PROPERTIES EXPORT_NAME ${name} POSITION_INDEPENDENT_CODE ON
    DUPIN_PUBLIC_HEADERS "${A_PUBLIC_HEADERS}" DUPIN_FOLDER ${name})
  target_compile_features(${target} PUBLIC cxx_std_20)
  target_link_libraries(${target} PUBLIC ${A_LINKS} PRIVATE $<BUILD_INTERFACE:dupin_options> ${A_PRIVATE_LINKS})
  install(TARGETS ${target} EXPORT dupinTargets ARCHIVE DESTINATION ${CMAKE_INSTALL_LIBDIR})
  install(FILES ${A_PUBLIC_HEADERS} DESTINATION ${CMAKE_INSTALL_INCLUDEDIR}/dupin/${name})
  set(DUPIN_LIBRARIES ${DUPIN_LIBRARIES} ${target} CACHE INTERNAL "")
endfunction()

# dupin_add_test(nurbs SOURCES a_test.cpp … LINKS dupin::nurbs) makes test_nurbs; each case is a CTest test.
function(dupin_add_test name)
  cmake_parse_arguments(A "" "" "SOURCES;LINKS" ${ARGN})
  add_executable(test_${name} ${A_SOURCES})
  target_link_libraries(test_${name} PRIVATE ${A_LINKS} dupin_options GTest::gtest GTest::gmock GTest::gtest_main)
  gtest_discover_tests(test_${name} DISCOVERY_MODE PRE_TEST TEST_PREFIX "${name}/" PROPERTIES TIMEOUT 600)
endfunction()
