# cmake -DBUILD=… -DSOURCE=… -DWORK=… -P run.cmake: installs the built tree into an empty prefix, then configures, builds and
# runs the project beside this file against it.
cmake_minimum_required(VERSION 3.25)

function(run)
  execute_process(COMMAND ${ARGN} RESULT_VARIABLE result OUTPUT_VARIABLE output ERROR_VARIABLE output)
  if(NOT result EQUAL 0)
    list(JOIN ARGN " " command)
    message(FATAL_ERROR "${command}: ${result}\n${output}")
  endif()
endfunction()

file(REMOVE_RECURSE ${WORK})
run(${CMAKE_COMMAND} --install ${BUILD} --prefix ${WORK}/prefix)
# A moved installation must work too: nothing in it may name the folder that it was installed to.
file(RENAME ${WORK}/prefix ${WORK}/moved)
file(GLOB_RECURSE pkg_config_file ${WORK}/moved/dupin.pc)
get_filename_component(pkg_config_path ${pkg_config_file} DIRECTORY)
set(ENV{PKG_CONFIG_PATH} ${pkg_config_path})
run(${CMAKE_COMMAND} -S ${SOURCE} -B ${WORK}/build -G Ninja -DCMAKE_BUILD_TYPE=Release
  -DCMAKE_CXX_COMPILER=${COMPILER} -DCMAKE_PREFIX_PATH=${WORK}/moved)
run(${CMAKE_COMMAND} --build ${WORK}/build)
foreach(program by_package by_layer by_pkg_config)
  run(${WORK}/build/${program})
endforeach()
# The installed command finds its reader where it was installed.
if(EXISTS ${WORK}/moved/bin/dupin AND EXISTS ${MODEL})
  run(${WORK}/moved/bin/dupin info ${MODEL} --json)
endif()
