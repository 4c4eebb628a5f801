# libobscura.so from the rooms up to session/, and what `cmake --install` puts where.
# SPDX-License-Identifier: Apache-2.0
include(GNUInstallDirs)
include(CMakePackageConfigHelpers)

# Only obscura::v0 is to be seen from outside.
set(symbols ${CMAKE_SOURCE_DIR}/cmake/libobscura.map)
add_library(obscura_library SHARED $<TARGET_OBJECTS:obscura_session>)
set_target_properties(obscura_library PROPERTIES
  OUTPUT_NAME obscura EXPORT_NAME obscura LINKER_LANGUAGE CXX LINK_DEPENDS ${symbols}
  VERSION ${PROJECT_VERSION} SOVERSION ${PROJECT_VERSION_MAJOR}.${PROJECT_VERSION_MINOR}
  LIBRARY_OUTPUT_DIRECTORY ${CMAKE_BINARY_DIR}/lib)
target_link_libraries(obscura_library PRIVATE obscura_options obscura_render obscura_denoise obscura_gltf fmt::fmt)
target_link_options(obscura_library PRIVATE -Wl,--version-script=${symbols} -Wl,--no-undefined)
target_include_directories(obscura_library INTERFACE $<INSTALL_INTERFACE:${CMAKE_INSTALL_INCLUDEDIR}>)
target_compile_features(obscura_library INTERFACE cxx_std_17)

install(TARGETS obscura RUNTIME COMPONENT program)
# Both the program and the library open it.
foreach(component program library)
  install(TARGETS obscura_oiio LIBRARY DESTINATION ${CMAKE_INSTALL_LIBDIR}/obscura COMPONENT ${component})
endforeach()
install(TARGETS obscura_library EXPORT obscura-targets
  LIBRARY COMPONENT library NAMELINK_COMPONENT development)
install(DIRECTORY ${CMAKE_SOURCE_DIR}/include/obscura TYPE INCLUDE COMPONENT development)
install(FILES ${CMAKE_SOURCE_DIR}/LICENSE TYPE DOC COMPONENT program)
# What `obscura bench` and `crosscheck` measure where no scene is given.
install(DIRECTORY ${CMAKE_SOURCE_DIR}/assets DESTINATION ${CMAKE_INSTALL_DATADIR}/obscura
  COMPONENT program PATTERN "*.py" EXCLUDE PATTERN generator EXCLUDE)

# find_package(obscura) and pkg-config
set(config_dir ${CMAKE_INSTALL_LIBDIR}/cmake/obscura)
file(WRITE ${CMAKE_BINARY_DIR}/generated/obscura-config.cmake
  "include(\"\${CMAKE_CURRENT_LIST_DIR}/obscura-targets.cmake\")\n")
write_basic_package_version_file(${CMAKE_BINARY_DIR}/generated/obscura-config-version.cmake
  COMPATIBILITY SameMinorVersion)
install(EXPORT obscura-targets NAMESPACE obscura:: DESTINATION ${config_dir} COMPONENT development)
install(FILES ${CMAKE_BINARY_DIR}/generated/obscura-config.cmake
  ${CMAKE_BINARY_DIR}/generated/obscura-config-version.cmake
  DESTINATION ${config_dir} COMPONENT development)
file(RELATIVE_PATH OBSCURA_PREFIX_FROM_PC /${CMAKE_INSTALL_LIBDIR}/pkgconfig /)
configure_file(${CMAKE_SOURCE_DIR}/cmake/obscura.pc.in ${CMAKE_BINARY_DIR}/generated/obscura.pc @ONLY)
install(FILES ${CMAKE_BINARY_DIR}/generated/obscura.pc
  DESTINATION ${CMAKE_INSTALL_LIBDIR}/pkgconfig COMPONENT development)
