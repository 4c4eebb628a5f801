# `cpack -G DEB` in the build folder: a Debian package of what `cmake --install` installs.
# SPDX-License-Identifier: Apache-2.0
install(FILES ${CMAKE_SOURCE_DIR}/CHANGELOG.md DESTINATION ${CMAKE_INSTALL_DOCDIR} COMPONENT program)

set(CPACK_GENERATOR DEB)
set(CPACK_PACKAGE_NAME obscura)
set(CPACK_PACKAGE_VENDOR "The Obscura authors")
set(CPACK_PACKAGE_CONTACT "The Obscura authors <obscura@localhost>")
set(CPACK_PACKAGE_DESCRIPTION_SUMMARY "path tracer for glTF 2.0 scenes that writes HDR EXR")
set(CPACK_PACKAGE_DESCRIPTION "Obscura path-traces glTF 2.0 assets on the CPU and writes scene-linear
 OpenEXR, and PNG and JPEG through OpenColorIO. It needs no GPU and no display.")
set(CPACK_PACKAGING_INSTALL_PREFIX /usr)
set(CPACK_STRIP_FILES ON)
set(CPACK_DEBIAN_FILE_NAME DEB-DEFAULT)
set(CPACK_DEBIAN_PACKAGE_SECTION graphics)
set(CPACK_DEBIAN_PACKAGE_SHLIBDEPS ON)  # the libraries that the program was linked to, by version
# The package's own library is no dependency of it.
set(CPACK_DEBIAN_PACKAGE_SHLIBDEPS_PRIVATE_DIRS ${CMAKE_BINARY_DIR}/lib)
set(CPACK_DEBIAN_PACKAGE_GENERATE_SHLIBS ON)
set(CPACK_DEBIAN_PACKAGE_CONTROL_EXTRA ${CMAKE_SOURCE_DIR}/cmake/triggers)
set(CPACK_PRE_BUILD_SCRIPTS ${CMAKE_SOURCE_DIR}/cmake/DebianFiles.cmake)
if(TARGET obscura_python)
  set(CPACK_DEBIAN_PACKAGE_RECOMMENDS python3-numpy)
endif()
include(CPack)
