# What the kernels are compiled for. Each instruction set costs a fifth of the time that they take.
#
# VANTAGE_INSTRUCTION_SETS is a list of Highway's names, or `best`: what this machine has at best, for
# a program that stays here. Code without vectors is always there. Processors with SSSE3 but without
# SSE4 (before 2008) use that.
set(VANTAGE_INSTRUCTION_SETS SSE4 AVX2 AVX3 AVX3_DL CACHE STRING
  "Instruction sets of the kernels: names of Highway's, or best")

# vantage_disabled_instruction_sets(RESULT): RESULT becomes the value of HWY_DISABLED_TARGETS.
function(vantage_disabled_instruction_sets result)
  set(known SSSE3 SSE4 AVX2 AVX3 AVX3_DL)
  set(wanted ${VANTAGE_INSTRUCTION_SETS})
  if(wanted STREQUAL "best")
    execute_process(COMMAND ${CMAKE_CXX_COMPILER} -march=native -dM -E -x c++ /dev/null
      OUTPUT_VARIABLE macros)
    # The macro by which Highway knows that a set is there.
    foreach(set_and_macro AVX3_DL:__AVX512VBMI2__ AVX3:__AVX512BW__ AVX2:__AVX2__ SSE4:__SSE4_2__)
      string(REPLACE ":" ";" set_and_macro ${set_and_macro})
      list(GET set_and_macro 0 wanted)
      list(GET set_and_macro 1 macro)
      if(macros MATCHES "define ${macro} ")
        break()
      endif()
    endforeach()
  endif()
  set(disabled ${known})
  foreach(name IN LISTS wanted)
    if(NOT name IN_LIST known)
      message(FATAL_ERROR "VANTAGE_INSTRUCTION_SETS has '${name}', expected ${known} or best")
    endif()
    list(REMOVE_ITEM disabled ${name})
  endforeach()
  list(TRANSFORM disabled PREPEND HWY_)
  list(JOIN disabled "|" disabled)
  set(${result} "(${disabled}|0)" PARENT_SCOPE)
endfunction()
