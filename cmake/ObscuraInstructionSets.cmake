# obscura_stage_isas: the instruction sets that the stages are compiled for (OBSCURA_ISAS).
# SPDX-License-Identifier: Apache-2.0
set(OBSCURA_ISAS all CACHE STRING
  "Instruction sets of the stages: all, native (the widest of this CPU), or a list of baseline, avx2, avx512")
set(known_isas baseline)
if(CMAKE_SYSTEM_PROCESSOR MATCHES "x86_64|AMD64")
  list(APPEND known_isas avx2 avx512)
endif()

if(OBSCURA_ISAS STREQUAL all)
  set(obscura_stage_isas ${known_isas})
elseif(OBSCURA_ISAS STREQUAL native)
  # The program itself is asked, by the file that it decides with.
  try_run(native_ran native_compiled ${CMAKE_BINARY_DIR}/native_isa
    SOURCES ${CMAKE_SOURCE_DIR}/tools/native_isa.cpp ${CMAKE_SOURCE_DIR}/src/base/cpu.cpp
    CMAKE_FLAGS -DINCLUDE_DIRECTORIES=${CMAKE_SOURCE_DIR}/src
    RUN_OUTPUT_VARIABLE obscura_stage_isas)
  if(NOT native_ran EQUAL 0)
    message(FATAL_ERROR "tools/native_isa.cpp could not be built and run; try -DOBSCURA_ISAS=all")
  endif()
else()
  set(obscura_stage_isas ${OBSCURA_ISAS})
endif()

set(unknown_isas ${obscura_stage_isas})
list(REMOVE_ITEM unknown_isas ${known_isas})
if(unknown_isas OR NOT obscura_stage_isas)
  list(JOIN known_isas ", " known)
  message(FATAL_ERROR "OBSCURA_ISAS is all, native, or a list of ${known}; it is '${OBSCURA_ISAS}'")
endif()
