# What the kernels are compiled for. Each instruction set costs a quarter of the time that they take.
#
# VANTAGE_INSTRUCTION_SETS is a list of Highway's names and of `best`, which is what this machine has
# at best, for a program that stays here. The least of them is what a processor must have: by default
# SSE4 on x86, that is SSE4.2 and AES, as nearly all have since 2013, and NEON on aarch64, as all have.
#
# SVE is left out: its vectors can be no elements of arrays and no members of structures, as half of
# the kernels have them.
if(CMAKE_SYSTEM_PROCESSOR MATCHES "^(aarch64|arm64)$")
  set(vantage_known_instruction_sets NEON)
  set(vantage_unused_instruction_sets SVE SVE_256 SVE2 SVE2_128)
  set(vantage_default_instruction_sets NEON)
else()
  set(vantage_known_instruction_sets SSSE3 SSE4 AVX2 AVX3 AVX3_DL)
  set(vantage_default_instruction_sets SSE4 AVX2 AVX3 AVX3_DL)
endif()
set(VANTAGE_INSTRUCTION_SETS ${vantage_default_instruction_sets} CACHE STRING
  "Instruction sets of the kernels: names of Highway's, and best")

# vantage_best_instruction_set(RESULT): the last set that the processor here has.
function(vantage_best_instruction_set result)
  list(GET vantage_default_instruction_sets 0 best)
  if(EXISTS /proc/cpuinfo AND NOT CMAKE_CROSSCOMPILING)
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
  set(known ${vantage_known_instruction_sets})
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
  list(APPEND disabled ${vantage_unused_instruction_sets})
  list(TRANSFORM disabled PREPEND HWY_)
  list(APPEND disabled 0)
  list(JOIN disabled "|" disabled)
  set(definitions "HWY_DISABLED_TARGETS=(${disabled})")
  if(CMAKE_SYSTEM_PROCESSOR MATCHES "^(x86_64|AMD64|i.86)$")
    list(APPEND definitions "HWY_BASELINE_TARGETS=HWY_${least}")
  endif()
  set(${result} ${definitions} PARENT_SCOPE)
endfunction()
