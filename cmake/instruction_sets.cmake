# What the kernels are compiled for. Each instruction set costs a quarter of the time that they take.
#
# VANTAGE_INSTRUCTION_SETS is a list of Highway's names and of `best`, which is what this machine has
# at best, for a program that stays here. On x86 the least of them is what a processor must have: by
# default SSE4, that is SSE4.2 and AES, as nearly all have since 2013.
set(VANTAGE_INSTRUCTION_SETS SSE4 AVX2 AVX3 AVX3_DL CACHE STRING
  "Instruction sets of the kernels: names of Highway's, and best")

# vantage_best_instruction_set(RESULT): the last set that the processor here has.
function(vantage_best_instruction_set result)
  set(best SSE4)
  if(EXISTS /proc/cpuinfo)
    file(STRINGS /proc/cpuinfo features REGEX "^flags" LIMIT_COUNT 1)
    set(sets AVX2 AVX3 AVX3_DL)
    set(features_of_sets avx2 avx512bw avx512_vbmi2)
    foreach(set feature IN ZIP_LISTS sets features_of_sets)
      if("${features} " MATCHES " ${feature} ")
        set(best ${set})
      endif()
    endforeach()
  endif()
  set(${result} ${best} PARENT_SCOPE)
endfunction()

# vantage_instruction_set_definitions(RESULT): RESULT becomes what Highway has to know of them.
function(vantage_instruction_set_definitions result)
  set(known SSSE3 SSE4 AVX2 AVX3 AVX3_DL)
  set(disabled ${known})
  foreach(name IN LISTS VANTAGE_INSTRUCTION_SETS)
    if(name STREQUAL "best")
      vantage_best_instruction_set(name)
    endif()
    if(NOT name IN_LIST known)
      message(FATAL_ERROR "VANTAGE_INSTRUCTION_SETS: '${name}' is none of ${known} or best")
    endif()
    list(REMOVE_ITEM disabled "${name}")
  endforeach()
  set(enabled ${known})
  list(REMOVE_ITEM enabled ${disabled} "")
  list(GET enabled 0 least)
  list(TRANSFORM disabled PREPEND HWY_)
  list(JOIN disabled "|" disabled)
  set(definitions "HWY_DISABLED_TARGETS=(${disabled}|0)")
  if(CMAKE_SYSTEM_PROCESSOR MATCHES "^(x86_64|AMD64|i.86)$")
    list(APPEND definitions "HWY_BASELINE_TARGETS=HWY_${least}")
  endif()
  set(${result} ${definitions} PARENT_SCOPE)
endfunction()
