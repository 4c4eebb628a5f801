# Compiler options that every target of the project shares.
# SPDX-License-Identifier: Apache-2.0
add_library(obscura_options INTERFACE)

target_compile_options(obscura_options INTERFACE
  -Wall -Wextra
  # Where files are joined (OBSCURA_UNITY), one may call a variable as another its constant: only
  # what shadows another variable of a function is an error there. Clang cannot tell them apart.
  $<$<NOT:$<BOOL:$<TARGET_PROPERTY:UNITY_BUILD>>>:-Wshadow>
  $<$<AND:$<BOOL:$<TARGET_PROPERTY:UNITY_BUILD>>,$<CXX_COMPILER_ID:GNU>>:-Wshadow=local>
  -Wconversion
  -fno-math-errno -fno-trapping-math  # sqrt becomes an instruction; NaN and infinity still work
  # a*b+c may become one fused instruction, but in targets that set OBSCURA_UNFUSED
  -ffp-contract=$<IF:$<BOOL:$<TARGET_PROPERTY:OBSCURA_UNFUSED>>,off,fast>
)
if(OBSCURA_WERROR)
  target_compile_options(obscura_options INTERFACE -Werror)
endif()
# GCC 12 sees overlapping copies in "text" + std::string (PR 105651).
if(CMAKE_CXX_COMPILER_ID STREQUAL GNU AND CMAKE_CXX_COMPILER_VERSION VERSION_LESS 13)
  target_compile_options(obscura_options INTERFACE -Wno-restrict)
endif()
# Masks are combined by & and |; for one path a mask is a bool, which clang takes for a slip.
if(CMAKE_CXX_COMPILER_ID MATCHES Clang)
  target_compile_options(obscura_options INTERFACE -Wno-bitwise-instead-of-logical)
endif()
target_compile_definitions(obscura_options INTERFACE
  $<$<CONFIG:Debug>:OBSCURA_DEBUG=1>
  OBSCURA_VERSION="${PROJECT_VERSION}"
)
target_include_directories(obscura_options INTERFACE ${CMAKE_SOURCE_DIR}/src)

# The floor that every file is compiled for; targets that set OBSCURA_MARCH (the stages, once per
# instruction set) have their own.
if(CMAKE_SYSTEM_PROCESSOR MATCHES "x86_64|AMD64")
  set(own_march $<TARGET_PROPERTY:OBSCURA_MARCH>)
  target_compile_options(obscura_options INTERFACE
    -march=$<IF:$<BOOL:${own_march}>,${own_march},x86-64-v2>)
endif()

if(OBSCURA_SANITIZE)
  # The stages are left out (OBSCURA_UNSANITIZED): gathers are not instrumented anyway, and GCC 12
  # needs more than three minutes for each of their files instead of a quarter of one.
  set(sanitized $<NOT:$<BOOL:$<TARGET_PROPERTY:OBSCURA_UNSANITIZED>>>)
  target_compile_options(obscura_options INTERFACE -fno-omit-frame-pointer
    "$<${sanitized}:-fsanitize=address,undefined;-fno-sanitize-recover=all>")
  target_link_options(obscura_options INTERFACE -fsanitize=address,undefined)
  if(CMAKE_CXX_COMPILER_ID STREQUAL GNU)  # the sanitizers' own code confuses this warning
    target_compile_options(obscura_options INTERFACE -Wno-maybe-uninitialized)
  endif()
else()
  # Targets that take longer to compile than to run set OBSCURA_UNOPTIMIZED: it halves the former.
  set(unoptimized $<BOOL:$<TARGET_PROPERTY:OBSCURA_UNOPTIMIZED>>)
  target_compile_options(obscura_options INTERFACE -fstack-protector-strong
    $<$<CONFIG:Release>:$<IF:${unoptimized},-O0,-D_FORTIFY_SOURCE=2>>)
  target_link_options(obscura_options INTERFACE -Wl,-z,relro,-z,now)
endif()
