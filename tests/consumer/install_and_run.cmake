# Run with cmake -P: installs the build at VANTAGE_BUILD_DIR into WORK_DIR/prefix, configures and
# builds CONSUMER_SOURCE_DIR against it, and runs the program; compiles each header for users alone. SANITIZE is the -fsanitize= value the
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

function(build name source_dir)
  step("configure ${name}" ${CMAKE_COMMAND} -S ${source_dir} -B ${WORK_DIR}/${name} -G ${GENERATOR}
    -D CMAKE_PREFIX_PATH=${WORK_DIR}/prefix
    -D CMAKE_BUILD_TYPE=${BUILD_TYPE}
    -D CMAKE_CXX_COMPILER=${CXX_COMPILER}
    -D CMAKE_CXX_FLAGS=${flags}
    ${ARGN})
  step("build ${name}" ${CMAKE_COMMAND} --build ${WORK_DIR}/${name})
endfunction()

step("install" ${CMAKE_COMMAND} --install ${VANTAGE_BUILD_DIR} --prefix ${WORK_DIR}/prefix)
build(consumer ${CONSUMER_SOURCE_DIR})
step("run the program" ${WORK_DIR}/consumer/consumer)
if(NOT SANITIZE)
  build(examples ${CONSUMER_SOURCE_DIR}/../../examples)
  foreach(example match_in_c match_in_cpp)
    step("run ${example}" ${CMAKE_COMMAND} -E chdir ${WORK_DIR} ${WORK_DIR}/examples/${example})
  endforeach()
  file(GLOB_RECURSE module ${WORK_DIR}/prefix/vantage.pc)
  step("build with pkg-config" sh -c "cc -o ${WORK_DIR}/example ${CONSUMER_SOURCE_DIR}/../../examples/match.c \
    $(pkg-config --cflags --libs ${module}) -lm")
endif()
step("run the installed vantage" ${WORK_DIR}/prefix/bin/vantage info)

# A sanitizer sees nothing more in the headers alone.
if(NOT SANITIZE)
  file(STRINGS ${CONSUMER_SOURCE_DIR}/../../engine/vantage.h headers REGEX "^#include \"")
  list(TRANSFORM headers REPLACE "^#include \"(.+)\"" "\\1")
  list(JOIN headers " " headers)
  build(headers ${CONSUMER_SOURCE_DIR}/headers "-DHEADERS=${headers}")
endif()
