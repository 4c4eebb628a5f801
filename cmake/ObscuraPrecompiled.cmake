# Headers of libraries that many files include, parsed once (OBSCURA_PCH).
# SPDX-License-Identifier: Apache-2.0
# None of the project's own headers is among them, so a change recompiles what it did before. Files
# still include all that they use: tests/layout knows where the standard library's most common names
# come from, and the preset coverage compiles each file by itself.
option(OBSCURA_PCH "Precompile the headers of libraries" ON)
option(OBSCURA_UNITY "Compile many source files of a target at once" ON)

set(obscura_std_headers
  <algorithm> <array> <atomic> <charconv> <cmath> <cstdint> <cstdio> <cstdlib> <cstring> <filesystem>
  <functional> <limits> <map> <memory> <mutex> <numeric> <optional> <set> <span> <string>
  <string_view> <system_error> <tuple> <unordered_map> <utility> <vector>)

# obscura_header_set(NAME libraries... HEADERS headers...): what targets of the set NAME share.
function(obscura_header_set name)
  cmake_parse_arguments(set "" "" "HEADERS" ${ARGN})
  if(NOT OBSCURA_PCH)
    return()
  endif()
  set(empty ${CMAKE_BINARY_DIR}/generated/precompiled/${name}.cpp)
  if(NOT EXISTS ${empty})
    file(WRITE ${empty} "")
  endif()
  add_library(obscura_headers_${name} OBJECT EXCLUDE_FROM_ALL ${empty})
  target_link_libraries(obscura_headers_${name} PRIVATE obscura_options ${set_UNPARSED_ARGUMENTS})
  target_precompile_headers(obscura_headers_${name} PRIVATE ${set_HEADERS})
endfunction()

# obscura_precompiled(TARGET NAME): this target's files begin with the headers of the set NAME.
function(obscura_precompiled target name)
  if(OBSCURA_PCH)
    target_precompile_headers(${target} REUSE_FROM obscura_headers_${name})
    # A precompiled header is no system header to GCC 12, which then warns of endless copies in
    # "text" + std::string (PR 105651).
    if(CMAKE_CXX_COMPILER_ID STREQUAL GNU AND CMAKE_CXX_COMPILER_VERSION VERSION_LESS 13)
      target_compile_options(${target} PRIVATE
        -Wno-stringop-overflow -Wno-stringop-overread -Wno-array-bounds)
    endif()
  endif()
endfunction()

# obscura_unity(TARGET): its files are compiled many at a time, which reads the libraries' headers
# once for all of them.
function(obscura_unity target)
  if(NOT OBSCURA_UNITY)
    return()
  endif()
  set_target_properties(${target} PROPERTIES UNITY_BUILD ON UNITY_BUILD_BATCH_SIZE 16)
  # GCC takes each joined file for a header, whose unnamed namespaces it warns of.
  if(CMAKE_CXX_COMPILER_ID STREQUAL GNU)
    target_compile_options(${target} PRIVATE -Wno-subobject-linkage)
  endif()
endfunction()
