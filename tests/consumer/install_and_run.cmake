# Run with cmake -P: installs the build at VANTAGE_BUILD_DIR into WORK_DIR/prefix, configures and
# builds CONSUMER_SOURCE_DIR against it, and runs the program. SANITIZE is the -fsanitize= value the
# libraries were built with, which whoever links them has to repeat.
function(step name)
  execute_process(COMMAND ${ARGN} RESULT_VARIABLE result OUTPUT_VARIABLE output
                  ERROR_VARIABLE output)
  if(NOT result EQUAL 0)
    message(FATAL_ERROR "consumer: ${name} failed (${result})\n${output}")
  endif()
  message(STATUS "consumer: ${name} done")
endfunction()

# A prefix left by an earlier run would hide a header that is no longer installed.
file(REMOVE_RECURSE ${WORK_DIR})
file(MAKE_DIRECTORY ${WORK_DIR})

set(flags "")
if(SANITIZE)
  set(flags "-fsanitize=${SANITIZE} -fno-omit-frame-pointer -fno-sanitize-recover=all")
endif()

# Of the headers for users, those without a source file of their own. The others are the first
# include of one, which the preset dev compiles by itself; compiling all here takes 20 s.
set(source_dir ${CONSUMER_SOURCE_DIR}/../..)
file(STRINGS ${source_dir}/engine/vantage.h lines REGEX "^#include \"")
set(headers "")
foreach(line IN LISTS lines)
  string(REGEX REPLACE "^#include \"(.+)\"" "\\1" header "${line}")
  string(REGEX REPLACE "h$" "cc" source ${header})
  if(NOT EXISTS ${source_dir}/${source})
    list(APPEND headers ${header})
  endif()
endforeach()
list(JOIN headers " " headers)

step("install" ${CMAKE_COMMAND} --install ${VANTAGE_BUILD_DIR} --prefix ${WORK_DIR}/prefix)
step("configure" ${CMAKE_COMMAND} -S ${CONSUMER_SOURCE_DIR} -B ${WORK_DIR}/build -G ${GENERATOR}
  -D CMAKE_PREFIX_PATH=${WORK_DIR}/prefix
  -D CMAKE_BUILD_TYPE=${BUILD_TYPE}
  -D CMAKE_CXX_COMPILER=${CXX_COMPILER}
  -D CMAKE_CXX_FLAGS=${flags}
  "-DHEADERS=${headers}")
step("build" ${CMAKE_COMMAND} --build ${WORK_DIR}/build)
step("run the program" ${WORK_DIR}/build/consumer)
step("run the installed vantage" ${WORK_DIR}/prefix/bin/vantage info)
