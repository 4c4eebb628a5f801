# Finds every library and works round what distributions' packages get wrong (third_party/README.md).
# SPDX-License-Identifier: Apache-2.0

find_package(Threads REQUIRED)
find_package(TBB REQUIRED)
find_package(nlohmann_json REQUIRED)
find_package(tl-expected REQUIRED)
find_package(xsimd REQUIRED)
# Debian's xsimd target links xtl, which it neither needs nor depends on; Debian 13's asks for xtl's
# headers as well, by a definition that precompiled headers would have to share.
set_target_properties(xsimd PROPERTIES
  INTERFACE_LINK_LIBRARIES "" INTERFACE_COMPILE_DEFINITIONS "")
find_package(CLI11 REQUIRED)
find_package(OpenSSL REQUIRED COMPONENTS Crypto)
find_package(fmt REQUIRED)
find_package(PkgConfig REQUIRED)

# Embree 4 where it exists, 3.13 otherwise; src/accel/embree.h hides the difference.
find_package(embree 4 CONFIG QUIET)
if(NOT embree_FOUND)
  find_package(embree 3.13 CONFIG REQUIRED)
endif()
message(STATUS "Embree ${embree_VERSION}")
set_property(TARGET embree APPEND PROPERTY
  INTERFACE_COMPILE_DEFINITIONS OBSCURA_EMBREE=${embree_VERSION_MAJOR})

# Debian's OpenImageIO target names an OpenCV folder that does not exist.
find_package(OpenEXR CONFIG REQUIRED)
find_package(Imath CONFIG REQUIRED)
find_package(OpenImageIO CONFIG REQUIRED)
get_target_property(oiio_folders OpenImageIO::OpenImageIO INTERFACE_INCLUDE_DIRECTORIES)
set(oiio_existing)
foreach(folder IN LISTS oiio_folders)
  if(folder MATCHES "^\\$<" OR EXISTS "${folder}")
    list(APPEND oiio_existing "${folder}")
  endif()
endforeach()
set_target_properties(OpenImageIO::OpenImageIO PROPERTIES
  INTERFACE_INCLUDE_DIRECTORIES "${oiio_existing}")

# Debian's OpenColorIO config file is in an unsearched place with a wrong prefix: take pkg-config.
find_package(OpenColorIO CONFIG QUIET)
if(NOT TARGET OpenColorIO::OpenColorIO)
  pkg_check_modules(OCIO REQUIRED IMPORTED_TARGET OpenColorIO)
  add_library(OpenColorIO::OpenColorIO ALIAS PkgConfig::OCIO)
endif()

pkg_check_modules(WEBP REQUIRED IMPORTED_TARGET libwebp libwebpdemux libwebpmux)
find_package(PNG REQUIRED)
pkg_check_modules(ZSTD REQUIRED IMPORTED_TARGET libzstd)
pkg_check_modules(ISAL REQUIRED IMPORTED_TARGET libisal)
# The server. Its headers must be read with the definitions that the library was built with.
pkg_check_modules(HTTPLIB REQUIRED IMPORTED_TARGET cpp-httplib)

# A header alone, and only that: no version's CMake file is needed.
find_path(TINYGLTF_INCLUDE_DIR tiny_gltf.h PATH_SUFFIXES tinygltf REQUIRED)
add_library(tinygltf_header INTERFACE)
target_include_directories(tinygltf_header SYSTEM INTERFACE ${TINYGLTF_INCLUDE_DIR})

# Draco's CMake file changed its place, its target and its variables from version to version; its
# header and its library stayed where they were.
find_path(DRACO_INCLUDE_DIR draco/compression/decode.h REQUIRED)
find_library(DRACO_LIBRARY draco REQUIRED)
add_library(draco_decoder INTERFACE)
target_include_directories(draco_decoder SYSTEM INTERFACE ${DRACO_INCLUDE_DIR})
target_link_libraries(draco_decoder INTERFACE ${DRACO_LIBRARY})

find_package(meshoptimizer CONFIG REQUIRED)
