# Compiler options that every target of the project shares.
# SPDX-License-Identifier: Apache-2.0
add_library(obscura_options INTERFACE)

target_compile_options(obscura_options INTERFACE
  -Wall -Wextra -Wshadow -Wconversion -Werror
  -fno-math-errno -fno-trapping-math  # sqrt becomes an instruction; NaN and infinity still work
  -ffp-contract=fast                  # a*b+c may become one fused instruction
)
target_compile_definitions(obscura_options INTERFACE
  $<$<CONFIG:Debug>:OBSCURA_DEBUG=1>
  OBSCURA_VERSION="${PROJECT_VERSION}"
)
target_include_directories(obscura_options INTERFACE ${CMAKE_SOURCE_DIR}/src)

# The floor that every file is compiled for; the stages are compiled again above it (src/stages).
if(CMAKE_SYSTEM_PROCESSOR MATCHES "x86_64|AMD64")
  target_compile_options(obscura_options INTERFACE -march=x86-64-v2)
endif()

if(OBSCURA_SANITIZE)
  target_compile_options(obscura_options INTERFACE
    -fsanitize=address,undefined -fno-sanitize-recover=all -fno-omit-frame-pointer)
  target_link_options(obscura_options INTERFACE -fsanitize=address,undefined)
else()
  target_compile_options(obscura_options INTERFACE -fstack-protector-strong
    $<$<CONFIG:Release>:-D_FORTIFY_SOURCE=2>)
  target_link_options(obscura_options INTERFACE -Wl,-z,relro,-z,now)
endif()
